"""How fast joints go: limbs that whirl as nobody's do."""

import numpy as np

from ..transcription.motion import Motion

SAMPLING_RATE = 250.0  # Hz
# m/s: Olympic boxers' fists reach 9.1 with a deviation of 2.1 (Walilko, Viano and Bir, British
# Journal of Sports Medicine 39, 2005).
FAST = 10.0
FASTER = 1.5  # times the recording's fastest joint: who throws or sprints is fast already


def fastest_joint(motion: Motion) -> float:
    """The greatest speed of a joint centre seen from the centre of mass, m/s."""
    times = np.linspace(0.0, motion.duration, 2 + int(motion.duration * SAMPLING_RATE))
    steps = np.linalg.norm(np.diff(motion.pose(times).centres, axis=0), axis=2)
    return float(steps.max() / (times[1] - times[0]))


def whirls(motion: Motion, recorded: Motion) -> bool:
    """Whether a joint goes faster than a person's, and much faster than any of the recording's."""
    speed = fastest_joint(motion)
    return speed > FAST and speed > FASTER * fastest_joint(recorded)
