"""A flight that is longer for what is lifted is told, with its frames; one that is not is not."""

from hangtime.solver.data.contacts import PhaseKind
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.reports.jumps import LiftedFlight
from hangtime.solver.data.requests import Lift, Requests
from hangtime.solver.results.flight_summary import lifted_flights, scene_frame
from hangtime.solver.stages.setup import set_up
from hangtime.tests.helpers.fitted_hop import fitted_hop


def lifted(*touching: str) -> list[LiftedFlight]:
    """Where these contacts of the landing are lifted; all where none is named."""
    lift = Lift("One leg", "ground 2", touching=touching)
    return [*lifted_flights(set_up(fitted_hop(), MotionProblem(requests=Requests(lifts=(lift,)))))]


def test_without_a_landing_the_flight_goes_on() -> None:
    fit = fitted_hop()
    flight, ground = fit.schedule.phases[1:3]
    assert flight.kind is PhaseKind.FLIGHT
    (found,) = lifted()
    assert found.lifts == ("One leg",)
    assert found.first_frame == scene_frame(fit, flight.start)
    assert found.last_frame == scene_frame(fit, ground.end)
    assert abs(found.with_contacts_s - (flight.end - flight.start)) < 1e-9
    assert abs(found.without_s - (ground.end - flight.start)) < 1e-9


def test_where_the_other_foot_stands_no_flight_is_longer() -> None:
    assert lifted("LeftFoot", "LeftToeBase") == []
    assert [*lifted_flights(set_up(fitted_hop(), MotionProblem()))] == []
