"""What every command of a terminal ends with: its exit code, a fault in words.

Loads none of the solver's stages: a batch plans and hands out cells without them.
"""

from pathlib import Path

from ...bridge.recipe.contacts import added_texts
from ...bridge.recipe.object_texts import support_texts
from ...bridge.recipe.problem import locate, read_recipe_text
from ...bridge.recipe.requests import point_texts
from ...solver.data.faults import BadRecipe, Fault, OffBalance, UnseenSupport
from ..words.messages import recipe_place, sentence

FAILED = 1  # by no fault of what was asked
WRONG_INPUT = 2
NO_SOLUTION = 3
CANCELLED = 130


def explained(fault: Fault, recipe: Path | None) -> str:
    """The fault in words, with the recipe's line where one is to blame, or lines to add to it."""
    if remedies := _remedies(fault):
        return "\n\n".join([sentence(fault), *remedies]).rstrip()
    if recipe is None or isinstance(fault, BadRecipe):
        return sentence(fault)
    line = locate(read_recipe_text(recipe), fault)
    return sentence(fault) if line is None else f"{recipe_place(recipe, line)}: {sentence(fault)}"


def _remedies(fault: Fault) -> list[str]:
    """What carries the body, as a recipe has it, where that is told."""
    if isinstance(fault, UnseenSupport):
        boxes = support_texts(fault.boxes)
        added = added_texts((*fault.hands, *fault.walls))
        return [*boxes, *added, *point_texts(fault.holds)]
    if isinstance(fault, OffBalance):
        return [*added_texts(fault.hands), *point_texts(fault.holds)]
    return []
