"""Motions as rows of see-through figures, and the poses that are asked for as white ones."""

from collections.abc import Iterator

import numpy as np

from ....bridge.constraint_kinds import pose
from ....bridge.properties.constraint import HangtimeConstraint
from ....bridge.rows.times import Frames
from ....solver.arrays import FloatArray, IntArray
from ....solver.data.contacts import PhaseKind
from ...drawing.sketch import Colour
from ..context.figure_cache import FigureCache
from ..context.layer import Layer, Part
from ..context.view_context import ShownMotion, ViewContext, holds
from ..geometry import palette, solids
from ..geometry.body_rotations import TracedFigure, posed
from ..geometry.shapes import Shape, faded
from .motion import interpolated, within

ROW, RECORDED_ROW, LIVE_ROW = 0.34, 0.24, 0.18  # opacities
NOW, LIVE_NOW = 0.5, 0.85
POSE_PLUMP, RECORDED_PLUMP = 1.7, 0.5  # times as thick as bones
ELSEWHEN = 0.6  # opacity of a pose at another frame than the shown one
MANY = 9  # ghosts about a flight
AROUND = 0.5  # s before and after it in which there are some
FAINTEST = 0.3  # of a ghost's opacity
MOST = 200  # ghosts of a motion at most
TELLING = 0.2  # m, by which some joint must have moved since the ghost before


def row(view: ViewContext, shown: ShownMotion, part: Part) -> Layer:
    """A motion at some frames."""
    size, colour = view.size, _row_colour(view, part)
    plump = RECORDED_PLUMP if part is Part.RECORDED_GHOSTS else 1.0
    frames = shown.traces.frames
    core = _core(view, shown) if view.options.ghost_auto else None
    step = view.options.ghost_step
    content = shown.key, core or step, size, colour

    def build() -> Iterator[Shape]:
        at = about(frames, core, view.rate) if core is not None else instants(frames, step)
        at = telling(shown.traces.heads, at, TELLING * size)
        near = [nearness(frame, core, view.rate) for frame in frames[at].tolist()]
        heads, tails = (ends[at] for ends in (shown.traces.heads, shown.traces.tails))
        faint = np.repeat([faded(colour, colour[3] * share) for share in near], heads.shape[1], 0)
        heads, tails = (ends.reshape(-1, 3) for ends in (heads, tails))
        yield solids.bodies(heads, tails, faint, size=size, plump=plump)

    return Layer(part, content, build, shown.matrix)


def _core(view: ViewContext, shown: ShownMotion) -> Frames:
    """The flight nearest to the frame that is shown; the whole clip where nothing flies.

    A recording tells no flights: the phases of its contacts do.
    """
    flights = [(each.start, each.end) for each in shown.traces.flights] or [
        span for name, span in view.phases.items() if name.startswith(PhaseKind.FLIGHT.value)
    ]
    if not flights:
        return float(shown.traces.frames[0]), float(shown.traces.frames[-1])
    frame = view.frame
    return min(flights, key=lambda span: max(span[0] - frame, frame - span[1], 0.0))


def about(frames: FloatArray, core: Frames, rate: float) -> IntArray:
    """Indices of MANY instants, evenly from AROUND before the core to as much after it."""
    first = max(core[0] - AROUND * rate, frames[0])
    last = min(core[1] + AROUND * rate, frames[-1])
    wished = np.linspace(first, last, MANY)
    return np.asarray(np.unique(np.searchsorted(frames, wished - 1e-6).clip(max=len(frames) - 1)))


def nearness(frame: float, core: Frames | None, rate: float) -> float:
    """How much is seen of a ghost: all within the core, less the further it is outside."""
    if core is None:
        return 1.0
    outside = max(core[0] - frame, frame - core[1], 0.0)
    return max(1.0 - (1.0 - FAINTEST) * outside / (AROUND * rate), FAINTEST)


def _row_colour(view: ViewContext, part: Part) -> Colour:
    if part is Part.RECORDED_GHOSTS:
        return faded(palette.RECORDED, RECORDED_ROW)
    if view.live is not None:
        return faded(palette.LIVE, LIVE_ROW)
    return faded(palette.ADAPTED, ROW)


def instants(frames: FloatArray, step: int) -> IntArray:
    """Indices of every `step`th frame, counted from the first; fewer where that is too many."""
    wide = max(float(step), (frames[-1] - frames[0]) / MOST)
    wished = np.arange(frames[0], frames[-1] + 1e-6, wide)
    return np.asarray(np.unique(np.searchsorted(frames, wished - 1e-6).clip(max=len(frames) - 1)))


def telling(heads: FloatArray, chosen: IntArray, least: float) -> IntArray:
    """Those of the chosen instants that differ from the one kept before; standing still is shown
    once. heads: (T, B, 3). least: how far one of them must have moved."""
    kept = [int(chosen[0])]
    for instant in chosen[1:].tolist():
        if np.linalg.norm(heads[instant] - heads[kept[-1]], axis=1).max() > least:
            kept.append(instant)
    return np.array(kept)


def now(view: ViewContext, shown: ShownMotion, colour: Colour) -> Layer:
    """A motion at the frame that is shown."""
    frame, traces, size = view.frame, shown.traces, view.size

    def build() -> Iterator[Shape]:
        if within(traces, frame):
            h, t = (interpolated(traces, a, frame) for a in (traces.heads, traces.tails))
            yield solids.bodies(h, t, colour, size=size)

    return Layer(Part.GHOST_NOW, (shown.key, frame, size, colour), build, shown.matrix)


def other_now(view: ViewContext) -> Layer | None:
    """The motion that the armature does not show: live ghost, adapted motion or recording."""
    if view.live is not None:
        return now(view, view.live, faded(palette.LIVE, LIVE_NOW))
    if view.performs_adapted:
        recording = view.recorded if view.options.recording_too else None
        return now(view, recording, faded(palette.RECORDED, NOW)) if recording else None
    return now(view, view.adapted, faded(palette.ADAPTED, NOW)) if view.adapted else None


# ---------------------------------------------------------------- poses


def poses(view: ViewContext, figures: FigureCache) -> Layer | None:
    """The poses that are asked for, hung where the figure is then; in the armature's space."""
    recorded = view.recorded
    wanted = tuple(w for r, _ in view.rows(pose.KIND.name) for w in _wanted(view, r))
    if recorded is None or not wanted:
        return None
    target = view.adapted or recorded
    size = view.units / max(view.armature.matrix_world.median_scale, 1e-9)
    content = wanted, recorded.key, target.key, size

    def build() -> Iterator[Shape]:
        source, hung = figures.of(view, recorded), figures.of(view, target)
        if source is not None and hung is not None:
            for each in wanted:
                yield from pose_shapes(each, source, hung, size)

    return Layer(Part.POSES, content, build, view.armature.matrix_world.copy().freeze())


Wanted = tuple[
    float, float | None, tuple[str, ...], bool
]  # frame, pose's frame, bones, whether now


def _wanted(view: ViewContext, row: HangtimeConstraint) -> Iterator[Wanted]:
    """A pose at the frame that is shown if it holds then, else at the ends of when it holds."""
    if not row.used:
        return
    span = view.span(row)
    bones = tuple(bone.name for bone in row.bones)
    for frame, held in _frames(span, view.frame):
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


def pose_shapes(
    wanted: Wanted, source: TracedFigure, target: TracedFigure, size: float
) -> Iterator[Shape]:
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
