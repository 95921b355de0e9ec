"""Drag Pin: a contact's or a point's place by the mouse, while the motion follows as a ghost."""

import bpy
import numpy as np
from mathutils import Vector

from ...bridge.accessors import current_scene, present
from ...bridge.armature.poses import metres_per_unit
from ...bridge.properties.constraint import HangtimeConstraint
from ...bridge.properties.contact import HangtimeContact, HangtimeStance
from ...bridge.properties.settings import settings_of
from ...bridge.properties.stances import place, stance_contacts, stand_on, told_along
from ...bridge.scene.members import ground_members
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import required_armature
from . import rays
from .drag_state import Axis, PinDrag
from .follow_mixin import FollowedDrag
from .mouse import GIVEN, Pixel, pixel, pixel_of, ray_at
from .snapping import Snapping

FLAT = 0.3  # of the view's direction along the vertical: below, the ground is seen edge-on
FARTHEST = 2.0  # times as far from the viewer as where it began: no farther towards the horizon
UP = Vector((0.0, 0.0, 1.0))
KEY_HINTS = (
    "X Y Z: axis · 0 to 9: metres along it, or {} · Shift: finer · "
    "Ctrl: steps, off surfaces · Esc: back"
)
SHIFTS = ("Forward", "Left", "Up")  # along a stance's axes
NO_PIN = "There is no such contact or point"
BEHIND = "Turn the view so that the pin is in front of you"

Standing = tuple[Vector, bpy.types.Object | None]  # where a contact is, and on what


