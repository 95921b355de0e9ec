"""Words over the viewport, and in its header."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

import blf
from hangtime.operators.drag import follow_mixin
from hangtime.operators.drag.typed_number import TypedNumber
from hangtime.solver.data.status import DragStatus
from hangtime.ui.drawing.paint import FONT_ID
from hangtime.ui.overlay.layers.labels import OUTLINE, SHADE

HEADER = 1010.0  # px of the viewport's header in a window of 1280 × 800, its margins left out
LETTERS = 11.0  # their size there


def test_every_version_has_the_outline_that_makes_words_over_bones_readable() -> None:
    blf.shadow(FONT_ID, OUTLINE, *SHADE)  # TypeError where it has not


def test_what_a_drag_onto_a_surface_tells_fits_into_a_small_window(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    summary = SimpleNamespace(deeper_cm=-12.3, higher_cm=-10.2, peak_bw=13.1)
    seen = SimpleNamespace(seen=SimpleNamespace(summary=summary, status=DragStatus.CONVERGED))
    monkeypatch.setattr(follow_mixin, "live", lambda: seen)
    drag = SimpleNamespace(_press=SimpleNamespace(dragging=True))
    place = "Forward -0.350 · Left -0.317 · Up 0.252 m from here · on Crate"
    found = follow_mixin.FollowedDrag._found(drag)
    blf.size(FONT_ID, LETTERS)
    assert blf.dimensions(FONT_ID, f"{place}{found}")[0] < HEADER


def test_a_drag_tells_its_numbers_also_where_no_motion_follows() -> None:
    told: list[str] = []
    drag = SimpleNamespace(
        _fault="Press Analyze again.",
        _shown="",
        _typed=TypedNumber(),
        text=lambda: "Up 0.252 m",
        _found=str,
        _area=SimpleNamespace(header_text_set=told.append),
    )
    follow_mixin.FollowedDrag._show(drag)
    drag._fault = ""
    follow_mixin.FollowedDrag._show(drag)
    drag._typed.key("TWO", "2")
    follow_mixin.FollowedDrag._show(drag)
    drag._fault = "Press Analyze again."
    follow_mixin.FollowedDrag._show(drag)
    assert told == [
        "Up 0.252 m · Press Analyze again.",
        "Up 0.252 m",
        "[2] Up 0.252 m",
        "[2] Up 0.252 m · Press Analyze again.",
    ]
