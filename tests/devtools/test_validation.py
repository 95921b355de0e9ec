"""The validation's measures on forces that are known, and the whole way on the trial held here."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hangtime.bridge.formats.motion_clip import to_z_up
from hangtime.devtools.filters import CUT_OFFS, differentiated, low_pass
from hangtime.devtools.recordings import HELD
from hangtime.devtools.validation.contacts import (
    EventKind,
    events,
    friction,
    measured_contacts,
    pressure,
)
from hangtime.devtools.validation.fitted import TO_TRIAL
from hangtime.devtools.validation.forces import (
    UP,
    largest_step,
    rms_errors,
    stances,
    total_variation,
)
from hangtime.devtools.validation.limits import (
    JERK,
    KNOWN_DEFECTS,
    KNOWN_MISSES,
    KNOWN_REFUSALS,
    LIMITS,
    MANY,
    OF_RECORDINGS,
    REFUSED,
    figure,
    figures,
)
from hangtime.devtools.validation.main import main, tell
from hangtime.devtools.validation.motions import (
    Closeness,
    HandJerk,
    Hold,
    LegTorques,
    MotionMeasures,
    hold,
    jerk,
    motion_measures,
)
from hangtime.devtools.validation.result import TrialResult
from hangtime.devtools.validation.table import page, tables
from hangtime.devtools.validation.trials import AXES, GroundForces, Trial, read
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.results.certificate import loaded_drifts
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.toy_problems import stood

RATE = 1000.0
TIMES = np.arange(2001) / RATE


def forces(left: np.ndarray, right: np.ndarray | None = None) -> GroundForces:
    """Vertical forces (T,) BW on the feet, pressed at the origin."""
    feet = np.zeros((len(TIMES), 2, 3))
    feet[:, 0, UP] = left
    if right is not None:
        feet[:, 1, UP] = right
    return GroundForces(TIMES, feet, np.zeros((len(TIMES), 2, 2)))


def trial(plates: GroundForces) -> Trial:
    """Somebody of 70 kg who stands still, whatever the plates say."""
    facts = {"subject_mass_kg": 70.0, "valid_window_s": [0.0, 2.0], "baseline_window_s": [0.1, 1.9]}
    return Trial("made", Path("made.bvh"), facts, plates, TIMES[::10], np.zeros((201, 3)))


def on_ground(start: float, end: float) -> np.ndarray:
    return np.where((start <= TIMES) & (end >= TIMES), 1.5, 0.0)


# ---------------------------------------------------------------- forces


def test_the_stored_baseline_of_the_held_trial_is_found_again() -> None:
    held_here = read(HELD, "BMC_run")
    errors = rms_errors(held_here, held_here.plates)
    assert [error.cut_off for error in errors] == list(CUT_OFFS)
    for error in errors:
        np.testing.assert_allclose(error.baseline, error.stored, atol=5e-4)
        np.testing.assert_allclose(error.ours, 0.0, atol=1e-9)


def test_a_known_error_is_its_rms() -> None:
    true, slow = np.ones(len(TIMES)), 0.2 * np.sin(2 * np.pi * TIMES / 0.9)
    too_fast = 0.3 * np.sin(2 * np.pi * 100.0 * TIMES)
    for error in rms_errors(trial(forces(true)), forces(true + slow, too_fast)):
        assert error.ours[UP] == pytest.approx(0.2 / np.sqrt(2.0), rel=0.03)
        assert error.ours_stance == error.ours
        assert error.baseline == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
        assert error.stored is None


def test_flights_are_left_out_of_the_stances() -> None:
    true = on_ground(0.4, 1.4)
    error = rms_errors(trial(forces(true)), forces(1.1 * true))[1]
    assert error.ours[UP] == pytest.approx(0.15 * np.sqrt(1.0 / 1.8), rel=0.05)
    assert error.ours_stance[UP] == pytest.approx(0.15, rel=0.05)


def test_the_filter_has_no_delay_and_halves_the_power_at_its_cut_off() -> None:
    wave = np.sin(2 * np.pi * 15.0 * TIMES)
    inside = slice(200, -200)
    np.testing.assert_allclose(low_pass(wave, RATE, 15.0)[inside], 0.5 * wave[inside], atol=0.01)


def test_differentiation_gives_the_weight_at_rest_and_nothing_in_free_fall() -> None:
    still, fall = np.zeros((201, 3)), np.zeros((201, 3))
    fall[:, UP] = -0.5 * STANDARD_GRAVITY * TIMES[::10] ** 2
    np.testing.assert_allclose(differentiated(still, 100.0)[:, UP], 1.0)
    np.testing.assert_allclose(differentiated(fall, 100.0)[2:-2], 0.0, atol=1e-9)


def test_a_step_is_found_a_slope_is_none_and_a_landing_explains_one() -> None:
    ramp = np.clip((TIMES - 0.5) / 0.02, 0.0, 2.0)  # 50 BW/s, as steep as people land
    jumping = forces(ramp + 0.4 * (TIMES >= 1.2) + 3.0 * (TIMES >= 1.5))
    step = largest_step(jumping, (0.1, 1.9), [1.5])
    assert step.jump == pytest.approx(0.4)
    assert step.jump_at == pytest.approx(1.2, abs=0.003)
    smooth = largest_step(forces(ramp), (0.1, 1.9), [])
    assert smooth.jump == pytest.approx(0.05, abs=1e-6)  # at the ramp's corners
    assert smooth.change == pytest.approx(0.1)


def test_total_variation_is_twice_the_peak_of_one_stance() -> None:
    assert total_variation(forces(on_ground(0.5, 1.0)), (0.1, 1.9)) == pytest.approx(3.0)


def test_a_stance_is_compared_by_peak_impulse_and_loading_rate() -> None:
    pulse = np.where(np.abs(TIMES - 1.0) < 0.2, np.cos(np.pi * (TIMES - 1.0) / 0.4), 0.0)
    late = np.interp(TIMES - 0.02, TIMES, pulse)
    (stance,) = stances(trial(forces(2.0 * pulse)), forces(2.2 * late))
    assert stance.peak[0] / stance.peak[1] == pytest.approx(1.1, rel=1e-3)
    assert stance.peak_time[0] - stance.peak_time[1] == pytest.approx(0.02, abs=1e-3)
    assert stance.impulse[1] == pytest.approx(2.0 * 0.8 / np.pi, rel=1e-3)
    assert stance.loading_rate[0] / stance.loading_rate[1] == pytest.approx(1.1, rel=1e-3)


# ---------------------------------------------------------------- contacts


def test_events_tell_how_late_the_contacts_found_are() -> None:
    plates, ours = forces(on_ground(0.5, 1.0)), forces(on_ground(0.52, 0.995))
    down, up = events(trial(plates), ours, [[(0.51, 1.003)], []])
    assert (down.foot, down.kind, up.kind) == ("Left", EventKind.TOUCH_DOWN, EventKind.LIFT_OFF)
    assert down.late_ms == pytest.approx(10.0, abs=1.5)
    assert down.force_late_ms == pytest.approx(20.0, abs=1.5)
    assert up.late_ms == pytest.approx(3.0, abs=1.5)
    assert up.force_late_ms == pytest.approx(-5.0, abs=1.5)


@pytest.mark.parametrize("found", [[], [(0.0, 2.0)]])
def test_a_contact_that_is_missed_or_cut_off_has_no_events(found: list) -> None:
    told = events(trial(forces(on_ground(0.5, 1.0))), forces(0.0 * TIMES), [found, []])
    assert [event.late_ms for event in told] == [None, None]


def test_slow_plates_tell_a_touch_down_between_their_samples() -> None:
    times = np.arange(100) / 100.0
    force = np.clip(20.0 * (times - 0.204), 0.0, 2.0) * (times < 0.6)
    (contact,) = measured_contacts(times, force)
    assert contact[0] == pytest.approx(0.204)


def test_pressure_is_weighted_by_force() -> None:
    plates = forces(np.where(TIMES < 1.0, 3.0, 1.0))
    moved = np.zeros((len(TIMES), 2, 2))
    moved[TIMES < 1.0, :, 0] = 0.04
    apart = pressure(trial(plates), replace(plates, pressure=moved))
    assert apart is not None
    assert apart.forward_cm == pytest.approx(3.0, rel=0.01)
    assert apart.distance_cm == pytest.approx(3.0, rel=0.01)
    assert apart.left_cm == 0.0


def test_friction_leaves_out_feet_that_hardly_carry() -> None:
    pushing = forces(np.where(TIMES < 1.0, 1.0, 0.05))
    pushing.feet[:, 0, 0] = 0.3
    assert friction(trial(pushing), pushing).largest == pytest.approx(0.3)


def test_both_sides_use_the_same_axes() -> None:
    in_file = np.array([1.0, 2.0, 3.0])
    in_blender = to_z_up("Y") @ in_file
    np.testing.assert_allclose(TO_TRIAL @ in_blender, in_file[AXES])


# ---------------------------------------------------------------- motions


def test_the_jerk_of_a_cubic() -> None:
    track = np.zeros((100, 1, 3))
    track[:, 0, 1] = (np.arange(100) / 50.0) ** 3
    assert jerk(track, 50.0, np.ones(97, dtype=bool)) == pytest.approx(6.0)


def test_the_standing_figure_holds_its_places() -> None:
    told = hold(stood())
    assert told.slide_mm < 5.0
    drifts = loaded_drifts(stood())
    assert told.above_mm == pytest.approx(1e3 * max(d.height.max() for d in drifts))


def test_the_knee_of_a_landing_is_no_more_than_that_of_the_whole() -> None:
    told = motion_measures(fitted_hop())
    assert told.landing_knee is not None
    assert 0.0 < told.landing_knee <= told.torques_per_kg.knee


def test_where_nothing_lands_there_is_no_landing_knee() -> None:
    nowhere = replace(fitted_hop(), schedule=replace(fitted_hop().schedule, contacts=()))
    told = motion_measures(nowhere)
    assert (told.landing_knee, told.hand_jerk) == (None, None)


# ---------------------------------------------------------------- limits


def moved(**measures: object) -> MotionMeasures:
    """A motion without a fault but those given."""
    good = MotionMeasures(
        Closeness(1.0, 1.0, 1.0), None, Hold(0.1, 0.1, 5.0), LegTorques(3.0, 3.0, 3.0), 3.0
    )
    return replace(good, **measures)


def code_of(*results: TrialResult, out: Path) -> int:
    return tell(results, out, write_page=False)


def test_limits_that_hold_end_with_0_and_one_that_is_missed_with_1(tmp_path: Path) -> None:
    good, bad = (
        TrialResult("jump", moved()),
        TrialResult("jump", moved(hold=Hold(9.0, 0.1, 5.0))),
    )
    assert code_of(good, out=tmp_path) == 0
    assert code_of(bad, out=tmp_path) == 1
    (miss,) = [f for f in figures([bad]) if not f.ok]
    assert (miss.name, miss.trial, miss.known) == ("recordings: loaded point: slide", "jump", False)


def test_a_known_miss_is_let_through_until_it_gets_worse(tmp_path: Path) -> None:
    name = OF_RECORDINGS + JERK
    must, known = LIMITS[name].must, KNOWN_MISSES[name]
    assert must is not None
    for worst, code in ((0.5 * (must + known), 0), (1.01 * known, 1)):
        result = TrialResult("jump", moved(hand_jerk=HandJerk(worst, 1.0)))
        assert code_of(result, out=tmp_path) == code
        (miss,) = [f for f in figures([result]) if not f.ok]
        assert (miss.name, miss.known) == (name, code == 0)


def test_every_known_miss_is_of_a_must_that_is_lower() -> None:
    for name, value in KNOWN_MISSES.items():
        must = LIMITS[name].must
        assert must is not None
        assert value > must


def test_a_known_defect_is_in_no_figure_but_on_the_page(tmp_path: Path) -> None:
    name = next(iter(KNOWN_DEFECTS))
    bad = TrialResult(name, moved(hold=Hold(30.0, 0.1, 5.0)))
    assert code_of(bad, out=tmp_path) == 0
    (only,) = figures([bad])
    assert only.name == REFUSED
    text = page(tables([bad], [only]))
    assert f"Not in these figures: {name}" in text
    assert f"| {name} | 1.00 |" in text


def test_means_of_few_trials_are_told_and_judged_of_many() -> None:
    assert figure("vertical rms at 15 Hz, mean", 0.2, "", 1).ok
    assert not figure("vertical rms at 15 Hz, mean", 0.2, "", MANY).ok


def test_the_treadmill_may_be_refused_but_may_not_crash_and_nothing_else_may(
    tmp_path: Path,
) -> None:
    (treadmill,) = KNOWN_REFUSALS
    assert code_of(TrialResult(treadmill, refused="The feet slide."), out=tmp_path) == 0
    assert code_of(TrialResult(treadmill, refused="Killed.", crashed=True), out=tmp_path) == 1
    assert code_of(TrialResult("jump", refused="The feet slide."), out=tmp_path) == 1


# ---------------------------------------------------------------- the whole


def test_a_refused_trial_is_a_row_and_a_miss() -> None:
    refused = [TrialResult("walk", kind="walk", refused="No flight was found.")]
    (only,) = figures(refused)
    assert (only.name, only.value, only.ok, only.known) == (REFUSED, 1, False, False)
    parts = tables(refused, [only])
    assert ("walk", "No flight was found.") in parts[-1].rows
    assert "| walk | No flight was found. |" in page(parts)


def test_a_name_that_is_not_there_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--only", "none", "--out", str(tmp_path)]) == 2
    assert "BMC_run" in capsys.readouterr().out
    assert main([str(tmp_path), "--out", str(tmp_path)]) == 2


def test_only_constants_that_there_are_can_be_varied(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for change in ("PI=3", "SOLE_COMPLIANCE=soft"):
        assert main(["--out", str(tmp_path), "--vary", change]) == 2
        assert change.partition("=")[0] in capsys.readouterr().out
    assert main(["--out", str(tmp_path), "--page", "--vary", "friction=0"]) == 2


@pytest.mark.slow
def test_a_varied_constant_changes_the_fit(tmp_path: Path) -> None:
    above = []
    for vary in ([], ["--vary", "SOLE_COMPLIANCE=0.004"]):
        main(["--only", "BMC_run", "--no-curves", "--out", str(tmp_path), *vary])
        content = json.loads((tmp_path / "figures.json").read_text(encoding="utf-8"))
        above.append(content["trials"][0]["motion"]["hold"]["above_mm"])
    assert above[1] < 4.5 < above[0]


@pytest.mark.slow
def test_the_held_trial_goes_all_the_way(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--only", "BMC_run", "--out", str(tmp_path)]) == 0
    assert "BMC_run" in capsys.readouterr().out
    content = json.loads((tmp_path / "figures.json").read_text(encoding="utf-8"))
    assert len(content["figures"]) > 15
    (told,) = content["trials"]
    assert told["refused"] is None
    assert 0.0 < told["measured"]["errors"][1]["ours"][UP] < 0.5
    assert (tmp_path / "BMC_run.svg").read_text(encoding="utf-8").endswith("</svg>\n")
    assert not list(tmp_path.glob("*.pickle"))
