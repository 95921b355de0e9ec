"""Turn Stance: about the vertical by the mouse, while the motion follows as a ghost."""

from math import degrees, inf, radians

import bpy
import numpy as np
from mathutils import Vector

from ...bridge.properties.contact import HangtimeStance
from ...bridge.properties.settings import settings_of
from ...bridge.properties.stances import active_stance, stance_contacts, stance_middle
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import required_armature
from .drag_state import ANGLE_STEP, ValueDrag
from .follow_mixin import FollowedDrag
from .mouse import pixel, ray_at
from .rays import Circle, angle_about

NO_STANCE = "Choose a contact of the stance first"


class TurnStanceOperator(FollowedDrag, bpy.types.Operator):
    bl_idname = OperatorId.TURN_STANCE
    bl_label = "Turn Stance"
    bl_description = (
        "Turn the chosen contact's stance about the vertical while the motion follows as a ghost; "
        "letting go adapts"
    )
    bl_options = {"REGISTER", "UNDO", "BLOCKING"}
    key_hints = "0 to 9: degrees · Shift: finer · Ctrl: steps of 5° · Esc: back"

    by: bpy.props.FloatProperty(
        name="By", description="Counter-clockwise seen from above", subtype="ANGLE"
    )

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        """In scripts and for redo."""
        stance = active_stance(settings_of(required_armature(context)))
        if stance is None:
            return self.refuse(NO_STANCE)
        stance.turn += self.by
        return {"FINISHED"}

    def take(self, _context: bpy.types.Context) -> str | None:
        settings = settings_of(self._armature)
        stance = active_stance(settings)
        if stance is None or (middle := stance_middle(settings, stance.name)) is None:
            return NO_STANCE
        self._name = stance.name
        contacts = stance_contacts(settings, stance.name)
        radius = max((Vector(c.at) - middle).xy.length for c in contacts)
        x, y = np.eye(3)[:2]
        self._circle = Circle(np.array(middle.to_tuple()), x, y, max(radius, 1e-6))
        self._began: float | None = None  # rad, of where the mouse takes hold
        self._drag = ValueDrag(stance.turn, -inf, inf, ANGLE_STEP)
        return None

    def pull(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        if self._began is None:
            at = ray_at(context, self._press.at)
            self._began = self._angle = angle_about(at, self._circle, 0.0)
        self._angle = angle_about(ray_at(context, pixel(event)), self._circle, self._angle)
        self._stance.turn = self._drag.move(
            self._angle - self._began, precise=event.shift, snap=event.ctrl
        )

    def put_by(self, number: float) -> None:
        self._stance.turn = self._drag.set(radians(number))

    @property
    def held(self) -> str:
        there = stance_contacts(settings_of(self._armature), self._name)
        return next((row.name for row in there if row.used), "")

    def let_go(self) -> bool:
        self.by = self._drag.value - self._drag.start
        return self._drag.let_go()

    def put_back(self) -> None:
        self._stance.turn = self._drag.put_back()

    def text(self) -> str:
        turned = degrees(self._drag.value - self._drag.start)
        return f"{self._name} turned by {turned:+.1f}° to {degrees(self._drag.value):.1f}°"

    @property
    def _stance(self) -> HangtimeStance:
        stance: HangtimeStance = settings_of(self._armature).stances[self._name]
        return stance
