"""A cycle on a rig that is posed through controls: its keys are on these, and repeat."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.read import record
from hangtime.bridge.loops.write_loop import Loop, write_loop
from hangtime.bridge.rows.choices import LoopRoot
from hangtime.devtools.recordings import find, read
from hangtime.devtools.rigs.actor import Actor, acting
from hangtime.devtools.rigs.controls.auto_rig_pro import auto_rig_pro
from hangtime.devtools.rigs.controls.rigify import rigify_human
from hangtime.solver.body.anatomy import map_anatomy
from hangtime.solver.data.recording import PoseTrack
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import curves_of
from hangtime.tests.blender.helpers.ik_rig import ik_rig

FRAMES = np.arange(1.0, 14.0)
TRAVEL = np.array([0.0, -1.2, 0.0])
CONTROLS = {"hips", "stand.L", "stand.R", "knee_pole.L", "knee_pole.R"}

pytestmark = pytest.mark.usefixtures("_enabled")


def walk(rig: bpy.types.Object, *, drift: float) -> None:
    """Key hips and feet: a step of each foot, and on. drift: m by which no two cycles agree."""
    for frame in FRAMES:
        share = (frame - FRAMES[0]) / (FRAMES[-1] - FRAMES[0])
        about = 2.0 * np.pi * share
        for name in sorted(CONTROLS):
            phase = about + (np.pi if name.endswith(".R") else 0.0)
            steps = name.startswith("stand")
            ahead = share * TRAVEL[1] - 0.1 * steps * np.sin(phase)
            higher = 0.06 + 0.05 * np.cos(phase) if steps else -0.1
            bone = rig.pose.bones[name]
            place = np.array([drift * share, ahead, higher])
            turn = np.array(bone.bone.matrix_local.to_3x3())
            bone.location = turn.T @ place if bone.bone.use_local_location else place
            bone.keyframe_insert("location", frame=frame)
        chest = rig.pose.bones["chest"]
        chest.rotation_mode = "XYZ"
        chest.rotation_euler = (0.1 * np.sin(about), 0.2 * np.cos(about), drift * share)
        chest.keyframe_insert("rotation_euler", frame=frame)


def performed(rig: bpy.types.Object) -> PoseTrack:
    """The bodies as they are shown."""
    shown = record(rig, FRAMES)
    columns = [segment.bone for segment in map_anatomy(shown.bones)]
    names = tuple(shown.bones[column].name for column in columns)
    return PoseTrack(FRAMES, names, shown.rotations[:, columns], shown.heads[:, columns[0]])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("root", "local"),
    [(LoopRoot.HIPS, True), (LoopRoot.HIPS, False), (LoopRoot.IN_PLACE, True)],
    ids=["travelling", "locations along the armature's axes", "in place"],
)
def test_controls_repeat_and_the_feet_go_on(root: LoopRoot, local: bool) -> None:
    rigs.reset()
    rig = ik_rig()
    for side in "LR":
        rig.data.bones[f"stand.{side}"].use_local_location = local
    walk(rig, drift=0.0)
    cycle = performed(rig)
    rig.animation_data.action = None
    walk(rig, drift=0.05)
    take, slot = current_action(rig), fcurves.slot_identifier(rig)
    loop = Loop.of(rig, cycle, root)
    action, written = complete(write_loop(rig, loop, take, slot, name="Loop"))
    fcurves.assign(rig, action, slot)
    assert written.controls is not None
    assert written.controls.kept
    keyed = {re.findall(r'"(.*?)"', curve.data_path)[0] for curve in curves_of(rig)}
    assert keyed >= CONTROLS
    assert not keyed & {"thigh.L", "shin.R", "foot.L"}
    travel = TRAVEL if root is LoopRoot.HIPS else 0.0 * TRAVEL
    steady = np.linspace(0.0, 1.0, len(FRAMES))[:, None] * (TRAVEL - travel)
    once = performed(rig)
    np.testing.assert_allclose(once.root_head, cycle.root_head - steady, atol=1e-4)
    np.testing.assert_allclose(once.rotations, cycle.rotations, atol=1e-3)
    for times in (1.0, -2.0):
        shown = record(rig, FRAMES + times * (len(FRAMES) - 1))
        first = record(rig, FRAMES)
        for bone in ("hips", "foot.L", "foot.R", "hand.R"):
            column = first.index(bone)
            again = first.heads[:, column] + times * travel
            np.testing.assert_allclose(shown.heads[:, column], again, atol=1e-4)


def runner(every: int) -> Actor:
    """A recorded run that begins over the rig, one in `every` of its frames."""
    whole = read(find("run_2.bvh"))
    run = acting(whole, whole).part(1.0, 152.0, every)
    return replace(run, heads=run.heads - run.heads[0, 0] * [1.0, 1.0, 0.0])


@pytest.mark.slow
@pytest.mark.parametrize("build", [rigify_human, auto_rig_pro], ids=["Rigify", "Auto-Rig Pro"])
def test_a_run_of_feet_in_inverse_kinematics_becomes_a_loop(
    build: Callable[..., bpy.types.Object],
) -> None:
    rig = build(runner(4), ik=True, rate=30)
    bpy.context.view_layer.objects.active = rig
    take, settings = current_action(rig), rig.hangtime
    settings.use_range, settings.loop.use = True, True
    settings.first_frame, settings.last_frame = 8, 30
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert current_action(rig) != take
    assert "controls have keys" in settings.status
    first, last = settings.first_frame, settings.last_frame
    frames = np.arange(first, last + 1.0)
    once, again = record(rig, frames), record(rig, frames + last - first)
    deform = [once.index(bone.name) for bone in rig.data.bones if bone.use_deform]
    travel = (again.heads - once.heads)[:, deform]
    assert 2.0 < np.linalg.norm(travel[0, 0]) < 2.3
    np.testing.assert_allclose(travel, np.broadcast_to(travel[0, 0], travel.shape), atol=1e-4)
