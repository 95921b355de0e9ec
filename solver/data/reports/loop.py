"""Record of the report on a motion that repeats."""

from dataclasses import dataclass


@dataclass(frozen=True)
class LoopReport:
    """The cycle's frames and those asked for, how far and fast it goes, and by how much its end
    misses its start: a joint's centre, its velocity and a point's contact force at most.

    turned_deg: by how much its way is turned against the recorded cycle's, counter-clockwise from
    above; 0 where either goes nowhere."""

    first_frame: float
    last_frame: float
    asked_first: float
    asked_last: float
    travel_m: float
    speed_m_s: float
    seam_pose_mm: float
    seam_velocity_mm_s: float
    seam_force_bw: float
    turned_deg: float = 0.0
