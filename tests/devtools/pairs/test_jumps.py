"""The jump's own frame, phases and measures, on the first hop of the ten."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hangtime.devtools.environment.problem import SetUpError
from hangtime.devtools.pairs import clips, main
from hangtime.devtools.pairs.jump_frame import jump_frame, landing_phase, longest_flight
from hangtime.devtools.pairs.jump_measures import jump_measures
from hangtime.devtools.pairs.phased_jump import PhasedJump, recorded_phases
from hangtime.devtools.pairs.solve import solver_options
from hangtime.solver.analysis.analyse import Analysis, analyse
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.solver_options import Method, ObjectiveKind
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import HOP_CLIP, fitted_hop


def phases_of(analysis: Analysis) -> PhasedJump:
    frame = jump_frame(analysis.performance, analysis.schedule)
    return recorded_phases(analysis.performance, longest_flight(analysis.schedule), frame)


def turned(recording: Recording, angle: float, by: tuple[float, float, float]) -> Recording:
    turn = axis_rotation(2, angle)
    heads = recording.heads @ turn.T + np.array(by)
    return replace(recording, heads=heads, rotations=turn @ recording.rotations)


def test_a_clip_turned_and_moved_is_the_same_jump() -> None:
    recording = load_recording(HOP_CLIP)
    one = phases_of(analyse(recording, MotionProblem()))
    other = phases_of(analyse(turned(recording, 2.0, (3.0, -1.0, 0.0)), MotionProblem()))
    assert max(one.distances(other).values()) < 0.02  # cm; the landing is found 20 µs later


def test_the_frame_starts_at_the_feet_and_looks_to_the_landing() -> None:
    analysis = analyse(load_recording(HOP_CLIP), MotionProblem())
    frame = jump_frame(analysis.performance, analysis.schedule)
    assert 0.6 < frame.landing[0] < 1.0
    assert frame.landing[1] == 0.0
    assert frame.of(frame.origin) == pytest.approx(np.zeros(3))
    further = replace(frame, landing=frame.landing + np.array([0.1, 0.0, 0.0]))
    assert frame.offset_to(further) == pytest.approx(0.1 * frame.axes[:, 0])
    flight = longest_flight(analysis.schedule)
    assert landing_phase(analysis.schedule, flight) == "ground 2"


def test_a_slid_jump_leaves_where_it_did_and_lands_with_the_offset() -> None:
    still = np.zeros((5, 2, 3))
    slid = PhasedJump(still, still, still).slid(np.array([0.2, 0.0, 0.0]))
    assert slid.crouch == pytest.approx(still)
    assert slid.flight[:, 0, 0] == pytest.approx([0.0, 0.05, 0.1, 0.15, 0.2])
    assert slid.distances(PhasedJump(still, still, still)) == pytest.approx(
        {"crouch": 0.0, "flight": 10.0, "landing": 20.0}
    )


def test_measures_of_a_fit_obey_the_law_of_falling() -> None:
    fitted = fitted_hop()
    frame = jump_frame(fitted.performance, fitted.schedule)
    flight = longest_flight(fitted.schedule)
    measures = jump_measures(fitted.motion, flight, frame, float(frame.landing[0]))
    start = frame.of(fitted.motion.com(np.array([flight.start])))[0, 2]
    rise = measures.take_off_speed**2 / (2.0 * STANDARD_GRAVITY)
    assert measures.apex_cm == pytest.approx(100.0 * (start + rise), abs=0.1)
    assert measures.flight_time_ms == pytest.approx(1000.0 * (flight.end - flight.start))
    travel = measures.forward_speed * (flight.end - flight.start)
    whole = measures.lean_cm + 100.0 * travel + measures.reach_cm
    assert whole == pytest.approx(100.0 * frame.landing[0], abs=0.1)
    assert 50.0 < measures.crouch_cm < 100.0
    assert 1.2 < measures.peak_push_bw < 4.0
    assert 0.0 < measures.arm_swing_deg < 180.0


# ---------------------------------------------------------------- what is set in pairs


def test_no_hops_window_reaches_another_hops_flight() -> None:
    windows = [jump.frames for jump in clips.hops()]
    flights = [tuple(1.0 + t * clips.RATE for t in flight) for flight in clips.HOP_FLIGHTS]
    for (before, own), (_, after) in zip(pairwise(flights), pairwise(windows), strict=True):
        assert before[1] < after[0] < own[0]
    for (_, after), (own, _) in zip(pairwise(flights), pairwise(windows), strict=True):
        assert own[1] < after[0]


def test_the_default_is_every_two_both_ways_and_fewer_keep_the_broad_jumps() -> None:
    every = clips.default_pairs()
    assert len(every) == len(set(every)) == 92
    some = clips.default_pairs(22)
    assert len(set(some)) == 22
    assert some[:2] == every[:2]
    assert len({source for source, _ in some[2:]}) == 10


def test_a_jump_is_given_as_a_clip_with_frames() -> None:
    assert clips.parse("a b/jump.bvh:10-200") == clips.Jump(
        "jump 10-200", "a b/jump.bvh", (10.0, 200.0)
    )
    with pytest.raises(SetUpError, match="CLIP:FIRST-LAST"):
        clips.parse("jump.bvh")


def test_solutions_are_methods_or_objectives() -> None:
    assert solver_options("implicit").method is Method.IMPLICIT
    both = solver_options("power+closeness")
    assert both.method is Method.EXPLICIT
    assert both.objectives == ((ObjectiveKind.POWER, 1.0), (ObjectiveKind.CLOSENESS, 1.0))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--solutions", "magic", "--pairs", "1"], "magic"),
        (["nowhere.bvh:1-99", "nothing.bvh:1-99"], "nowhere.bvh"),
        ([f"{HOP_CLIP}:1-150", f"{HOP_CLIP}:2-150"], "0.4 s"),
    ],
)
def test_wrong_input_ends_with_a_sentence(arguments, words, capsys, tmp_path) -> None:
    assert main.main([*arguments, "--out", str(tmp_path)]) == 2
    assert words in capsys.readouterr().err


@pytest.mark.slow
def test_two_real_jumps_are_compared(capsys, tmp_path) -> None:
    main.main(["--pairs", "1", "--out", str(tmp_path)])
    assert "broad 114cm → broad 116cm" in capsys.readouterr().out
    assert (tmp_path / "figures.json").is_file()
    assert len(list(tmp_path.glob("*.svg"))) == 1
