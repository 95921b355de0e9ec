"""What tests in the bpy module share: the extension enabled, and a recorded jump."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    import bpy


@pytest.fixture(scope="session")
def _enabled() -> Iterator[None]:
    """Once, so that one worker and its fits serve all tests, as they do in an artist's session."""
    import hangtime

    hangtime.register()
    yield
    hangtime.unregister()


@pytest.fixture
def jump() -> bpy.types.Object:
    """The recorded jump, active, its frames chosen."""
    from hangtime.bridge.files.import_clip import import_clip
    from hangtime.tests.blender.helpers import rigs
    from hangtime.tests.helpers.clips import JUMP, JUMP_FRAMES, mocap_path

    rigs.reset()
    armature = import_clip(mocap_path(JUMP)).armature
    settings = armature.hangtime
    settings.use_range = True
    settings.first_frame, settings.last_frame = JUMP_FRAMES
    return armature


@pytest.fixture
def analysed(jump: bpy.types.Object) -> bpy.types.Object:
    """The same, its contacts found."""
    import bpy

    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    return jump
