"""Editors' regions as draw handlers see them, for Blender without a window."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import bpy
import pytest
from hangtime.ui.drawing import paint
from hangtime.ui.drawing.sketch import Drawing, Text


@dataclass
class Canvas:
    """What handlers painted and wrote, and how many pictures were made for it."""

    pictures: list[paint.DrawingBatches] = field(default_factory=list)
    texts: list[Text] = field(default_factory=list)
    made: int = 0

    @property
    def words(self) -> list[str]:
        return [text.words for text in self.texts]

    def clear(self) -> None:
        self.pictures.clear()
        self.texts.clear()
        self.made = 0


def canvas(monkeypatch: pytest.MonkeyPatch) -> Canvas:
    """Stands in for the GPU."""
    shown = Canvas()

    def upload(drawing: Drawing) -> paint.DrawingBatches:
        shown.made += 1
        return paint.DrawingBatches(None, None, drawing.texts)

    def painted(drawing: paint.DrawingBatches, *_: object) -> None:
        shown.pictures.append(drawing)
        shown.texts.extend(drawing.texts)

    monkeypatch.setattr(paint, "upload", upload)
    monkeypatch.setattr(paint, "paint", painted)
    monkeypatch.setattr(paint, "write", shown.texts.extend)
    monkeypatch.setattr(paint, "compile_shaders", lambda _region: None)
    return shown


def region(kind: str, alignment: str, x: int, y: int, width: int, height: int) -> Any:
    return SimpleNamespace(
        type=kind, alignment=alignment, x=x, y=y, width=width, height=height, view2d=None
    )


def viewport(width: int = 1200, height: int = 700, *others: Any) -> Any:
    """A context of a 3D viewport."""
    window = region("WINDOW", "NONE", 0, 0, width, height)
    return _context(
        window,
        SimpleNamespace(type="VIEW_3D", regions=[window, *others]),
        SimpleNamespace(
            type="VIEW_3D",
            overlay=SimpleNamespace(show_overlays=True),
            show_region_asset_shelf=False,
        ),
    )


def timeline(first: float, last: float, width: int = 1000, height: int = 200) -> Any:
    """A context of a timeline that shows the frames from first to last."""
    window = region("WINDOW", "NONE", 0, 0, width, height)
    window.view2d = SimpleNamespace(
        region_to_view=lambda x, y: (first + x * (last - first) / width, y)
    )
    area = SimpleNamespace(type="DOPESHEET_EDITOR", regions=[window])
    return _context(window, area, SimpleNamespace(show_markers=True))


def _context(window: Any, area: Any, space: Any) -> Any:
    real = bpy.context
    return SimpleNamespace(
        scene=real.scene,
        view_layer=real.view_layer,
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        region=window,
        area=area,
        space_data=space,
    )
