"""Joint centres of a jump by phase: crouch, flight, landing; two jumps are compared at the same."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...solver.analysis.performance import Performance
from ...solver.arrays import FloatArray
from ...solver.data.contacts import Phase
from ...solver.numerics.interpolation import interpolate
from ...solver.transcription.motion import Motion
from .jump_frame import JumpFrame

AROUND = 0.4  # s before take-off and after landing that are compared
INSTANTS = 49  # of each phase


@dataclass(frozen=True)
class PhasedJump:
    """Joint centres (N, B, 3) m, jump frame, at N even instants of each phase, ends included.

    crouch: the last `AROUND` before take-off; landing: the first after it.
    """

    crouch: FloatArray
    flight: FloatArray
    landing: FloatArray

    def phases(self) -> dict[str, FloatArray]:
        """Each phase by its name."""
        return {"crouch": self.crouch, "flight": self.flight, "landing": self.landing}

    def distances(self, other: "PhasedJump") -> dict[str, float]:
        """Mean distance of the joint centres in each phase, cm."""
        pairs = zip(self.phases().items(), other.phases().values(), strict=True)
        return {
            name: 100.0 * float(np.linalg.norm(mine - theirs, axis=2).mean())
            for (name, mine), theirs in pairs
        }

    def slid(self, offset: FloatArray) -> "PhasedJump":
        """Moved along the floor by offset (3,) m, jump frame, evenly during the flight."""
        share = np.linspace(0.0, 1.0, len(self.flight))[:, None, None]
        return PhasedJump(self.crouch, self.flight + share * offset, self.landing + offset)

    def instants(self) -> dict[str, FloatArray]:
        """Joint centres (B, 3) at the lowest pelvis, take-off, highest pelvis and landing."""
        lowest, highest = self.crouch[:, 0, 2].argmin(), self.flight[:, 0, 2].argmax()
        return {
            "crouch": self.crouch[lowest],
            "take-off": self.flight[0],
            "apex": self.flight[highest],
            "landing": self.flight[-1],
        }


def recorded_phases(performance: Performance, flight: Phase, frame: JumpFrame) -> PhasedJump:
    """A recording's phases."""

    def centres(times: FloatArray) -> FloatArray:
        return interpolate(performance.times, performance.centres, times)

    return _phased(centres, flight, frame)


def motion_phases(motion: Motion, flight: Phase, frame: JumpFrame) -> PhasedJump:
    """A solved motion's phases. flight: in its own time."""
    return _phased(motion.joint_centres, flight, frame)


def _phased(
    centres: Callable[[FloatArray], FloatArray], flight: Phase, frame: JumpFrame
) -> PhasedJump:
    edges = (flight.start - AROUND, flight.start, flight.end, flight.end + AROUND)
    spans = pairwise(edges)
    return PhasedJump(*(frame.of(centres(np.linspace(*span, INSTANTS))) for span in spans))
