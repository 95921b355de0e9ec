"""Menus: *Hangtime* in the viewport's Object and Pose menus, where F3 finds it; those of lists."""

from contextlib import ExitStack

import bpy

from ...bridge.accessors import present
from ...bridge.constraint_kinds import KINDS, cone, contact_force, torque_limit
from ...bridge.constraints.bone_presets import preset_names
from ...bridge.rows.choices import BodyKind, SurfaceRole
from ...bridge.rows.kind import Icon, MenuGroup
from ...operators.names import OperatorId
from .lists import ICONS, ROLE_ICONS


class AddConstraintMenu(bpy.types.Menu):
    bl_idname = "HANGTIME_MT_add_constraint"
    bl_label = "Add Constraint"
    bl_description = "Add a constraint about the selected pose bones and the current frame"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = present(self.layout)
        for group in MenuGroup:
            for kind in (kind for kind in KINDS.values() if kind.menu is group):
                entry = layout.operator(OperatorId.ADD_CONSTRAINT, text=kind.label, icon=kind.icon)
                entry.kind = kind.name
            layout.separator()
        layout.menu(PresetsMenu.bl_idname, icon="PRESET")


class BonePresetsMenu(bpy.types.Menu):
    bl_idname = "HANGTIME_MT_bone_presets"
    bl_label = "Bone Presets"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = present(self.layout)
        names = preset_names()
        for name in names:
            layout.operator(OperatorId.APPLY_BONE_PRESET, text=name).name = name
        if names:
            layout.separator()
        layout.operator(OperatorId.SAVE_BONE_PRESET, icon="ADD")
        layout.operator(OperatorId.IMPORT_BONE_PRESET, icon="IMPORT")
        layout.operator(OperatorId.EXPORT_BONE_PRESET, icon="EXPORT")
        if names:
            layout.menu(RemoveBonePresetMenu.bl_idname, icon="REMOVE")


class RemoveBonePresetMenu(bpy.types.Menu):
    bl_idname = "HANGTIME_MT_remove_bone_preset"
    bl_label = "Remove Preset"

    def draw(self, _context: bpy.types.Context) -> None:
        for name in preset_names():
            present(self.layout).operator(OperatorId.REMOVE_BONE_PRESET, text=name).name = name


class PresetsMenu(bpy.types.Menu):
    bl_idname = "HANGTIME_MT_presets"
    bl_label = "Add Preset"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = present(self.layout)
        layout.operator(OperatorId.JOINT_LIMITS, icon=cone.KIND.icon)
        layout.operator(OperatorId.JOINT_STRENGTH, icon=torque_limit.KIND.icon)
        layout.separator()
        layout.operator(OperatorId.SOFT_LANDING, icon=contact_force.KIND.icon)
        layout.operator(OperatorId.LIMP_LIMB, icon=torque_limit.KIND.icon)
        layout.operator(OperatorId.CARRY_WEIGHT, icon=ICONS[BodyKind.LOAD.name])


class ConstraintMoreMenu(bpy.types.Menu):
    bl_idname = "HANGTIME_MT_constraint_more"
    bl_label = "Constraint Specials"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = present(self.layout)
        layout.operator(OperatorId.COPY_CONSTRAINT, icon="DUPLICATE")
        layout.operator(OperatorId.ASSIGN_BONES, icon="RESTRICT_SELECT_OFF").of = "CONSTRAINTS"
        layout.operator(OperatorId.PLACE_CONSTRAINT, icon="CON_LOCLIKE")
        layout.separator()
        ranges: tuple[tuple[str, str, Icon], ...] = (
            ("FRAME", "Set Range to Current Frame", "KEYFRAME"),
            ("PHASE", "Set Range to Current Phase", "CENTER_ONLY"),
            ("PREVIEW", "Set Range to Preview Range", "PREVIEW_RANGE"),
        )
        for to, text, icon in ranges:
            layout.operator(OperatorId.SET_CONSTRAINT_RANGE, text=text, icon=icon).to = to
        layout.separator()
        layout.menu(PresetsMenu.bl_idname, icon="PRESET")


class AddBodyChangeMenu(bpy.types.Menu):
    bl_idname = "HANGTIME_MT_add_body_change"
    bl_label = "Add Body Change"
    bl_description = "Add a weight, a limb or a shape of the selected pose bones"

    def draw(self, _context: bpy.types.Context) -> None:
        for kind in BodyKind:
            entry = present(self.layout).operator(
                OperatorId.ADD_BODY_CHANGE, text=kind.value, icon=ICONS[kind.name]
            )
            entry.kind = kind.name


class AddSurfaceMenu(bpy.types.Menu):
    bl_idname = "HANGTIME_MT_add_surface"
    bl_label = "Add Surface"
    bl_description = "Let objects of the scene be solid"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = present(self.layout)
        for collection, what in ((False, "Selected"), (True, "Active Collection")):
            for role in SurfaceRole:
                text = f"{what} as {role.value}"
                icon: Icon = "OUTLINER_COLLECTION" if collection else ROLE_ICONS[role.name]
                entry = layout.operator(OperatorId.ADD_SURFACES, text=text, icon=icon)
                entry.role, entry.collection = role.name, collection
            layout.separator()


GROUPS: tuple[tuple[OperatorId | type[bpy.types.Menu], ...], ...] = (
    (OperatorId.FIND_BONES, OperatorId.EXAMINE, OperatorId.REPAIR_ALL, OperatorId.ANALYZE),
    (
        OperatorId.ADD_CONTACT,
        OperatorId.DRAG_PIN,
        OperatorId.TURN_STANCE,
        OperatorId.PLACE_BY_EMPTY,
        OperatorId.PUT_BACK,
    ),
    (AddConstraintMenu, AddBodyChangeMenu, AddSurfaceMenu),
    (OperatorId.ADD_SUPPORT_BOX, OperatorId.ADD_OFFERED_CONTACTS, OperatorId.ADD_HOLDS),
    (
        OperatorId.ADAPT,
        OperatorId.REFINE,
        OperatorId.UPDATE,
        OperatorId.FIT,
        OperatorId.USE_BEST,
        OperatorId.CANCEL,
    ),
    (
        OperatorId.COMPARE,
        OperatorId.SHOW_RECORDING,
        OperatorId.SHOW_ADAPTED,
        OperatorId.ACCEPT,
        OperatorId.DISCARD,
        OperatorId.SHOW_REPORT,
    ),
    (
        OperatorId.EXPORT,
        OperatorId.EXPORT_RECIPE,
        OperatorId.SAVE_PLOTS,
    ),
)


class HangtimeMenu(bpy.types.Menu):
    """All that is about the armature, or adds a row; what is about one row is beside that alone."""

    bl_idname = "HANGTIME_MT_hangtime"
    bl_label = "Hangtime"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = present(self.layout)
        for group in GROUPS:
            for entry in group:
                if isinstance(entry, OperatorId):
                    layout.operator(entry)
                else:
                    layout.menu(entry.bl_idname)
            layout.separator()


def add(undo: ExitStack) -> None:
    """Appends the menu, until `undo` is closed."""
    for menu in (bpy.types.VIEW3D_MT_object, bpy.types.VIEW3D_MT_pose):
        menu.append(_draw)
        undo.callback(menu.remove, _draw)


def _draw(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    layout = present(menu.layout)
    layout.separator()
    layout.menu(HangtimeMenu.bl_idname)
