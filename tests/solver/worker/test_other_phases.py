"""A problem goes on about the contacts and instants that it named, whatever the fit let go."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.operators.words.messages import sentence
from hangtime.solver.analysis.timeline import timeline
from hangtime.solver.constraints.contact_setup import without_lifted
from hangtime.solver.data.contacts import ContactSchedule, Interval
from hangtime.solver.data.faults import JoinedPhase, NothingTouches, PinLetGo, UnknownPhaseIn
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.requests import AngleLimit, Hold, Lift, PhaseTiming, Requests, When
from hangtime.solver.worker.other_phases import on_phases_of
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.fitted_hop import hop

STANCES = ((0.0, 0.5), (0.8, 1.3), (1.6, 2.0))  # s


def found() -> ContactSchedule:
    """Three stances of a foot, two flights between them."""
    like = hop().schedule.contacts[0]
    contacts = tuple(
        replace(like, name=f"{like.point} {i}", start=start, end=end, place=np.zeros(3))
        for i, (start, end) in enumerate(STANCES, start=1)
    )
    return ContactSchedule(contacts, 2.0, 0.0)


def doubted() -> ContactSchedule:
    """The same, the first flight carried by something unseen: ground 2 is part of ground 1."""
    return replace(found(), unseen=(Interval(0.5, 0.8),)).named_as(found())


def phase_names(schedule: ContactSchedule) -> list[str]:
    return [phase.name for phase in schedule.phases]


def test_phases_behind_one_that_is_carried_keep_their_names() -> None:
    assert phase_names(doubted()) == ["ground 1", "flight 2", "ground 3"]


def test_they_keep_them_also_where_the_schedule_is_cut() -> None:
    late = doubted().part(1.0, 2.0)
    assert phase_names(late) == ["ground 1", "flight 2", "ground 3"]
    assert phase_names(found().part(1.0, 2.0)) == ["ground 2", "flight 2", "ground 3"]


def test_they_keep_them_where_the_motion_is_held_at_its_end_and_where_contacts_are_lifted() -> None:
    holds = (Hold("End", 1.7 * recording().rate, 0.5, ends=True),)
    held = timeline(doubted(), 0.0, recording().rate, (), holds).schedule(doubted())
    assert phase_names(held) == ["ground 1", "flight 2", "ground 3"]
    lifts = Requests(lifts=(Lift("Up", "ground 2"),))
    lifted = without_lifted(found(), MotionProblem(requests=lifts))
    assert phase_names(lifted) == ["ground 1", "flight 1", "ground 3"]


def test_where_a_phase_is_divided_all_are_counted_on() -> None:
    whole, divided = found(), replace(found(), contacts=found().contacts[::2])
    assert phase_names(whole.named_as(divided)) == phase_names(whole)
    assert phase_names(divided.named_as(whole)) == ["ground 1", "flight 1", "ground 3"]
    late = whole.part(1.0, 2.0)
    carried = replace(late, unseen=(Interval(0.4, 0.5),)).named_as(late)  # amid its flight
    assert phase_names(carried) == ["ground 2", "flight 2", "ground 3", "flight 3", "ground 4"]


def name(number: int) -> str:
    return found().contacts[number - 1].name


def recording() -> Recording:
    return load_recording(JUMP)


def mapped(problem: MotionProblem, fitted: ContactSchedule) -> MotionProblem:
    return on_phases_of(problem, found(), fitted, recording())


def test_where_nothing_was_let_go_the_problem_stays() -> None:
    problem = MotionProblem(pins=(Pin("Landing", "ground 2"),))
    assert mapped(problem, found()) is problem


def test_a_pin_stays_with_its_contacts() -> None:
    pins = (Pin("First", "ground 1"), Pin("Middle", "ground 2"), Pin("Last", "ground 3"))
    first, middle, last = mapped(MotionProblem(pins=pins), doubted()).pins
    assert (first.phase, first.touching) == ("ground 1", (name(1),))
    assert (middle.phase, middle.touching) == ("ground 1", (name(2),))
    assert (last.phase, last.touching) == ("ground 3", ())


def test_a_pin_of_what_was_let_go_is_told() -> None:
    schedule = found()
    left = replace(schedule, contacts=schedule.contacts[::2], unseen=(Interval(0.8, 1.3),))
    with pytest.raises(PinLetGo) as caught:
        mapped(MotionProblem(pins=(Pin("Middle", "ground 2"),)), left)
    assert name(2) in sentence(caught.value)
    assert "Middle" in sentence(caught.value)


def test_a_contact_that_was_let_go_keeps_no_other_pin_of_its_stance() -> None:
    """A stance is moved by a pin for each of its contacts."""
    first, *others = found().contacts
    heel = replace(first, name="Heel 1", point="Heel")
    both = replace(found(), contacts=(first, heel, *others))
    pins = (Pin("Toe", "ground 1", (first.name,)), Pin("Heel", "ground 1", (heel.name,)))
    left = replace(both, contacts=(heel, *others))
    problem = on_phases_of(MotionProblem(pins=pins), both, left, recording())
    assert [(pin.name, pin.touching) for pin in problem.pins] == [("Heel", ("Heel 1",))]


def test_requests_stay_with_their_instants() -> None:
    limits = tuple(
        AngleLimit(phase, "LeftLeg", None, None, when=When(phase))
        for phase in ("ground 2", "flight 2")
    )
    requests = Requests(angles=limits, lifts=(Lift("Lift", "ground 3"),))
    told = mapped(MotionProblem(requests=requests), doubted()).requests
    first, rate = float(recording().frames[0]), recording().rate
    joined, kept = (limit.when for limit in told.angles)
    assert joined.phase is None
    assert joined.frames == pytest.approx((first + 0.8 * rate, first + 1.3 * rate))
    assert kept == When("flight 2")
    assert told.lifts[0].phase == "ground 3"


def test_what_is_lifted_stays_the_same_where_its_phase_is_joined() -> None:
    lifts = (Lift("All", "ground 2"), Lift("Bone", "ground 2", (found().contacts[1].bone,)))
    told = mapped(MotionProblem(requests=Requests(lifts=lifts)), doubted()).requests
    assert [(lift.phase, lift.touching) for lift in told.lifts] == [("ground 1", (name(2),))] * 2


def test_a_phase_that_is_no_more_is_not_retimed() -> None:
    requests = Requests(timings=(PhaseTiming("Longer", "flight 1", factor=1.2),))
    with pytest.raises(JoinedPhase) as caught:
        mapped(MotionProblem(requests=requests), doubted())
    assert caught.value.kept == ("flight 2",)
    assert "choose flight 2, or frames" in sentence(caught.value)


def test_a_lift_of_nothing_that_touches_is_told_so() -> None:
    requests = Requests(lifts=(Lift("Up", "ground 1", ("Nose",)),))
    with pytest.raises(NothingTouches):
        mapped(MotionProblem(requests=requests), doubted())


def test_a_phase_that_never_was_is_told_with_those_that_are() -> None:
    requests = Requests(timings=(PhaseTiming("Longer", "flight 7", factor=1.2),))
    with pytest.raises(UnknownPhaseIn) as caught:
        mapped(MotionProblem(requests=requests), doubted())
    assert caught.value.known == tuple(phase.name for phase in found().phases)
