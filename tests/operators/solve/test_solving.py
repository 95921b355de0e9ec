"""The states of a solve, without Blender."""

from collections.abc import Mapping

import pytest
from hangtime.operators.solve.pace import Pace
from hangtime.operators.solve.solving import SolveState, Solving
from hangtime.solver.worker.protocol import Progress


def told(share: float = 0.5) -> Progress:
    return Progress(1, "adapt", 2, 40.0, "Left toe 2", share)


def solving() -> Solving:
    under_way = Solving()
    under_way.advance(SolveState.SOLVING)
    return under_way


class Clock:
    """s since the work began."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def timed(looks: Mapping[SolveState, float]) -> tuple[Solving, Clock]:
    clock = Clock()
    return Solving(looks=looks, pace=Pace(clock)), clock


def shares_during(under_way: Solving, clock: Clock, seconds: float, steps: int = 50) -> list[float]:
    """The share after each step of a piece of work."""
    found = []
    for step in range(1, steps + 1):
        clock.now += seconds / steps
        under_way.did(step / steps)
        found.append(under_way.share)
    return found


def test_the_status_bar_says_stage_percent_and_the_worst_constraint() -> None:
    under_way, clock = timed({})
    clock.now = 1.0
    under_way.advance(SolveState.SOLVING)
    clock.now = 3.0
    under_way.heard(told())
    assert "adapting, 60 %" in under_way.text
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
    under_way, clock = timed({SolveState.PREPARING: 1.0})
    shares_during(under_way, clock, 19.0)
    under_way.advance(SolveState.SOLVING)
    under_way.advance(SolveState.PREPARING)
    clock.now += 1.0
    under_way.did(0.5)
    assert under_way.text == "preparing the drag, 53 %"


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


def test_what_takes_most_of_the_time_is_most_of_the_progress() -> None:
    """On control rigs reading was 0 to 5 %, and writing 95 to 100 %, whatever they took."""
    under_way, clock = timed({SolveState.CHECKING: 1.0, SolveState.WRITING: 20.0})
    seconds = {"read": 5.0, "solve": 5.0, "check": 5.0, "look": 5.0, "write": 80.0}
    shares, at = [], dict[str, float]()
    for name, state in (
        ("read", None),
        ("solve", SolveState.SOLVING),
        ("check", SolveState.CHECKING),
        ("look", SolveState.WRITING),  # at the take, a first piece of writing
        ("write", None),
    ):
        if state is not None:
            under_way.advance(state)
        shares += shares_during(under_way, clock, seconds[name])
        at[name] = shares[-1]
    assert shares == sorted(shares)
    done = [5.0, 10.0, 15.0, 20.0, 100.0]
    assert list(at.values()) == pytest.approx([s / 100.0 for s in done], abs=0.05)


def test_another_piece_that_takes_longer_than_was_expected_goes_on_from_there() -> None:
    under_way, clock = timed({})
    before = shares_during(under_way, clock, 1.0)
    after = shares_during(under_way, clock, 60.0)
    assert before[-1] < 0.2
    assert before + after == sorted(before + after)
    assert after[len(after) // 2] == pytest.approx(0.5, abs=0.1)


def test_an_examination_tells_its_share_though_a_search_is_made_again() -> None:
    under_way, clock = timed({})
    shares_during(under_way, clock, 5.0)
    assert under_way.text == "reading the recording, 50 %"
    under_way.advance(SolveState.SOLVING)
    for share in (0.4, 0.2):
        clock.now += 2.0
        under_way.heard(Progress(1, "examine", 0, 0.0, "", share))
        assert under_way.text == "looking for faults, 70 %"
