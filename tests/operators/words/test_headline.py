"""The first lines of a solved motion say no more than its report."""

from dataclasses import replace

import pytest
from hangtime.operators.words.headline import MOST_GIVEN_UP, headline, missed_body_lines
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.reports.certificate import CertificateItem
from hangtime.solver.data.reports.constraints import ConstraintReport
from hangtime.solver.data.reports.jumps import LiftedFlight
from hangtime.solver.data.reports.keys import BlendReport, BodyMiss
from hangtime.solver.data.reports.loop import LoopReport
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.status import Durations
from hangtime.solver.results.report import report
from hangtime.solver.stages.implicit import adapt
from hangtime.tests.helpers.fitted_hop import fitted_hop


def told(*given_up: ConstraintReport) -> list[str]:
    """The headline of the hop as it was recorded, had this been given up."""
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    return headline(replace(made, conditions=given_up))


def test_what_gave_way_is_in_the_first_line_and_the_worst_are_named_first() -> None:
    limbs = [
        ConstraintReport(f"Hand in shape {i}", RowKind.SOLID, 10.0 + i, 30.0, met=False)
        for i in range(MOST_GIVEN_UP)
    ]
    bend = ConstraintReport("Left knee bends", RowKind.RANGE, 9.0, 40.0, met=False)  # 78 tolerances
    lines = told(*limbs, bend)
    assert f"gave way in {MOST_GIVEN_UP + 1} places" in lines[0]
    beside = [line.strip() for line in lines if "beside what is asked for" in line]
    assert beside[0].startswith("Left knee bends 9° beyond its range (frame 40)")
    assert beside[1].startswith(f"Hand in shape {MOST_GIVEN_UP - 1}")
    assert len(beside) == MOST_GIVEN_UP
    assert any(line.strip().startswith("and 1 more") for line in lines)


def test_a_flight_that_lifting_made_longer_is_told_with_its_frames() -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    assert not any("nothing touches" in line for line in headline(made))
    flight = LiftedFlight(("One leg",), 199.0, 292.0, 0.22, 0.77)
    lines = headline(replace(made, lifted_flights=(flight,)))
    (line,) = [line for line in lines if "nothing touches from frame 199 to 292" in line]
    assert "“One leg”" in line
    assert "0.77 s" in line


def test_feet_that_slide_on_the_way_back_are_told() -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    assert headline(replace(made, slide_on_way_back_m=0.009)) == headline(made)
    (told,) = set(headline(replace(made, slide_on_way_back_m=0.0617))) - set(headline(made))
    assert told.startswith("  Standing feet slide by 62 mm on the way back to where the take was;")


def test_flights_that_last_as_recorded_in_another_gravity_are_told() -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    there = replace(made, figure=replace(made.figure, gravity_m_s2=1.62))
    (told,) = set(headline(there)) - set(headline(made))
    assert told == "  Flights last as recorded at this gravity, too; a Timing makes them longer"
    timed = tuple(replace(phase, adapted_s=2.0 * phase.recorded_s) for phase in made.phases)
    assert headline(replace(there, phases=timed)) == headline(made)


def test_a_blend_that_has_far_to_go_is_told_with_its_speed_and_a_remedy() -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    into = BlendReport(
        into=True,
        first_frame=31.0,
        last_frame=60.0,
        off_m=0.48,
        speed_m_s=4.2,
        frame=45.0,
        take_speed_m_s=0.6,
    )
    out = replace(into, into=False, first_frame=330.0, last_frame=359.0)
    near = replace(into, off_m=0.02)
    assert headline(replace(made, blends=(near,))) == headline(made)
    lines = "\n".join(headline(replace(made, blends=(into, out))))
    assert (
        "The hips are 48.0 cm beside the take at frame 60: the blend in (frames 31 to 60) moves "
        "them at up to 4.2 m/s (frame 45), the take at 0.6" in lines
    )
    assert "Begin the range earlier" in lines
    assert "beside the take at frame 330: the blend out (frames 330 to 359)" in lines
    assert "End the range later" in lines


