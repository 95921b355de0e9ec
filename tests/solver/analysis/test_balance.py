"""Who sits or leans has the weight beside the feet; who stands, walks or lands has not."""

import pytest
from hangtime.operators.words.doctor_text import finding_sentence
from hangtime.operators.words.messages import sentence
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.balance import SURELY_LASTS, off_balance
from hangtime.solver.data.faults import OffBalance
from hangtime.solver.data.problem import MotionProblem, Unseen
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.leaned import leaned

CLEAN = JUMP, "131_03_hop.bvh", "fair1_jumping.bvh", "cmu1_jumping_jacks.bvh", "run_2.bvh"


@pytest.mark.parametrize("name", CLEAN)
def test_feet_that_carry_the_body_are_below_its_weight(name: str) -> None:
    analysis = analyse(load_recording(name), MotionProblem())
    assert off_balance(analysis.performance, analysis.schedule, SURELY_LASTS) == ()
    assert analysis.unseen == ()


def test_who_leans_is_told_so() -> None:
    """Refused is what is sure: whether something must carry the fit tells."""
    analysis = analyse(leaned(20.0), MotionProblem(unseen=Unseen.REFUSE))
    (told,) = analysis.unseen
    assert told == OffBalance(((1.0, 90.0),))
    said = "In frames 1 to 90 the weight is beside the feet, as of who sits or leans"
    assert sentence(told).startswith(said)


def test_the_doctor_notes_who_leans() -> None:
    notes = [finding_sentence(each) for each in diagnose(leaned(20.0)).findings]
    assert any(note.startswith("The weight is beside the feet in frames 1 to 90") for note in notes)


def test_who_leans_a_little_is_not() -> None:
    """Over toes, though not by a hand's breadth beyond them."""
    assert analyse(leaned(8.0), MotionProblem()).unseen == ()
