"""How much of long work is done, by the time that it takes; without Blender."""

from collections.abc import Callable
from dataclasses import dataclass, field
from time import perf_counter


@dataclass
class Pace:
    """Work in parts of which each has pieces, one after the other, that tell how far they are.
    clock: s. share: of all that is done, 0 to 1, which never falls."""

    clock: Callable[[], float] = perf_counter
    share: float = 0.0
    _done: float = 0.0  # of the piece
    _began: float = field(init=False)
    _part_began: float = field(init=False)
    _piece_began: float = field(init=False)
    _told: float = field(init=False)  # when the piece was heard of last

    def __post_init__(self) -> None:
        self._began = self.clock()
        self.next_part()

    def next_part(self) -> None:
        """The next part begins."""
        self._part_began = self._piece_began = self._told = self.clock()
        self._done = 0.0

    def lasts(self, done: float) -> float:
        """So much of a piece is done, above 0 to 1; less than before is of another one. How long
        it lasts all in all, s."""
        if done < self._done or self._done >= 1.0:
            self._piece_began = self._told
        self._done, self._told = done, self.clock()
        return (self._told - self._piece_began) / done

    def expect(self, piece: float, part: float, later: float) -> None:
        """s that the piece, the part that it is of, and all that comes after, are to last."""
        left = max(self._piece_began + piece, self._part_began + part) - self._told
        elapsed = self._told - self._began
        whole = elapsed + max(left, 0.0) + later
        if whole > 0.0:
            self.share = max(self.share, elapsed / whole)
