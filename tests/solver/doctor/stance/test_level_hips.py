"""Hips whose height was left out, and how it is given back."""

import numpy as np
import pytest
from hangtime.devtools.doctor.combined import both
from hangtime.devtools.doctor.damages.poses import noisy
from hangtime.devtools.doctor.damages.whole_body import in_place, joined, levelled, raised
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.anatomy import Part
from hangtime.solver.data.constants import STANDARD_GRAVITY, UP
from hangtime.solver.data.problem import Mend, MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.scaling import scaled_recording
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.repair import as_asked, repaired
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.doctor.stance.arcs import UNDER, with_arcs
from hangtime.solver.doctor.stance.level_hips import find_level_hips
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.doctored import figure, jump
from hypothesis import given, settings
from hypothesis import strategies as st

RATE = 120.0
HEIGHT = Repairs(mend=(Mend.LEVEL_HIPS,))


def vertical_jump(speed: float) -> tuple[FloatArray, FloatArray]:
    """How far legs hold the centre of mass up, (T,) m, and its height in truth: a push of 0.3 m up
    to a speed, m/s, a flight with straight legs, the same backwards, and rest on both sides."""
    push, flight = 0.6 / speed, 2.0 * speed / STANDARD_GRAVITY
    times = np.arange(0.0, 1.0 + 2.0 * push + flight, 1.0 / RATE) - 0.5
    after = 2.0 * push + flight - times  # the same in time that goes back
    since = np.clip(np.minimum(times, after), 0.0, push)
    above = 0.7 + 0.5 * speed / push * since**2
    flown = np.clip(times - push, 0.0, flight)
    return above, above + speed * flown - 0.5 * STANDARD_GRAVITY * flown**2


def bent(recording: Recording, original: Recording) -> float:
    """M, rms, of all joints, each clip at its mean height: the floor of one may be a sole off."""
    off = recording.heads - original.heads
    return float(np.sqrt(np.mean(((off - off[..., 2].mean() * UP) ** 2).sum(axis=2))))


@settings(max_examples=25)
@given(st.floats(1.0, 4.0))
def test_who_pushes_off_flies_as_high_as_the_speed_carries(speed: float) -> None:
    above, truth = vertical_jump(speed)
    assert with_arcs(above, RATE) == pytest.approx(truth, abs=0.02 * speed)


@settings(max_examples=25)
@given(st.integers(0, 1000))
def test_nobody_is_lower_than_the_legs_allow_or_falls_faster_than_gravity(seed: int) -> None:
    """Within a flight; where legs would have to pull it is one."""
    rng = np.random.default_rng(seed)
    above = 0.9 + 0.05 * np.cumsum(rng.normal(size=40)).repeat(6) / 6.0
    heights = with_arcs(above, RATE)
    assert (heights > above - UNDER).all()
    flies = np.abs(heights - above) > UNDER
    inner = flies[1:-1] & flies[2:] & flies[:-2]
    bent = (heights[2:] - 2.0 * heights[1:-1] + heights[:-2]) * RATE**2
    assert bent[inner] == pytest.approx(-STANDARD_GRAVITY)


@pytest.mark.parametrize("height", [0.0, 0.8])
def test_who_stands_or_bends_the_knees_stays_on_the_ground(height: float) -> None:
    above = height + 0.1 * np.cos(np.linspace(0.0, 12.0, 300))
    assert with_arcs(above, RATE) == pytest.approx(above)


@pytest.mark.parametrize(
    ("name", "left"),
    [
        (JUMP, 0.1),
        pytest.param("hops_in_place.bvh", 0.25, marks=pytest.mark.slow),
        pytest.param("run_2.bvh", 0.65, marks=pytest.mark.slow),
    ],
)
def test_hips_whose_height_was_left_out_get_it_back(name: str, left: float) -> None:
    """A run's short flights tell less of it."""
    original = load_recording(name)
    damaged = levelled().of(original).recording
    found = diagnose(damaged)
    assert [finding.kind for finding in found.findings] == [FindingKind.LEVEL_HIPS]
    given_back = repaired(damaged, found.repairs)
    assert bent(given_back, original) < left * bent(damaged, original)
    assert [f for f in diagnose(given_back).findings if not f.kind.note] == []


