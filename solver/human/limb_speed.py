"""How fast joints go: faster than a person's, where limbs are thrown about."""

from dataclasses import dataclass

import numpy as np

from ..transcription.motion import Motion

SAMPLING_RATE = 250.0  # Hz
# m/s: Olympic boxers' fists reach 9.1 with a deviation of 2.1 (Walilko, Viano and Bir, British
# Journal of Sports Medicine 39, 2005).
FAST = 10.0
FASTER = 1.5  # times the recording's fastest joint: who throws or sprints is fast already


@dataclass(frozen=True)
class JointSpeed:
    """Speed of a body's joint centre seen from the centre of mass, m/s."""

    body: int
    speed: float


def fastest_joint(motion: Motion) -> JointSpeed:
    """The fastest joint of a motion, when it is fastest."""
    times = np.linspace(0.0, motion.duration, 2 + int(motion.duration * SAMPLING_RATE))
    steps = np.linalg.norm(np.diff(motion.pose(times).centres, axis=0), axis=2).max(axis=0)
    body = int(steps.argmax())
    return JointSpeed(body, float(steps[body] / (times[1] - times[0])))


def too_fast(motion: Motion, recorded: Motion) -> JointSpeed | None:
    """The fastest joint, where it goes faster than a person's and much faster than any of the
    recording's."""
    fastest = fastest_joint(motion)
    limit = max(FAST, FASTER * fastest_joint(recorded).speed)
    return fastest if fastest.speed > limit else None
