"""The certificate of a real hop: against the motion's own samples, and what spoilt ones fail."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.operators.words.headline import headline
from hangtime.operators.words.report_text import as_text, certificate_lines
from hangtime.solver.body.anatomy import Part
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.reports.certificate import CertificateItem as Item
from hangtime.solver.data.reports.certificate import CertificateLine
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.reports.report import Report
from hangtime.solver.data.requests import Lift, Requests
from hangtime.solver.results.certificate import friction_used, loaded_drifts
from hangtime.solver.results.report import report
from hangtime.solver.results.torque_curve import exact_torques
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.transcription.motion import Motion
from hangtime.tests.helpers.fitted_hop import fitted_hop

FIT_WORST = Item.FIT_WORST_FRAME
PROBLEM, ORIGIN = MotionProblem(), Origin("hop.bvh")


@cache
def plain() -> Adaptation:
    """The fit as an adaptation that changes nothing."""
    return adapt(fitted_hop(), PROBLEM)


@cache
def found() -> Report:
    return report(plain(), PROBLEM, ORIGIN)


def line(item: Item, of: Report | None = None) -> CertificateLine:
    return next(each for each in (of or found()).certificate if each.item is item)


def spoilt(block: int, column: int, by: float) -> Report:
    """The report on the fit with one unknown moved."""
    x = plain().outcome.x.copy()
    x[block, column] += by
    outcome = replace(plain().outcome, x=x)
    return report(replace(plain(), outcomes=(*plain().outcomes, outcome)), PROBLEM, ORIGIN)


def test_every_item_has_one_line_that_says_whether_it_holds() -> None:
    assert [each.item for each in found().certificate] == list(Item)
    assert all(each.holds == (each.value <= each.limit) for each in found().certificate)
    assert line(Item.RESIDUAL_FORCE_PEAK_SHARE).holds
    assert line(Item.RESIDUAL_MOMENT_PEAK_SHARE).holds


def test_a_force_that_nothing_explains_fails() -> None:
    motion = plain().motion
    bad = spoilt(len(motion.x) // 2, motion.transcription.layout.com.start + 2, 0.02)
    assert not line(Item.RESIDUAL_FORCE_PEAK_SHARE, bad).holds
    assert not line(Item.RESIDUAL_FORCE_PEAK, bad).holds
    newtons = line(Item.RESIDUAL_FORCE_PEAK, bad).value
    largest = line(Item.PEAK_FORCE, bad).value * 70.0 * 9.81
    share = line(Item.RESIDUAL_FORCE_PEAK_SHARE, bad).value
    assert share == pytest.approx(100.0 * newtons / largest, rel=0.02)
    assert "unexplained force" in "".join(certificate_lines(bad))


def test_loaded_points_are_looked_at_over_the_whole_contact() -> None:
    """The slide as a sampled motion shows it, beyond the pins' intervals too."""
    motion = plain().motion
    worst = 0.0
    for i, each in enumerate(motion.transcription.contacts):
        times = np.linspace(each.contact.start, each.contact.end, 3001)[1:-1]
        force = np.linalg.norm(motion.forces(times)[:, each.point], axis=1)
        at = motion.contact_points(times)[force > 0.05 * 70.0 * 9.81, each.point]
        along = np.linalg.norm((at - motion.places[i])[:, :2], axis=1)
        worst = max(worst, 1000.0 * float(along.max()))
        assert found().contacts[i].loaded_slide_mm == pytest.approx(1000.0 * along.max(), abs=0.5)
    assert line(Item.SLIDE).value == pytest.approx(worst, abs=0.5)


def test_a_moved_place_is_a_slide_and_a_height() -> None:
    motion = plain().motion
    moved = Motion(motion.transcription, motion.x, motion.places + np.array([0.03, 0.0, 0.04]))
    for here, there in zip(loaded_drifts(motion), loaded_drifts(moved), strict=True):
        assert there.height == pytest.approx(here.height - 0.04)
        assert np.abs(there.slide - 0.03).max() <= here.slide.max() + 1e-9


