"""Rigid move of a stance: about the vertical and along the world's axes."""

from dataclasses import dataclass, replace

_NO_MOVE = 1e-7  # m and rad


@dataclass(frozen=True)
class StanceMove:
    """Move of a ground phase from where it was recorded to where it is in the adapted motion.

    phase: its name. pivot: m, world, about which it turns. turn: rad, about the vertical,
    counter-clockwise from above. shift: m, world, after the turn.
    """

    phase: str
    pivot: tuple[float, float, float]
    turn: float
    shift: tuple[float, float, float]

    @property
    def stays(self) -> bool:
        """Whether the stance is where it was recorded."""
        return max(abs(self.turn), *(abs(each) for each in self.shift)) < _NO_MOVE

    def from_elsewhere(self, away: tuple[float, float, float]) -> "StanceMove":
        """The move that takes to the same place what stands so far away, m."""
        (x, y, z), (a, b, c), (u, v, w) = self.pivot, away, self.shift
        pivot, shift = (x + a, y + b, z + c), (u - a, v - b, w - c)
        return replace(self, pivot=pivot, shift=shift)

    def scaled(self, factor: float) -> "StanceMove":
        """The move with every length times `factor`, about the world's origin."""
        pivot, shift = (
            (factor * x, factor * y, factor * z) for x, y, z in (self.pivot, self.shift)
        )
        return replace(self, pivot=pivot, shift=shift)