class DragPinOperator(FollowedDrag, bpy.types.Operator):
    bl_idname = OperatorId.DRAG_PIN
    bl_label = "Drag Pin"
    bl_description = (
        "Move a contact (with its foot or its stance, as Moves says) or a point while the motion "
        "follows as a ghost; letting go adapts. A click chooses it in its list"
    )
    bl_options = {"REGISTER", "UNDO", "BLOCKING", "GRAB_CURSOR"}

    contact: bpy.props.IntProperty(
        name="Contact",
        description="Its place in the list; the chosen one if below 0",
        default=-1,
        options={"SKIP_SAVE"},
    )
    constraint: bpy.props.IntProperty(
        name="Constraint",
        description="A point in the list of constraints instead of a contact, if not below 0",
        default=-1,
        options={"SKIP_SAVE"},
    )
    whole: bpy.props.BoolProperty(
        name="Whole Stance",
        description="Move every contact of the phase, or if off this one alone; as Moves says "
        "where it is not given",
        options={"SKIP_SAVE"},
    )
    axis: bpy.props.EnumProperty(
        name="Axis",
        description="What the drag is held to at first",
        items=[("NONE", "None", "Over the ground"), *((a.name, a.name, "") for a in Axis)],
        options=GIVEN,
    )
    shift: bpy.props.FloatVectorProperty(
        name="Shift", description="How far, in the world", subtype="TRANSLATION", unit="LENGTH"
    )
    ground: bpy.props.StringProperty(
        name="On",
        description="The ground that the contact stands on afterwards, by its object's name",
        options={"SKIP_SAVE"},
    )

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        """In scripts and for redo: the pin moves by `shift`."""
        self._armature = required_armature(context)
        if self._find_row() is None:
            return self.refuse(NO_PIN)
        self._put(Vector(self._place) + Vector(self.shift), self.ground)
        return {"FINISHED"}

    def take(self, context: bpy.types.Context) -> str | None:
        if self._find_row() is None:
            return NO_PIN
        self._metres = metres_per_unit(present(context.scene))
        x, y, z = (self._metres * each for each in self._place)
        row, axis = self._row, Axis.__members__.get(self.axis)
        self._snapping: Snapping | None = None
        if not isinstance(row, HangtimeConstraint):
            self._snapping = Snapping.of(self._armature, row, present(context.scene))
        self._drag = PinDrag((x, y, z), axis)
        if self._snapping is not None:
            self._drag.lands, self._drag.floor = self._snapping.lands, self._snapping.floor
        sight = present(context.region_data).view_rotation @ UP
        self._ground = abs(sight.z) > FLAT
        self._normal = UP if self._ground else sight
        seen_at = pixel_of(context, self._place)
        if seen_at is None:
            return BEHIND
        self._pixel = seen_at
        self._was = self._remembered()
        self._choose()
        return None

    def press(self, event: bpy.types.Event) -> bool:
        if event.type not in Axis.__members__:
            return False
        self._drag.key(Axis[event.type])
        return self._press.dragging

    def pull(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        # As if the mouse had taken hold of the pin itself, wherever it did.
        ways = zip(self._pixel, pixel(event), self._press.at, strict=True)
        across, up = (pin + to - began for pin, to, began in ways)
        now = self._aim(context, (across, up), surfaces=not event.ctrl)
        if now is None:
            return  # above the horizon: it stays where it is
        x, y, z = (float(each) for each in self._metres * now - np.array(self._drag.start))
        to = self._drag.move((x, y, z), precise=event.shift, snap=event.ctrl)
        self._put(Vector(to) / self._metres, self._standing)

    def put_by(self, number: float) -> None:
        x, y, z = (number * each for each in self._typed_way)
        self._put(Vector(self._drag.set((x, y, z))) / self._metres, self._standing)

    @property
    def _typed_way(self) -> tuple[float, ...]:
        """Where numbers lead, world: along the axis, else the first that the header tells."""
        axis, stance = self._drag.axis, self._stance
        if axis is not None:
            return tuple(float(i == axis.value) for i in range(3))
        return (1.0, 0.0, 0.0) if stance is None else tuple(stance.forward_axis)

    @property
    def held(self) -> str:
        row = self._row
        return row.name if isinstance(row, HangtimeContact) else ""

    def let_go(self) -> bool:
        moved, self.ground = self._drag.let_go(), self._standing
        self.shift = Vector(self._drag.shift) / self._metres
        if self._press.dragging and not moved:  # along Z, or in steps, it stands on nothing
            self._restore()
        return moved

    def put_back(self) -> None:
        self._drag.put_back()
        settings = settings_of(self._armature)
        settings.active_contact, settings.active_constraint = self._was[:2]
        self._restore()

    def _restore(self) -> None:
        """Puts places, and what is stood on, back."""
        settings = settings_of(self._armature)
        places, point = self._was[2:]
        for index, (at, on) in places.items():
            place(settings, settings.contacts[index], at.to_tuple(), whole=False)
            settings.contacts[index].on = on
        row = self._row
        if isinstance(row, HangtimeConstraint):
            row.use_place, row.place = point

    def chosen(self) -> bool:
        settings = settings_of(self._armature)
        return (settings.active_contact, settings.active_constraint) != self._was[:2]

    @property
    def key_hints(self) -> str:
        return KEY_HINTS.format("along X" if self._stance is None else "forward")

    def text(self) -> str:
        shift, stance = self._drag.shift, self._stance
        names: tuple[str, ...] = ("X", "Y", "Z")
        if stance is not None:
            names, shift = SHIFTS, told_along(stance, shift)
        # Without adding zero there would be one with a minus.
        moved = (f"{name} {round(by, 3) + 0.0:.3f}" for name, by in zip(names, shift, strict=True))
        way = f"Along {self._drag.axis.name}: " if self._drag.axis is not None else ""
        standing = f" · on {self._standing}" if self._standing else ""
        return f"{way}{' · '.join(moved)} m from here{standing}"

    # -- where ---------------------------------------------------------------------------------

    @property
    def _row(self) -> HangtimeContact | HangtimeConstraint:
        row = self._find_row()
        assert row is not None
        return row

    @property
    def _stance(self) -> HangtimeStance | None:
        """Along whose axes it is told how far a contact is moved; None of a point."""
        row = self._row
        if isinstance(row, HangtimeConstraint):
            return None
        stance: HangtimeStance | None = settings_of(self._armature).stances.get(row.phase)
        return stance

    def _find_row(self) -> HangtimeContact | HangtimeConstraint | None:
        settings = settings_of(self._armature)
        if self.constraint >= 0:
            rows, index = settings.constraints, self.constraint
        else:
            rows = settings.contacts
            index = self.contact if self.contact >= 0 else settings.active_contact
        return rows[index] if 0 <= index < len(rows) else None

    @property
    def _place(self) -> tuple[float, ...]:
        """Blender units, world."""
        row = self._row
        return tuple(row.place if isinstance(row, HangtimeConstraint) else row.at)

    def _put(self, to: Vector, ground: str) -> None:
        row, settings = self._row, settings_of(self._armature)
        if isinstance(row, HangtimeConstraint):
            row.use_place, row.place = True, to
            return
        place(settings, row, to.to_tuple(), whole=self._whole)
        members = ground_members(settings, current_scene())
        on = next((each.object for each in members if each.name == ground), None)
        stand_on(settings, row, on, whole=self._whole)

    @property
    def _whole(self) -> bool | None:
        """As of `place`; None where nobody said."""
        return self.whole if self.properties.is_property_set("whole") else None

    def _remembered(self) -> tuple[int, int, dict[int, Standing], tuple[bool, Vector]]:
        """State to restore: what is chosen, contacts' places, the point's."""
        settings, row = settings_of(self._armature), self._row
        places, point = {}, (False, Vector())
        if isinstance(row, HangtimeConstraint):
            point = (row.use_place, Vector(row.place))
        else:
            contacts = stance_contacts(settings, row.phase)
            places = {settings.contacts.find(c.name): (Vector(c.at), c.on) for c in contacts}
        return settings.active_contact, settings.active_constraint, places, point

    def _choose(self) -> None:
        settings = settings_of(self._armature)
        if self.constraint >= 0:
            settings.active_constraint = self.constraint
        elif self.contact >= 0:
            settings.active_contact = self.contact

    @property
    def _standing(self) -> str:
        """The ground that the pin is on; empty where it is on none."""
        landing = self._drag.landing
        return landing.ground if landing is not None else ""

    def _aim(self, context: bpy.types.Context, at: Pixel, *, surfaces: bool) -> rays.Vector | None:
        """The place under a pixel on a surface, the ground, the plane that faces the viewer, or the
        axis through the pin; Blender units, world. None where it points at none of that."""
        ray = ray_at(context, at)
        start = np.array(self._drag.start) / self._metres
        if self._drag.axis is not None:
            axis = rays.unit([float(i == self._drag.axis.value) for i in range(3)])
            distance = rays.along_line(ray, start, axis)
            return start + distance * axis if distance is not None else None
        if surfaces and self._snapping is not None:
            seen = self._snapping.seen(ray)
            if seen is not None:
                return np.array([*seen, start[2]])  # landing gives the height
        return rays.on_plane(ray, start, self._normal.to_tuple(), FARTHEST)
