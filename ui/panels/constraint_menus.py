"""The menus of the lists: kinds to add, presets, and what else can be done with a row."""

from __future__ import annotations

import bpy

from ...bridge.properties.kinds import BodyKind, ConstraintKind
from ...operators.names import MenuId, OperatorId
from .constraint_lists import ICONS

GROUPS = (
    (ConstraintKind.POINT, ConstraintKind.POSE, ConstraintKind.ORIENTATION),
    (ConstraintKind.ANGLE, ConstraintKind.CONE, ConstraintKind.TWIST, ConstraintKind.TORQUE),
    (ConstraintKind.FORCE, ConstraintKind.LIFT),
    (ConstraintKind.TIMING, ConstraintKind.HOLD),
)


class AddConstraintMenu(bpy.types.Menu):
    bl_idname = MenuId.ADD_CONSTRAINT
    bl_label = "Add Constraint"
    bl_description = "Add a constraint about the selected pose bones and the current frame"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        for group in GROUPS:
            for kind in group:
                entry = layout.operator(
                    OperatorId.ADD_CONSTRAINT, text=kind.value, icon=ICONS[kind.name]
                )
                entry.kind = kind.name
            layout.separator()
        layout.menu(MenuId.PRESETS, icon="PRESET")


class PresetsMenu(bpy.types.Menu):
    bl_idname = MenuId.PRESETS
    bl_label = "Add Preset"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator(OperatorId.JOINT_LIMITS, icon=ICONS[ConstraintKind.CONE.name])
        layout.operator(OperatorId.JOINT_STRENGTH, icon=ICONS[ConstraintKind.TORQUE.name])
        layout.separator()
        layout.operator(OperatorId.SOFT_LANDING, icon=ICONS[ConstraintKind.FORCE.name])
        layout.operator(OperatorId.LIMP_LIMB, icon=ICONS[ConstraintKind.TORQUE.name])
        layout.operator(OperatorId.CARRY_WEIGHT, icon=ICONS[BodyKind.LOAD.name])


class ConstraintMoreMenu(bpy.types.Menu):
    bl_idname = MenuId.CONSTRAINT_MORE
    bl_label = "Constraint Specials"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator(OperatorId.COPY_CONSTRAINT, icon="DUPLICATE")
        layout.operator(OperatorId.ASSIGN_BONES, icon="RESTRICT_SELECT_OFF").of = "CONSTRAINTS"
        layout.operator(OperatorId.PLACE_CONSTRAINT, icon="CON_LOCLIKE")
        layout.separator()
        for to, text, icon in (
            ("FRAME", "Set Range to Current Frame", "KEYFRAME"),
            ("PHASE", "Set Range to Current Phase", "CENTER_ONLY"),
            ("PREVIEW", "Set Range to Preview Range", "PREVIEW_RANGE"),
        ):
            layout.operator(OperatorId.SET_CONSTRAINT_RANGE, text=text, icon=icon).to = to
        layout.separator()
        layout.menu(MenuId.PRESETS, icon="PRESET")


class AddBodyChangeMenu(bpy.types.Menu):
    bl_idname = MenuId.ADD_BODY_CHANGE
    bl_label = "Add Body Change"
    bl_description = "Add a weight or a limb of the selected pose bones"

    def draw(self, _context: bpy.types.Context) -> None:
        for kind in BodyKind:
            entry = self.layout.operator(
                OperatorId.ADD_BODY_CHANGE, text=kind.value, icon=ICONS[kind.name]
            )
            entry.kind = kind.name


CLASSES = (AddConstraintMenu, PresetsMenu, ConstraintMoreMenu, AddBodyChangeMenu)
