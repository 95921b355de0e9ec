"""Durations and size of a jump go with where it lands: both ways, and not at all where it stays."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.body.anatomy import Part
from hangtime.solver.data.contacts import Interval
from hangtime.solver.data.problem import MotionProblem, OffsetAxes, Pin
from hangtime.solver.data.requests import Hold, PhaseTiming, PointRequest, Requests, When
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.solver_options import SolverOptions
from hangtime.solver.data.status import Durations
from hangtime.solver.fitting.fit import Fit, fit
from hangtime.solver.fitting.transcribe import initial_guess, transcribe
from hangtime.solver.stages import durations as durations_module
from hangtime.solver.stages.anticipation import changed_jumps
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.stages.setup import set_up
from hangtime.solver.transcription.motion import Motion
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.fitted_hop import HOP_CLIP, fitted_hop

FLIGHT, LANDING = "flight 1", "ground 2"
DISTANCE = 0.77  # m, of the feet from take-off to landing
APEX = 89.0  # frame of the shorter hop's highest


@cache
def whole_hop() -> Fit:
    """With the standing before it, which tells how deep its crouch is."""
    analysis = analyse(load_recording(HOP_CLIP), MotionProblem())
    return fit(analysis.performance, analysis.schedule)


def to(forward: float, **offset: float) -> MotionProblem:
    up, turn = offset.get("up", 0.0), offset.get("turn", 0.0)
    return MotionProblem(pins=(Pin("Landing", LANDING, offset=(forward, 0.0, up), turn=turn),))


@cache
def adapted(forward: float) -> Adaptation:
    return adapt(whole_hop(), to(forward))


def durations(adaptation: Adaptation) -> dict[str, float]:
    return {p.name: p.end - p.start for p in adaptation.setup.context.phases}


def recorded() -> dict[str, float]:
    return {p.name: p.end - p.start for p in whole_hop().schedule.phases}


def push(adaptation: Adaptation) -> np.ndarray:
    """Instants of the ground phase before the flight."""
    return np.linspace(0.0, adaptation.setup.schedule.flights[0].start, 300)


def crouch(adaptation: Adaptation) -> float:
    """Least height of the centre of mass before the flight, m."""
    return float(adaptation.motion.com(push(adaptation))[:, 2].min())


def arm_swing(adaptation: Adaptation) -> float:
    """Mean range of the arms' direction from shoulder to hand, rad."""
    posed = adaptation.motion.pose(push(adaptation))
    bodies = adaptation.motion.transcription.character.bodies
    shoulders, hands = (
        posed.centres[:, [i for i, body in enumerate(bodies) if body.part is part]]
        for part in (Part.UPPER_ARM, Part.HAND)
    )
    along = (hands - shoulders) / np.linalg.norm(hands - shoulders, axis=2, keepdims=True)
    between = np.arccos(np.clip(np.einsum("tai,sai->tsa", along, along), -1.0, 1.0))
    return float(between.max(axis=(0, 1)).mean())


@pytest.mark.slow
def test_a_longer_jump_flies_longer_and_a_shorter_one_shorter() -> None:
    """Near the square root of the distance, as where the take-off's angle stays."""
    was = recorded()[FLIGHT]
    for forward in (0.15, -0.15):
        now = durations(adapted(forward))[FLIGHT]
        share = np.log(now / was) / (0.5 * np.log((DISTANCE + forward) / DISTANCE))
        assert 0.15 < share < 2.0, forward


@pytest.mark.slow
def test_a_bigger_jump_is_performed_bigger_and_a_smaller_one_smaller() -> None:
    shorter, same, longer = (adapted(forward) for forward in (-0.15, 0.0, 0.15))
    assert crouch(longer) < crouch(same) - 0.005 < crouch(shorter) - 0.01
    assert arm_swing(longer) > arm_swing(same) + 0.01 > arm_swing(shorter) + 0.02
    pushes = [durations(each)["ground 1"] for each in (shorter, same, longer)]
    assert pushes == sorted(pushes)


@pytest.mark.slow
def test_the_push_is_longer_rather_than_harder() -> None:
    def peak(adaptation: Adaptation) -> float:
        return float(adaptation.motion.forces(push(adaptation)).sum(axis=1)[:, 2].max())

    assert peak(adapted(0.15)) < 1.05 * peak(adapted(0.0))


