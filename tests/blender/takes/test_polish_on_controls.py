"""Hand polish on a rig that is posed through controls."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.polish.renewal import Renewal
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.results.made import note_made
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import write_adapted_incrementally
from hangtime.solver.body.anatomy import map_anatomy
from hangtime.solver.data.contacts import ContactSchedule
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.tests.blender.helpers.ik_rig import ik_rig

SPAN = (1.0, 3.0)
FEW_KEYS = [[1.0, 0.0], [2.5, 0.4], [4.0, 0.1]]

pytestmark = pytest.mark.usefixtures("_enabled")


def adapt(rig: bpy.types.Object, up: float) -> bpy.types.Action:
    """A result in which frames 1 to 3 are so much higher, with the polish of the one before."""
    take = read_recorded(rig, *SPAN)
    columns = [segment.bone for segment in map_anatomy(take.bones)]
    bodies = tuple(take.bones[column].name for column in columns)
    heads = take.heads[:, columns[0]] + [0.0, 0.0, up]
    track = PoseTrack(take.frames, bodies, take.rotations[:, columns], heads)
    renewal = Renewal.of(rig)
    motion = AdaptedMotion(track, TimeMap(SPAN, SPAN), None, ResultOptions())
    action, written = complete(write_adapted_incrementally(rig, motion))
    schedule = ContactSchedule((), 1.0, 0.0)
    complete(renewal.put_on(action, written.owned, written.time, schedule, 24.0))
    note_made(rig, action, written.span, written.later)
    renewal.note(action, written.time, SPAN)
    return action


def test_what_no_written_control_owns_keeps_its_few_keys() -> None:
    rig = ik_rig()
    rig["mood"] = 0.0
    hips = rig.pose.bones["hips"]
    for frame, height in ((1, -0.05), (4, -0.2)):
        hips.location.y = height
        hips.keyframe_insert("location", frame=frame)
    adapt(rig, 0.02)
    polished = {'["mood"]': 0, 'pose.bones["toe.L"].scale': 1}
    for path, index in polished.items():
        curve = fcurves.ensured(fcurves.holder(rig), path, index, "")
        for frame, value in FEW_KEYS:
            curve.keyframe_points.insert(frame, value)
    place = hips.path_from_id("location")
    lifted = fcurves.holder(rig).fcurves.find(place, index=0)
    lifted.keyframe_points.insert(2.0, 0.3)  # of a control that is written: as an offset
    again = fcurves.holder_in(adapt(rig, 0.04), fcurves.slot_identifier(rig)).fcurves
    for path, index in polished.items():
        kept = fcurves.keys(again.find(path, index=index))
        np.testing.assert_allclose(kept, FEW_KEYS, atol=1e-6)
    assert again.find(place, index=0).evaluate(2.0) == pytest.approx(0.3, abs=1e-3)
