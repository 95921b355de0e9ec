"""How well a solved cycle's end meets its start."""

import numpy as np

from ..arrays import FloatArray
from ..body.kinematics import BodyPoint
from ..data.constants import STANDARD_GRAVITY
from ..data.loop import LEAST_TRAVEL, Cycle
from ..data.reports.loop import LoopReport
from ..transcription.motion import Motion


def loop_report(motion: Motion, cycle: Cycle, recorded: FloatArray) -> LoopReport:
    """Of the motion itself, whatever is written of it. cycle: the frames that it is of. recorded:
    (T, 3) m, the recording's centre of mass in them."""
    ends = np.array([0.0, motion.duration])
    com = motion.com(ends)
    travel = (com[1] - com[0]) * [1.0, 1.0, 0.0]
    centres = motion.joint_centres(ends)
    apart = np.linalg.norm(centres[1] - travel - centres[0], axis=1)
    posed, rates = motion.pose(ends), motion.angles(ends, 1)
    points = tuple(BodyPoint(i, body.tip) for i, body in enumerate(posed.character.bodies))
    velocities = posed.point_rates(points, rates) + motion.com(ends, 1)[:, None]
    forces = motion.forces(ends) / (motion.transcription.character.mass * STANDARD_GRAVITY)
    length = float(np.linalg.norm(travel))
    return LoopReport(
        *cycle.frames,
        *cycle.asked,
        travel_m=length,
        speed_m_s=length / motion.duration,
        seam_pose_mm=1000.0 * float(apart.max()),
        seam_velocity_mm_s=1000.0 * _furthest(velocities),
        seam_force_bw=_furthest(forces),
        turned_deg=_turned(recorded[-1] - recorded[0], travel),
    )


def _turned(recorded: FloatArray, travel: FloatArray) -> float:
    """Degrees between the level directions of two ways (3,), m."""
    (x, y), (u, v) = recorded[:2], travel[:2]
    if min(np.hypot(x, y), np.hypot(u, v)) < LEAST_TRAVEL:
        return 0.0
    return float(np.degrees(np.arctan2(x * v - y * u, x * u + y * v)))


def _furthest(ends: FloatArray) -> float:
    """Largest difference between the two ends' vectors (2, n, 3)."""
    return float(np.linalg.norm(ends[1] - ends[0], axis=1).max(initial=0.0))
