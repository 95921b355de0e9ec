"""The fit always ends: something unseen carries where it must, what contradicts is let go."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hangtime.devtools.checks.mujoco_check import check_motion, check_npz
from hangtime.operators.words.headline import accepted_lines, headline
from hangtime.operators.words.messages import sentence
from hangtime.operators.words.report_text import as_text
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.pins.pinned_places import pinned_places
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.constants import UP
from hangtime.solver.data.contacts import PhaseKind
from hangtime.solver.data.faults import FitNeedsSupport, UnknownPhase, UnseenSupport
from hangtime.solver.data.problem import MotionProblem, Pin, Unseen
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.reports.report import Report
from hangtime.solver.data.requests import PointRequest, Requests, When
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.traces import UNSEEN_SUPPORT
from hangtime.solver.fitting.fit import Fit
from hangtime.solver.fitting.lasting_fit import lasting_fit, leaning
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.results.fit_quality import fit_quality
from hangtime.solver.results.npz_export import save
from hangtime.solver.results.unseen_support import fit_needs
from hangtime.solver.transcription.motion import dynamics_residual
from hangtime.solver.worker.pipeline import (
    AdaptationResult,
    Subject,
    adapt_fit,
    fit_subject,
    measure,
    solve,
)
from hangtime.solver.worker.stage_clock import StageClock
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.doctored import spun
from hangtime.tests.helpers.fitted_hop import HOP, HOP_CLIP, frames_of, hop
from hangtime.tests.helpers.leaned import leaned

DROP = 0.3  # m
AROUND = 0.3  # s, of the flight


def dropped() -> Recording:
    """The hop as a jump down, around its flight: nothing that it shows carries it at first."""
    recording = load_recording(HOP_CLIP).window(*frames_of(HOP_CLIP, HOP))
    (flight,) = (p for p in hop().schedule.phases if p.kind is PhaseKind.FLIGHT)
    share = np.clip((recording.times - flight.start) / (flight.end - flight.start), 0.0, 1.0)
    heads = recording.heads.copy()
    heads[..., 2] += DROP * (1.0 - share[:, None])
    first, rate = float(recording.frames[0]), recording.rate
    ends = (flight.start - AROUND, flight.end + AROUND)
    return replace(recording, heads=heads).window(*(first + round(t * rate) for t in ends))


@cache
def subject() -> Subject:
    return measure(dropped(), MotionProblem())


@cache
def fitted() -> Fit:
    return fit_subject(subject(), StageClock())


@cache
def adapted(up: float = 0.0) -> AdaptationResult:
    pins = (Pin("Landing", "ground 2", offset=(0.0, 0.0, up)),) if up else ()
    return adapt_fit(subject().asked(MotionProblem(pins=pins)), fitted(), StageClock())


def report() -> Report:
    return adapted().report(Origin("drop"))


@cache
def hung() -> AdaptationResult:
    """A jumper, lifted and swung up and down: nothing that the recording shows carries it."""
    jump = load_recording(JUMP).window(100.0, 180.0)
    heads = jump.heads.copy()
    heads[..., 2] += 1.0 + 0.5 * np.sin(6.0 * jump.times)[:, None]
    heads[:8, :, 2] -= heads[:8, :, 2].min()  # the floor is told
    hanging = measure(replace(jump, heads=heads).window(110.0, 180.0), MotionProblem())
    return solve(hanging, StageClock())


@pytest.mark.slow
def test_a_body_that_hangs_is_fitted_without_any_contact() -> None:
    made = hung()
    assert made.schedule.contacts == ()
    assert made.fault is None
    told = made.report(Origin("hang"))
    (unseen,) = told.unseen_support
    assert (unseen.first_frame, unseen.last_frame) == pytest.approx((110.0, 180.0), abs=0.5)
    assert unseen.force_bw > 1.0
    assert 0.3 < unseen.mean_bw < unseen.force_bw
    assert told.fit_to_recording.joint_centres_rms_cm < 1.0
    text = as_text(told)
    assert text.startswith("Solved, but not with what the recording shows alone")
    assert "on average and at most) 110 to 180" in " ".join(text.split())
    assert UNSEEN_SUPPORT in made.traces().contacts


def test_mujoco_finds_nothing_that_unseen_support_leaves_unexplained(tmp_path: Path) -> None:
    """Nor do Newton and Euler, by differences of what the file for others holds."""
    motion = hung().adaptation.motion
    save(motion, tmp_path / "trajectory.npz")
    for left in (check_motion(motion)[0], check_npz(tmp_path / "trajectory.npz")):
        assert not left.flying.any()
        assert left.worst("force", flying=False) < 1e-3
        assert left.rms("moment", flying=False) < 2e-3


def test_who_refuses_unseen_support_is_refused_what_only_the_fit_tells() -> None:
    """Here the analysis tells it as well, and is not asked."""
    refusing = hung().subject.asked(MotionProblem(unseen=Unseen.REFUSE))
    with pytest.raises(FitNeedsSupport) as caught:
        adapt_fit(refusing, hung().adaptation.fit, StageClock())
    assert caught.value.spans == ((110, 180),)
    assert "carries the body in frames 110 to 180, which the recipe refuses" in sentence(
        caught.value
    )


@pytest.mark.slow
def test_what_is_unseen_carries_the_body() -> None:
    assert fitted().solved
    t = fitted().motion.transcription
    times = np.linspace(0.01, AROUND - 0.05, 40)
    weight = t.character.mass * 9.80665
    carried = fitted().motion.forces(times)[:, -t.n_support :].sum(axis=1) / weight
    recorded = np.linalg.norm(carried, axis=1)
    assert recorded.mean() > 0.8
    left = dynamics_residual(fitted().motion, np.linspace(0.0, fitted().motion.duration, 200))
    assert np.abs(left.force).max() < 1e-6
    assert np.abs(left.moment).max() < 0.01
    apart = fitted().motion.joint_centres(subject().recording.times)
    apart = apart - fitted().performance.centres
    assert np.sqrt((apart**2).sum(axis=2).mean()) < 0.025


@pytest.mark.slow
def test_the_headline_tells_where_and_how_much() -> None:
    (unseen,) = report().unseen_support
    first = float(subject().recording.frames[0])
    assert unseen.first_frame == pytest.approx(first, abs=1.0)
    assert unseen.force_bw > 0.8
    told = headline(report())
    assert told[0].startswith("Solved, but not with what the recording shows alone")
    assert "everything asked for holds" not in told[0]
    assert any("Something unseen carries the body" in line for line in told)


@pytest.mark.slow
def test_what_is_carried_so_is_adapted() -> None:
    made = adapted(0.1)
    assert made.fault is None
    assert made.adaptation.motion.places[-1, 2] == pytest.approx(0.1, abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bones", "normal", "least", "most"),
    [
        (("LeftToeBase", "RightToeBase"), (0.0, 0.0, 1.0), 0.9, 1.0),
        (("LeftToeBase", "RightToeBase"), (1.0, 0.0, 0.0), 0.0, 0.1),
        (("LeftHand",), (0.0, 0.0, 1.0), 0.1, 0.5),
    ],
)
def test_points_that_push_back_carry_what_was_unseen(
    bones: tuple[str, ...], normal: tuple[float, float, float], least: float, most: float
) -> None:
    """Where they can: nobody stands on a wall, or hangs all of the body on one hand at its side.
    least, most: their share of the vertical force."""
    (flight,) = subject().schedule.flights
    first = float(subject().recording.frames[0])
    when = When(frames=(first, first + flight.start * subject().recording.rate))
    points = tuple(
        PointRequest(f"{bone} on it", bone, when, environment=True, normal=normal) for bone in bones
    )
    asked = subject().asked(MotionProblem(requests=Requests(points=points)))
    made = adapt_fit(asked, fitted(), StageClock())
    assert made.fault is None
    motion = made.adaptation.motion
    t = motion.transcription
    added = [c.point for c in t.contacts if "on it" in c.contact.name]
    forces = motion.forces(np.linspace(0.02, flight.start - 0.06, 60))[..., 2].mean(axis=0)
    unseen, carried = forces[-t.n_support :].sum(), forces[added].sum()
    assert least < carried / (carried + unseen) < most


def test_a_stance_on_what_is_not_there_has_no_contact_to_move() -> None:
    """It was moved to no number."""
    pins = (Pin("Take-off", "ground 1", offset=(0.0, 0.0, 0.1)),)
    with pytest.raises(UnknownPhase) as found:
        pinned_places(MotionProblem(pins=pins), subject().analysis.performance, subject().schedule)
    assert found.value.known == ("ground 2",)


@pytest.mark.slow
def test_a_dance_without_a_flight_is_fitted() -> None:
    """Feet and hands support in turn, the feet drift with the suit, and there is no flight."""
    recording = load_recording("rokoko_jesse_dance.bvh")
    dance = measure(recording, MotionProblem(frames=(1.0, 250.0)))
    found = fit_subject(dance, StageClock())
    assert found.solved
    assert found.schedule.flights == ()
    assert fit_quality(found).joint_centres_rms_cm < 2.5


@pytest.mark.slow
def test_who_lies_on_the_floor_stays_there() -> None:
    """The toes alone touch, which hold nobody up who leans over by 80 degrees."""
    fitted = fit_subject(measure(leaned(80.0), MotionProblem()), StageClock())
    assert fitted.solved
    assert fitted.schedule.contacts
    assert fit_quality(fitted).joint_centres_rms_cm < 1.0  # by its toes alone 9


@pytest.mark.slow
def test_who_leans_on_what_was_not_recorded_is_carried() -> None:
    """The toes touch all the while, so there is neither a flight nor anything on the floor."""
    subject = measure(leaned(20.0), MotionProblem())
    assert subject.schedule.unseen == ()
    fitted = fit_subject(subject, StageClock())
    assert fitted.let_go == ()
    assert len(fitted.schedule.contacts) == len(subject.schedule.contacts)
    assert fitted.schedule.unseen
    assert fit_quality(fitted).joint_centres_rms_cm < 1.0  # by the feet alone 4
    with pytest.raises(FitNeedsSupport):
        adapt_fit(subject.asked(MotionProblem(unseen=Unseen.REFUSE)), fitted, StageClock())


def test_no_moment_of_flight_is_left_between_a_contact_and_what_carries_unseen() -> None:
    """Who keels over onto the hands, and lifts the feet some milliseconds before they are there."""
    stands = load_recording(JUMP).window(1.0, 90.0)
    toes = [i for i, bone in enumerate(stands.bones) if "Toe" in bone.name]
    share = np.clip((np.arange(len(stands.frames)) - 25) / 35.0, 0.0, 1.0)
    turn = axis_rotation(0, np.radians(80.0) * (3.0 * share**2 - 2.0 * share**3))
    hinge = stands.heads[0, toes].mean(axis=0) * [1.0, 1.0, 0.0]
    heads = np.einsum("tij,tbj->tbi", turn, stands.heads - hinge) + hinge
    falls = replace(stands, heads=heads, rotations=turn[:, None] @ stands.rotations)
    analysis = measure(falls, MotionProblem()).analysis
    performance, schedule = analysis.performance, replace(analysis.schedule, contacts=())
    (there,) = leaning(performance, schedule)
    assert 0.0 < there.start < there.end == pytest.approx(schedule.duration)
    lifted = replace(analysis.schedule.contacts[0], start=0.0, end=there.start - 0.002)
    (joined,) = leaning(performance, replace(schedule, contacts=(lifted,)))
    assert joined.start == lifted.end
    long_before = replace(lifted, end=there.start - 0.2)
    (apart,) = leaning(performance, replace(schedule, contacts=(long_before,)))
    assert apart.start == there.start


@pytest.mark.slow
def test_a_figure_without_toes_keeps_its_contacts() -> None:
    """Heel and ball on one bone cannot come nearer to each other as one of them rises."""
    run = load_recording("BMC_run.bvh")
    keep = [i for i, bone in enumerate(run.bones) if "Toe" not in bone.name]
    bones = tuple(
        replace(run.bones[i], parent=keep.index(run.bones[i].parent) if i else -1) for i in keep
    )
    toeless = replace(run, bones=bones, heads=run.heads[:, keep], rotations=run.rotations[:, keep])
    fitted = fit_subject(measure(toeless, MotionProblem(frames=(1.0, 60.0))), StageClock())
    assert fitted.solved
    assert not fitted.let_go


@pytest.mark.slow
@pytest.mark.parametrize("every", [1, 4])
def test_a_skid_of_both_feet_leaves_no_contradiction_behind(every: int) -> None:
    """They are at one place and then, at once, at another. every: of so many frames one is there;
    of few the centre of mass does not tell whether it falls."""
    whole = load_recording(HOP_CLIP).window(*frames_of(HOP_CLIP, HOP))
    recording = whole.part(slice(None, None, every))
    last = hop().schedule.phases[-1]
    share = np.clip((recording.times - last.start - 0.2) / 0.1, 0.0, 1.0)
    heads = recording.heads.copy()
    heads[..., 0] += 0.08 * share[:, None]
    subject = measure(replace(recording, heads=heads), MotionProblem())
    fitted = fit_subject(subject, StageClock())
    assert fitted.solved
    assert not fitted.let_go
    (unseen,) = fitted.schedule.unseen
    assert last.start < unseen.start < unseen.end < unseen.start + 0.1
    assert len(fitted.schedule.flights) == len(hop().schedule.flights)
    (told,) = subject.analysis.unseen
    assert isinstance(told, UnseenSupport)
    assert "skid to another place" in sentence(told)


@pytest.mark.slow
def test_a_contact_that_contradicts_the_others_is_let_go_and_told() -> None:
    """One point of a standing foot is said to be further off than the foot can turn."""
    schedule, performance = hop().schedule, hop().performance
    shifted = schedule.contacts[-1]
    wrong = replace(shifted, place=shifted.place + np.array([0.0, 0.3, 0.0]))
    contacts = (*schedule.contacts[:-1], wrong)
    found = lasting_fit(
        performance, replace(schedule, contacts=contacts), lambda s: [None] * len(s.contacts)
    )
    assert found.solved
    assert {each.contact.point.split()[0] for each in found.let_go} == {wrong.point.split()[0]}
    assert all(each.off > RowKind.PIN.tolerance for each in found.let_go)
    assert [p.name for p in found.schedule.phases] == [p.name for p in schedule.phases]


@pytest.mark.slow
def test_a_contact_that_is_near_enough_is_accepted_and_told() -> None:
    """The same, where that far off is said to be good enough."""
    schedule, performance = hop().schedule, hop().performance
    shifted = schedule.contacts[-1]
    wrong = replace(shifted, place=shifted.place + np.array([0.0, 0.3, 0.0]))
    contacts = (*schedule.contacts[:-1], wrong)
    found = lasting_fit(
        performance,
        replace(schedule, contacts=contacts),
        lambda s: [None] * len(s.contacts),
        good_enough=0.3,
    )
    assert found.solved
    assert found.let_go == ()
    needs = fit_needs(found)
    assert needs.accepted
    assert all(0.01 < each.off_mm < 310.0 for each in needs.accepted)
    assert {each.limit_mm for each in needs.accepted} == {300.0}
    assert any("good enough" in line for line in accepted_lines(needs))


@pytest.mark.slow
@pytest.mark.parametrize(("axis", "carried"), [(UP, False), (np.array([1.0, 0.0, 0.0]), True)])
def test_a_clear_fall_is_a_flight_unless_something_unseen_turns_the_body(
    axis: FloatArray, *, carried: bool
) -> None:
    """A twist that the feet may give, and a somersault that the push-off had no turn for: with a
    moment out of nowhere it is far nearer."""
    still = analyse(load_recording(JUMP), MotionProblem()).schedule.flights[0]
    turned = spun(load_recording(JUMP), axis, still.start + 0.02, still.end - 0.02)
    analysis = analyse(turned, MotionProblem())
    found = lasting_fit(analysis.performance, analysis.schedule, lambda s: [None] * len(s.contacts))
    assert found.solved
    assert bool(found.schedule.unseen) is carried
    assert len(found.schedule.flights) == (not carried)
    apart = found.motion.joint_centres(turned.times) - analysis.performance.centres
    assert np.sqrt((apart**2).sum(axis=2).mean()) < 0.04
