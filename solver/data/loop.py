"""A cycle of a motion that repeats."""

from dataclasses import dataclass

LEAST_TRAVEL = 0.3  # m a cycle; what goes less far, as on the spot, has no course


@dataclass(frozen=True)
class Cycle:
    """First and last scene frame of one cycle, and those that were asked for."""

    frames: tuple[float, float]
    asked: tuple[float, float]

    @property
    def as_asked(self) -> bool:
        return self.frames == self.asked
