"""An elliptic cone that is wider by the same angle all around, as a measure of a joint's rotation.

More of a cone's half angle alone would be more the way that it is narrow, and little the way that
it is wide: 10 degrees of a hip's, 3 and a half of its flexion. So directions are pulled towards the
axis before they are measured, each by as much as takes the wider edge onto the cone's own. Without
width it is the cone's measure.
"""

from dataclasses import dataclass, field

import numpy as np

from ..arrays import FloatArray
from ..body.human_limits import ON_AXIS, edge, narrowing, off_axis
from ..transcription.joint_measures import ConeAngle


@dataclass(frozen=True)
class WiderCone(ConeAngle):
    """The measure of a cone of half angle `half`, rad, of directions pulled towards its axis, so
    that `half` is its value where they are `by` rad beyond the cone."""

    half: float = field(kw_only=True)
    by: float = field(kw_only=True)

    def of(self, R: FloatArray) -> FloatArray:
        angle, ways = off_axis(self._parts(R))
        narrow = narrowing(ways, self.stretch)
        pulled = angle * self._pull(narrow)
        return np.asarray(np.arctan2(narrow * np.sin(pulled), np.cos(pulled)))

    def gradient(self, R: FloatArray) -> FloatArray:
        parts = self._parts(R)
        angle, ways = off_axis(parts)
        narrow = narrowing(ways, self.stretch)
        pull, own = self._pull(narrow), edge(narrow, self.half)
        sine, cosine = np.sin(angle * pull), np.cos(angle * pull)
        size = (narrow * sine) ** 2 + cosine**2
        by_pulled, by_narrow = narrow / size, sine * cosine / size
        tangent = np.sin(self.half) ** 2 + (narrow * np.cos(self.half)) ** 2
        edge_by_narrow = -np.sin(self.half) * np.cos(self.half) / tangent
        by_narrow = by_narrow + by_pulled * angle * self.by * edge_by_narrow / (own + self.by) ** 2
        flattened = 1.0 / self.stretch[1] ** 2 - 1.0 / self.stretch[0] ** 2
        narrow_by_way = ways[:, 0] * ways[:, 1] * flattened / narrow
        around = by_narrow * narrow_by_way / np.maximum(np.sin(angle), ON_AXIS)
        outward, aside = ways @ self.frame[1:], np.stack([-ways[:, 1], ways[:, 0]], 1)
        off = np.cos(angle)[:, None] * outward - np.sin(angle)[:, None] * self.frame[0]
        ahead = (by_pulled * pull)[:, None] * off + around[:, None] * (aside @ self.frame[1:])
        return np.asarray(np.cross(R @ self.along, ahead))

    def past(
        self, R: FloatArray, lower: FloatArray | float, upper: FloatArray | float
    ) -> FloatArray:
        below, above = super().past(R, lower, upper)
        return np.stack([below, above - self.by])

    def _pull(self, narrow: FloatArray) -> FloatArray:
        """(U,) what angles from the axis are multiplied by."""
        own = edge(narrow, self.half)
        return own / (own + self.by)


def wider_cone(cone: ConeAngle, half: float, by: float) -> ConeAngle:
    """A cone of half angle `half`, rad, that is wider by `by`, rad; itself where that is none."""
    if by == 0.0:
        return cone
    if isinstance(cone, WiderCone):
        by += cone.by
    return WiderCone(cone.joint, cone.along, cone.frame, cone.stretch, half=half, by=by)
