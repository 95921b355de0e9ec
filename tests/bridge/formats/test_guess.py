"""Unit and upward axis are guessed of clips whose files do not tell."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.bridge.formats.guess import ACCLAIM_UNIT, guess_unit, guess_up
from hangtime.bridge.formats.motion_clip import Joint, MotionClip, forward_kinematics
from hangtime.devtools.recordings import HOPS
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.helpers.clips import load_clip

HOP_BVH = "hop_01_01.bvh"


@pytest.mark.parametrize(
    ("relative", "unit", "up", "rate"),
    [
        ("forward_jump_116cm.bvh", ACCLAIM_UNIT, "Y", 120.0),
        ("131_03_hop.bvh", ACCLAIM_UNIT, "Y", 120.0),
        (HOP_BVH, ACCLAIM_UNIT, "Y", 120.0),
        ("run_1.bvh", ACCLAIM_UNIT, "Y", 120.0),
        (HOPS, ACCLAIM_UNIT, "Y", 120.0),
        ("cmu1_jumping_jacks.bvh", ACCLAIM_UNIT, "Y", 30.0),
        ("fair1_jumping.bvh", 0.0254, "Z", 120 / 1.001),
        ("rokoko_jesse_dance.bvh", 0.01, "Y", 100.0),
    ],
)
def test_unit_up_and_rate_are_guessed_right(
    relative: str, unit: float, up: str, rate: float
) -> None:
    clip = load_clip(relative)
    assert guess_up(clip) == up
    assert guess_unit(clip) == pytest.approx(unit)
    assert 1.0 / clip.frame_time == pytest.approx(rate)


def test_who_lies_is_no_smaller() -> None:
    """A clip of a fall, or of crawling, has the same unit as one of the same figure that stands."""
    clip = load_clip("rokoko_jesse_dance.bvh")
    rotations = clip.rotations.copy()
    rotations[:, 0] = axis_rotation(0, np.full(len(rotations), np.pi / 2)) @ rotations[:, 0]
    assert guess_unit(replace(clip, rotations=rotations)) == pytest.approx(0.01)


@pytest.mark.parametrize("metres", [0.0, 10.0])
def test_a_root_that_stands_still_far_off_makes_nobody_larger(metres: float) -> None:
    """As many suits export it: the hips hang on a joint that marks where the stage is."""
    clip, unit = load_clip("rokoko_jesse_dance.bvh"), 0.01
    still = Joint("Reference", -1, np.zeros(3))
    joints = (still, *(replace(each, parent=each.parent + 1) for each in clip.joints))
    count = len(clip.positions)
    positions = np.concatenate([np.zeros((count, 1, 3)), clip.positions], axis=1)
    positions[:, 1] += [metres / unit, 0.0, 0.0]
    turned = np.concatenate([np.tile(np.eye(3), (count, 1, 1, 1)), clip.rotations], axis=1)
    far = replace(clip, joints=joints, positions=positions, rotations=turned)
    assert guess_unit(far) == pytest.approx(unit)


def test_up_is_guessed_without_telling_names() -> None:
    clip = load_clip("fair1_jumping.bvh")
    joints = tuple(replace(joint, name=f"joint{i}") for i, joint in enumerate(clip.joints))
    assert guess_up(replace(clip, joints=joints)) == "Z"


UP = {"Y": 1, "Z": 2}
UPRIGHT_AT_REST = ("forward_jump_116cm.bvh", "Y"), ("fair1_jumping.bvh", "Z")


def turned(clip: MotionClip, turn: np.ndarray) -> MotionClip:
    """Its motion turned by a rotation (3, 3) about the origin; the rest pose stays."""
    rotations, positions = clip.rotations.copy(), clip.positions.copy()
    rotations[:, 0], positions[:, 0] = turn @ rotations[:, 0], positions[:, 0] @ turn.T
    return replace(clip, rotations=rotations, positions=positions)


def on_the_floor(clip: MotionClip, up: str) -> MotionClip:
    """The figure set down so that its lowest joint is on the floor at each frame."""
    positions = clip.positions.copy()
    positions[:, 0, UP[up]] -= forward_kinematics(clip)[0][..., UP[up]].min(axis=1)
    return replace(clip, positions=positions)


@pytest.mark.parametrize(("name", "up"), UPRIGHT_AT_REST)
@pytest.mark.parametrize("heading", [0, 90, 180, 270])
@pytest.mark.parametrize("tilt", [90, -90, 180])
def test_who_lies_or_stands_on_the_hands_all_through_is_upright_at_rest(
    name: str, up: str, heading: int, tilt: int
) -> None:
    way = axis_rotation(UP[up], np.radians(heading)) @ axis_rotation(0, np.radians(tilt))
    assert guess_up(on_the_floor(turned(load_clip(name), way), up)) == up


@pytest.mark.parametrize(("name", "up"), UPRIGHT_AT_REST)
@pytest.mark.parametrize("heading", [0, 90, 180, 270])
@pytest.mark.parametrize("height", [0.0, 0.3, 1.0])
def test_who_is_upside_down_for_long_stands_upright_at_the_ends(
    name: str, up: str, heading: int, height: float
) -> None:
    """As in a freeze, on the floor or on something of so many m: head and feet change places, and
    only leaning is left in the mean."""
    clip = load_clip(name)
    share = np.linspace(0.0, 1.0, len(clip.positions))
    over = np.radians(160.0) * np.interp(share, [0.2, 0.3, 0.7, 0.8], [0.0, 1.0, 1.0, 0.0])
    way = axis_rotation(UP[up], np.full(len(share), np.radians(heading))) @ axis_rotation(0, over)
    rotations = clip.rotations.copy()
    rotations[:, 0] = way @ rotations[:, 0]
    frozen = on_the_floor(replace(clip, rotations=rotations), up)
    frozen.positions[:, 0, UP[up]] += height / guess_unit(clip)
    assert guess_up(frozen) == up


@pytest.mark.parametrize(("name", "up"), UPRIGHT_AT_REST)
@pytest.mark.parametrize("heading", [0, 90, 180, 270])
def test_a_root_that_turns_all_to_the_other_axis_outweighs_the_rest_pose(
    name: str, up: str, heading: int
) -> None:
    """As exporters write motion in another world than the skeleton's; also in place."""
    clip, other = load_clip(name), "Z" if up == "Y" else "Y"
    way = axis_rotation(0, np.radians(90 if up == "Y" else -90))
    way = way @ axis_rotation(UP[up], np.radians(heading))
    at_origin = clip.positions.copy()
    at_origin[:, 0] = 0.0
    assert guess_up(turned(clip, way)) == other
    assert guess_up(turned(replace(clip, positions=at_origin), way)) == other


def test_a_rest_pose_whose_bones_all_follow_one_axis_tells_nothing() -> None:
    clip = load_clip("forward_jump_116cm.bvh")
    joints = tuple(
        replace(joint, offset=np.array([0.0, 0.0, np.linalg.norm(joint.offset)]))
        for joint in clip.joints
    )
    assert guess_up(replace(clip, joints=joints)) == "Y"
