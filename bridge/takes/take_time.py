"""Where each frame of a take is in its result, whose durations may be others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.reports.jumps import TimeMap

_SAME = 1e-3  # frames; the report's corners are rounded


@dataclass(frozen=True)
class TakeTime:
    """Piecewise linear map of a take's frames to its result's.

    recorded, result: (N,) corners, ascending; outside of them frames are as far apart as before.
    """

    recorded: FloatArray
    result: FloatArray

    @staticmethod
    def of(times: TimeMap, settle: float) -> TakeTime:
        """The map of a report, after which what follows comes a whole number of frames later.

        So its keys stay on whole frames. settle: frames of the take after the adapted ones, during
        which its clock makes up for the rest, half a frame at most.
        """
        recorded, result = np.array(times.recorded_frame), np.array(times.adapted_frame)
        if np.allclose(recorded, result, atol=_SAME):
            ends = recorded[[0, -1]]
            return TakeTime(ends, ends)
        end = recorded[-1] + settle
        later = np.round(result[-1] - recorded[-1])
        return TakeTime(np.append(recorded, end), np.append(result, end + later))

    @property
    def later(self) -> int:
        """Frames by which what follows comes later; negative is earlier."""
        return round(float(self.result[-1] - self.recorded[-1]))

    @property
    def unchanged(self) -> bool:
        """Whether every frame stays where it was."""
        return bool(np.array_equal(self.recorded, self.result))

    def to_result(self, frames: FloatArray) -> FloatArray:
        """Frames (T,) of the result at which the take's are shown."""
        return mapped(frames, self.recorded, self.result)

    def to_recorded(self, frames: FloatArray) -> FloatArray:
        """Frames (T,) of the take that the result's show."""
        return mapped(frames, self.result, self.recorded)


def mapped(frames: FloatArray, before: FloatArray, after: FloatArray) -> FloatArray:
    """Frames (T,) where corners (N,) are elsewhere; outside of these as far from them."""
    frames = np.asarray(frames, dtype=float)
    outside = frames - np.clip(frames, before[0], before[-1])
    return np.asarray(np.interp(frames - outside, before, after) + outside)
