"""What goes on in this Blender beside what is in its file."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Protocol

from ..solver.messages import Adapted
from .solving import Solving

if TYPE_CHECKING:
    from .adapt import Asked


class Running(Protocol):
    """A modal operator at work."""

    def leave(self) -> None:
        """Nothing of the work remains."""


@dataclass
class Session:
    """The solve under way, who runs it, why the last one failed, and the best that it found."""

    solving: Solving | None = None
    failure: str = ""
    best: Best | None = None
    running: list[Running] = field(default_factory=list)

    def end(self) -> None:
        """Ends what runs, without a word; for when the extension goes."""
        for operator in list(self.running):
            operator.leave()
        self.best, self.failure = None, ""


@dataclass(frozen=True)
class Best:
    """The best motion that a solve found which failed, and what was asked."""

    asked: Asked
    answer: Adapted


@cache
def session() -> Session:
    """The one session of this Blender."""
    return Session()
