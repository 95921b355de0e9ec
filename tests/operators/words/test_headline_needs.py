"""What a fit needs beside the recording is told, of reports and of a fit alone."""

from dataclasses import replace

import pytest
from hangtime.operators.words.headline import accepted_lines, headline
from hangtime.solver.data.contacts import PhaseKind
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.reports.constraints import (
    AcceptedReport,
    FitNeeds,
    LetGoReport,
    UnseenSupportReport,
)
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.reports.report import as_json
from hangtime.solver.results.report import report
from hangtime.solver.results.unseen_support import fit_needs
from hangtime.solver.stages.implicit import adapt
from hangtime.tests.helpers.fitted_hop import fitted_hop


def test_all_frames_of_unseen_support_and_all_contacts_let_go_are_told() -> None:
    needs = FitNeeds(
        (
            UnseenSupportReport(1.0, 41.0, 4.74, 13.0, 0.1, 2.5),
            UnseenSupportReport(58.0, 115.0, 1.36, 111.0, 0.3, 0.7),
        ),
        (LetGoReport("Right heel 2", 29.0, 74.0, 66.0),),
    )
    support, contacts = accepted_lines(needs)
    assert "on average and at most) 1 to 41 (2.5, 4.74), 58 to 115 (0.7, 1.36); " in support
    assert "Point with Pushes Back" in support
    assert "Right heel 2" in contacts
    assert accepted_lines(FitNeeds()) == []


def test_where_hands_touch_already_it_is_told_how_far_the_weight_is_beside_them() -> None:
    on_hands = UnseenSupportReport(47.0, 362.0, 1.31, 104.0, 0.3, 0.3, beside_hands_m=0.23)
    seat = UnseenSupportReport(400.0, 420.0, 0.7, 410.0, 0.1, 0.5)
    seated, handstand = accepted_lines(FitNeeds((on_hands, seat)))
    assert "400 to 420" in seated
    assert "47 to 362 (0.3, 1.31); hands touch there already" in handstand
    assert "the weight is 23.0 cm beside hands and feet" in handstand
    assert "Add Contact" not in handstand


def test_what_turns_the_body_and_carries_nothing_of_it_is_told_by_itself() -> None:
    seat = UnseenSupportReport(1.0, 138.0, 0.005, 130.0, 0.118, 0.001)
    rises = UnseenSupportReport(139.0, 189.0, 0.94, 152.0, 0.09, 0.62)
    carries, turns = accepted_lines(FitNeeds((seat, rises)))
    assert "139 to 189 (0.62, 0.94)" in carries
    assert "1 to 138" not in carries
    assert turns.startswith("Something unseen turns the body, but carries nothing of it")
    assert turns.endswith("0.118 body weights × metre in frames 1 to 138")


def test_a_flight_that_something_unseen_carries_is_told_with_how_it_falls() -> None:
    """As the hop's is, had it been recorded under another gravity and carried."""
    fitted = fitted_hop()
    (flight,) = (p for p in fitted.schedule.phases if p.kind is PhaseKind.FLIGHT)
    assert fit_needs(replace(fitted, carried=(flight,))).carried_flights == ()  # it does fall
    slower = fitted.performance.com.copy()
    slower[:, 2] += (9.80665 - 7.5) / 2.0 * (fitted.performance.times - flight.start) ** 2
    performance = replace(fitted.performance, com=slower)
    needs = fit_needs(replace(fitted, performance=performance, carried=(flight,)))
    (told,) = needs.carried_flights
    assert told.acceleration == pytest.approx(7.5, abs=0.5)
    assert told.off_mm > 10.0
    (line,) = accepted_lines(needs)
    assert line.startswith("In the flight that was found from frame ")
    assert f"falls at {told.acceleration:.1f} m/s²" in line
    problem = MotionProblem()
    made = report(adapt(fitted, problem), problem, Origin("hop"))
    assert line in "\n".join(headline(replace(made, carried_flights=(told,))))


def test_what_is_good_enough_is_told_with_its_amounts_and_the_artist_s_limit() -> None:
    """It needs nothing that the recording does not show, but it is not all that was asked for."""
    near = AcceptedReport("Left heel 2", 0.4, 0.5), AcceptedReport("Right toe 2", 0.12, 0.5)
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    made = replace(made, accepted_contacts=near)
    first, *lines = headline(made)
    assert (
        "everything asked for holds, but 2 contacts are off their places by up to 0.4 mm" in first
    )
    assert "where 0.5 mm is good enough" in first
    (told,) = (line for line in lines if "good enough (0.5 mm in each direction)" in line)
    assert told.endswith("Left heel 2 (0.4 mm), Right toe 2 (0.12 mm)")
    recorded = as_json(made)["accepted_contacts"]
    assert recorded == [vars(each) for each in near]


def test_one_contact_is_told_as_one() -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    near = (AcceptedReport("Left heel 2", 0.4, 0.5),)
    assert "but a contact is off its place" in headline(replace(made, accepted_contacts=near))[0]
