"""What a solved motion is judged by."""

from dataclasses import dataclass

import numpy as np
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.contacts import ContactSchedule
from hangtime.solver.fitting.fit import Fit
from hangtime.solver.transcription.motion import Motion, dynamics_residual, pinned_instants

RATE = 480.0  # Hz, finer than the nodes


@dataclass(frozen=True)
class Measures:
    """Root force (BW) and moment (BW·m) unexplained, rms, the moment in flight and on the ground;
    worst drift of a pinned point, m; vertical force: least of any point, most of all, BW."""

    force: float
    flight_moment: float
    ground_moment: float
    drift: float
    pull: float
    peak: float


def measure(motion: Motion, schedule: ContactSchedule) -> Measures:
    times = np.arange(0.0, motion.duration, 1.0 / RATE)
    left = dynamics_residual(motion, times)
    flying = np.any([(times > f.start) & (times < f.end) for f in schedule.flights], axis=0)
    contacts = motion.transcription.contacts
    drifts = [motion.drift(i, pinned_instants(c, RATE)).max() for i, c in enumerate(contacts)]
    vertical = motion.forces(times)[..., 2] / (
        motion.transcription.character.mass * STANDARD_GRAVITY
    )
    return Measures(
        force=_rms(left.force),
        flight_moment=_rms(left.moment[flying]),
        ground_moment=_rms(left.moment[~flying]),
        drift=float(max(drifts)),
        pull=float(vertical.min()),
        peak=float(vertical.sum(axis=1).max()),
    )


def assert_valid(motion: Motion, schedule: ContactSchedule) -> None:
    """The issue's figures, by the solver's own functions."""
    found = measure(motion, schedule)
    assert found.force < 1e-4
    assert found.flight_moment < 0.001
    assert found.ground_moment < 0.005
    assert found.drift < 0.001
    assert found.pull > -0.02
    assert found.peak < 12.0


def joint_error(fitted: Fit) -> float:
    """Joint centres against the recording, rms over joints and frames, m."""
    performance = fitted.performance
    off = fitted.motion.joint_centres(performance.times) - performance.centres
    return _rms(off.reshape(-1, 3))


def _rms(vectors: np.ndarray) -> float:
    return float(np.sqrt((vectors**2).sum(axis=1).mean()))
