"""Reduced keys on a rig that is posed through controls."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.read import record
from hangtime.bridge.keys.events import KeyEvents, PlantedPoint
from hangtime.bridge.keys.written import KeyedAction, choose_keys
from hangtime.bridge.recipe.keys import KeyOptions
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.rows.choices import KeyChoice
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import write_result
from hangtime.solver.body.anatomy import map_anatomy
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.numerics.rotations import rotation_vector
from hangtime.tests.blender.helpers.ik_rig import ik_rig

LAST, DEEPER = 12, 0.06  # frames, m

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.mark.slow
def test_reduced_keys_on_controls_keep_the_error_of_the_bones_that_follow() -> None:
    rig = ik_rig()
    hips, stand = rig.pose.bones["hips"], rig.pose.bones["stand.L"]
    for frame, height in ((1, -0.05), (6, -0.2), (LAST, -0.05)):
        hips.location.y = height
        for bone in (hips, stand):
            bone.keyframe_insert("location", frame=frame)
    take = record(rig, np.arange(1.0, LAST + 1.0))
    columns = [segment.bone for segment in map_anatomy(take.bones)]
    bodies = tuple(take.bones[column].name for column in columns)
    dip = DEEPER * np.sin(np.linspace(0.0, np.pi, LAST)) ** 2
    lower = take.heads[:, columns[0]] - dip[:, None] * [0.0, 0.3, 1.0]
    track = PoseTrack(take.frames, bodies, take.rotations[:, columns], lower)
    span = (1.0, float(LAST))
    motion = AdaptedMotion(track, TimeMap(span, span), None, ResultOptions())
    action, written = write_result(rig, motion, name="deeper")
    assert written is not None
    before = record(rig, take.frames)
    standing = PlantedPoint("foot.L", np.zeros(3), 1.0, float(LAST))
    keyed = KeyedAction(
        action, fcurves.slot_identifier(rig), bodies, take.frames, None, written.rig
    )
    options = KeyOptions(KeyChoice.REDUCED, 0.002, float(np.radians(0.2)))
    report = complete(choose_keys(rig, keyed, options, KeyEvents((standing,), ())))
    after = record(rig, take.frames)
    off = np.linalg.norm(after.heads - before.heads, axis=2)[:, columns]
    apart = np.swapaxes(before.rotations, -1, -2) @ after.rotations
    turned = np.linalg.norm(rotation_vector(apart[:, columns].reshape(-1, 3, 3)), axis=1)
    assert 1e3 * off.max() < 2.0
    assert np.degrees(turned.max()) < 0.2
    assert report.choice == KeyChoice.REDUCED.value
    assert report.keys < 0.8 * report.channels * LAST
    assert report.largest_error_mm == pytest.approx(1e3 * off.max(), abs=0.02)
    slid = (after.heads - before.heads)[:, after.index("foot.L"), :2]
    assert 1e3 * np.linalg.norm(slid, axis=1).max() < 1.0  # a point that stands, half as far
