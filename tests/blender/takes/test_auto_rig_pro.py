"""Results on a rig that is laid out as Auto-Rig Pro's."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.read import record
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.scene.skin import read_skin
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import write_result
from hangtime.devtools.rigs.actor import CLIP
from hangtime.devtools.rigs.controls.auto_rig_pro import auto_rig_pro
from hangtime.devtools.rigs.controls.cases import RATE, cases, performer
from hangtime.devtools.rigs.controls.measure import EDIT, slide
from hangtime.devtools.rigs.controls.skin import add_skin, own_vertices, skin_at
from hangtime.solver.body.anatomy import Part, Side, map_anatomy
from hangtime.solver.body.character import build_character
from hangtime.solver.data.contacts import Contact
from hangtime.solver.data.recording import Bone, PoseTrack, Recording
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.numerics.rotations import axis_rotation, rotation_vector
from hangtime.solver.solid.flesh import flesh_of
from hangtime.solver.worker.pipeline import measure, solve
from hangtime.solver.worker.stage_clock import StageClock
from hangtime.tests.blender.helpers.actions import curves_of
from hangtime.tests.blender.helpers.skins import make_skin

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.mark.slow
def test_a_rig_as_auto_rig_pros_is_written_to_its_controls() -> None:
    take = performer().part(1.0, 12.0, 1)
    rig = auto_rig_pro(take, ik=False, rate=RATE)
    shown = record(rig, take.frames)
    bodies = tuple(shown.bones[segment.bone].name for segment in map_anatomy(shown.bones))
    columns = [shown.index(body) for body in bodies]
    turn = axis_rotation(2, 0.3)
    turned = turn @ shown.rotations[:, columns]
    forearm = bodies.index("forearm.l")
    turned[:, forearm] = axis_rotation(0, 0.2) @ turned[:, forearm]
    moved = PoseTrack(shown.frames, bodies, turned, shown.heads[:, columns[0]] @ turn.T)
    span = (1.0, float(take.frames[-1]))
    skin = add_skin(rig, {"hand.l": Part.HAND, "forearm_twist.l": Part.FOREARM})
    motion = AdaptedMotion(moved, TimeMap(span, span), None, ResultOptions())
    write_result(rig, motion, name="moved")
    after = record(rig, shown.frames)
    np.testing.assert_allclose(after.rotations[:, columns], turned, atol=1e-4)
    # What deforms goes along with it, and the skin.
    hand, twist = after.index("hand.l"), after.index("forearm_twist.l")
    elbow = after.heads[:, columns[forearm]]
    np.testing.assert_allclose(after.heads[:, twist], (elbow + after.heads[:, hand]) / 2, atol=1e-4)
    palm = skin_at(skin, shown.frames)[:, own_vertices(skin, "hand.l")].mean(1)
    along = after.rotations[:, hand, :, 1] * rig.data.bones["hand.l"].length / 2
    np.testing.assert_allclose(palm, after.heads[:, hand] + along, atol=1e-4)
    keyed = {re.findall(r'"(.*?)"', curve.data_path)[0] for curve in curves_of(rig)}
    assert {"c_root_master.x", "c_forearm_fk.l", "c_foot_fk.r"} <= keyed
    assert all(name.startswith("c_") for name in keyed)


def test_a_bone_that_deforms_counts_with_the_body_whose_twist_it_shares() -> None:
    of = {case.key: case.deforming for case in cases()}
    rigify = ["DEF-thigh.L", "DEF-thigh.L.001", "DEF-spine.001", "ORG-thigh.L", "thigh_fk.L"]
    assert of["rigify_fk"](rigify, ("DEF-spine.001", "ORG-thigh.L")) == {
        "DEF-thigh.L": "ORG-thigh.L",
        "DEF-thigh.L.001": "ORG-thigh.L",
        "DEF-spine.001": "DEF-spine.001",
    }
    auto_rig_pro = ["thigh.l", "thigh_twist.l", "thigh_stretch.l", "c_thigh_fk.l", "foot.l"]
    assert of["arp_fk"](auto_rig_pro, ("thigh.l", "foot.l")) == {
        "thigh_twist.l": "thigh.l",
        "thigh_stretch.l": "thigh.l",
        "foot.l": "foot.l",
    }


def test_a_foots_control_slides_by_what_its_keys_carry_the_pinned_heel() -> None:
    """It turns about the heel, and goes on by 2 mm a frame."""
    rest = np.eye(3)
    names = ("foot.l", "c_foot_ik.l")
    bones = tuple(Bone(name, -1, np.zeros(3), np.ones(3), rest) for name in names)
    heel = np.array([0.0, 0.05, -0.08])
    turns = np.stack([axis_rotation(0, 0.1 * t) for t in range(3)])
    forth = 0.002 * np.arange(3)[:, None] * [0.0, 1.0, 0.0]
    heads = np.repeat((heel - turns @ heel + forth)[:, None], 2, axis=1)
    frames = np.arange(1.0, 4.0)
    shown = Recording("jump", bones, frames, frames / RATE, heads, turns[:, None].repeat(2, axis=1))
    contact = Contact("Left heel 1", "Left heel", "foot.l", heel, 0.0, 1.0, heel)
    slid = slide(shown, contact, np.arange(3), "c_foot_ik.{s}")
    assert slid.value == pytest.approx(2.0)
    assert slid.bone == "c_foot_ik.l"


def test_limbs_that_deform_tell_the_shapes_of_the_bodies_that_they_follow() -> None:
    """They hang on the root's control, and not on one another."""
    take = performer().part(1.0, 2.0, 1)
    rig = auto_rig_pro(take, ik=True, rate=RATE)
    make_skin(rig, {bone.name: 0.04 for bone in rig.data.bones if bone.use_deform})
    shown = record(rig, take.frames)
    character = build_character(shown)
    found = flesh_of(complete(read_skin(rig, shown.frames)).skin, shown, character)
    limbs = {i for i, body in enumerate(character.bodies) if body.side is not Side.MIDDLE}
    assert limbs <= set(found)


@pytest.mark.slow
def test_limbs_that_are_straight_for_some_frames_are_met() -> None:
    """The left arm all but straightens in the air; what it needed before leads nowhere then."""
    case = next(each for each in cases() if each.key == "arp_ik")
    take = performer()
    rig = case.build(take)
    recording = record(rig, take.frames)
    problem = replace(CLIP.problem(EDIT), frames=(take.frames[0], take.frames[-1]))
    answer = solve(measure(recording, problem), StageClock())
    motion = AdaptedMotion(answer.track, answer.times, answer.moved, ResultOptions())
    write_result(rig, motion, name=EDIT)
    shown = record(rig, answer.track.frames)
    columns = [shown.index(bone) for bone in answer.track.bones]
    apart = np.swapaxes(answer.track.rotations, -1, -2) @ shown.rotations[:, columns]
    turned = np.linalg.norm(rotation_vector(apart), axis=-1)
    assert np.degrees(turned.max()) < 1.0