@pytest.mark.slow
def test_where_nothing_is_moved_every_duration_stays() -> None:
    assert durations(adapted(0.0)) == pytest.approx(recorded())
    assert adapted(0.0).setup.context.timeline.unchanged


@pytest.mark.slow
def test_a_landing_that_hardly_moves_changes_hardly_anything() -> None:
    near = adapted(0.002)
    assert durations(near)[FLIGHT] == pytest.approx(recorded()[FLIGHT], abs=0.002)
    assert crouch(near) == pytest.approx(crouch(adapted(0.0)), abs=0.002)


@pytest.mark.slow
def test_a_hop_that_is_carried_as_a_whole_keeps_its_times() -> None:
    pins = tuple(
        Pin(phase, phase, offset=(0.4, 0.2, 0.0), axes=OffsetAxes.WORLD)
        for phase in ("ground 1", LANDING)
    )
    assert durations(adapt(whole_hop(), MotionProblem(pins=pins))) == pytest.approx(recorded())


@pytest.mark.slow
def test_a_turn_alone_keeps_its_times() -> None:
    setup = set_up(whole_hop(), to(0.0, turn=np.pi / 2))
    assert setup.context.timeline.unchanged


def test_a_jump_to_a_bar_keeps_its_times_though_the_landing_behind_it_moves() -> None:
    """Nobody moved the grip."""
    hands = tuple(
        PointRequest(f"{hand} on a bar", hand, When(phase="hanging"), environment=True, grip=True)
        for hand in ("LeftHand", "RightHand")
    )
    requests = Requests(points=hands, holds=(Hold("hanging", APEX, 0.5),))
    further = to(0.3)
    assert set_up(fitted_hop(), further).durations is Durations.FOUND
    hanging = replace(further, requests=requests)
    assert set_up(fitted_hop(), hanging).durations is Durations.RECORDED


@pytest.mark.slow
def test_the_artist_may_keep_all_times() -> None:
    requests = Requests(solution=SolverOptions(keep_times=True))
    problem = MotionProblem(pins=to(0.15).pins, requests=requests)
    assert set_up(whole_hop(), problem).context.timeline.unchanged


def test_a_timing_of_the_flight_stands() -> None:
    requests = Requests(timings=(PhaseTiming("As it was", FLIGHT, factor=1.0),))
    setup = set_up(whole_hop(), MotionProblem(pins=to(0.15).pins, requests=requests))
    assert setup.context.timeline.unchanged


def test_a_timing_of_the_push_stands_while_the_flight_is_free() -> None:
    requests = Requests(timings=(PhaseTiming("Slower", "ground 1", factor=1.1),))
    setup = set_up(whole_hop(), MotionProblem(pins=to(0.15).pins, requests=requests))
    now = {p.name: p.end - p.start for p in setup.context.phases}
    assert now["ground 1"] == pytest.approx(1.1 * recorded()["ground 1"], abs=1e-6)
    assert now[FLIGHT] > 1.02 * recorded()[FLIGHT]


def test_contacts_phases_and_timeline_agree() -> None:
    found = adapted(0.15)
    context = found.setup.context
    mapped = context.timeline.to_new(np.array([p.end for p in whole_hop().schedule.phases]))
    assert [p.end for p in context.schedule.phases] == pytest.approx(mapped.tolist(), abs=1e-6)
    assert found.motion.duration == pytest.approx(context.timeline.duration)
    assert len(found.track.frames) > len(whole_hop().performance.recording.frames)


@pytest.mark.slow
@pytest.mark.parametrize(("forward", "up"), [(1.8, 0.0), (0.0, 1.2)])
def test_far_landings_have_durations_too(forward: float, up: float) -> None:
    setup = set_up(whole_hop(), to(forward, up=up))
    assert setup.durations is Durations.FOUND
    (flight,) = setup.schedule.flights
    assert flight.end - flight.start > 1.1 * recorded()[FLIGHT]


@pytest.mark.slow
def test_a_set_of_ever_farther_landings_flies_evenly_longer() -> None:
    """Variants beside each other must look it: none of 30 cm more leaps up."""
    distances = np.arange(0.6, 1.96, 0.3)
    made = [set_up(broad_jump(), to(float(forward))).schedule.flights for forward in distances]
    flights = np.array([flight[0].end - flight[0].start for flight in made])
    growth = np.diff(flights)
    assert growth.min() > 0.0, flights
    assert growth.max() < 0.12, flights  # 30 cm at the fall's own sqrt: 0.08 s here


