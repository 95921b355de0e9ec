"""Export: accepted results as takes of one file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature.read import record
from hangtime.bridge.files.reimport import reimport
from hangtime.tests.blender.helpers.fbx import fbx_file

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def adapted(jump: bpy.types.Object) -> bpy.types.Object:
    """The jump with a result, made by hand instead of by a solve."""
    recorded = current_action(jump)
    result = recorded.copy()
    result.name, result.hangtime.recording = "Longer", recorded
    jump.animation_data.action = jump.hangtime.adapted = result
    assert bpy.ops.hangtime.find_bones() == {"FINISHED"}
    return jump


@pytest.fixture
def accepted(adapted: bpy.types.Object) -> bpy.types.Object:
    assert bpy.ops.hangtime.accept() == {"FINISHED"}
    return adapted


def test_export_waits_for_a_result_that_is_accepted(
    adapted: bpy.types.Object, tmp_path: Path
) -> None:
    """The ending tells the format where none is chosen."""
    assert not bpy.ops.hangtime.export.poll()
    assert bpy.ops.hangtime.accept() == {"FINISHED"}
    assert not bpy.ops.hangtime.accept.poll()
    result = current_action(adapted)
    frames = np.arange(*result.frame_range)[::20]
    shown = record(adapted, frames)
    for name, begins in (
        ("out.fbx", b"Kaydara FBX"),
        ("out.glb", b"glTF"),
        ("out.usda", b"#usda 1.0"),
    ):
        path = tmp_path / name
        assert bpy.ops.hangtime.export(filepath=str(path)) == {"FINISHED"}
        assert path.read_bytes().startswith(begins)
        again = reimport(path, frames)
        columns = [again.index(bone.name) for bone in shown.bones]
        np.testing.assert_allclose(again.heads[:, columns], shown.heads, atol=1e-3)
    assert current_action(adapted) == result


def test_all_accepted_results_are_takes_of_one_file(
    accepted: bpy.types.Object, tmp_path: Path
) -> None:
    first = current_action(accepted)
    second, third = first.copy(), first.copy()
    second.name, third.name = "Higher", "Not Accepted"
    third.hangtime.accepted = False
    path = tmp_path / "jumps.fbx"
    done = bpy.ops.hangtime.export(
        filepath=str(path), engine="UNREAL", takes="ACCEPTED", root="ROOT_BONE"
    )
    assert done == {"FINISHED"}
    found = fbx_file(path)
    assert set(found.takes) == {first.name, "Higher"}
    assert {"Armature", "root"} <= set(found.transformations)
    assert current_action(accepted) == first


def test_a_usd_of_several_takes_is_refused_in_words(
    accepted: bpy.types.Object, tmp_path: Path
) -> None:
    current_action(accepted).copy()
    path = tmp_path / "jumps.usda"
    with pytest.raises(RuntimeError, match="A USD file holds one take"):
        bpy.ops.hangtime.export(filepath=str(path), takes="ACCEPTED", format="USD")
    assert not path.exists()
