"""What an analysis told of weight beside the feet is told of a result as far as it holds there."""

from dataclasses import replace
from functools import cache

from hangtime.solver.data.faults import OffBalance, UnseenSupport
from hangtime.solver.data.problem import AddedContact, MotionProblem
from hangtime.solver.data.reports.constraints import UnseenSupportReport
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.reports.report import Report
from hangtime.solver.data.requests import PointRequest, When
from hangtime.solver.results.report import report
from hangtime.solver.results.unseen_support import hints_left
from hangtime.solver.stages.implicit import adapt
from hangtime.tests.helpers.fitted_hop import fitted_hop, hop

RECORDING, SCHEDULE = hop().performance.recording, hop().schedule
FIRST, LAST = RECORDING.ends


@cache
def unchanged() -> Report:
    return report(adapt(fitted_hop(), MotionProblem()), MotionProblem(), Origin("hop"))


def carried(first: float, last: float, force: float = 0.8) -> Report:
    return replace(
        unchanged(),
        unseen_support=(UnseenSupportReport(first, last, force, first, 0.2, 0.6 * force),),
    )


def test_what_the_fit_carries_by_feet_alone_is_not_told_again() -> None:
    told = OffBalance(((FIRST, LAST),))
    stands = replace(carried(FIRST, LAST), unseen_support=())
    turned = carried(FIRST, LAST, force=0.01)
    for each in (stands, turned):
        assert hints_left([told], each, SCHEDULE, RECORDING) == []
    aloft = UnseenSupport(FIRST, LAST)
    assert hints_left([aloft, told], stands, SCHEDULE, RECORDING) == [aloft]


def test_a_hint_is_told_where_something_unseen_carries() -> None:
    half = round((FIRST + LAST) / 2.0)
    hands = (AddedContact("Left hand", FIRST, LAST), AddedContact("Right hand", FIRST, half - 1.0))
    told = OffBalance(((FIRST, LAST),), hands, ((FIRST, LAST),))
    (left,) = hints_left([told], carried(half, LAST), SCHEDULE, RECORDING)
    assert isinstance(left, OffBalance)
    assert left.spans == left.resting == ((half, LAST),)
    assert left.hands == hands[:1]


def test_hands_that_hold_on_are_not_told_where_points_of_theirs_do() -> None:
    touch = SCHEDULE.contacts[0]
    grip = replace(touch, name="Bar", point="Bar", start=0.0, end=SCHEDULE.duration)
    hangs = replace(SCHEDULE, contacts=(*SCHEDULE.contacts, grip))
    point = PointRequest("Bar", "Hand", When(frames=(FIRST, LAST)), environment=True, grip=True)
    told = UnseenSupport(FIRST, LAST, holds=(point,))
    assert hints_left([told], carried(FIRST, LAST), SCHEDULE, RECORDING) == [told]
    assert hints_left([told], carried(FIRST, LAST), hangs, RECORDING) == []


def test_a_hint_is_not_told_where_a_point_pushes_back() -> None:
    touch = SCHEDULE.contacts[0]
    seat = replace(touch, name="Seat", point="Seat", start=0.0, end=SCHEDULE.duration)
    seated = replace(SCHEDULE, contacts=(*SCHEDULE.contacts, seat))
    told = OffBalance(((FIRST, LAST),))
    assert hints_left([told], carried(FIRST, LAST), SCHEDULE, RECORDING) == [told]
    assert hints_left([told], carried(FIRST, LAST), seated, RECORDING) == []
