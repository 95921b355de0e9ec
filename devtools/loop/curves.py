"""Curves of a loop played twice as SVG: knees and hips as Blender shows them, beside the recording,
and the force from the ground."""

from collections.abc import Iterator

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.body.anatomy import Part, Side
from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.worker.pipeline import AdaptationResult
from .played import Played

WIDTH, HEIGHT, LEFT, TOP = 900, 130, 50, 30  # px, of a panel
PER_FRAME = 4  # samples
LOOPED, RECORDED = "#d1481f", "#3a7fc2"

Line = tuple[str, FloatArray, FloatArray]  # colour, instants (T,) s, values (T,)


def picture(name: str, result: AdaptationResult, played: Played) -> str:
    """Angles in degrees and body weights over two cycles; the seam is the line in the middle."""
    motion, performance = result.adaptation.motion, result.subject.analysis.performance
    first, last = played.frames
    frames = np.arange(first, 2.0 * last - first, 1.0 / PER_FRAME)
    times, duration = (frames - first) / played.rate, (last - first) / played.rate
    shown = played.points(frames)
    panels: list[tuple[str, list[Line]]] = []
    for side in Side.LEFT, Side.RIGHT:
        chain = [performance.character.body(part, side) for part in (Part.THIGH, Part.SHANK)]
        foot = performance.character.body(Part.FOOT, side)
        assert foot is not None
        legs = [body for body in (*chain, foot) if body is not None]
        lines = [
            (RECORDED, performance.times, _bend(performance.centres[:, legs])),
            (LOOPED, times, _bend(shown[:, legs])),
        ]
        panels.append((f"{side.value} knee, °", lines))
    weight = motion.transcription.character.mass * STANDARD_GRAVITY
    load = motion.forces(np.mod(times, motion.duration)).sum(axis=1)[:, 2] / weight
    panels.append(("ground, up, BW", [(LOOPED, times, load)]))
    return "\n".join(_document(name, panels, duration)) + "\n"


def _bend(joints: FloatArray) -> FloatArray:
    """(T,) degrees at the middle of three joints (T, 3, 3); 0 is straight."""
    upper, lower = np.diff(joints, axis=1).swapaxes(0, 1)
    lengths = np.linalg.norm(upper, axis=1) * np.linalg.norm(lower, axis=1)
    return np.asarray(np.degrees(np.arccos((upper * lower).sum(axis=1) / lengths)))


def _document(name: str, panels: list[tuple[str, list[Line]]], seam: float) -> Iterator[str]:
    height = TOP + len(panels) * HEIGHT
    yield (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
        'font-family="sans-serif" font-size="11">'
    )
    yield f'<rect width="{WIDTH}" height="{height}" fill="white"/>'
    yield f'<text x="{LEFT}" y="18">{name}: the loop twice (red), the recording once (blue)</text>'
    across = (WIDTH - LEFT - 20) / (2.0 * seam)
    for row, (label, lines) in enumerate(panels):
        values = np.concatenate([line[2] for line in lines])
        low, high = float(values.min()), float(values.max())
        top = TOP + row * HEIGHT
        scale = (HEIGHT - 30) / (high - low)
        x = LEFT + across * seam
        yield f'<path d="M{x:.1f} {top}V{top + HEIGHT - 20}" stroke="#999"/>'
        yield f'<text x="4" y="{top + 12}">{label}</text>'
        yield f'<text x="4" y="{top + 28}">{high:.1f}</text>'
        yield f'<text x="4" y="{top + HEIGHT - 20}">{low:.1f}</text>'
        for colour, times, each in lines:
            points = " ".join(
                f"{LEFT + across * t:.1f},{top + 10 + scale * (high - v):.1f}"
                for t, v in zip(times, each, strict=True)
            )
            yield f'<polyline points="{points}" fill="none" stroke="{colour}"/>'
    yield "</svg>"
