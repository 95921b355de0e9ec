"""Reduced keys on a rig that is posed through controls."""

from __future__ import annotations

from dataclasses import dataclass

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
from hangtime.devtools.rigs.controls.cases import RATE, performer
from hangtime.devtools.rigs.controls.rigify import rigify_human
from hangtime.solver.body.anatomy import map_anatomy
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.data.reports.keys import KeysReport
from hangtime.solver.numerics.rotations import rotation_vector
from hangtime.tests.blender.helpers.ik_rig import ik_rig

LAST, DEEPER = 12, 0.06  # frames, m

pytestmark = pytest.mark.usefixtures("_enabled")


@dataclass(frozen=True)
class Reduced:
    """What reduced keys leave of a result: its report, and by how much bodies are off it as Blender
    plays them (mm, degrees). slid: mm over the ground, of the left foot."""

    report: KeysReport
    mm: float
    degrees: float
    slid: float


def deeper(rig: bpy.types.Object, last: int, standing: str = "") -> Reduced:
    """Write frames 1 to the last to the controls with the pelvis deeper, and reduce the keys.

    standing: a bone that stands.
    """
    take = record(rig, np.arange(1.0, last + 1.0))
    columns = [segment.bone for segment in map_anatomy(take.bones)]
    bodies = tuple(take.bones[column].name for column in columns)
    dip = DEEPER * np.sin(np.linspace(0.0, np.pi, last)) ** 2
    lower = take.heads[:, columns[0]] - dip[:, None] * [0.0, 0.3, 1.0]
    track = PoseTrack(take.frames, bodies, take.rotations[:, columns], lower)
    span = (1.0, float(last))
    motion = AdaptedMotion(track, TimeMap(span, span), None, ResultOptions())
    action, written = write_result(rig, motion, name="deeper")
    assert written is not None
    before = record(rig, take.frames)
    planted = (PlantedPoint(standing, np.zeros(3), *span),) if standing else ()
    keyed = KeyedAction(
        action, fcurves.slot_identifier(rig), bodies, take.frames, None, written.rig
    )
    options = KeyOptions(KeyChoice.REDUCED, 0.002, float(np.radians(0.2)))
    report = complete(choose_keys(rig, keyed, options, KeyEvents(planted, ())))
    after = record(rig, take.frames)
    moved = after.heads - before.heads
    apart = np.swapaxes(before.rotations, -1, -2) @ after.rotations
    turned = np.linalg.norm(rotation_vector(apart[:, columns].reshape(-1, 3, 3)), axis=1)
    foot = columns[next(i for i, body in enumerate(bodies) if "foot.L" in body)]
    return Reduced(
        report,
        1e3 * float(np.linalg.norm(moved[:, columns], axis=2).max()),
        float(np.degrees(turned.max())),
        1e3 * float(np.linalg.norm(moved[:, foot, :2], axis=1).max()),
    )


def require_kept(found: Reduced, frames: int, share: float) -> None:
    """The error is kept, as told, by a share of the keys that every frame has."""
    assert found.mm < 2.0
    assert found.degrees < 0.2
    assert found.report.choice == KeyChoice.REDUCED.value
    assert found.report.keys < share * found.report.channels * frames
    assert found.report.largest_error_mm == pytest.approx(found.mm, abs=0.02)


def stand_and_squat(rig: bpy.types.Object) -> None:
    """Keys of a handmade rig's hips and foot."""
    hips, stand = rig.pose.bones["hips"], rig.pose.bones["stand.L"]
    for frame, height in ((1, -0.05), (6, -0.2), (LAST, -0.05)):
        hips.location.y = height
        for bone in (hips, stand):
            bone.keyframe_insert("location", frame=frame)


@pytest.mark.slow
def test_reduced_keys_on_controls_keep_the_error_of_the_bones_that_follow() -> None:
    rig = ik_rig()
    stand_and_squat(rig)
    found = deeper(rig, LAST, standing="foot.L")
    require_kept(found, LAST, 0.8)
    assert found.slid < 1.0  # a point that stands, half as far


@pytest.mark.slow
def test_a_control_that_the_take_turns_about_a_locked_axis_keeps_the_error_too() -> None:
    rig = ik_rig()
    stand_and_squat(rig)
    spine = rig.pose.bones["spine"]
    spine.rotation_mode, spine.lock_rotation = "XYZ", (True, False, True)
    for frame, (bend, twist) in ((1, (0.0, 0.0)), (5, (0.5, 0.2)), (LAST, (0.1, -0.4))):
        spine.rotation_euler = bend, twist, bend - twist
        spine.keyframe_insert("rotation_euler", frame=frame)
    require_kept(deeper(rig, LAST), LAST, 0.8)


@pytest.mark.slow
def test_reduced_keys_on_a_generated_rigs_inverse_kinematics_keep_the_error() -> None:
    rig = rigify_human(performer(), ik=True, rate=RATE)
    require_kept(deeper(rig, 2 * LAST), 2 * LAST, 0.5)
