"""Frames at rest and the shorter parts of what was joined are left out by the range."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.fcurves import curves_of, put, table
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.files.import_clip import import_clip
from hangtime.bridge.repairs.stored import finding_of, is_applied
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.operators.recording.damages import kinds, take_frames_out
from hangtime.tests.helpers.clips import JUMP, begun_at_rest, mocap_path

JOINED = 240

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.mark.slow
def test_frames_at_rest_are_left_out_by_the_range(tmp_path) -> None:
    rigs.reset()
    jump = import_clip(begun_at_rest(mocap_path(JUMP), tmp_path)).armature
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(jump) == ["bind pose"]
    bpy.ops.hangtime.repair(kind="bind pose")
    assert (jump.hangtime.use_range, jump.hangtime.first_frame) == (True, 2)
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(jump) == ["bind pose"]  # to be left in again
    bpy.ops.hangtime.repair(kind="bind pose")
    assert not jump.hangtime.use_range


@pytest.mark.slow
def test_frames_at_rest_at_both_ends_are_left_out_together(tmp_path) -> None:
    rigs.reset()
    jump = import_clip(begun_at_rest(mocap_path(JUMP), tmp_path, ended=True)).armature
    last = round(read_recording(jump).frames[-1])
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(jump) == ["bind pose"]
    bpy.ops.hangtime.repair(kind="bind pose")
    settings = jump.hangtime
    assert (settings.use_range, settings.first_frame, settings.last_frame) == (True, 2, last - 1)
    bpy.ops.hangtime.repair(kind="bind pose")
    assert not settings.use_range


@pytest.fixture
def joined(jump: bpy.types.Object) -> bpy.types.Object:
    """The jump, 0.4 m elsewhere from frame 240 on."""
    for curve in curves_of(jump):
        if 'Hips"' in curve.data_path and curve.data_path.endswith("location"):
            keys = table(curve)
            keys["co"][keys["co"][:, 0] >= JOINED, 1] += 0.4 / jump.scale.x / np.sqrt(3.0)
            put(curve, keys)
    return jump


@pytest.mark.slow
def test_of_a_clip_that_was_joined_the_longest_part_is_kept(joined) -> None:
    settings = joined.hangtime
    settings.use_range = False
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert "jump" in kinds(joined)
    assert bpy.ops.hangtime.repair_all() == {"FINISHED"}
    assert (settings.use_range, settings.first_frame, settings.last_frame) == (True, 1, JOINED - 1)
    assert is_applied(settings, settings.findings["jump"])
    assert bpy.ops.hangtime.repair(kind="jump") == {"FINISHED"}
    assert not settings.use_range


@pytest.mark.slow
@pytest.mark.parametrize(
    ("chosen", "left"),
    [
        ((100, 290), (100, JOINED - 1)),
        ((JOINED - 20, 320), (JOINED, 320)),
        ((JOINED + 5, 320), (JOINED + 5, 320)),
    ],
)
def test_of_the_frames_that_were_chosen_the_longest_part_stays(joined, chosen, left) -> None:
    """A range on the other side needs no repair."""
    settings = joined.hangtime
    settings.use_range = True
    settings.first_frame, settings.last_frame = chosen
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    if bpy.ops.hangtime.repair_all.poll():
        bpy.ops.hangtime.repair_all()
    assert (settings.first_frame, settings.last_frame) == left


@pytest.mark.slow
def test_frames_that_are_put_in_move_what_is_left_out(joined) -> None:
    settings = joined.hangtime
    settings.use_range = False
    take_frames_out(joined)
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert {"dropped frames", "jump"} <= set(kinds(joined))
    assert bpy.ops.hangtime.repair_all() == {"FINISHED"}
    assert (settings.first_frame, settings.last_frame) == (1, JOINED - 1)
    assert finding_of(settings.findings["jump"]).frames == ((JOINED - 1, JOINED),)


def test_a_trim_makes_the_frame_range(jump) -> None:
    assert bpy.ops.hangtime.trim(first=100, last=290) == {"FINISHED"}
    assert (jump.hangtime.first_frame, jump.hangtime.last_frame) == (100, 290)
    with pytest.raises(RuntimeError, match="no range"):
        bpy.ops.hangtime.trim(first=100, last=90)