def test_feet_that_slide_in_a_blend_are_told_with_the_remedy() -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    into = BlendReport(True, 31.0, 60.0, 0.02, 0.6, 45.0, 0.6, 0.043, "RightAnkle")
    out = replace(into, into=False, first_frame=330.0, last_frame=359.0)
    usual = headline(made)
    lines = headline(replace(made, blends=(into, out)))
    assert [line.strip() for line in lines if line not in usual] == [
        "RightAnkle slides by 43 mm in the blend in (frames 31 to 60), while it stands in the "
        "take. Begin the range before it comes down",
        "RightAnkle slides by 43 mm in the blend out (frames 330 to 359), while it stands in the "
        "take. End the range when it has left",
    ]
    little = replace(into, slide_m=0.02)
    assert headline(replace(made, blends=(little,))) == headline(made)


@pytest.mark.parametrize("durations", Durations)
def test_durations_that_were_sought_in_vain_are_told(durations: Durations) -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    lines = headline(replace(made, durations=durations))
    in_vain = durations in (Durations.NONE_FOUND, Durations.NOT_MET)
    assert any("Durations are as recorded" in line for line in lines) == in_vain


def test_a_loop_that_goes_elsewhere_than_the_recorded_cycle_is_told() -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    loop = LoopReport(28.0, 123.0, 28.0, 122.0, 2.1, 2.7, 0.0, 0.0, 0.0)
    turned = replace(made, loop=replace(loop, turned_deg=-5.04))
    assert headline(replace(made, loop=loop)) == headline(made)
    assert "  The loop goes 5.0° further to the right than the recorded cycle" in headline(turned)


def test_a_fit_that_is_far_off_in_one_place_is_told_so_first() -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    fit = made.fit_to_recording

    def lines(**values: float | str) -> list[str]:
        return headline(replace(made, fit_to_recording=replace(fit, **values)))

    far = "Solved, but the fit is far from the recording in one place"
    assert not lines()[0].startswith(far)
    assert lines(worst_joint_cm=18.7)[0].startswith(far)
    turned = lines(turned_limb="left shank", turned_limb_deg=73.0, turned_limb_frame=47.0)
    assert turned[0].startswith(far)
    assert "  The fit turns the left shank away from the recording by 73° (frame 47)" in turned
    assert lines(most_turned="left toe", most_turned_deg=73.0, turned_limb_deg=40.0) == lines()


def test_a_slide_under_load_that_shows_is_told_though_its_line_holds() -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))

    def sliding(mm: float) -> list[str]:
        """What the headline says of it."""
        lines = tuple(
            replace(line, value=mm, where="Left toe 2", frame=30.0, holds=True)
            if line.item is CertificateItem.SLIDE
            else line
            for line in made.certificate
        )
        return [line for line in headline(replace(made, certificate=lines)) if "slides" in line]

    assert sliding(1.9) == []
    assert sliding(4.07) == [
        "  a loaded point slides by 4.07 mm (Left toe 2, frame 30): limit 5 mm"
    ]


def test_where_nothing_gave_way_nothing_is_said_of_it() -> None:
    assert not any("gave way" in line or "beside" in line for line in told())


def test_bones_that_controls_do_not_bring_where_they_should_be_are_told() -> None:
    problem = MotionProblem()
    made = report(adapt(fitted_hop(), problem), problem, Origin("hop"))
    missed = BodyMiss("DEF-hand.L", 405.7, 298.0, 111.4, 297.0)
    (told,) = set(headline(replace(made, missed_bodies=(missed,)))) - set(headline(made))
    assert told.endswith("DEF-hand.L is up to 406 mm (frame 298) and 111° (frame 297) off")


def test_a_turn_that_is_none_in_whole_degrees_is_not_told() -> None:
    (told,) = missed_body_lines([BodyMiss("DEF-hand.L", 12.9, 31.0, 0.04, 32.0)])
    assert told.endswith(": DEF-hand.L is up to 13 mm (frame 31) off")
