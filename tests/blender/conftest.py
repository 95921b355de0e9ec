"""What tests in the bpy module share: the extension enabled, and a recorded jump."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    import bpy

JUMP = "forward_jump_116cm.bvh"
FIRST, LAST = 73, 325


@pytest.fixture(scope="module")
def _enabled() -> Iterator[None]:
    """Once for a module, so that one worker and its fits serve all of its tests."""
    import hangtime

    hangtime.register()
    yield
    hangtime.unregister()


@pytest.fixture
def jump() -> bpy.types.Object:
    """The recorded jump, active, its frames chosen."""
    from hangtime.bridge.files.import_clip import import_clip
    from hangtime.tests.blender.helpers import rigs
    from hangtime.tests.helpers.clips import mocap_path

    rigs.reset()
    armature = import_clip(mocap_path(JUMP)).armature
    settings = armature.hangtime
    settings.use_range = True
    settings.first_frame, settings.last_frame = FIRST, LAST
    return armature


@pytest.fixture
def analysed(jump: bpy.types.Object) -> bpy.types.Object:
    """The same, its contacts found."""
    import bpy

    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    return jump
