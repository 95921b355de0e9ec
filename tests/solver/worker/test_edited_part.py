"""What of a long take an edit solves: the jumps that pins are about, under their own names."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.devtools.recordings import HOPS
from hangtime.solver.analysis.pins.pinned_places import chosen_contacts, phase_of
from hangtime.solver.data.contacts import PhaseKind
from hangtime.solver.data.problem import ContactEdit, Mend, MotionProblem, Pin
from hangtime.solver.data.requests import BodyChange, Requests
from hangtime.solver.worker.pipeline import Subject, measure, solve
from hangtime.solver.worker.stage_clock import StageClock
from hangtime.tests.helpers.clips import load_recording

FURTHER = (0.3, 0.0, 0.0)
AS_ITS_OWN = 0.03  # m; contacts found in the take and in the window differ by millimetres


@cache
def hops() -> Subject:
    """All ten, 23 s."""
    return measure(load_recording(HOPS), MotionProblem())


def pinned(*phases: str) -> MotionProblem:
    return MotionProblem(pins=tuple(Pin(phase, phase, offset=FURTHER) for phase in phases))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("phases", "solved"),
    [
        (("ground 5",), ("ground 4", "flight 4", "ground 5")),
        (("ground 1",), ("ground 1", "flight 1", "ground 2")),
        (("ground 3", "ground 4"), ("ground 2", "flight 2", "ground 3", "flight 3", "ground 4")),
    ],
)
def test_an_edit_is_of_the_jumps_that_it_changes(
    phases: tuple[str, ...], solved: tuple[str, ...]
) -> None:
    whole, part = hops(), hops().asked(pinned(*phases)).edited()
    schedule = part.analysis.schedule
    assert tuple(phase.name for phase in schedule.phases) == solved
    names = {contact.name: contact for contact in whole.analysis.schedule.contacts}
    assert all((names[c.name].place == c.place).all() for c in schedule.contacts)
    ends = sorted((contact.start, contact.point) for contact in schedule.contacts)
    assert ends == [(contact.start, contact.point) for contact in schedule.contacts]
    first = float(part.recording.frames[0] - whole.recording.frames[0]) / whole.recording.rate
    flight = next(p for p in whole.analysis.schedule.phases if p.name == "flight 4")
    mine = [p for p in schedule.phases if p.name == "flight 4"]
    assert [p.start + first for p in mine] == pytest.approx([flight.start] * len(mine))


@pytest.mark.slow
def test_what_is_about_all_of_a_take_is_solved_on_all_of_it() -> None:
    heavy = Requests(body=BodyChange(mass=80.0))
    for problem in (MotionProblem(), replace(pinned("ground 5"), requests=heavy)):
        assert hops().asked(problem).edited().analysis is hops().analysis


@pytest.mark.parametrize("phase", ["ground 5", "ground 8"])
def test_contacts_that_pins_name_are_in_the_part_however_late_they_begin(phase: str) -> None:
    """Who lands walks on: what drags the whole stance pins each of its steps."""
    schedule = hops().analysis.schedule
    there = schedule.of_phase(next(p for p in schedule.phases if p.name == phase))
    each = [Pin(c.name, phase, (c.name,), place=tuple(c.place + FURTHER)) for c in there]
    part = hops().asked(MotionProblem(pins=tuple(each))).edited().analysis
    assert part is not hops().analysis
    for pin in each:
        assert chosen_contacts(pin, phase_of(pin, part.schedule), part.schedule)


def test_a_stance_that_is_turned_or_placed_as_one_is_in_the_part_as_one() -> None:
    """About the middle of all its contacts, which is another without the last of them."""
    whole = hops().analysis.schedule
    there = {c.name for c in whole.of_phase(next(p for p in whole.phases if p.name == "ground 5"))}
    for pin in (Pin("turned", "ground 5", turn=0.3), Pin("there", "ground 5", place=FURTHER)):
        part = hops().asked(MotionProblem(pins=(pin,))).edited().analysis.schedule
        assert there <= {contact.name for contact in part.contacts}


def test_what_is_mended_or_corrected_is_so_everywhere() -> None:
    for mended in (
        replace(pinned("ground 5"), contacts=(ContactEdit("Left toe 9", remove=True),)),
        replace(pinned("ground 5"), mend=(Mend.NOISE,)),
        replace(pinned("ground 5"), drift=(0.1, 0.0)),
    ):
        assert hops().asked(mended).edited().analysis is hops().analysis


def test_a_stance_that_is_too_short_to_carry_what_follows_is_solved_with_it() -> None:
    """The body bounces on."""
    bouncing = measure(load_recording("hops_in_place.bvh"), MotionProblem())
    assert bouncing.asked(pinned("ground 5")).edited().analysis is bouncing.analysis


def test_a_part_is_none_of_a_part() -> None:
    part = hops().asked(pinned("ground 5")).edited()
    assert part.edited().analysis is part.analysis


@pytest.mark.slow
def test_one_jump_in_a_long_take_is_that_jump_in_a_window_of_its_own() -> None:
    result = solve(hops().asked(pinned("ground 5")), StageClock())
    assert result.fault is None
    frames = result.subject.recording.frames
    window = replace(pinned("ground 2"), frames=(float(frames[0]), float(frames[-1])))
    own = solve(measure(load_recording(HOPS), window), StageClock())
    one, other = result.adaptation.motion, own.adaptation.motion
    assert one.duration == pytest.approx(other.duration, abs=0.02)
    times = np.linspace(0.0, min(one.duration, other.duration), 200)
    apart = np.linalg.norm(one.joint_centres(times) - other.joint_centres(times), axis=2)
    assert np.sqrt((apart**2).mean()) < AS_ITS_OWN
    assert result.moved is not None
    assert own.moved is not None
    assert result.moved.shift == pytest.approx(own.moved.shift, abs=1e-3)
    phases = result.adaptation.setup.schedule.phases
    assert [p.name for p in phases if p.kind is PhaseKind.FLIGHT] == ["flight 4"]
