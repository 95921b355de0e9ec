"""What tests in the bpy module share: the extension enabled, and a recorded jump."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    import bpy


@pytest.fixture(scope="session", autouse=True)
def _factory_settings() -> None:
    """Whatever who runs the tests prefers."""
    bpy = pytest.importorskip("bpy", reason="needs the bpy module")
    bpy.ops.wm.read_factory_settings(use_empty=True)


@pytest.fixture(scope="session")
def _enabled() -> Iterator[None]:
    """Once, so that one worker and its fits serve all tests, as they do in an artist's session."""
    import hangtime

    hangtime.register()
    yield
    hangtime.unregister()


@pytest.fixture(scope="session")
def _jump_file(_enabled: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file with the recorded jump, active, its frames chosen."""
    from hangtime.bridge.files.import_clip import import_clip
    from hangtime.tests.blender.helpers import rigs
    from hangtime.tests.helpers.clips import JUMP, JUMP_FRAMES, mocap_path

    rigs.reset()
    settings = import_clip(mocap_path(JUMP)).armature.hangtime
    settings.use_range = True
    settings.first_frame, settings.last_frame = JUMP_FRAMES
    return saved(tmp_path_factory.mktemp("jump") / "jump.blend")


@pytest.fixture(scope="session")
def _analysed_file(_jump_file: Path) -> Path:
    """The same, its contacts found."""
    import bpy

    opened(_jump_file)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    return saved(_jump_file.with_name("analysed.blend"))


@pytest.fixture(scope="session")
def _adapted_file(_analysed_file: Path) -> Path:
    """The same, its landing 5 cm higher."""
    import bpy

    opened(_analysed_file).hangtime.stances["ground 2"].up = 0.05
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    return saved(_analysed_file.with_name("adapted.blend"))


@pytest.fixture
def jump(_jump_file: Path) -> bpy.types.Object:
    return opened(_jump_file)


@pytest.fixture
def analysed(_analysed_file: Path) -> bpy.types.Object:
    return opened(_analysed_file)


@pytest.fixture
def adapted(_adapted_file: Path) -> bpy.types.Object:
    return opened(_adapted_file)


@pytest.fixture
def armature() -> bpy.types.Object:
    """A figure with a recording, alone in its file."""
    from hangtime.tests.blender.helpers import rigs

    rigs.reset()
    made = rigs.make_armature()
    rigs.animate(made)
    return made


def saved(path: Path) -> Path:
    import bpy

    assert bpy.ops.wm.save_as_mainfile(filepath=str(path)) == {"FINISHED"}
    return path


def opened(path: Path) -> bpy.types.Object:
    """A file's active armature. A file is quicker opened than a recording read and analysed."""
    import bpy

    assert bpy.ops.wm.open_mainfile(filepath=str(path)) == {"FINISHED"}
    return bpy.context.view_layer.objects.active
