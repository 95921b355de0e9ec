"""Retimed phases and held frames: the map of time, its contacts, and what cannot be asked."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.operators.words.messages import sentence
from hangtime.solver.analysis.timeline import Stretch, Timeline, TimeWarp, active_interval, timeline
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.contacts import Contact, ContactSchedule, Interval
from hangtime.solver.data.faults import (
    BadTiming,
    BesideFrames,
    BesidePhase,
    NamedAsPhase,
    TooMuchTime,
    UnknownPhaseIn,
)
from hangtime.solver.data.requests import ALWAYS, Hold, Moment, PhaseTiming, When
from hypothesis import given
from hypothesis import strategies as st

RATE, FIRST = 100.0, 1.0
DURATION = 1.2
NO_APEX = np.zeros((0, 2))


def schedule() -> ContactSchedule:
    """Both feet until 0.4 s, the left one again from 0.7 s, the right one from 0.8 s on."""

    def contact(point: str, number: int, start: float, end: float) -> Contact:
        return Contact(
            f"{point} {number}", point, point, np.zeros(3), start, end, np.array([start, 0.0, 0.0])
        )

    contacts = (
        contact("left", 1, 0.0, 0.3),
        contact("right", 1, 0.0, 0.4),
        contact("left", 2, 0.7, DURATION),
        contact("right", 2, 0.8, DURATION),
    )
    return ContactSchedule(contacts, DURATION, 0.0)


def made(*, timings: tuple[PhaseTiming, ...] = (), holds: tuple[Hold, ...] = ()) -> Timeline:
    return timeline(schedule(), FIRST, RATE, timings, holds)


def frame(time: float) -> float:
    return FIRST + RATE * time


FACTORS = st.fixed_dictionaries(
    {name: st.floats(0.3, 3.0) for name in ("ground 1", "flight 1", "ground 2")}
)
TIMES = st.lists(st.floats(0.0, DURATION), min_size=1, max_size=20).map(np.array)
HOLDS = st.dictionaries(st.integers(1, 119), st.floats(0.05, 1.0), min_size=1, max_size=3)


def retimed(factors: dict[str, float]) -> tuple[PhaseTiming, ...]:
    return tuple(PhaseTiming(name, name, factor=f) for name, f in factors.items())


def held(seconds: dict[int, float]) -> tuple[Hold, ...]:
    return tuple(Hold(f"hold {k}", FIRST + k, s) for k, s in seconds.items())


@given(TIMES)
def test_nothing_asked_changes_nothing(times: FloatArray) -> None:
    line = made()
    assert line.unchanged
    assert line.duration == pytest.approx(DURATION)
    assert line.to_new(times) == pytest.approx(times, abs=1e-8)
    assert line.schedule(schedule()).boundaries == pytest.approx(schedule().boundaries)


@given(FACTORS, TIMES)
def test_without_holds_there_is_a_way_back(factors: dict[str, float], times: FloatArray) -> None:
    line = made(timings=retimed(factors))
    assert line.to_old(line.to_new(times)) == pytest.approx(times, abs=1e-8)
    assert (np.diff(line.to_new(np.sort(times))) >= 0.0).all()


@given(FACTORS)
def test_phases_last_as_long_as_was_asked(factors: dict[str, float]) -> None:
    line = made(timings=retimed(factors))
    for old, new in zip(schedule().phases, line.schedule(schedule()).phases, strict=True):
        assert new.name == old.name
        length = factors[old.name] * (old.end - old.start)
        assert new.end - new.start == pytest.approx(length, abs=1e-7)


def test_seconds_are_seconds() -> None:
    line = made(timings=(PhaseTiming("long", "flight 1", seconds=0.6),))
    assert line.duration == pytest.approx(DURATION + 0.3)
    assert not line.unchanged


@given(HOLDS, TIMES)
def test_holds_insert_their_seconds_and_nothing_else(
    seconds: dict[int, float], times: FloatArray
) -> None:
    line = made(holds=held(seconds))
    assert line.duration == pytest.approx(DURATION + sum(seconds.values()), abs=1e-7)
    assert not line.unchanged
    for span in line.holds:
        k = int(span.name.split()[1])
        assert span.end - span.start == pytest.approx(seconds[k], abs=1e-7)
        inside = np.linspace(span.start, span.end, 5)
        assert line.to_old(inside) == pytest.approx(k / RATE, abs=1e-6)
    before = [sum(s for k, s in seconds.items() if k / RATE < t - 1e-6) for t in times]
    apart = np.array([min(abs(k / RATE - t) for k in seconds) for t in times]) > 1e-6
    assert line.to_new(times)[apart] == pytest.approx((times + before)[apart], abs=1e-6)


@given(FACTORS, HOLDS)
def test_contacts_keep_their_order_places_and_share_of_time(
    factors: dict[str, float], seconds: dict[int, float]
) -> None:
    line = made(timings=retimed(factors), holds=held(seconds))
    new = line.schedule(schedule())
    assert [c.name for c in new.contacts] == [c.name for c in schedule().contacts]
    assert new.duration == line.duration
    for was, now in zip(schedule().contacts, new.contacts, strict=True):
        assert now.end > now.start
        assert (now.place == was.place).all()
        assert (now.end >= line.duration - 1e-9) == (was.end >= DURATION)
    assert [p.name for p in new.phases] == [p.name for p in schedule().phases]


def test_a_held_frame_is_found_where_its_hold_begins() -> None:
    line = made(holds=(Hold("hang", frame(0.5), 0.4),))
    assert line.instant(frame(0.5)) == pytest.approx(0.5)
    assert line.instant(frame(0.6)) == pytest.approx(1.0)
    assert line.holds[0].start == pytest.approx(0.5)


def test_a_hold_that_ends_cuts_the_rest_off() -> None:
    line = made(holds=(Hold("bar", frame(0.55), 0.25, ends=True),))
    assert line.duration == pytest.approx(0.8)
    cut = line.schedule(schedule())
    assert [c.name for c in cut.contacts] == ["left 1", "right 1"]
    assert [p.name for p in cut.phases] == ["ground 1", "flight 1"]
    assert cut.phases[-1].end == pytest.approx(0.8)


def test_a_contact_that_is_cut_lasts_to_the_new_end() -> None:
    line = made(holds=(Hold("stand", frame(0.9), 0.5, ends=True),))
    contacts = line.schedule(schedule()).contacts
    assert [c.end for c in contacts[2:]] == pytest.approx([1.4, 1.4])


def test_who_stands_at_the_end_stands_through_a_hold_of_it() -> None:
    line = made(holds=(Hold("stand", frame(DURATION), 0.5),))
    new = line.schedule(schedule())
    assert [c.end for c in new.contacts[2:]] == pytest.approx([1.7, 1.7])
    assert [p.name for p in new.phases] == ["ground 1", "flight 1", "ground 2"]


# -- when -----------------------------------------------------------------------------------


def when(asked: When = ALWAYS, line: Timeline | None = None) -> tuple[float, float]:
    line = line or made()
    apex = np.stack([np.linspace(0.0, 1.2, 121), np.linspace(0.0, 1.2, 121)], axis=1)
    apex[:, 1] = -((apex[:, 1] - 0.52) ** 2)
    return active_interval("asked", asked, line, line.schedule(schedule()).phases, apex)


def test_when_is_the_whole_clip_a_phase_frames_or_what_they_share() -> None:
    assert when() == (0.0, DURATION)
    assert when(When(phase="flight 1")) == pytest.approx((0.4, 0.7))
    assert when(When(frames=(frame(0.2), frame(0.5)))) == pytest.approx((0.2, 0.5))
    assert when(When(phase="flight 1", frames=(frame(0.2), frame(0.5)))) == pytest.approx(
        (0.4, 0.5)
    )
    assert when(When(frames=(frame(0.2), frame(0.2)))) == pytest.approx((0.2, 0.2))


@pytest.mark.parametrize(
    ("moment", "expected"),
    [(Moment.START, 0.4), (Moment.MIDDLE, 0.55), (Moment.APEX, 0.52), (Moment.END, 0.7)],
)
def test_moments_are_single_instants(moment: Moment, expected: float) -> None:
    start, end = when(When(phase="flight 1", moment=moment))
    assert start == end == pytest.approx(expected)


def test_a_hold_is_a_phase_by_its_name() -> None:
    line = made(holds=(Hold("hang", frame(0.5), 0.4),))
    assert when(When(phase="hang"), line) == pytest.approx((0.5, 0.9))
    assert when(When(phase="ground 2"), line) == pytest.approx((1.1, 1.6))


# -- faults ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("timings", "holds"),
    [
        ((), (Hold("short", frame(0.3), 0.5), Hold("H", frame(0.5), 1000.0))),
        ((PhaseTiming("H", "flight 1", factor=1000.0),), (Hold("short", frame(0.3), 0.5),)),
        ((PhaseTiming("H", "flight 1", seconds=20.0),), (Hold("twin", frame(0.3), 11.0),)),
    ],
)
def test_more_time_than_a_solve_has_room_for_is_refused(
    timings: tuple[PhaseTiming, ...], holds: tuple[Hold, ...]
) -> None:
    """By the one that adds most of it: a thousand seconds took all memory of a machine."""
    with pytest.raises(TooMuchTime) as caught:
        made(timings=timings, holds=holds)
    assert caught.value.request == "H"


def test_half_a_minute_may_be_added() -> None:
    assert made(holds=(Hold("H", frame(0.5), 29.0),)).duration == pytest.approx(DURATION + 29.0)


def test_unknown_phases_are_named_with_those_there_are() -> None:
    with pytest.raises(UnknownPhaseIn) as caught:
        made(timings=(PhaseTiming("long", "flight 2", factor=2.0),))
    assert (caught.value.request, caught.value.phase) == ("long", "flight 2")
    assert caught.value.known == ("ground 1", "flight 1", "ground 2")
    line = made(holds=(Hold("hang", frame(0.5), 0.4),))
    with pytest.raises(UnknownPhaseIn) as caught:
        when(When(phase="swing"), line)
    assert (caught.value.request, caught.value.known[-1]) == ("asked", "hang")


@pytest.mark.parametrize(
    "timing",
    [
        PhaseTiming("short", "flight 1", seconds=0.0),
        PhaseTiming("short", "flight 1", seconds=-1.0),
        PhaseTiming("short", "flight 1", factor=0.01),
        PhaseTiming("short", "flight 1", factor=0.0),
    ],
)
def test_phases_too_short_are_refused_by_name(timing: PhaseTiming) -> None:
    with pytest.raises(BadTiming) as caught:
        made(timings=(timing,))
    assert caught.value.request == "short"


@pytest.mark.parametrize("seconds", [0.0, -1.0])
def test_holds_of_no_time_are_refused_by_name(seconds: float) -> None:
    with pytest.raises(BadTiming) as caught:
        made(holds=(Hold("hang", frame(0.5), seconds),))
    assert caught.value.request == "hang"


@pytest.mark.parametrize("name", ["flight 1", "Ground 2", " FLIGHT  7"])
def test_a_hold_named_as_a_phase_is_refused(name: str) -> None:
    """It took what was asked of that phase."""
    with pytest.raises(NamedAsPhase) as caught:
        made(holds=(Hold(name, frame(0.5), 0.4),))
    assert sentence(caught.value).startswith(f"The hold “{name}” has the name of a phase;")


@pytest.mark.parametrize("at", [-0.1, 1.3])
def test_holds_outside_the_clip_are_refused_with_the_frames_that_there_are(at: float) -> None:
    with pytest.raises(BesideFrames) as caught:
        made(holds=(Hold("hang", frame(at), 0.4),))
    told = caught.value
    assert (told.request, told.at) == ("hang", frame(at))
    assert told.first <= frame(0.0) < told.last
    assert not told.first <= told.at <= told.last


def test_frames_outside_a_phase_are_refused() -> None:
    with pytest.raises(BesidePhase) as caught:
        when(When(phase="flight 1", frames=(frame(0.9), frame(1.0))))
    assert caught.value.request == "asked"
    assert "which lie outside flight 1" in sentence(caught.value)


def test_two_holds_of_one_frame_are_both_held() -> None:
    line = made(holds=(Hold("a", frame(0.5), 0.2), Hold("b", frame(0.5), 0.3)))
    assert [span.name for span in line.holds] == ["a", "b"]
    assert line.duration == pytest.approx(DURATION + 0.5)


def test_unseen_support_moves_along() -> None:
    """What stays behind would be a flight where something carries."""
    carried = replace(schedule(), unseen=(Interval(0.4, 0.7),))
    line = timeline(carried, FIRST, RATE, retimed({"ground 1": 1.5}), ())
    moved = line.schedule(carried)
    assert moved.flights == ()
    assert (moved.unseen[0].end - moved.unseen[0].start) == pytest.approx(0.45)


STRETCHES = (Stretch(0.1, 0.4, 1.25), Stretch(0.4, 0.7, 0.8))


@given(TIMES)
def test_a_warp_comes_back(times: FloatArray) -> None:
    warp = TimeWarp.of(STRETCHES, DURATION)
    assert warp.inverse(warp(times)) == pytest.approx(times, abs=1e-8)


def test_a_warp_stretches_its_intervals_and_nothing_else() -> None:
    warp = TimeWarp.of(STRETCHES, DURATION)
    lengths = np.diff(warp(np.array([0.0, 0.1, 0.4, 0.7, DURATION])))
    assert lengths == pytest.approx([0.1, 0.375, 0.24, 0.5])


@given(HOLDS)
def test_a_timeline_is_warped_in_its_new_time(seconds: dict[int, float]) -> None:
    line = made(timings=retimed({"flight 1": 2.0}), holds=held(seconds))
    warp = TimeWarp.of((Stretch(0.5, 0.9, 1.5),), line.duration)
    both = line.warped(warp)
    times = np.linspace(0.0, DURATION, 50)
    assert both.to_new(times) == pytest.approx(warp(line.to_new(times)), abs=1e-7)
    assert both.duration == pytest.approx(line.duration + 0.2)
    for was, now in zip(line.holds, both.holds, strict=True):
        assert now.start == pytest.approx(float(warp(was.start)))
