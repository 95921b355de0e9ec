"""Words over the viewport."""

from __future__ import annotations

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

import blf
from hangtime.ui.drawing.paint import FONT_ID
from hangtime.ui.overlay.layers.labels import OUTLINE, SHADE


def test_every_version_has_the_outline_that_makes_words_over_bones_readable() -> None:
    blf.shadow(FONT_ID, OUTLINE, *SHADE)  # TypeError where it has not
