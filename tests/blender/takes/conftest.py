"""An armature with keys, for tests of takes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    import bpy


@pytest.fixture
def armature() -> bpy.types.Object:
    from hangtime.tests.blender.helpers import rigs

    rigs.reset()
    made = rigs.make_armature()
    rigs.animate(made)
    return made