def test_friction_is_of_all_forces_together() -> None:
    contacts = plain().motion.transcription.contacts
    times = np.array([contacts[0].contact.start + 0.01])
    forces = np.zeros((1, len(plain().motion.transcription.points), 3))
    forces[0, contacts[0].point] = [0.3, 0.4, 1.0]
    assert friction_used(contacts, times, forces, 1.0) == pytest.approx(0.5)
    assert friction_used(contacts, times, 0.1 * forces, 1.0) == 0.0  # hardly carries
    assert friction_used(contacts, times, 0.1 * forces, 0.165) == pytest.approx(0.5)  # on the Moon
    grips = tuple(replace(each, friction=None) for each in contacts)
    assert friction_used(grips, times, forces, 1.0) == 0.0


def test_torques_are_per_kilogram_of_the_worse_side() -> None:
    motion = plain().motion
    character = motion.transcription.character
    times = np.arange(0.0005, motion.duration, 0.001)
    sizes = np.abs(exact_torques(motion, plain().setup.torques, times)).max(axis=0) / 70.0
    knees = [
        sizes[joint.first - 3]
        for body, joint in zip(character.bodies, character.joints, strict=True)
        if body.part is Part.SHANK
    ]
    assert line(Item.KNEE_TORQUE).value == pytest.approx(max(knees), rel=1e-6)
    assert line(Item.KNEE_TORQUE).limit == pytest.approx(1.5 * 0.163 * 9.81 * character.height)


def test_headlines_say_no_more_than_is_true() -> None:
    def text(**values: float) -> str:
        """The headline of a report all of whose lines hold, but for these values."""
        lines = (replace(each, value=0.0, holds=True) for each in found().certificate)
        made = tuple(
            replace(each, value=values[each.item.name], holds=False, frame=12.0, where="")
            if each.item.name in values
            else each
            for each in lines
        )
        return as_text(replace(found(), certificate=made)).partition("\n\n")[0]

    first, _, nearness = text().partition("\n")
    assert first == "Solved: the motion obeys physics and everything asked for holds."
    assert re.fullmatch(
        r"  The fit is within [\d.]+ cm of the recording \(rms\); worst [\d.]+ cm, "
        r"(left|right) \w+, frame \d+",
        nearness,
    )
    far = text(FIT_RMS=9.2, SLIDE=80.0, KNEE_TORQUE=60.0, UNDER=40.0, LOADING_RATE=211.0)
    assert far.startswith("Solved, but the fit is far from the recording")
    assert "obeys physics" not in far
    assert "everything asked for holds" not in far
    assert "5 of the certificate's 19 lines do not" in far
    assert "fit off the recording, rms 9.2 cm (frame 12)" in far
    assert "a loaded point slides by 80 mm" in far
    assert "loading rate" not in far  # the least of them


def test_of_a_fit_alone_no_line_is_compared_with_that_fit() -> None:
    assert {each.recorded for each in found().certificate} == {None}


def test_what_the_recording_has_alike_is_told_apart_from_what_an_edit_did() -> None:
    lift = replace(PROBLEM, requests=Requests(lifts=(Lift("None", "flight 1"),)))
    edited = report(plain(), lift, ORIGIN)
    own = [each for each in edited.certificate if each.item not in (Item.FIT_RMS, FIT_WORST)]
    assert [each.recorded for each in own] == pytest.approx([each.value for each in own])
    assert line(FIT_WORST, edited).recorded is None

    def text(recorded: float = 2.0, **values: float) -> list[str]:
        """The headline where these lines have a limit of 1, and so much in the recording."""
        made = tuple(
            replace(each, value=values[each.item.name], limit=1.0, holds=False, recorded=recorded)
            for each in found().certificate
            if each.item.name in values
        )
        return headline(replace(found(), certificate=made))

    assert text(KNEE_TORQUE=2.0)[0].endswith("lines does not hold, as in the recording.")
    assert text(0.99, KNEE_TORQUE=1.01)[0].endswith("lines does not hold.")
    told = text(KNEE_TORQUE=2.05, HIP_TORQUE=1.5, ANKLE_TORQUE=5.0)
    assert told[0].endswith("3 of the certificate's 3 lines do not hold, 2 as in the recording.")
    first = next(each for each in told if "torque" in each)
    assert "ankle torque 5 N·m/kg" in first
    assert first.endswith("limit 1 N·m/kg, recorded 2")


def test_the_whole_certificate_is_in_the_text() -> None:
    text = as_text(found())
    for words in ("knee torque", "loading rate", "friction coefficient used", "N·m/kg"):
        assert words in text
