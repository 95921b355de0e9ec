"""Frames of a result: adapted, blended, and what follows."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.reports.keys import BlendReport
from ...solver.data.stance_move import StanceMove
from ..companions.found import Companions
from ..controls.control_rig import ControlRig
from ..controls.missed.kept import KeptByControls
from .joining.offsets import remaining
from .take_time import TakeTime

BLEND = 0.25  # s, the usual blend
RETURN = 1.0  # s after the adapted frames, by which a take is usually back
BESIDE = 0.01  # frames from a frame that is replaced to the keys before it that stay


@dataclass(frozen=True)
class ResultSpan:
    """Frames of a result, on its own clock.

    first, last: the adapted ones. begin, end: the whole take's. blend_in, blend_out: frames over
    which offsets fade. Where the take ends within them, its last frame keeps what has not faded:
    in fewer frames bodies would go faster than in any other blend.
    """

    first: float
    last: float
    begin: float
    end: float
    blend_in: float
    blend_out: float

    @property
    def between(self) -> tuple[float, float]:
        """Frames strictly between which keys of bodies are replaced."""
        left, right = self.first - self.blend_in, self.last + self.blend_out
        if self.blend_in == 0.0 or left < self.begin:
            left = max(self.begin, np.floor(left)) - BESIDE
        if self.blend_out == 0.0 or right > self.end:
            right = max(self.last, min(self.end, np.ceil(right))) + BESIDE
        return float(left), float(right)

    @property
    def kept(self) -> float:
        """Share of the offset after the adapted frames that the take's last frame keeps."""
        if not len(self.after):
            return 0.0
        return float(remaining(self.after[-1:] - self.last, self.blend_out)[0])

    @property
    def before(self) -> FloatArray:
        """Whole frames that are blended in, (T,)."""
        return np.arange(np.ceil(self.between[0]), self.first)

    @property
    def after(self) -> FloatArray:
        """Whole frames that are blended out, (T,)."""
        return np.arange(self.last + 1.0, np.floor(self.between[1]) + 1.0)

    @property
    def rest(self) -> FloatArray:
        """Whole frames after these, (T,), the take's last one included; none where the take ends
        within the blend, for there every body ends with the blend's last frame."""
        if self.last + self.blend_out > self.end:
            return np.empty(0)
        start = max(np.floor(self.between[1]), self.last) + 1.0
        return np.arange(start, np.ceil(max(self.end, self.last)) + 1.0)


@dataclass(frozen=True)
class WrittenTake:
    """What was done to a take. back: the frame by which it is where it was; None where it is not.

    time: where the take's frames are in the result. applied: bones whose curves had modifiers, or
    were muted, and are keys now. held: bones that moved joints within the body, and hold still now.
    controls: how near the bodies are that controls pose, and rig: these controls; None where bodies
    have keys of their own. owned: paths of the curves that have keys of the result's own. slide: m,
    by which the way back makes standing feet slide. blends: how they move the hips, where there are
    frames to blend. companions: bones outside of the body that went along with it.
    """

    span: ResultSpan
    moved: StanceMove | None
    back: float | None
    time: TakeTime
    applied: tuple[str, ...] = ()
    held: tuple[str, ...] = ()
    controls: KeptByControls | None = None
    rig: ControlRig | None = None
    owned: frozenset[str] = frozenset()
    slide: float = 0.0
    blends: tuple[BlendReport, ...] = ()
    companions: Companions = field(default_factory=Companions)

    @property
    def later(self) -> int:
        """Frames by which what follows comes later; negative is earlier."""
        return self.time.later
