"""Motions as rows of see-through figures, and the poses that are asked for as white ones."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ....bridge.constraint_kinds import pose
from ....bridge.rows.times import Frames
from ..context.figure_cache import Figures
from ..context.layer import Layer, Part
from ..context.view_context import Seen, Shown, holds
from ..geometry import palette, solids
from ..geometry.body_rotations import Figure, posed
from ..geometry.shapes import Colour, Shape, faded
from .motion import interpolated, within

if TYPE_CHECKING:
    from ....bridge.properties.constraint import HangtimeConstraint

FloatArray = NDArray[np.float64]

ROW, RECORDED_ROW, LIVE_ROW = 0.34, 0.24, 0.18  # opacities
NOW, LIVE_NOW = 0.5, 0.85
POSE_PLUMP, RECORDED_PLUMP = 1.7, 0.5  # times as thick as bones
ELSEWHEN = 0.6  # opacity of a pose at another frame than the shown one
MOST = 200  # ghosts of a motion at most
TELLING = 0.2  # m, by which some joint must have moved since the ghost before


def row(seen: Seen, shown: Shown, part: Part) -> Layer:
    """A motion every few frames."""
    step, size = seen.view.ghost_step, seen.size
    colour = _row_colour(seen, part)
    plump = RECORDED_PLUMP if part is Part.RECORDED_GHOSTS else 1.0
    content = shown.key, step, size, colour

    def build() -> Iterator[Shape]:
        chosen = telling(shown.traces.heads, instants(shown.traces.frames, step), TELLING * size)
        h, t = (a[chosen].reshape(-1, 3) for a in (shown.traces.heads, shown.traces.tails))
        yield solids.bodies(h, t, colour, size=size, plump=plump)

    return Layer(part, content, build, shown.matrix)


def _row_colour(seen: Seen, part: Part) -> Colour:
    if part is Part.RECORDED_GHOSTS:
        return faded(palette.RECORDED, RECORDED_ROW)
    if seen.live is not None:
        return faded(palette.LIVE, LIVE_ROW)
    return faded(palette.ADAPTED, ROW)


def instants(frames: FloatArray, step: int) -> NDArray[np.int64]:
    """Indices of every `step`th frame, counted from the first; fewer where that is too many."""
    wide = max(float(step), (frames[-1] - frames[0]) / MOST)
    wished = np.arange(frames[0], frames[-1] + 1e-6, wide)
    return np.unique(np.searchsorted(frames, wished - 1e-6).clip(max=len(frames) - 1))


def telling(heads: FloatArray, chosen: NDArray[np.int64], least: float) -> NDArray[np.int64]:
    """Those of the chosen instants that differ from the one kept before; standing still is shown
    once. heads: (T, B, 3). least: how far one of them must have moved."""
    kept = [int(chosen[0])]
    for instant in chosen[1:].tolist():
        if np.linalg.norm(heads[instant] - heads[kept[-1]], axis=1).max() > least:
            kept.append(instant)
    return np.array(kept)


def now(seen: Seen, shown: Shown, colour: Colour) -> Layer:
    """A motion at the frame that is shown."""
    frame, traces, size = seen.frame, shown.traces, seen.size

    def build() -> Iterator[Shape]:
        if within(traces, frame):
            h, t = (interpolated(traces, a, frame) for a in (traces.heads, traces.tails))
            yield solids.bodies(h, t, colour, size=size)

    return Layer(Part.GHOST_NOW, (shown.key, frame, size, colour), build, shown.matrix)


def other_now(seen: Seen) -> Layer | None:
    """What the armature does not show: the live ghost, the adapted motion or the recording."""
    if seen.live is not None:
        return now(seen, seen.live, faded(palette.LIVE, LIVE_NOW))
    if seen.performs_adapted:
        recording = seen.recorded if seen.view.recording_too else None
        return now(seen, recording, faded(palette.RECORDED, NOW)) if recording else None
    return now(seen, seen.adapted, faded(palette.ADAPTED, NOW)) if seen.adapted else None


# ---------------------------------------------------------------- poses


def poses(seen: Seen, figures: Figures) -> Layer | None:
    """The poses that are asked for, hung where the figure is then; in the armature's space."""
    recorded = seen.recorded
    wanted = tuple(w for r, _ in seen.rows(pose.KIND.name) for w in _wanted(seen, r))
    if recorded is None or not wanted:
        return None
    target = seen.adapted or recorded
    size = seen.units / max(seen.armature.matrix_world.median_scale, 1e-9)
    content = wanted, recorded.key, target.key, size

    def build() -> Iterator[Shape]:
        source, hung = figures.of(seen, recorded), figures.of(seen, target)
        if source is not None and hung is not None:
            for each in wanted:
                yield from pose_shapes(each, source, hung, size)

    return Layer(Part.POSES, content, build, seen.armature.matrix_world.copy().freeze())


Wanted = tuple[
    float, float | None, tuple[str, ...], bool
]  # frame, pose's frame, bones, whether now


def _wanted(seen: Seen, row: HangtimeConstraint) -> Iterator[Wanted]:
    """A pose at the frame that is shown if it holds then, else at the ends of when it holds."""
    if not row.used:
        return
    span = seen.span(row)
    bones = tuple(bone.name for bone in row.bones)
    for frame, held in _frames(span, seen.frame):
        if row.source == pose.PoseSource.REST.name:
            yield frame, None, bones, held
        else:
            yield frame, row.pose_frame if row.use_pose_frame else frame, bones, held


def _frames(span: Frames, frame: float) -> list[tuple[float, bool]]:
    if holds(span, frame):
        return [(float(np.clip(frame, *span)), True)]
    if span[0] > span[1]:
        return []
    return [(f, False) for f in sorted(set(span)) if np.isfinite(f)]


def pose_shapes(wanted: Wanted, source: Figure, target: Figure, size: float) -> Iterator[Shape]:
    """In the armature's space; nothing where the bones are not the figure's."""
    frame, pose_frame, bones, held = wanted
    names = set(bones)
    chosen = tuple(i for i, b in enumerate(source.bones) if b in names or not names)
    if not chosen or source.bones != target.bones:
        return
    if pose_frame is None:
        source, instant = source.resting(), 0
    else:
        instant = source.at(pose_frame)
    heads, tails = posed(source, instant, target, target.at(frame), chosen)
    colour = palette.POSE if held else faded(palette.POSE, ELSEWHEN)
    yield solids.bodies(heads, tails, colour, size=size, plump=POSE_PLUMP)
