"""Frames that a recording lacks are put in, and those it has too many of taken out, in a copy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.keys_digest import keys_digest
from hangtime.bridge.fake_users import guard
from hangtime.bridge.files.import_clip import import_clip
from hangtime.bridge.repairs.missing_keys import put_in
from hangtime.bridge.repairs.stored import applied, finding_of, findings, is_applied
from hangtime.bridge.takes.takes import derive
from hangtime.solver.doctor.repairs import MissingFrames, Repairs
from hangtime.tests.blender.operators.recording.damages import GAP, LACKS, take_frames_out
from hangtime.tests.helpers.clips import (
    JUMP,
    JUMP_FRAMES,
    mocap_path,
    with_frames_repeated,
    without_frames,
)

HELD, EXTRA, LATER = 195, 36, 250  # a frame that is held for so many more, and a gap after it
pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def lacking(jump: bpy.types.Object) -> bpy.types.Object:
    """The jump without frames 151 to 154, those after them that much earlier."""
    take_frames_out(jump)
    return jump


@pytest.mark.slow
def test_missing_frames_are_put_into_a_copy(jump, request) -> None:
    whole = read_recorded(jump, *JUMP_FRAMES)
    lacking = request.getfixturevalue("lacking")
    settings, recorded = lacking.hangtime, lacking.animation_data.action
    before = keys_digest(recorded)
    settings.use_range, settings.first_frame, settings.last_frame = True, 60, 326
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert finding_of(settings.findings["dropped frames"]).amount == LACKS
    assert bpy.ops.hangtime.repair(kind="dropped frames") == {"FINISHED"}
    assert lacking.animation_data.action != recorded
    assert keys_digest(recorded) == before
    assert (settings.first_frame, settings.last_frame) == (60, 326 + LACKS)
    filled = read_recorded(lacking, *JUMP_FRAMES)
    assert np.abs(filled.heads - whole.heads).max() < 2e-3
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert is_applied(settings, settings.findings["dropped frames"])  # no more is found to be wrong
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert bpy.ops.hangtime.repair(kind="dropped frames") == {"FINISHED"}
    assert lacking.animation_data.action == recorded
    assert list(bpy.data.actions) == [recorded]
    assert settings.last_frame == 326
    assert applied(settings) == Repairs()


@pytest.mark.slow
def test_frames_that_are_too_many_are_taken_out_and_later_ones_put_in(tmp_path: Path) -> None:
    """Remedies count in the recording's frames, whichever are out already."""
    held = with_frames_repeated(mocap_path(JUMP), HELD, EXTRA, tmp_path)
    take = import_clip(without_frames(held, LATER, LACKS, tmp_path)).armature
    settings, recorded = take.hangtime, take.animation_data.action
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    told = finding_of(settings.findings["repeated frames"])
    assert told.remedy == Repairs(missing=(MissingFrames(HELD, -EXTRA),))
    assert bpy.ops.hangtime.repair(kind="repeated frames") == {"FINISHED"}
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert bpy.ops.hangtime.repair(kind="dropped frames") == {"FINISHED"}
    assert applied(settings).missing == (MissingFrames(HELD, -EXTRA), MissingFrames(LATER, LACKS))
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert {row.name for row in findings(settings) if not is_applied(settings, row)} == set()
    mended = read_recorded(take, *JUMP_FRAMES)
    whole = read_recorded(import_clip(mocap_path(JUMP)).armature, *JUMP_FRAMES)
    assert np.abs(mended.heads - whole.heads).max() < 5e-3
    bpy.context.view_layer.objects.active = take
    for kind in ("dropped frames", "repeated frames"):
        assert bpy.ops.hangtime.repair(kind=kind) == {"FINISHED"}
    assert take.animation_data.action == recorded
    assert finding_of(settings.findings["repeated frames"]) == told


def test_frames_left_out_again_leave_a_recording_its_fake_user_while_a_result_lives(
    lacking,
) -> None:
    recorded, gap = lacking.animation_data.action, (MissingFrames(GAP, LACKS),)
    recorded.use_fake_user = False
    result = recorded.copy()
    derive(result, recorded, lacking)
    guard(recorded)
    for left in (True, False):
        put_in(lacking, gap, ())
        assert lacking.animation_data.action != recorded
        put_in(lacking, (), gap)
        assert lacking.animation_data.action == recorded
        assert recorded.use_fake_user == left
        if left:
            bpy.data.actions.remove(result)


@pytest.mark.slow
def test_missing_frames_are_not_put_into_a_strip(lacking) -> None:
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    data = lacking.animation_data
    action, slot = data.action, getattr(data, "action_slot", None)
    strip = data.nla_tracks.new().strips.new("Take", 1, action)
    if slot is not None:
        strip.action_slot = slot
    data.action = None
    with pytest.raises(RuntimeError, match="a strip plays it"):
        bpy.ops.hangtime.repair(kind="dropped frames")
    assert applied(lacking.hangtime) == Repairs()
