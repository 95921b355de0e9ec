"""Functions that Blender calls when something happens (`bpy.app.handlers`)."""

from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

Handlers = list[Callable[..., Any]]


def add_handler(undo: ExitStack, handlers: Handlers, function: Callable[..., Any]) -> None:
    """Has Blender call a function until `undo` is closed, or until a script empties the list."""
    handlers.append(function)
    undo.callback(_remove, handlers, function)


def _remove(handlers: Handlers, function: Callable[..., Any]) -> None:
    if function in handlers:
        handlers.remove(function)
