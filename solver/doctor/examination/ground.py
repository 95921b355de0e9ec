"""What a recording stands on: seen from ground of the scene, that is at rest, at the height 0."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...analysis.performance import Performance, perform
from ...arrays import FloatArray
from ...data.recording import Recording
from ...data.scene import SceneObject
from ...scene.support import Heights, StandingGround
from ..repairs import Repairs
from ..stance.footing import FLOOR_OFF, NEAR, standing
from .repair import placed, placed_skin


def as_stood(performance: Performance, scene: Sequence[SceneObject]) -> Performance:
    """The performance as seen from the ground that most of it stands on, where its feet slide less
    than as it was recorded; as it was where that is the floor, or ground that it does not touch."""
    recording = performance.recording
    ground = StandingGround.of(-np.inf, scene, recording)  # objects alone: the floor is known
    if ground.bare:
        return performance
    for carrier in ground.carriers:
        seen = perform(carrier.seen_recording(recording), performance.character, performance.skin)
        top = _top(seen, carrier.heights)
        if top is not None and _slide(seen) < _slide(performance):
            return _lowered(seen, top)
    top = _top(performance, ground.heights)
    return performance if top is None else _lowered(performance, top)


def beneath(recording: Recording, scene: Sequence[SceneObject]) -> Heights:
    """Heights, m, of the scene's ground right below places; 0 where there is none."""
    ground = StandingGround.of(-np.inf, scene, recording)

    def heights(times: FloatArray, places: FloatArray) -> FloatArray:
        tops = ground.heights(times, places)
        return np.where(np.abs(places[:, 2] - tops) < NEAR, tops, 0.0)

    return heights


def _top(performance: Performance, heights: Heights) -> float | None:
    """Height, m, of ground on which feet stand at least half of the time; None where they do not.

    Ground beneath them that they do not touch tells nothing of the recording.
    """
    stood = standing(performance)
    tops = heights(stood.times, stood.places)
    on = np.abs(stood.places[:, 2] - tops) < FLOOR_OFF
    return float(np.median(tops[on])) if 2 * on.sum() >= max(len(on), 1) else None


def _slide(performance: Performance) -> float:
    """How fast, m/s, feet that stand slide in the median."""
    speeds = np.linalg.norm(standing(performance).velocities, axis=1)
    return float(np.median(speeds)) if len(speeds) else np.inf


def _lowered(performance: Performance, top: float) -> Performance:
    """With the ground at 0."""
    lower = Repairs(floor=top)
    skin = placed_skin(performance.skin, lower)
    return perform(placed(performance.recording, lower), performance.character, skin)
