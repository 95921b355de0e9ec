"""A foot that stands flat does so with all of its sole, on the floor or on something else."""

import numpy as np
import pytest
from hangtime.bridge.recipe.object_texts import support_texts
from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.performance import find_contacts, perform
from hangtime.solver.body.character import build_character
from hangtime.solver.data.contacts import ContactSchedule
from hangtime.solver.data.faults import UnseenSupport
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.fitting.fit import fit
from hangtime.solver.worker.pipeline import measure
from hangtime.tests.helpers.doctored import onto


def found(metres: float) -> ContactSchedule:
    recording = onto(metres)
    return find_contacts(perform(recording, build_character(recording)))


def test_where_the_floor_is_not_level_heels_stand_too() -> None:
    """They did not, 3 cm up, and who landed so stood on the toes."""
    schedule = found(0.03)
    landed = {contact.point for contact in schedule.contacts if contact.start > 1.0}
    assert landed == {"Left heel", "Left toe", "Right heel", "Right toe"}
    assert schedule.unseen == ()


def test_on_a_mat_no_foot_is_half_on_the_floor() -> None:
    """Toes were, up to 5 cm: one of four points, and the fit was 16 cm off."""
    onto_it, off_it = found(0.05), found(-0.05)
    assert all(contact.end < 1.0 for contact in onto_it.contacts)
    assert all(contact.start > 1.0 for contact in off_it.contacts)
    assert [gap.end for gap in onto_it.unseen] == [onto_it.duration]
    assert [gap.start for gap in off_it.unseen] == [0.0]


@pytest.mark.parametrize("metres", [0.038, 0.039, 0.04, 0.041, 0.042])
def test_about_the_least_height_of_a_mat_both_feet_are_on_one_thing(metres: float) -> None:
    """Soles are up to a centimetre apart: one foot stood, and the other on nothing."""
    schedule = found(metres)
    landed = {contact.point for contact in schedule.contacts if contact.start > 1.0}
    assert len(landed) == (0 if schedule.unseen else 4)


@pytest.mark.slow
@pytest.mark.parametrize("metres", [-0.05, 0.05])
def test_with_the_box_that_is_offered_the_fit_of_a_mat_is_near(metres: float) -> None:
    """Off one it was 4.6 cm off, for one toe of four points stood."""
    recording = onto(metres)
    (unseen,) = measure(recording, MotionProblem()).analysis.unseen
    assert isinstance(unseen, UnseenSupport)
    scene = parse_recipe("\n".join(support_texts(unseen.boxes))).problem.scene
    found = analyse(recording, MotionProblem(scene=scene))
    fitted = fit(found.performance, found.schedule)
    assert fitted.solved
    bones = [recording.index(body.bone) for body in fitted.motion.transcription.character.bodies]
    off = fitted.motion.joint_centres(recording.times) - recording.heads[:, bones]
    assert np.sqrt(np.mean(np.sum(off**2, axis=-1))) < 0.015
