"""Keys of a recipe's result. What the table may hold: see problem.py."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

from ...solver.data.faults import NotInLoop
from ..recipe_syntax.items import Kind, angle, choice, number
from ..recipe_syntax.table import ABOVE_ZERO
from ..rows.choices import KeyChoice


@dataclass(frozen=True)
class KeyOptions:
    """Keys that a result gets.

    distance: m, of a joint in the world, and angle: rad, of a bone in the world, by which reduced
    keys may be off at any frame.
    """

    on: KeyChoice = KeyChoice.EVERY_FRAME
    distance: float = 0.002
    angle: float = radians(0.2)


def require_every_frame(options: KeyOptions) -> None:
    """A loop's keys are on every frame. Raises NotInLoop."""
    if options.on is not KeyChoice.EVERY_FRAME:
        raise NotInLoop(f"keys on “{options.on.value}”")


KEYS = Kind(
    "keys",
    KeyOptions,
    (
        choice("on", KeyChoice),
        number("distance", ABOVE_ZERO),
        angle("angle", ABOVE_ZERO),
    ),
    named=False,
)
