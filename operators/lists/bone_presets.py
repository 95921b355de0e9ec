"""Bone presets: saved, applied, brought from other machines and taken there."""

from collections.abc import Mapping
from pathlib import Path

import bpy
from bpy_extras.io_utils import ExportHelper, ImportHelper

from ...bridge.accessors import present
from ...bridge.constraints.bone_mapping import choose_parts, find_parts
from ...bridge.constraints.bone_presets import (
    SUFFIX,
    free_preset_name,
    is_preset,
    mapped_bones,
    preset_path,
    read_preset,
    write_preset,
)
from ...bridge.properties.settings import settings_of
from ..names import OperatorId
from ..operator_types import FROM_BLEND, OperatorResult
from ..solve.common import NO_FILE, FaultyOperator, chosen_armature, required_armature

NO_ARMATURE = "Choose or select an armature first"
THERE_ALREADY = "There is a bone preset “{}” already: choose another name, or tick Replace"
NO_PRESET = "There is no bone preset “{}”"
NO_BONES = "No bones are mapped: press Find Bones, or choose them"
MOST_NAMED = 4  # in a message


class _BonePreset(FaultyOperator):
    """Mixin: needs an armature."""

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return NO_ARMATURE if chosen_armature(context) is None else None

    def apply(self, context: bpy.types.Context, bones: Mapping[str, str], name: str) -> None:
        """Lets the bones move their parts, and says what the armature lacks."""
        lacking = choose_parts(required_armature(context), bones)
        if lacking:
            more = len(lacking) - MOST_NAMED
            listed = ", ".join(lacking[:MOST_NAMED]) + (f" and {more} more" if more > 0 else "")
            self.report({"WARNING"}, f"“{name}” names bones that this armature lacks: {listed}")
        else:
            self.report({"INFO"}, f"Mapped {len(bones)} bones by “{name}”")


class SaveBonePresetOperator(_BonePreset, bpy.types.Operator):
    bl_idname = OperatorId.SAVE_BONE_PRESET
    bl_label = "Save Bone Preset"
    bl_description = "Keep which bone moves which part of the body, for other armatures like this"

    name: bpy.props.StringProperty(name="Name", default="My Rig")
    replace: bpy.props.BoolProperty(
        name="Replace", description="Overwrite the preset of that name", options={"SKIP_SAVE"}
    )

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> OperatorResult:
        return present(context.window_manager).invoke_props_dialog(self)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = present(self.layout)
        layout.prop(self, "name")
        if self._is_there():
            layout.label(text=f"There is a preset “{self.name}” already", icon="ERROR")
            layout.prop(self, "replace")

    def _is_there(self) -> bool:
        return is_preset(self.name)

    def run(self, context: bpy.types.Context) -> OperatorResult:
        bones = _mapped(context)
        if not bones or not self.name.strip():
            return self.refuse(NO_BONES if not bones else "A preset needs a name")
        if self._is_there() and not self.replace:
            return self.refuse(THERE_ALREADY.format(self.name))
        write_preset(preset_path(self.name), bones)
        self.report({"INFO"}, f"Saved the bone preset “{self.name}”")
        return {"FINISHED"}


class ApplyBonePresetOperator(_BonePreset, bpy.types.Operator):
    bl_idname = OperatorId.APPLY_BONE_PRESET
    bl_label = "Apply Bone Preset"
    bl_description = "Let the bones of this preset move the parts of the body"
    bl_options = {"REGISTER", "UNDO"}

    name: bpy.props.StringProperty(name="Name")

    def run(self, context: bpy.types.Context) -> OperatorResult:
        if not is_preset(self.name):
            return self.refuse(NO_PRESET.format(self.name))
        self.apply(context, read_preset(preset_path(self.name)), self.name)
        return {"FINISHED"}


class RemoveBonePresetOperator(FaultyOperator, bpy.types.Operator):
    bl_idname = OperatorId.REMOVE_BONE_PRESET
    bl_label = "Remove Bone Preset"
    bl_description = "Delete the file of this bone preset"

    name: bpy.props.StringProperty(name="Name")

    @classmethod
    def obstacle(cls, _context: bpy.types.Context) -> str | None:
        return None

    def run(self, _context: bpy.types.Context) -> OperatorResult:
        if not is_preset(self.name):
            return self.refuse(NO_PRESET.format(self.name))
        preset_path(self.name).unlink()
        self.report({"INFO"}, f"Removed the bone preset “{self.name}”")
        return {"FINISHED"}


# The stubs take `check` and `invoke` of the mixins for functions that return nothing.
class ImportBonePresetOperator(_BonePreset, bpy.types.Operator, ImportHelper):  # type: ignore[misc]
    bl_idname = OperatorId.IMPORT_BONE_PRESET
    bl_label = "Import Bone Preset"
    bl_description = "Apply the bone preset in a file, or a recipe's bones, and keep it"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = SUFFIX
    filepath: bpy.props.StringProperty(subtype="FILE_PATH", options=FROM_BLEND)
    filter_glob: bpy.props.StringProperty(default=f"*{SUFFIX}", options={"HIDDEN"})

    def run(self, context: bpy.types.Context) -> OperatorResult:
        if not bpy.path.basename(self.filepath):
            return self.refuse(NO_FILE)
        path = Path(bpy.path.abspath(self.filepath))
        bones = read_preset(path)
        name = free_preset_name(path.stem, bones)
        write_preset(preset_path(name), bones)
        self.apply(context, bones, name)
        return {"FINISHED"}


class ExportBonePresetOperator(_BonePreset, bpy.types.Operator, ExportHelper):  # type: ignore[misc]
    bl_idname = OperatorId.EXPORT_BONE_PRESET
    bl_label = "Export Bone Preset"
    bl_description = "Write which bone moves which part of the body into a file, to hand on"

    filename_ext = SUFFIX
    filepath: bpy.props.StringProperty(subtype="FILE_PATH", options=FROM_BLEND)
    filter_glob: bpy.props.StringProperty(default=f"*{SUFFIX}", options={"HIDDEN"})

    def run(self, context: bpy.types.Context) -> OperatorResult:
        bones = _mapped(context)
        if not bones:
            return self.refuse(NO_BONES)
        if not bpy.path.basename(self.filepath):
            return self.refuse(NO_FILE)
        path = Path(bpy.path.abspath(self.filepath)).with_suffix(SUFFIX)
        write_preset(path, bones)
        self.report({"INFO"}, f"Exported {path.name}")
        return {"FINISHED"}


def _mapped(context: bpy.types.Context) -> dict[str, str]:
    """What the panel shows; what is found by itself, where nothing was looked for yet."""
    armature = required_armature(context)
    settings = settings_of(armature)
    if not settings.parts:
        find_parts(armature)
    return mapped_bones(settings)
