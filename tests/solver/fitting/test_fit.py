"""The fit on real jumps: physics, contacts, nearness; and frames of reference do not matter."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.recordings import HOPS
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Bone, Recording
from hangtime.solver.data.status import Status
from hangtime.solver.fitting.fit import Fit, fit
from hangtime.solver.fitting.knot_refinement import on_finer_basis
from hangtime.solver.fitting.transcribe import transcribe
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import HOP, HOP_CLIP, fitted_hop, frames_of
from hangtime.tests.helpers.validity import assert_valid, joint_error

MIRROR = np.diag([-1.0, 1.0, 1.0])
OTHERS = {  # recording: seconds
    "forward_jump_116cm.bvh": None,
    "forward_jump_114cm.bvh": None,
    "high_jump.bvh": None,
    "run_1.bvh": None,
    "run_2.bvh": None,
    HOPS: (1.4, 3.0),
    "fair1_jumping.bvh": None,
}
MORE_HOPS = [(4.49, 5.99), (5.99, 7.69), (10.29, 11.79)]


def hop_recording() -> Recording:
    return load_recording(HOP_CLIP).window(*frames_of(HOP_CLIP, HOP))


def fit_of(recording: Recording, frames: tuple[float, float] | None = None) -> Fit:
    analysis = analyse(recording, MotionProblem(frames=frames))
    return fit(analysis.performance, analysis.schedule)


def moved(recording: Recording, turn: np.ndarray, shift: np.ndarray) -> Recording:
    """The recording as seen from elsewhere."""
    bones = tuple(
        replace(
            b,
            head=turn @ b.head + shift,
            tail=turn @ b.tail + shift,
            rotation=turn @ b.rotation,
        )
        for b in recording.bones
    )
    return replace(
        recording,
        bones=bones,
        heads=recording.heads @ turn.T + shift,
        rotations=turn @ recording.rotations,
    )


def mirrored(recording: Recording) -> Recording:
    """The recording in a mirror: left and right change places."""

    def bone(b: Bone) -> Bone:
        swapped = b.name.replace("Left", "*").replace("Right", "Left").replace("*", "Right")
        return Bone(
            swapped, b.parent, MIRROR @ b.head, MIRROR @ b.tail, MIRROR @ b.rotation @ MIRROR
        )

    return replace(
        recording,
        bones=tuple(bone(b) for b in recording.bones),
        heads=recording.heads @ MIRROR,
        rotations=MIRROR @ recording.rotations @ MIRROR,
    )


def centres(fitted: Fit) -> np.ndarray:
    return fitted.motion.joint_centres(np.linspace(0.0, fitted.motion.duration, 60))


def test_a_hop_is_fitted() -> None:
    fitted = fitted_hop()
    assert fitted.outcome.status is Status.SOLVED
    assert fitted.outcome.violation <= 1.0
    assert_valid(fitted.motion, fitted.schedule)
    assert joint_error(fitted) < 0.012
    performance = fitted.performance
    pelvis = fitted.motion.joint_centres(performance.times)[:, 0, 2]
    assert abs(pelvis.max() - performance.centres[:, 0, 2].max()) < 0.01


def test_the_recording_is_left_alone() -> None:
    recording = hop_recording()
    kept = recording.heads.copy(), recording.rotations.copy(), recording.times.copy()
    analysis = analyse(recording, MotionProblem())
    transcribe(analysis.performance, analysis.schedule)
    fitted_hop().motion.track(recording)
    assert (recording.heads == kept[0]).all()
    assert (recording.rotations == kept[1]).all()
    assert (recording.times == kept[2]).all()


def test_the_track_is_the_motion_on_the_recording_s_bones() -> None:
    fitted = fitted_hop()
    recording = fitted.performance.recording
    track = fitted.motion.track(recording)
    assert (track.frames == recording.frames).all()
    unity = np.broadcast_to(np.eye(3), track.rotations.shape)
    assert track.rotations @ np.swapaxes(track.rotations, -1, -2) == pytest.approx(unity, abs=1e-9)
    recorded = recording.rotations[:, [recording.index(b) for b in track.bones]]
    turned = np.einsum("tbij,tbij->tb", track.rotations, recorded)  # 1 + 2 cos of the angle between
    assert np.degrees(np.arccos(np.clip((turned - 1) / 2, -1, 1))).mean() < 6.0
    assert np.linalg.norm(track.root_head - recording.heads[:, 0], axis=1).max() < 0.05


def test_limbs_do_not_jerk() -> None:
    """Angular accelerations stay near those of the recording's own smooth spline."""
    fitted = fitted_hop()
    times = np.arange(0.05, fitted.motion.duration - 0.05, 1 / 120)
    bend = np.abs(np.diff(fitted.motion.joint_centres(times), 2, axis=0)).max() * 120**2
    recorded = fitted.performance.centres
    assert bend < 1.5 * np.abs(np.diff(recorded, 2, axis=0)).max() * 120**2


def test_a_finer_basis_holds_the_same_motion() -> None:
    motion = fitted_hop().motion
    basis = motion.transcription.basis
    finer = on_finer_basis(motion, np.arange(0, basis.n_spans, 3))
    times = np.linspace(0.0, motion.duration, 400)
    assert finer.angles(times) == pytest.approx(motion.angles(times), abs=1e-9)
    assert finer.com(times) == pytest.approx(motion.com(times), abs=1e-9)
    weight = motion.transcription.character.mass * 9.81
    assert finer.forces(times) == pytest.approx(motion.forces(times), abs=1e-3 * weight)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [37.0, 161.0])
def test_where_the_recording_lies_changes_nothing_else(degrees: float) -> None:
    turn, shift = axis_rotation(2, np.radians(degrees)), np.array([30.0, -7.0, 0.0])
    seen = fit_of(moved(load_recording(HOP_CLIP), turn, shift), frames_of(HOP_CLIP, HOP))
    assert seen.outcome.status is Status.SOLVED
    off = np.linalg.norm(centres(seen) - (centres(fitted_hop()) @ turn.T + shift), axis=-1)
    assert np.sqrt((off**2).mean()) < 0.001
    assert off.max() < 0.01  # refinement's thresholds may fall on other spans


@pytest.mark.slow
def test_a_mirrored_recording_gives_the_mirrored_fit() -> None:
    seen = fit_of(mirrored(hop_recording()))
    assert seen.outcome.status is Status.SOLVED
    names = [b.name for b in seen.performance.recording.bones]
    assert "LeftFoot" in names
    off = np.linalg.norm(centres(seen) - centres(fitted_hop()) @ MIRROR, axis=-1)
    assert np.sqrt((off**2).mean()) < 0.006  # joint axes, and so splines, are not mirrored
    assert off.max() < 0.045


@pytest.mark.slow
@pytest.mark.parametrize("relative", OTHERS)
def test_other_recordings_are_fitted(relative: str) -> None:
    seconds = OTHERS[relative]
    frames = None if seconds is None else frames_of(relative, seconds)
    fitted = fit_of(load_recording(relative), frames)
    assert fitted.outcome.status is Status.SOLVED
    assert_valid(fitted.motion, fitted.schedule)
    assert joint_error(fitted) < 0.017


@pytest.mark.slow
@pytest.mark.parametrize("seconds", MORE_HOPS)
def test_more_hops_are_fitted(seconds: tuple[float, float]) -> None:
    fitted = fit_of(load_recording(HOPS), frames_of(HOPS, seconds))
    assert fitted.outcome.status is Status.SOLVED
    assert_valid(fitted.motion, fitted.schedule)
    assert joint_error(fitted) < 0.017
