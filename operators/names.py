"""Every name under which Blender knows a part of the extension."""

from enum import StrEnum

CATEGORY = "Hangtime"  # the sidebar's tab
COMMAND = "hangtime"  # blender --command hangtime


class OperatorId(StrEnum):
    """bl_idname of each operator; also bpy.ops.<name>."""

    ANALYZE = "hangtime.analyze"
    ADAPT = "hangtime.adapt"
    FIND_BONES = "hangtime.find_bones"
    FIT = "hangtime.fit"
    REFINE = "hangtime.refine"
    USE_BEST = "hangtime.use_best"
    CANCEL = "hangtime.cancel"
    ACCEPT = "hangtime.accept"
    DISCARD = "hangtime.discard"
    COMPARE = "hangtime.compare"
    SHOW_REPORT = "hangtime.show_report"
    EXPORT_FBX = "hangtime.export_fbx"
    EXPORT_GLTF = "hangtime.export_gltf"
    ADD_CONTACT = "hangtime.add_contact"
    REMOVE_CONTACT = "hangtime.remove_contact"
    DRAG_PIN = "hangtime.drag_pin"
    TURN_STANCE = "hangtime.turn_stance"
    DRAG_LIMIT = "hangtime.drag_limit"
    AIM_CONE = "hangtime.aim_cone"
    PLACE_BY_EMPTY = "hangtime.place_by_empty"
    PUT_BACK = "hangtime.put_back"
    SHOW_RECORDING = "hangtime.show_recording"
    SHOW_ADAPTED = "hangtime.show_adapted"
    DRAG_CONTACT_EDGE = "hangtime.drag_contact_edge"
    PICK_CONTACT = "hangtime.pick_contact"
    SAVE_PLOTS = "hangtime.save_plots"
    ADD_CONSTRAINT = "hangtime.add_constraint"
    REMOVE_CONSTRAINT = "hangtime.remove_constraint"
    COPY_CONSTRAINT = "hangtime.copy_constraint"
    MOVE_CONSTRAINT = "hangtime.move_constraint"
    SET_CONSTRAINT_RANGE = "hangtime.set_constraint_range"
    PLACE_CONSTRAINT = "hangtime.place_constraint"
    ASSIGN_BONES = "hangtime.assign_bones"
    ADD_BONE = "hangtime.add_bone"
    REMOVE_BONE = "hangtime.remove_bone"
    ADD_BODY_CHANGE = "hangtime.add_body_change"
    REMOVE_BODY_CHANGE = "hangtime.remove_body_change"
    JOINT_LIMITS = "hangtime.preset_joint_limits"
    JOINT_STRENGTH = "hangtime.preset_joint_strength"
    SOFT_LANDING = "hangtime.preset_soft_landing"
    LIMP_LIMB = "hangtime.preset_limp_limb"
    CARRY_WEIGHT = "hangtime.preset_carry_weight"


class PanelId(StrEnum):
    """bl_idname of each panel of the sidebar, from top to bottom."""

    CHARACTER = "HANGTIME_PT_character"
    BONES = "HANGTIME_PT_bones"
    RECORDING = "HANGTIME_PT_recording"
    CONTACTS = "HANGTIME_PT_contacts"
    STANCE = "HANGTIME_PT_stance"
    CONTACT = "HANGTIME_PT_contact"
    CONSTRAINTS = "HANGTIME_PT_constraints"
    CONSTRAINT = "HANGTIME_PT_constraint"
    BODY_CHANGES = "HANGTIME_PT_body_changes"
    SOLVE = "HANGTIME_PT_solve"
    ADVANCED = "HANGTIME_PT_advanced"
    RESULT = "HANGTIME_PT_result"
    EXPORT = "HANGTIME_PT_export"
    DISPLAY = "HANGTIME_PT_display"


class ListId(StrEnum):
    """bl_idname of each list."""

    CONTACTS = "HANGTIME_UL_contacts"
    CONSTRAINTS = "HANGTIME_UL_constraints"
    BODY_CHANGES = "HANGTIME_UL_body_changes"


class MenuId(StrEnum):
    """bl_idname of each menu."""

    HANGTIME = "HANGTIME_MT_hangtime"
    ADD_CONSTRAINT = "HANGTIME_MT_add_constraint"
    PRESETS = "HANGTIME_MT_presets"
    CONSTRAINT_MORE = "HANGTIME_MT_constraint_more"
    ADD_BODY_CHANGE = "HANGTIME_MT_add_body_change"


class GizmoGroupId(StrEnum):
    """bl_idname of each group of handles in the 3D viewport."""

    PINS = "HANGTIME_GGT_pins"
    LIMITS = "HANGTIME_GGT_limits"
