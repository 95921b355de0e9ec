"""Text of the sidebar: as much in a line as there is room for."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace

import pytest

pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.ui.drawing import paint
from hangtime.ui.drawing.wrapping import broken, wrapped

TOLD = "The fit is within 0.93 cm of the recording; worst 8.69 cm, right foot, frame 226"


def test_lines_are_filled_and_no_word_is_lost() -> None:
    found = list(broken(TOLD, 30.0, len))
    assert max(map(len, found)) <= 30
    assert " ".join(found) == TOLD
    for line, after in pairwise(found):
        assert len(f"{line} {after.split()[0]}") > 30


def test_a_word_wider_than_the_room_has_its_own_line() -> None:
    assert list(broken("of mixamorig_RightHandThumb4 bent", 10.0, len)) == [
        "of",
        "mixamorig_RightHandThumb4",
        "bent",
    ]
    assert list(broken("", 10.0, len)) == [""]


def test_a_wide_sidebar_has_fewer_lines_and_paragraphs_stay(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(paint, "text_width", lambda words, _size: 6.0 * len(words))  # no font here

    def count(width: int) -> int:
        style = SimpleNamespace(widget=SimpleNamespace(points=11.0))
        context = SimpleNamespace(
            region=SimpleNamespace(width=width),
            preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0), ui_styles=[style]),
        )
        return len(wrapped(context, f"{TOLD}\nShort").splitlines())

    assert count(255) > count(370) > count(1000) == 2
    assert count(50) == count(150) < 7, (
        "a sliver cuts lines off; words above each other are no text"
    )
