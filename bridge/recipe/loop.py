"""Loop options of a recipe: what carries the travel. Keys: see problem.py."""

from dataclasses import dataclass

from ..recipe_syntax.items import Kind, choice
from ..rows.choices import LoopRoot


@dataclass(frozen=True)
class LoopOptions:
    """How a loop is written."""

    root: LoopRoot = LoopRoot.HIPS


LOOP = Kind("loop", LoopOptions, (choice("root", LoopRoot),), named=False)
