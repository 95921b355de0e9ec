"""What every command of a terminal ends with: its exit code, a fault in words.

Loads none of the solver's stages: a batch plans and hands out cells without them.
"""

from pathlib import Path

from ...bridge.recipe.object_texts import offered_texts
from ...bridge.recipe.problem import locate, read_recipe_text
from ...solver.data.faults import BadRecipe, Fault
from ...solver.unseen.offered import OfferedSupport
from ..words.messages import recipe_place, sentence

FAILED = 1  # by no fault of what was asked
WRONG_INPUT = 2
NO_SOLUTION = 3
CANCELLED = 130


def explained(fault: Fault, recipe: Path | None) -> str:
    """The fault in words, with the recipe's line where one is to blame, or lines to add to it."""
    if remedies := offered_texts(OfferedSupport.of([fault])):
        return "\n\n".join([sentence(fault), *remedies]).rstrip()
    if recipe is None or isinstance(fault, BadRecipe):
        return sentence(fault)
    line = locate(read_recipe_text(recipe), fault)
    return sentence(fault) if line is None else f"{recipe_place(recipe, line)}: {sentence(fault)}"
