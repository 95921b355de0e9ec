"""The fit's motion beside the recording: closeness, hands, loaded points and joint torques."""

from dataclasses import dataclass

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.body.anatomy import Part
from ...solver.fitting.fit import Fit
from ...solver.results.certificate import loaded_drifts
from ...solver.transcription.motion import Motion, motion_inverse_dynamics
from ...solver.worker.pipeline import dynamics_of
from .causes.landings import RecordedLanding, recorded_landings

RATE = 1000.0  # Hz
END_FRAMES = 10
AROUND_LANDING = 0.1  # s, on both sides of a touch-down
LEG_PARTS = (Part.THIGH, Part.SHANK, Part.FOOT)  # below hip, knee and ankle
LANDING = 0.3  # s after a touch-down, in which the legs give and hold


@dataclass(frozen=True)
class Closeness:
    """Joint centres of the fit against the recording, rms, cm: all frames, first and last ten."""

    whole_cm: float
    first_cm: float
    last_cm: float


def closeness(fit: Fit) -> Closeness:
    """At the recording's frames."""
    performance = fit.performance
    apart = fit.motion.joint_centres(performance.times) - performance.centres
    parts = apart, apart[:END_FRAMES], apart[-END_FRAMES:]
    return Closeness(*(100.0 * _rms(part) for part in parts))


@dataclass(frozen=True)
class HandJerk:
    """Rms jerk of both wrists within 0.1 s of the whole body's landings, m/s³."""

    fit: float
    recording: float

    @property
    def ratio(self) -> float:
        """Fit over recording."""
        return self.fit / self.recording


def hand_jerk(fit: Fit) -> HandJerk | None:
    """By third differences of the frames, of both alike; None where nothing lands."""
    performance, character = fit.performance, fit.performance.character
    hands = [i for i, body in enumerate(character.bodies) if body.part is Part.HAND]
    middles = performance.times[1:-2] + 0.5 / performance.recording.rate
    near = np.zeros(len(middles), dtype=np.bool_)
    for landing in landings(fit):
        near |= np.abs(middles - landing) <= AROUND_LANDING
    if not hands or not near.any():
        return None
    centres = fit.motion.joint_centres(performance.times)
    return HandJerk(
        *(
            jerk(tracks[:, hands], performance.recording.rate, near)
            for tracks in (centres, performance.centres)
        )
    )


def jerk(tracks: FloatArray, rate: float, counted: BoolArray) -> float:
    """Rms third difference of tracks (T, P, 3) m at `rate` Hz, m/s³. counted: (T - 3,)."""
    return _rms(np.diff(tracks, 3, axis=0)[counted] * rate**3)


@dataclass(frozen=True)
class Hold:
    """Worst of any loaded point: slide from its place, depth under and height above it, mm."""

    slide_mm: float
    under_mm: float
    above_mm: float


def hold(motion: Motion) -> Hold:
    """Of all contacts, each over the whole of it, as the certificate has it."""
    drifts = loaded_drifts(motion)
    slides, heights = [d.slide for d in drifts], [d.height for d in drifts]
    sizes = slides, [-height for height in heights], heights
    return Hold(*(1e3 * max((float(x.max(initial=0.0)) for x in s), default=0.0) for s in sizes))


@dataclass(frozen=True)
class LegTorques:
    """Largest torque about any axis of either leg's joints, N·m per kg of the body."""

    hip: float
    knee: float
    ankle: float


def leg_torques(motion: Motion, times: FloatArray) -> LegTorques:
    """At instants (T,) s, by inverse dynamics."""
    torques = np.abs(motion_inverse_dynamics(dynamics_of(motion), motion, times).torques)
    character = motion.transcription.character
    peaks = dict.fromkeys(LEG_PARTS, 0.0)
    for body, joint in zip(character.bodies[1:], character.joints[1:], strict=True):
        if body.part in peaks:
            of_joint = torques[:, joint.first - 3 : joint.dofs.stop - 3].max() / character.mass
            peaks[body.part] = max(peaks[body.part], float(of_joint))
    return LegTorques(*(peaks[part] for part in LEG_PARTS))


@dataclass(frozen=True)
class MotionMeasures:
    """What is told of a fit's motion. landing_knee: N·m/kg, within 0.3 s after the body lands.

    recorded_landings: of the feet, before the fit.
    """

    closeness: Closeness
    hand_jerk: HandJerk | None
    hold: Hold
    torques_per_kg: LegTorques
    landing_knee: float | None
    recorded_landings: tuple[RecordedLanding, ...] = ()


def motion_measures(fit: Fit) -> MotionMeasures:
    """All of them."""
    times = (np.arange(int(fit.motion.duration * RATE)) + 0.5) / RATE
    landing = np.zeros(len(times), dtype=np.bool_)
    for instant in landings(fit):
        landing |= (times > instant) & (times < instant + LANDING)
    return MotionMeasures(
        closeness(fit),
        hand_jerk(fit),
        hold(fit.motion),
        leg_torques(fit.motion, times),
        leg_torques(fit.motion, times[landing]).knee if landing.any() else None,
        recorded_landings(fit),
    )


def landings(fit: Fit) -> list[float]:
    """Instants, s, at which the whole body lands."""
    return [f.end for f in fit.schedule.flights if f.end < fit.schedule.duration]


def _rms(vectors: FloatArray) -> float:
    """Root mean square length of (..., 3)."""
    return float(np.sqrt((vectors**2).sum(axis=-1).mean()))
