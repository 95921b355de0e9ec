"""The states of a solve, without Blender."""

import pytest
from hangtime.operators.solve.solving import SolveState, Solving
from hangtime.solver.worker.protocol import Progress


def told(share: float = 0.5) -> Progress:
    return Progress(1, "adapt", 2, 40.0, "Left toe 2", share)


def solving() -> Solving:
    under_way = Solving()
    under_way.advance(SolveState.SOLVING)
    return under_way


def test_the_status_bar_says_stage_percent_and_the_worst_constraint() -> None:
    under_way = solving()
    under_way.heard(told())
    assert "adapting" in under_way.text
    assert "48 %" in under_way.text
    assert "Left toe 2 (40 × allowed)" in under_way.text


def test_the_share_never_falls_on_the_way() -> None:
    under_way = Solving()
    shares = [under_way.share]
    under_way.advance(SolveState.SOLVING)
    for share in (0.1, 0.6, 1.0):
        under_way.heard(told(share))
        shares.append(under_way.share)
    for state in (SolveState.CHECKING, SolveState.WRITING, SolveState.ENDED):
        under_way.advance(state)
        shares.append(under_way.share)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_who_cancels_hears_what_was_cancelled_and_what_is_left() -> None:
    under_way = Solving(label="Adapt")
    assert under_way.cancelled == (
        "Adapt was cancelled while reading the recording; nothing was changed"
    )
    assert not under_way.has_result
    under_way = Solving(label="Analyze", state=SolveState.PREPARING)
    assert under_way.cancelled == ("Preparing the drag was cancelled; what Analyze found is kept")
    assert under_way.has_result


def test_who_cancels_an_update_after_its_analysis_hears_that_the_new_contacts_stay() -> None:
    under_way = Solving(label="Update")
    under_way.advance(SolveState.SOLVING)
    under_way.again()
    under_way.advance(SolveState.SOLVING)
    under_way.heard(told())
    assert under_way.cancelled == "Update was cancelled while adapting; the new contacts are kept"
    assert under_way.has_result  # which is a step that can be undone


def test_who_cancels_once_the_result_is_shown_hears_that_it_stays() -> None:
    under_way = Solving(label="Adapt", state=SolveState.WRITING)
    assert under_way.cancelled.endswith("writing keyframes; nothing was changed")
    under_way.written = True
    assert under_way.cancelled.endswith("writing keyframes; the result is kept as it is")
    assert under_way.has_result


def test_after_an_analysis_it_says_what_is_made_ready() -> None:
    under_way = solving()
    under_way.advance(SolveState.PREPARING)
    assert under_way.text == "preparing the drag, 95 %"


def test_only_a_solve_can_be_stopped_and_only_once() -> None:
    under_way = Solving()
    assert not under_way.can_stop
    with pytest.raises(ValueError, match="reading"):
        under_way.stop()
    under_way.advance(SolveState.SOLVING)
    under_way.stop()
    assert not under_way.can_stop
    under_way.heard(told())  # a step that was on its way
    assert "as it stands" in under_way.text


def test_states_do_not_go_back() -> None:
    under_way = solving()
    under_way.advance(SolveState.WRITING)
    with pytest.raises(ValueError, match="CHECKING after WRITING"):
        under_way.advance(SolveState.CHECKING)
    with pytest.raises(ValueError, match="writing"):
        under_way.heard(told())


def test_blender_stays_usable_but_for_the_moment_of_writing() -> None:
    under_way = solving()
    assert all(under_way.passes(event) for event in ("Z", "SPACE", "LEFTMOUSE", "MOUSEMOVE"))
    under_way.advance(SolveState.WRITING)
    assert not under_way.passes("Z")
    assert not under_way.passes("LEFTMOUSE")
    assert under_way.passes("MOUSEMOVE")


def test_reading_and_examining_tell_their_share() -> None:
    under_way = Solving(reads=0.5)
    texts = []
    for part in (0.0, 0.5, 1.0, 0.1):  # the last of a shorter piece
        under_way.did(part)
        texts.append(under_way.text)
    assert texts == [f"reading the recording, {share} %" for share in (0, 25, 50, 50)]
    under_way.advance(SolveState.SOLVING)
    for share in (0.4, 0.2):  # a search that is made again
        under_way.heard(Progress(1, "examine", 0, 0.0, "", share))
        assert under_way.text == "looking for faults, 66 %"
