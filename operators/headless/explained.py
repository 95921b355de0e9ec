"""What every command of a terminal ends with: its exit code, a fault in words, a signal.

Loads none of the solver's stages: a batch plans and hands out cells without them.
"""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...bridge.recipe.contacts import added_texts
from ...bridge.recipe.object_texts import support_texts
from ...bridge.recipe.problem import locate, read_recipe_text
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
        return [*support_texts(fault.boxes), *added_texts(fault.hands)]
    return added_texts(fault.hands) if isinstance(fault, OffBalance) else []


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Whoever ends the process politely, by Ctrl-C or otherwise, has it clean up:
    KeyboardInterrupt, also out of Blender's operators, which make an error of their own of it."""
    came = False

    def interrupt(_number: int, _frame: object) -> None:
        nonlocal came
        came = True
        raise KeyboardInterrupt

    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    for number, handler in before.items():
        if handler is not signal.SIG_IGN:  # as of what a shell runs in the background
            signal.signal(number, interrupt)
    try:
        yield
    except Exception as error:
        if came:
            raise KeyboardInterrupt from error
        raise
    finally:
        for number, handler in before.items():
            # None is one that Python did not set, as Blender's own in the background: it cannot be
            # put back from here.
            signal.signal(number, signal.SIG_DFL if handler is None else handler)
