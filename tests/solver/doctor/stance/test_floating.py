"""A body that floats about while its feet stand is told, and held to the ground."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.damage import at_rate
from hangtime.devtools.doctor.damages.whole_body import floating, swaying
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.body.anatomy import Part
from hangtime.solver.data.problem import Mend, MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.repair import as_asked, floated, repaired
from hangtime.solver.doctor.figure import figure_of
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.doctor.stance.flat_feet import flat_feet
from hangtime.solver.doctor.stance.floating import find_floating, held_to_the_ground
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.numerics.runs import runs
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.doctored import figure, jump

HELD = Repairs(mend=(Mend.FLOATING,))


def told(recording: Recording) -> list[FindingKind]:
    return [f.kind for f in diagnose(recording).findings if not f.kind.note]


def moved(recording: Recording) -> np.ndarray:
    """(3,) m, rms, by which feet that stand flat in the jump as it was recorded move."""
    feet, clean = (list(flat_feet(each, figure())) for each in (recording, jump()))
    stands = [foot.stands(jump().rate) for foot in clean]
    parts = [
        foot.track[first : last + 1]
        for foot, at in zip(feet, stands, strict=True)
        for first, last in runs(at)
    ]
    return np.sqrt(np.mean(np.concatenate([each - each.mean(axis=0) for each in parts]) ** 2, 0))


@pytest.mark.slow
@pytest.mark.parametrize(("metres", "seconds"), [(0.05, 2.0), (0.1, 3.0), (0.15, 4.0)])
def test_a_body_that_floats_up_and_down_is_told_and_its_feet_held_level(metres, seconds) -> None:
    damaged = floating(metres, seconds).of(jump()).recording
    found = diagnose(damaged)
    assert FindingKind.FLOATING in [f.kind for f in found.findings]
    assert moved(repaired(damaged, found.repairs))[2] < 0.4 * moved(damaged)[2]


def test_a_body_that_sways_is_told_and_its_feet_keep_their_place() -> None:
    damaged = swaying(0.1, 2.0).of(jump()).recording
    assert told(damaged) == [FindingKind.FLOATING]
    assert moved(repaired(damaged, HELD))[0] < 0.4 * moved(damaged)[0]


@pytest.mark.parametrize("name", [JUMP, "131_03_hop.bvh", "hop_01_01.bvh", "hops_in_place.bvh"])
@pytest.mark.parametrize("rate", [24.0, 60.0])
def test_honest_feet_do_not_float_and_are_left_as_they_are(name: str, rate: float) -> None:
    clip = at_rate(load_recording(name), rate)
    assert find_floating(clip, figure_of(clip)) is None
    np.testing.assert_array_equal(repaired(clip, HELD).heads, clip.heads)


@pytest.mark.parametrize(
    ("name", "metres", "seconds"),
    [("high_jump.bvh", 0.1, 3.0), ("high_jump.bvh", 0.12, 3.0), ("131_03_hop.bvh", 0.1, 5.0)],
)
def test_a_level_floor_below_feet_that_stand_shortly_is_no_box(name, metres, seconds) -> None:
    """Of 2.9 s the jumper's feet stand flat in 0.7, which tells little of the way between."""
    clean = load_recording(name)
    damaged = floating(metres, seconds).of(clean).recording
    assert apart(repaired(damaged, HELD), clean) < 0.6 * apart(damaged, clean)


def off_a_box(height: float) -> Recording:
    """The jump from a box: what is before its flight's middle is higher, smoothly."""
    middle = jump().times[int(np.argmax(jump().heads[:, figure().bones[0], 2]))]
    later = np.clip((jump().times - middle) / 0.3 + 0.5, 0.0, 1.0)
    higher = height * (1.0 - later**2 * (3.0 - 2.0 * later))
    return replace(jump(), heads=jump().heads + higher[:, None, None] * [0.0, 0.0, 1.0])


def test_a_body_that_floats_beside_a_box_keeps_the_box() -> None:
    clean = off_a_box(0.3)
    assert find_floating(clean, figure()) is None
    for metres, seconds in ((0.05, 2.0), (0.1, 3.0)):
        damaged = floating(metres, seconds).of(clean).recording
        found = find_floating(damaged, figure())
        assert found is not None
        assert found.amount < 200.0 * metres
        assert apart(repaired(damaged, HELD), clean) < 0.8 * apart(damaged, clean)


def test_who_climbs_does_not_float() -> None:
    """Feet that stand still, each a step higher than the one before."""
    steps = np.repeat([0.0, 0.0, 0.15, 0.15, 0.3], 51)[: len(jump().times)]
    rise = steps[:, None, None] * np.array([0.0, 0.0, 1.0])
    stepped = replace(jump(), heads=jump().heads + rise)
    assert find_floating(stepped, figure()) is None


def test_one_foot_that_is_lifted_flat_is_no_floating() -> None:
    """The other one stands meanwhile."""
    heads = jump().heads.copy()
    lifted = 0.05 * (1.0 - np.cos(2.0 * np.pi * jump().times / 0.8))
    left = [b for b, bone in enumerate(jump().bones) if bone.name in ("LeftFoot", "LeftToeBase")]
    assert left[0] in figure().of(Part.FOOT)
    heads[:, left, 2] += lifted[:, None]
    assert find_floating(replace(jump(), heads=heads), figure()) is None


def test_feet_that_are_held_still_in_the_air_do_not_float() -> None:
    """As in a freeze on the hands, or of who lies on the back with the feet up."""
    swayed = swaying(0.1, 2.0).of(jump()).recording
    assert find_floating(swayed, figure()) is not None
    for degrees in (-90.0, 180.0):
        turn = axis_rotation(0, np.array([np.radians(degrees)]))[0]
        heads, rotations = swayed.heads @ turn.T, turn @ swayed.rotations
        turned = replace(swayed, heads=heads, rotations=rotations)
        assert find_floating(turned, figure()) is None
        assert held_to_the_ground(turned, figure()) is turned


def test_the_problem_that_asks_for_it_is_held_and_tells_how_far_it_floated() -> None:
    damaged = floating(0.1, 3.0).of(jump()).recording
    asked = MotionProblem(mend=(Mend.FLOATING,))
    held, last = as_asked(damaged, asked), float(damaged.frames[-1])
    np.testing.assert_array_equal(held.heads, repaired(damaged, HELD).heads)
    away = damaged.heads[-1, 0] - held.heads[-1, 0]
    assert floated(damaged, asked, last) == pytest.approx(tuple(away))
    assert floated(damaged, MotionProblem(), last) == (0.0, 0.0, 0.0)


def test_a_frame_alone_floats_nowhere() -> None:
    alone = jump().part(slice(0, 1))
    assert held_to_the_ground(alone, figure()) is alone