@pytest.mark.parametrize(
    "name",
    [
        JUMP,
        pytest.param("131_03_hop.bvh", marks=pytest.mark.slow),
        pytest.param("run_2.bvh", marks=pytest.mark.slow),
    ],
)
def test_capture_that_tells_all_from_the_hips_gets_height_and_way_back(name: str) -> None:
    original = load_recording(name)
    damaged = both(levelled(), in_place()).of(original).recording
    found = diagnose(damaged)
    kinds = [finding.kind for finding in found.findings if not finding.kind.note]
    assert kinds == [FindingKind.LEVEL_HIPS, FindingKind.IN_PLACE]
    assert apart(repaired(damaged, found.repairs), original) < 0.2 * apart(damaged, original)


def test_the_speed_at_which_feet_leave_is_told_before_what_trembles_is_smoothed() -> None:
    """Smoothed first, the hop was 6 cm off."""
    damaged = both(noisy(3.0, 1.0), levelled()).of(load_recording("hop_01_01.bvh"))
    found = diagnose(damaged.recording)
    assert FindingKind.NOISE in {finding.kind for finding in found.findings}
    mended = repaired(damaged.recording, found.repairs)
    assert bent(mended, damaged.original) < 0.025


@pytest.mark.parametrize("phase", range(5))
def test_at_24_frames_a_second_a_jump_is_found_wherever_its_frames_fall(phase: int) -> None:
    """By lines the speeds of a push were 0.6 m/s off, and two arcs were taken for its flight."""
    original = load_recording(JUMP).part(slice(phase, None, 5))
    mended = repaired(levelled().of(original).recording, HEIGHT)
    assert bent(mended, original) < 0.02


@pytest.mark.parametrize("backwards", [False, True])
def test_who_is_in_the_air_at_an_end_of_the_clip_flies_there(*, backwards: bool) -> None:
    above, truth = vertical_jump(2.5)
    half = slice(0, len(above) // 2)
    turn = slice(None, None, -1) if backwards else slice(None)
    assert with_arcs(above[half][turn], RATE)[turn] == pytest.approx(truth[half], abs=0.08)


def test_a_sound_recording_stays_as_it_is() -> None:
    assert repaired(jump(), HEIGHT).heads == pytest.approx(jump().heads)


@pytest.mark.parametrize("metres", [-0.9, 0.4])
def test_the_floor_is_told_where_it_is(metres: float) -> None:
    """Capture that tells all from the hips has it below 0."""
    damaged = raised(metres).of(levelled().of(jump()).recording).recording
    found = diagnose(damaged)
    assert [each.kind for each in found.findings] == [FindingKind.LEVEL_HIPS, FindingKind.FLOOR]
    assert found.findings[-1].amount == pytest.approx(metres, abs=0.02)
    assert apart(repaired(damaged, found.repairs), jump()) < 0.02


def test_a_stated_height_tells_how_fast_the_figure_falls() -> None:
    small = scaled_recording(jump(), 0.7)
    asked = MotionProblem(mend=HEIGHT.mend, height=1.75)
    mended = as_asked(levelled().of(small).recording, asked)
    assert bent(mended, small) < 0.01


def test_two_takes_whose_hips_are_level_are_parted_too() -> None:
    found = diagnose(joined(0.4).of(levelled().of(jump()).recording).recording)
    assert {FindingKind.JUMP, FindingKind.LEVEL_HIPS} <= {each.kind for each in found.findings}
    assert found.repairs.trims


def test_a_size_and_a_mass_that_nobody_has_are_told_beside_it() -> None:
    damaged = scaled_recording(levelled().of(jump()).recording, 100.0)
    found = diagnose(damaged, mass=700.0)
    kinds = [finding.kind for finding in found.findings]
    assert kinds == [FindingKind.LEVEL_HIPS, FindingKind.SIZE, FindingKind.MASS]
    assert found.mass == pytest.approx(65.0, rel=0.2)
    assert apart(repaired(damaged, found.repairs), jump()) < 0.02


def test_who_sits_may_keep_the_hips_level() -> None:
    seated = levelled().of(jump()).recording
    assert find_level_hips(seated, figure()) is not None
    seated.heads[:, figure().of(Part.FOOT), 2] += 0.4
    assert find_level_hips(seated, figure()) is None