def test_a_flight_that_the_range_begins_in_has_no_push_to_change() -> None:
    analysis = analyse(load_recording("run_2.bvh"), MotionProblem(frames=(28, 123)))
    transcription = transcribe(analysis.performance, analysis.schedule)
    x = initial_guess(transcription, analysis.performance)
    places = np.array([contact.place for contact in analysis.schedule.contacts])
    start = Motion(transcription, x, places)
    jumps = changed_jumps(start, analysis.schedule, places + np.array([0.1, 0.0, 0.0]), ())
    assert all(jump.take_off > 0.0 for jump in jumps)


@cache
def broad_jump() -> Fit:
    analysis = analyse(load_recording(JUMP), MotionProblem(frames=(60.0, 330.0)))
    return fit(analysis.performance, analysis.schedule)


def far(nudge: float = 0.0) -> Adaptation:
    pin = Pin("Landing", LANDING, offset=(0.5 + nudge, 0.1, 0.1))
    return adapt(broad_jump(), MotionProblem(pins=(pin,)))


@pytest.mark.slow
def test_a_clip_ends_as_it_was_recorded_however_far_the_landing_moves() -> None:
    """Nothing holds its last instant, where by metres alone a neck twirled by 73 degrees."""
    found = far().motion
    before, after = (
        each.joint_rotations(np.array([each.duration]))[0, 1:]
        for each in (broad_jump().motion, found)
    )
    cosine = 0.5 * (np.trace(before.swapaxes(1, 2) @ after, axis1=1, axis2=2) - 1.0)
    assert np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))).max() < 15.0


@pytest.mark.slow
def test_rounding_decides_nothing_that_is_seen() -> None:
    """A pin that is a nanometre elsewhere moves no joint centre by more than 5 mm."""
    first, second = far().motion, far(nudge=1e-9).motion
    share = np.linspace(0.0, 1.0, 200)
    centres = [each.joint_centres(share * each.duration) for each in (first, second)]
    assert np.linalg.norm(centres[0] - centres[1], axis=2).max() < 0.005


@pytest.mark.slow
def test_an_adaptation_knows_nothing_of_earlier_ones() -> None:
    first = far().outcome.x
    adapt(broad_jump(), MotionProblem(pins=(Pin("Landing", LANDING, offset=(-0.2, 0.0, 0.1)),)))
    assert np.array_equal(far().outcome.x, first)


@pytest.mark.slow
def test_no_limb_is_turned_into_the_trunk_on_the_way() -> None:
    """A hop of 44 cm onto one foot that turns, 20 cm higher: steps that turned arms by more than
    linear rows can tell left one 14 cm in the trunk."""
    frames = (91.0, 334.0)
    analysis = analyse(load_recording("131_03_hop.bvh"), MotionProblem(frames=frames))
    raised = replace(to(0.0, up=0.2), frames=frames)
    found = adapt(fit(analysis.performance, analysis.schedule), raised)
    assert found.solved
    assert found.setup.durations is Durations.FOUND
    guards = found.setup.guards
    beyond = [each for guard in guards for each in guard.violations(found.motion)]
    assert {guard.kind for guard in guards} == {RowKind.SOLID, RowKind.RANGE}
    assert all(each.amount < 3.0 * each.kind.tolerance for each in beyond), beyond


def test_steps_that_diverge_are_given_up_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """From a pin some metres behind, each further step cost a minute and led to 1e29 tolerances."""
    steps = []

    def step(_linearised: object, _metric: object, _problem: object, at: Any, *_: object) -> Any:
        steps.append(at)
        return 99.0 * at[0], np.array([0.3])

    def timed(s: np.ndarray) -> Any:
        return SimpleNamespace(s=s, values=lambda x: x.ravel())

    monkeypatch.setattr(durations_module, "_step", step)
    monkeypatch.setattr(
        durations_module,
        "_BorderedProblem",
        lambda *_: SimpleNamespace(timed=timed),
    )
    linearised = SimpleNamespace(rows=None, violation=lambda value: np.abs(value).max())
    metric = SimpleNamespace(times=lambda x: x)
    start: Any = SimpleNamespace(motion=None, metric=metric, unpriced=linearised)
    flights = (Interval(0.5, 1.0),)
    found = durations_module.find_durations(start, np.ones((1, 1)), np.zeros((1, 3)), flights)
    assert found is None
    assert len(steps) == 1
