"""Which recording an analysis is of: a key that is kept with it, and a sketch of its motion."""

from __future__ import annotations

from dataclasses import replace
from math import isclose

from ...solver.analysis.motion_sketch import MotionSketch
from ...solver.data.recording import POSE_TOLERANCE, Recording, digest
from ..accessors import current_scene
from ..armature.poses import frames_per_second
from ..properties.settings import HangtimeSettings
from ..rows.phases import SAME
from ..takes.options import loop_options

# Relative. Clips round their frame time: .00833 s is 4e-4 from .0083333 s. At this much a fall of
# 1 m is 1 mm off. NTSC's rates are 1e-3 from whole ones, and are meant.
SAME_RATE = 5e-4
_DIGEST = 64  # digits, with which an analysis' key begins

_Span = tuple[float, float]


def wanted_range(settings: HangtimeSettings) -> tuple[float, float] | tuple[None, None]:
    """First and last frame that the artist chose; (None, None) for the action's own."""
    if not settings.use_range:
        return None, None
    return float(settings.first_frame), float(settings.last_frame)


def span_of(settings: HangtimeSettings, recording: Recording) -> tuple[float, float]:
    """First and last scene frame that are adapted; a recording may have frames beyond."""
    first, last = wanted_range(settings)
    if first is None or last is None:
        return recording.ends
    within = recording.window(first, max(first, last)).frames
    return float(within[0]), float(within[-1])


def analysis_key(
    settings: HangtimeSettings,
    recording: Recording,
    grid: float = POSE_TOLERANCE,
    *,
    named: bool = False,
    timed: bool = False,
) -> str:
    """What an analysis is of: the recording, the range where there are frames beyond it, and
    whether it is a loop's, and its repairs. grid: of its poses; to their last bit they would be
    others on another computer. named, timed: whether its action's name and its times are part of
    it; the rate is kept beside it. Raises BadRecipe."""
    told = recording if named else replace(recording, name="")
    told = told if timed else replace(told, times=told.frames - told.frames[0])
    span, key = span_of(settings, recording), digest(told, grid)
    whole = span == (recording.frames[0], recording.frames[-1])
    key = key if whole else f"{key} {span[0]:g} {span[1]:g}"
    key = key if loop_options(settings) is None else f"{key} loop"
    return f"{key}\n{settings.repairs}" if settings.repairs else key


def analysis_is_of(settings: HangtimeSettings, recording: Recording) -> bool:
    """Whether this is what was analysed, whatever its action is called now, but for rounding:
    going into edit mode and back moves bones by less than a micrometre. Earlier versions kept
    the key alone, with its times, before that with its name, too, the first ones of every bit."""
    if rates_since(settings) is None:
        key = analysis_key(settings, recording)
        if settings.analysed == key:
            return True
        kept = MotionSketch.from_text(settings.analysed_motion)
        before = str(settings.analysed)  # "" where a sketch may be left, but no analysis
        as_asked = before != "" and before[_DIGEST:] == key[_DIGEST:]
        if as_asked and kept is not None and kept.is_near(MotionSketch.of(recording)):
            return True
    return any(
        settings.analysed == analysis_key(settings, recording, grid, named=named, timed=True)
        for grid, named in ((POSE_TOLERANCE, False), (POSE_TOLERANCE, True), (0.0, True))
    )


def rates_since(settings: HangtimeSettings) -> tuple[float, float] | None:
    """The scene's frames per second when the recording was analysed, and now; None where they are
    the same, or an earlier version did not keep them."""
    before, now = float(settings.analysed_rate), frames_per_second(current_scene())
    return (before, now) if before and not isclose(before, now, rel_tol=SAME_RATE) else None


def spans_since(settings: HangtimeSettings, recording: Recording) -> tuple[_Span, _Span] | None:
    """First and last scene frame that were analysed, and that are to be adapted now; None where
    they are the same, or an earlier version did not keep them."""
    before, now = tuple(map(float, settings.analysed_span)), span_of(settings, recording)
    if not any(before) or all(abs(a - b) < SAME for a, b in zip(before, now, strict=True)):
        return None
    return (before[0], before[1]), now


def repaired_since(settings: HangtimeSettings) -> bool:
    """Whether the recording was analysed with other repairs than it has now."""
    key = str(settings.analysed)
    return bool(key) and key.partition("\n")[2] != settings.repairs
