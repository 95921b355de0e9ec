"""Soles that a person may have, alike under both feet, whatever the feet of a recording do."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.analysis.performance import contact_points, find_contacts, perform
from hangtime.solver.body.character import build_character
from hangtime.solver.data.contacts import ContactPoint
from hangtime.solver.data.recording import Recording
from hangtime.tests.helpers.clips import JUMP, load_recording

HIGH = "131_03_hop.bvh"  # the balls of its feet stand 7 cm up, higher than any other's
TIPTOE = "rokoko_jesse_dance.bvh"  # a dance whose ankles are never lower than 14 cm
RUNS = ("run_1.bvh", "run_2.bvh", "run_3.bvh")
JUMPS = (
    JUMP,
    "forward_jump_114cm.bvh",
    "high_jump.bvh",
    "hops_in_place.bvh",
    "fair1_jumping.bvh",
    "cmu1_jumping_jacks.bvh",
)
RIGHT = ("RightFoot", "RightToeBase")
SHOD_ANKLE = 0.039, 0.03  # of the stature, by Drillis and Contini; m of a thick shoe
NEAR = 0.01  # m


def points_of(recording: Recording) -> tuple[dict[str, ContactPoint], float]:
    return contact_points(perform(recording, build_character(recording)))


def raised(recording: Recording, height: float) -> Recording:
    return replace(recording, heads=recording.heads + np.array([0.0, 0.0, height]))


def foot_up(height: float, names: tuple[str, ...] = RIGHT) -> Recording:
    """The jump with a foot held higher, as a bent knee would."""
    recording = load_recording(JUMP)
    heads = recording.heads.copy()
    heads[:, [recording.index(name) for name in names], 2] += height
    return replace(recording, heads=heads)


def beneath(recording: Recording, side: str) -> float:
    """m, of the heel's point under the ankle in the first frame, in which both feet are level."""
    points, _ = points_of(recording)
    ankle = recording.heads[0, recording.index(f"{side}Foot")]
    return float(ankle[2] - points[f"{side} heel"].track[0, 2])


@pytest.mark.slow
@pytest.mark.parametrize("height", [0.08, 0.15, 0.3])
def test_a_foot_that_floats_has_the_sole_of_the_other(height: float) -> None:
    recording = foot_up(height)
    points, floor = points_of(recording)
    assert floor == 0.0
    assert beneath(recording, "Right") == pytest.approx(beneath(recording, "Left"), abs=NEAR)
    for end in ("heel", "toe"):
        assert points[f"Right {end}"].track[0, 2] == pytest.approx(height, abs=0.02)
    schedule = find_contacts(perform(recording, build_character(recording)))
    assert {c.point for c in schedule.contacts} == {"Left heel", "Left toe"}


def test_feet_that_stand_a_little_apart_both_stand() -> None:
    points, floor = points_of(foot_up(0.015))
    for point in ("Left heel", "Left toe", "Right heel", "Right toe"):
        assert points[point].track[0, 2] == pytest.approx(floor, abs=NEAR)


def test_a_shorter_leg_stands_on_a_thicker_sole() -> None:
    """As the rest pose tells: a shoe with a raised sole makes up for it."""
    shorter = 0.06
    recording = foot_up(shorter)
    up = np.array([0.0, 0.0, shorter])
    bones = tuple(
        replace(b, head=b.head + up, tail=b.tail + up) if b.name in RIGHT else b
        for b in recording.bones
    )
    points, floor = points_of(replace(recording, bones=bones))
    assert floor == 0.0
    assert points["Right heel"].track[0, 2] == pytest.approx(0.0, abs=NEAR)
    assert points["Right toe"].track[0, 2] == pytest.approx(0.0, abs=NEAR)


@pytest.mark.slow
def test_the_floor_goes_with_the_recording() -> None:
    """It does not leap, and goes by as much where 0 cannot be the floor."""
    recording, lift = load_recording(HIGH), 0.01
    floors = [points_of(raised(recording, lift * i))[1] for i in range(-16, 13)]
    steps = np.diff(floors)
    assert np.all((steps >= 0.0) & (steps < 2.0 * lift + 1e-9))
    assert steps[:5] == pytest.approx(lift)
    assert steps[-5:] == pytest.approx(lift)


def test_a_dancer_on_tiptoe_has_the_soles_of_one_who_stands() -> None:
    recording = load_recording(TIPTOE)
    character = build_character(recording)
    points, floor = contact_points(perform(recording, character))
    assert floor == 0.0
    share, shoe = SHOD_ANKLE
    for side in ("Left", "Right"):
        below_and_behind = np.hypot(share * character.height + shoe, 0.05)
        assert np.linalg.norm(points[f"{side} heel"].offset) < below_and_behind


@pytest.mark.parametrize("clip", [HIGH, *RUNS, *JUMPS])
def test_recordings_stand_on_the_world_s_floor(clip: str) -> None:
    """Their balls are 2 to 7 cm up when they stand, and who adds ground puts it at 0."""
    assert points_of(load_recording(clip))[1] == 0.0
