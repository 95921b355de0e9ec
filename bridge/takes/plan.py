"""What is to be done to a take: an adapted motion, and which frames it changes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack
from ...solver.data.reports.jumps import TimeMap
from ...solver.data.stance_move import StanceMove
from ..accessors import current_scene
from ..armature.fcurves import CurveHolder
from ..armature.poses import frames_per_second
from ..recipe.result import ResultOptions
from ..rows.choices import After
from .joining.offsets import remaining
from .key_splice import key_span
from .owned import OwnedChannel
from .span import BESIDE, BLEND, RETURN, ResultSpan
from .take_time import TakeTime


@dataclass(frozen=True)
class AdaptedMotion:
    """An adapted motion to be put into the take that it was made from.

    times: the report's map. moved: the last stance's move. ends: whether nothing shall follow.
    kept: first and last frame of each adaptation that the take holds already, which no blend shall
    reach into. touching: bones that touch in it.
    """

    track: PoseTrack
    times: TimeMap
    moved: StanceMove | None
    options: ResultOptions
    ends: bool = False
    kept: tuple[tuple[float, float], ...] = ()
    touching: tuple[str, ...] = ()

    @property
    def recorded_frames(self) -> FloatArray:
        """Frames of the recording that were adapted, (T,)."""
        corners = self.times.recorded_frame
        return np.arange(np.ceil(corners[0]), np.floor(corners[-1]) + 1.0)


@dataclass(frozen=True)
class Plan:
    """What goes where. moved: with which stance what follows is carried; None where nothing is.
    back: frame by which the take is where it was, where it is to come back."""

    span: ResultSpan
    time: TakeTime
    moved: StanceMove | None
    back: float | None

    @property
    def body_frames(self) -> FloatArray:
        """Frames at which all bodies are keyed."""
        span = self.span
        adapted = np.arange(span.first, span.last + 1.0)
        return np.concatenate([span.before, adapted, span.after])

    @property
    def shares(self) -> FloatArray:
        """(T,) at the body's frames: 1 where joints hold as the motion's do, 0 as the take's."""
        span = self.span
        before = remaining(span.first - span.before, span.blend_in)
        after = remaining(span.after - span.last, span.blend_out)
        adapted = len(self.body_frames) - len(before) - len(after)
        return np.concatenate([before, np.ones(adapted), after])

    @property
    def rest_frames(self) -> FloatArray:
        """Frames after these at which only what carries the figure is keyed."""
        if self.moved is None:
            return np.empty(0)
        rest = self.span.rest
        return rest if self.back is None else rest[rest <= self.back]

    def between(self, channel: OwnedChannel) -> tuple[float, float]:
        """Frames strictly between which a channel's keys are replaced."""
        left, right = self.span.between
        if channel.carries and self.moved is not None:
            frames = np.concatenate([self.span.after, self.rest_frames])
            right = max(right, float(frames[-1]) + (BESIDE if self.back is None else 0.0))
        return left, right

    def beside(self, channel: OwnedChannel) -> tuple[float | None, float | None]:
        """Whole frames next to those that are replaced; None where the take does not reach them."""
        left, right = self.between(channel)
        before, after = float(np.floor(left)), float(np.ceil(right))
        return (
            before if before >= self.span.begin else None,
            after if after <= self.span.end else None,
        )


def planned(curves: CurveHolder, motion: AdaptedMotion) -> Plan:
    """What is to be done to a take that these curves animate."""
    options, track, rate = motion.options, motion.track, frames_per_second(current_scene())
    usual = float(np.round(BLEND * rate))
    blend_in = usual if options.blend_in is None else float(np.round(options.blend_in))
    blend_out = usual if options.blend_out is None else float(np.round(options.blend_out))
    first, last = float(track.frames[0]), float(track.frames[-1])
    recorded_last = motion.times.recorded_frame[-1]
    for start, end in motion.kept:
        if end <= first:
            blend_in = min(blend_in, first - end)
        if start >= recorded_last:
            blend_out = min(blend_out, np.floor(start - recorded_last))
    if motion.ends:
        blend_out = 0.0
    keyed = np.array(key_span(list(curves.fcurves)))
    room = np.floor(keyed[1]) - recorded_last  # within which its end comes to a whole frame
    time = TakeTime.of(motion.times, max(min(blend_out, room), 1.0))
    begin, end = time.to_result(keyed).tolist()
    follows = not motion.ends and np.floor(end) > last
    moved = None if motion.moved is None or motion.moved.stays or not follows else motion.moved
    back = None
    if moved is not None and options.after is After.RETURN:
        by = options.return_frame
        by = recorded_last + max(RETURN * rate, 2.0 * blend_out) if by is None else by
        # A frame that is chosen is in the take (require_return_within); the usual one may not be.
        back = min(float(np.ceil(time.to_result(np.array([by]))[0])), np.floor(end))
        blend_out = min(blend_out, back - last)
    span = ResultSpan(first, last, begin, last if motion.ends else end, blend_in, blend_out)
    return Plan(span, time, moved, back)
