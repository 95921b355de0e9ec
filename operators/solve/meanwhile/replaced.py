"""Work in parts that ends before Blender replaces its data: by an undo, a redo or another file.

What a part keeps for the next of curves, bones and settings is freed then, and Blender tells Python
of data-blocks alone; to touch the rest ends Blender with a segmentation fault.
"""

from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack, contextmanager, suppress

import bpy

from ....bridge.app_handlers import add_handler
from ....solver.data.faults import Fault


@contextmanager
def before_replaced(stop: Callable[[], None]) -> Iterator[None]:
    """Context in which Blender calls a function while all that it is about to replace is there."""
    handlers = bpy.app.handlers
    with ExitStack() as undo:
        for each in (handlers.undo_pre, handlers.redo_pre, handlers.load_pre):
            add_handler(undo, each, lambda *_of_handlers: stop())
        yield


def end_with(parts: Generator[object, None, object], why: Exception) -> None:
    """Has work end with a fault, as if met by the part that was to come: it puts back what it has
    changed, as far as that is still there."""
    with suppress(Fault, ReferenceError, StopIteration):
        parts.throw(why)
    with suppress(ReferenceError):
        parts.close()
