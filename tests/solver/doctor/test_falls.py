"""Clock and size are told by falls, where these are falls."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.clock import slowed
from hangtime.devtools.doctor.damages.whole_body import sized
from hangtime.solver.analysis.carried_by import agreed_rate
from hangtime.solver.analysis.performance import find_contacts, perform
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import build_character
from hangtime.solver.data.problem import AddedContact, MotionProblem
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.suspects import faults_of
from hangtime.solver.doctor.falls import find_scale, in_the_air
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.local_poses import LocalPoses
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.numerics.rotations import rotation_matrix
from hangtime.solver.unseen.held import is_held
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.doctored import character, jump


@pytest.mark.parametrize("factor", [0.5, 0.8, 1.25, 2.0])
def test_a_clock_that_is_wrong_is_told_by_the_fall(factor: float) -> None:
    damaged = slowed(factor).of(jump()).recording
    found = find_scale(perform(damaged, character()))
    assert found is not None
    assert found.kind is FindingKind.TIME_SCALE
    assert found.remedy is not None
    assert found.remedy.time_scale * factor == pytest.approx(1.0, abs=1e-9)  # 120 Hz is usual
    assert found.alternative is not None
    assert found.alternative.scale == pytest.approx(factor**2, rel=0.05)


@pytest.mark.parametrize("factor", [pytest.param(0.85, marks=pytest.mark.slow), 1.2])
def test_a_long_fall_tells_a_size_that_may_be_a_persons(factor: float) -> None:
    """One of 0.4 s tells the acceleration to a few percent: sizes that miss it by 15 % are told,
    with the clock that explains them as well."""
    damaged = sized(factor, "size").of(jump()).recording
    (found,) = diagnose(damaged).findings
    assert found.kind is FindingKind.TIME_SCALE
    assert found.alternative is not None
    assert found.alternative.scale * factor == pytest.approx(1.0, rel=0.04)


def test_a_body_that_leans_on_a_hand_does_not_fall() -> None:
    """As in a cartwheel: it sinks as if a clock that is wrong had slowed its fall."""
    slow = slowed(2.0).of(jump()).recording
    carried = perform(slow, character())
    schedule = find_contacts(carried)
    assert agreed_rate(carried, schedule) == pytest.approx(120.0)
    hand = character().body(Part.HAND, Side.LEFT)
    carried.centres[:, hand, 2] = schedule.floor_m + 0.04
    assert agreed_rate(carried, schedule) is None
    assert find_scale(carried) is None


@pytest.mark.parametrize("factor", [0.5, 2.0, 4.0])
def test_a_body_that_a_hand_holds_does_not_fall(factor: float) -> None:
    """As on a bar or a ledge, high above the floor, where the hand keeps its place."""
    slow = slowed(factor).of(jump()).recording
    assert find_scale(perform(slow, character())) is not None
    held = perform(slow, character())
    hand = character().body(Part.HAND, Side.LEFT)
    held.centres[:, hand] = [0.0, 0.0, 2.3]
    assert find_scale(held) is None
    assert agreed_rate(held, find_contacts(held)) is None


def test_who_stands_still_at_an_end_of_it_did_not_fall() -> None:
    """As on a roof after a climb; in mid-air, at an end of a fall, a body is the fastest."""
    flight = perform(jump(), character())
    aloft = in_the_air(flight)
    parts, com, height = flight.centres[aloft], flight.com[aloft], character().height
    assert not is_held(parts, com, height)
    still = np.minimum(np.arange(len(com) + 10), len(com) - 1)
    assert is_held(parts[still], com[still], height)
    assert is_held(parts[still[::-1]], com[still[::-1]], height)


def test_falls_in_which_a_stated_contact_touches_tell_no_clock() -> None:
    slow = slowed(2.0).of(jump()).recording
    (told,) = faults_of(slow, MotionProblem())
    assert told.kind is FindingKind.TIME_SCALE
    (first, last) = told.frames[0]
    vaults = AddedContact("Left hand", first + 10.0, last - 10.0)
    assert faults_of(slow, MotionProblem(added=(vaults,))) == []
    before = AddedContact("Left toe", first - 30.0, first - 1.0)
    assert faults_of(slow, MotionProblem(added=(before,))) == [told]


@pytest.mark.parametrize("factor", [1.6, 0.01, 2.54])
def test_a_size_that_is_nobodys_is_told_by_the_fall(factor: float) -> None:
    damaged = sized(factor, "size").of(jump()).recording
    found = find_scale(perform(damaged, build_character(damaged)))
    assert found is not None
    assert found.kind is FindingKind.SIZE
    assert found.remedy is not None
    assert found.remedy.scale * factor == pytest.approx(1.0, rel=0.04)


def test_a_clock_is_not_told_by_falls_in_which_frames_are_held() -> None:
    """Two frames doubled in a flight of 0.2 s make it longer, as a slower clock would."""
    hop = load_recording("131_03_hop.bvh")
    aloft = np.searchsorted(hop.times, [1.70, 1.76])
    rows = np.sort(np.append(np.arange(len(hop.frames)), aloft))
    at = np.arange(len(rows))
    doubled = replace(
        hop,
        frames=hop.frames[0] + at,
        times=at / hop.rate,
        heads=hop.heads[rows],
        rotations=hop.rotations[rows],
    )
    kinds = [finding.kind for finding in diagnose(doubled).findings if not finding.kind.note]
    assert kinds == [FindingKind.HELD_FRAMES]


@pytest.mark.parametrize(("height", "seconds"), [(0.045, 0.6), (0.09, 0.8)])
def test_falls_that_disagree_tell_no_clock(height: float, seconds: float) -> None:
    """A hop as on the moon, of which half is in the air, beside a jump that falls as it should: as
    where legs are exchanged, and none of them touches."""
    u = (jump().times - jump().times[15]) / seconds
    lifted = 4.0 * height * np.maximum(u * (1.0 - u), 0.0)
    heads = jump().heads + lifted[:, None, None] * np.array([0.0, 0.0, 1.0])
    hovering = replace(jump(), heads=heads)
    assert find_scale(perform(hovering, character())) is None
    many = load_recording("hops_in_place.bvh")  # of whose falls one is at 6.7 m/s²
    found = find_scale(perform(slowed(1.25).of(many).recording, build_character(many)))
    assert found is not None
    assert found.remedy == Repairs(time_scale=pytest.approx(0.8))


@pytest.mark.parametrize("degrees", [pytest.param(40.0, marks=pytest.mark.slow), 60.0])
def test_a_walks_foot_that_floats_tells_no_clock(degrees: float) -> None:
    """Its shank is turned for a step, of which 0.1 s goes straight on as far as can be told."""
    walk = load_recording("01_01.amc").window(1841, 2160)
    share, shank = np.linspace(0.0, 1.0, len(walk.frames)), walk.index("ltibia")
    turned = np.radians(degrees) * np.interp(share, [0.38, 0.42, 0.58, 0.62], [0, 1, 1, 0])
    local = LocalPoses.of(walk)
    local.rotations[:, shank] @= rotation_matrix(np.outer(turned, [1.0, 0.0, 0.0]))
    kinds = {finding.kind for finding in diagnose(local.posed(walk)).findings}
    assert FindingKind.TIME_SCALE not in kinds


def test_what_is_carried_unseen_tells_no_clock() -> None:
    """Hips that are held at nearly one height: what legs do then makes parabolas of 1.3 m/s²."""
    hop = load_recording("hop_01_01.bvh")
    heads = hop.heads.copy()
    heads[:, :, 2] += 0.98 * (hop.heads[:, :1, 2].mean() - hop.heads[:, :1, 2])
    kinds = {finding.kind for finding in diagnose(replace(hop, heads=heads)).findings}
    assert FindingKind.UNSEEN_SUPPORT in kinds
    assert FindingKind.TIME_SCALE not in kinds


@pytest.mark.slow
@pytest.mark.parametrize("name", ["run_1.bvh", "run_3.bvh"])
def test_a_runs_short_flights_tell_a_size(name: str) -> None:
    """A parabola through them is up to 6 % off, for the centre of mass wanders by millimetres."""
    recording = load_recording(name)
    size = 1.6 * build_character(recording).height
    (found,) = [f for f in diagnose(sized(1.6, "").of(recording).recording).findings if f.remedy]
    assert found.kind is FindingKind.SIZE
    assert found.amount == pytest.approx(size, rel=0.01)
    assert found.remedy is not None
    assert found.remedy.scale * 1.6 == pytest.approx(1.0, rel=0.04)


def test_a_mass_that_does_not_go_with_the_size_is_told() -> None:
    diagnosis = diagnose(jump(), mass=700.0)
    assert [finding.kind for finding in diagnosis.findings] == [FindingKind.MASS]
    assert diagnosis.mass == pytest.approx(63.0, abs=8.0)
