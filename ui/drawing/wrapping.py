"""Text in lines that the sidebar has room for."""

from collections.abc import Callable, Iterator

import bpy

from ...bridge.accessors import present
from . import paint
from .editor import ui_scale

# px at an interface scale of 1
MARGINS = 66.0  # the panel's, a box's and the tabs'
ICON = 26.0
LEAST_ROOM = 160.0  # a narrower sidebar cuts lines off; words above each other are read by nobody


def wrapped(context: bpy.types.Context, text: str, icons: int = 1) -> str:
    """Text in lines that the region has room for, as its font is, beside some icons."""
    scale = ui_scale(context)
    room = present(context.region).width - scale * (MARGINS + icons * ICON)
    room = max(room, scale * LEAST_ROOM)
    size = scale * present(context.preferences).ui_styles[0].widget.points

    def width(words: str) -> float:
        return paint.text_width(words, size)

    return "\n".join(line for each in text.splitlines() for line in broken(each, room, width))


def broken(text: str, room: float, width: Callable[[str], float]) -> Iterator[str]:
    """A paragraph in lines no wider than the room; a word that is wider has a line of its own."""
    line = ""
    for word in text.split():
        longer = f"{line} {word}" if line else word
        if line and width(longer) > room:
            yield line
            longer = word
        line = longer
    yield line
