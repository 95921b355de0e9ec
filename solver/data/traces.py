"""Sampled quantities of a motion for drawing: body, paths, forces, torques over time.

Data alone, without CasADi: Blender keeps and draws it. results/trace_sampling.py makes it.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import FloatArray

UNSEEN_SUPPORT = "Unseen support"  # the points at which something unseen carries the body


@dataclass(frozen=True)
class FlightParabola:
    """Ballistic path of the centre of mass in a flight phase.

    start, end: scene frames of take-off and landing. parabola: (N, 3) m, world.
    """

    name: str
    start: float
    end: float
    parabola: FloatArray


@dataclass(frozen=True)
class Traces:
    """Sampled motion at T instants; world frame, SI units.

    frames: (T,) scene frames. bones: of the figure; heads, tails: (T, B, 3) m. com: (T, 3) m;
    velocity: (T, 3) m/s of it; momentum: (T, 3) N·m·s about it. contacts: names of the points that
    touch, and UNSEEN_SUPPORT for those at which something unseen carries; points: (T, C, 3) m;
    forces: (T, C, 3) N on the body, zero while they do not touch;
    weight: N, the body's. joints: bones whose torques are known; torques: (T, J) N·m, the largest
    component of each joint. changes: (T, B) rad that each bone's joint is turned from the
    recording's; (0, 0) where nothing is told. Of a recording the contacts are all points that might
    touch; forces, torques and flights it has none (T, 0, 3). solids: names of the bodies whose
    solid shapes, capsules, are traced, one each; their ends solid_starts, solid_ends: (T, S, 3) m,
    and solid_radii: (S,) m.
    """

    frames: FloatArray
    bones: tuple[str, ...]
    heads: FloatArray
    tails: FloatArray
    com: FloatArray
    velocity: FloatArray
    momentum: FloatArray
    contacts: tuple[str, ...]
    points: FloatArray
    forces: FloatArray
    weight: float
    joints: tuple[str, ...]
    torques: FloatArray
    flights: tuple[FlightParabola, ...]
    changes: FloatArray = field(default_factory=lambda: np.zeros((0, 0)))
    solids: tuple[str, ...] = ()
    solid_starts: FloatArray = field(default_factory=lambda: np.zeros((0, 0, 3)))
    solid_ends: FloatArray = field(default_factory=lambda: np.zeros((0, 0, 3)))
    solid_radii: FloatArray = field(default_factory=lambda: np.zeros(0))


def scaled_traces(traces: Traces, factor: float) -> Traces:
    """Traces of a figure `factor` times as large: lengths scaled, forces and torques kept."""
    solids = ("solid_starts", "solid_ends", "solid_radii")
    lengths = ("heads", "tails", "com", "velocity", "points", *solids)
    flights = tuple(replace(f, parabola=factor * f.parabola) for f in traces.flights)
    scaled = {name: factor * getattr(traces, name) for name in lengths}
    return replace(traces, **scaled, flights=flights)
