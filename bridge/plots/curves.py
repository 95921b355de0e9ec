"""A motion's curves over time, as they are plotted and written to files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.traces import Traces


class Take(Enum):
    """The motion that a curve is of."""

    RECORDING = "Recording"
    ADAPTED = "Adapted"


@dataclass(frozen=True)
class Curve:
    """A quantity over time. frames, values: (T,). part: what of the chart's quantity, "" all."""

    take: Take
    frames: FloatArray
    values: FloatArray
    part: str = ""

    @property
    def name(self) -> str:
        return f"{self.take.value} {self.part}".rstrip()

    def at(self, frame: float) -> float | None:
        """The value at a frame; None where the motion has none."""
        if not self.frames[0] <= frame <= self.frames[-1]:
            return None
        return float(np.interp(frame, self.frames, self.values))


@dataclass(frozen=True)
class Cap:
    """A bound that the artist set on what a chart shows, from frame to frame."""

    name: str
    start: float
    end: float
    value: float


@dataclass(frozen=True)
class Chart:
    """Curves with one axis. from_zero: whether the axis starts at zero whatever the values are.

    digits: behind the point, of values that are read off. missing: why there are no curves.
    """

    title: str
    unit: str
    curves: tuple[Curve, ...]
    digits: int
    from_zero: bool = True
    caps: tuple[Cap, ...] = ()
    missing: str = ""


WEIGHTS = "body weights on Earth"  # also where gravity is another
Takes = Mapping[Take, Traces]


def force_chart(takes: Takes, caps: tuple[Cap, ...]) -> Chart:
    """Contact forces in body weights: their sum's size, which caps are about, and its vertical."""
    curves = []
    for take, traces in takes.items():
        if not traces.forces.size:  # a recording knows none
            continue
        total = traces.forces.sum(axis=1) / traces.weight
        size = np.linalg.norm(total, axis=1)
        curves.append(Curve(take, traces.frames, size))
        if take is Take.ADAPTED:
            curves.append(Curve(take, traces.frames, total[:, 2], "Vertical"))
    missing = "" if curves else "Adapt to see forces"
    return Chart("Contact Force", WEIGHTS, tuple(curves), 2, caps=caps, missing=missing)


def torque_chart(takes: Takes, bone: str, caps: tuple[Cap, ...]) -> Chart:
    """Largest component of a joint's torque, N·m."""
    known = {take: traces for take, traces in takes.items() if bone in traces.joints}
    curves = tuple(
        Curve(take, traces.frames, traces.torques[:, traces.joints.index(bone)])
        for take, traces in known.items()
    )
    if curves:
        return Chart(f"Torque of {bone}", "N·m", curves, 0, caps=caps)
    if not any(traces.joints for traces in takes.values()):
        return Chart("Torque", "N·m", (), 0, missing="Adapt to see torques")
    missing = f"{bone} has no joint that is solved" if bone else "Select a bone in Pose Mode"
    return Chart("Torque", "N·m", (), 0, missing=missing)


def height_chart(takes: Takes) -> Chart:
    """Height of the centre of mass, m."""
    curves = tuple(Curve(take, t.frames, t.com[:, 2]) for take, t in takes.items())
    return Chart("Height of Centre of Mass", "m", curves, 2, from_zero=False)


def speed_chart(takes: Takes) -> Chart:
    """Speed of the centre of mass, m/s."""
    curves = tuple(
        Curve(take, t.frames, np.linalg.norm(t.velocity, axis=1)) for take, t in takes.items()
    )
    return Chart("Speed of Centre of Mass", "m/s", curves, 2)


def table(takes: Takes) -> tuple[list[str], list[list[float | None]]]:
    """Every curve as columns, one line for each frame at which any motion has a value.

    Also all joints' torques, and vertical forces point by point. Returns headings, with units in
    letters that any program reads, and lines; None where a motion has no value at a frame.
    """
    curves = [(c.title, c.unit, curve) for c in _all_charts(takes) for curve in c.curves]
    frames = sorted({float(frame) for _, _, curve in curves for frame in curve.frames})
    headings = ["Frame"]
    lines: list[list[float | None]] = [[frame] for frame in frames]
    for title, unit, curve in curves:
        headings.append(f"{curve.name}: {title} ({unit.replace('·', ' ')})")
        values = dict(zip(curve.frames.tolist(), curve.values.tolist(), strict=True))
        for line, frame in zip(lines, frames, strict=True):
            line.append(values.get(frame))
    return headings, lines


def _all_charts(takes: Takes) -> list[Chart]:
    charts = [height_chart(takes), speed_chart(takes), force_chart(takes, ())]
    charts += [_point_chart(takes, point) for point in _distinct(takes, "contacts")]
    charts += [torque_chart(takes, bone, ()) for bone in _distinct(takes, "joints")]
    return charts


def _point_chart(takes: Takes, point: str) -> Chart:
    curves = tuple(
        Curve(take, t.frames, t.forces[:, t.contacts.index(point), 2] / t.weight, "Vertical")
        for take, t in takes.items()
        if point in t.contacts and t.forces.size  # a recording has contacts without forces
    )
    return Chart(f"Force of {point}", WEIGHTS, curves, 2)


def _distinct(takes: Takes, names: str) -> list[str]:
    every = dict.fromkeys(name for traces in takes.values() for name in getattr(traces, names))
    return [name for name in every if name]
