"""Modal drag of a joint limit's handle in the viewport.

The handles (ui/gizmos) say where a limit is drawn; what the mouse does there is the same for all.
"""

import bpy

from ...bridge.accessors import present
from ...bridge.properties.constraint import HangtimeConstraint
from ...bridge.properties.settings import settings_of
from ..operator_types import OperatorResult, PolledOperator
from ..solve.common import EDIT_MODE, chosen_armature, required_armature
from ..solve.live import clear_header, redraw_viewports
from ..solve.session import session
from ..solve.task import clear_status, closes
from .mouse import BACK, CONFIRM, GIVEN, Press

KEY_HINTS = "Shift: finer · Ctrl: in steps of 5° · Esc: back"
NO_LIMIT = "There is no such joint limit or cone"
BY_HANDLES = "Drag the limit's handles in a 3D viewport"


class LimitDrag(PolledOperator):
    """Mixin of modal operators that change a limit of a joint."""

    constraint: bpy.props.IntProperty(
        name="Constraint", description="Its place in the list", options=GIVEN
    )
    centre: bpy.props.FloatVectorProperty(description="The joint, world", options=GIVEN)

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        armature = chosen_armature(context)
        if armature is None or not len(settings_of(armature).constraints):
            return NO_LIMIT
        return EDIT_MODE if armature.mode == "EDIT" else None

    # -- what is dragged -----------------------------------------------------------------------

    def take(self, context: bpy.types.Context) -> bool:
        """The mouse takes hold; whether it can."""
        raise NotImplementedError

    def pull(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        """The mouse is elsewhere."""
        raise NotImplementedError

    def put_back(self, row: HangtimeConstraint) -> None:
        """All is as it was."""
        raise NotImplementedError

    def let_go(self) -> bool:
        """The mouse lets go; whether anything has changed."""
        raise NotImplementedError

    def text(self) -> str:
        """The present value, for the header."""
        raise NotImplementedError

    # -- Blender's way -------------------------------------------------------------------------

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        self._armature = required_armature(context)
        self._press = Press.of(context, event, click=True)
        row = self.find_row()
        if row is None or context.region_data is None or not self.take(context):
            return self.refuse(NO_LIMIT if row is None else BY_HANDLES)
        self._found = (row.met, row.status)
        self._area, self._window = present(context.area), present(context.window)
        session().status_bar.say(KEY_HINTS)
        present(context.window_manager).modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        if self.find_row() is None:  # a script removed it
            self._leave()
            return {"CANCELLED"}
        pressed = event.value == "PRESS"
        gone = context.region_data is None  # its viewport, or another workspace is shown
        if gone or (event.type in BACK and pressed):
            self.cancel(context)
            return {"CANCELLED"}
        released = event.type == "LEFTMOUSE" and event.value == "RELEASE"
        if released or (event.type in CONFIRM and pressed):
            self._leave()
            return {"FINISHED"} if self.let_go() else {"CANCELLED"}
        if event.type == "MOUSEMOVE" and self._press.drags(context, event):
            self.pull(context, event)
            self._area.header_text_set(f"{self.row.name}: {self.text()}")
            redraw_viewports()
        return {"RUNNING_MODAL"}

    def cancel(self, _context: bpy.types.Context) -> None:
        """Also called by Blender when it opens another file or quits meanwhile."""
        row = self.find_row()
        if row is not None:
            self.put_back(row)
            row.met, row.status = self._found
        self._leave()

    def _leave(self) -> None:
        clear_header(self._area)
        redraw_viewports()
        clear_status(window_closes=closes(self._window))

    @property
    def row(self) -> HangtimeConstraint:
        """The constraint, while it is there."""
        return present(self.find_row())

    def find_row(self) -> HangtimeConstraint | None:
        """The constraint; None where a script removed it, or its armature."""
        try:
            rows = settings_of(self._armature).constraints
        except ReferenceError:
            return None
        return rows[self.constraint] if 0 <= self.constraint < len(rows) else None
