"""The bars' draw handler, and the mouse's way to their edges."""

from contextlib import ExitStack

import bpy

from ...bridge.accessors import present
from ...operators.names import OperatorId
from ...operators.timeline.timeline_bars import bars_in
from ..drawing import paint
from ..drawing.cache import ContentCache
from .drawing import STROKE, drawn

KEYMAP = "Dopesheet"  # the timeline's, too
# Those that are added last are asked first: edges before bars.
CLICKED = (OperatorId.PICK_CONTACT, OperatorId.DRAG_CONTACT_EDGE)


def add(undo: ExitStack) -> None:
    """Shows bars in timelines and dope sheets, to be dragged, until `undo` is closed."""
    overlay = BarOverlay()
    space = bpy.types.SpaceDopeSheetEditor
    handle = space.draw_handler_add(overlay.draw, (), "WINDOW", "POST_PIXEL")
    undo.callback(space.draw_handler_remove, handle, "WINDOW")
    configuration = present(bpy.context.window_manager).keyconfigs.addon
    if configuration is None:  # Blender without an interface
        return
    keymap = configuration.keymaps.new(name=KEYMAP, space_type="DOPESHEET_EDITOR")
    for operator in CLICKED:
        item = keymap.keymap_items.new(operator, "LEFTMOUSE", "PRESS")
        undo.callback(keymap.keymap_items.remove, item)


class BarOverlay:
    """Draws the bars; what it prepares is remembered for each content and zoom."""

    def __init__(self) -> None:
        self._drawings = ContentCache[paint.DrawingBatches](paint.CACHED_DRAWINGS)
        self._compiled = False

    def draw(self) -> None:
        """Called by Blender for each timeline and dope sheet."""
        context = bpy.context
        if not self._compiled:  # beforehand, as what first shows bars has enough to do
            paint.compile_shaders(present(context.region))
            self._compiled = True
        bars = bars_in(context)
        if bars is None:
            return
        drawing = self._drawings.get(
            "bars", bars, lambda: paint.upload(drawn(bars, paint.text_width))
        )
        paint.paint(drawing, present(context.region), STROKE * bars.scale)
