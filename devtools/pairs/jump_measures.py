"""What a performer changes from one jump to another, as numbers of a solved motion."""

from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.body.anatomy import Part
from ...solver.data.constants import STANDARD_GRAVITY, UP
from ...solver.data.contacts import Phase
from ...solver.transcription.motion import Motion
from ..filters import low_pass
from .jump_frame import JumpFrame

RATE = 480.0  # Hz
PUSH = 0.5  # s before take-off in which crouch and push lie
CUT_OFF = 15.0  # Hz


@dataclass(frozen=True)
class JumpMeasures:
    """Measures of one jump.

    crouch_cm: lowest pelvis before take-off, above the floor. take_off_speed, forward_speed: m/s
    of the centre of mass at take-off. lean_cm, reach_cm: how far it is before the feet's place at
    take-off, and behind theirs at landing. apex_cm: its highest place above the floor.
    arm_swing_deg: range of the upper arms' flexion against the trunk from `PUSH` before take-off to
    landing. push_time_ms: from the lowest pelvis to take-off. peak_push_bw: largest
    vertical force before take-off.
    """

    crouch_cm: float
    take_off_speed: float
    forward_speed: float
    lean_cm: float
    reach_cm: float
    apex_cm: float
    flight_time_ms: float
    arm_swing_deg: float
    push_time_ms: float
    peak_push_bw: float


def jump_measures(motion: Motion, flight: Phase, frame: JumpFrame, distance: float) -> JumpMeasures:
    """Measures of a solved motion's jump. flight: in its own time. distance: m, of the feet."""
    before = _instants(max(0.0, flight.start - PUSH), flight.start)
    during = _instants(flight.start, flight.end)
    pelvis = frame.of(motion.joint_centres(before)[:, 0])[:, 2]
    lowest = before[pelvis.argmin()]
    ahead = frame.of(motion.com(np.array([flight.start, flight.end])))[:, 0]
    speed = motion.com(np.array([flight.start]), 1)[0] @ frame.axes
    return JumpMeasures(
        crouch_cm=100.0 * float(pelvis.min()),
        take_off_speed=float(speed[2]),
        forward_speed=float(speed[0]),
        lean_cm=100.0 * float(ahead[0]),
        reach_cm=100.0 * (distance - float(ahead[1])),
        apex_cm=100.0 * float(frame.of(motion.com(during))[:, 2].max()),
        flight_time_ms=1000.0 * (flight.end - flight.start),
        arm_swing_deg=arm_swing(motion, _instants(float(before[0]), flight.end), frame.axes[:, 0]),
        push_time_ms=1000.0 * float(flight.start - lowest),
        peak_push_bw=peak_push(motion, flight.start),
    )


def arm_swing(motion: Motion, times: FloatArray, ahead: FloatArray) -> float:
    """Range, degrees, of the upper arms' flexion against the trunk in the plane of the jump.

    ahead: (3,) the jump's forward, world. The trunk points from the pelvis to between the
    shoulders; flexion is the mean of both arms'.
    """
    pose, bodies = motion.pose(times), motion.transcription.character.bodies
    arms = [i for i, body in enumerate(bodies) if body.part is Part.UPPER_ARM]
    trunk = pose.centres[:, arms].mean(axis=1) - pose.centres[:, 0]
    lean = np.arctan2(trunk @ ahead, trunk @ UP)
    along = [pose.rotations[:, i] @ bodies[i].tip for i in arms]
    forward = np.mean([np.unwrap(np.arctan2(x @ ahead, -x @ UP)) for x in along], axis=0)
    return float(np.degrees(np.ptp(forward + lean)))


def peak_push(motion: Motion, take_off: float) -> float:
    """Largest vertical force of all contacts in the push, body weights, low-passed."""
    times = _instants(0.0, motion.duration)
    weight = motion.transcription.character.mass * STANDARD_GRAVITY
    vertical = motion.forces(times).sum(axis=1)[:, 2] / weight
    smooth = low_pass(vertical, RATE, CUT_OFF)
    return float(smooth[(times >= take_off - PUSH) & (times <= take_off)].max())


def _instants(start: float, end: float) -> FloatArray:
    return np.linspace(start, end, 2 + int((end - start) * RATE))
