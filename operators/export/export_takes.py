"""Export: accepted results as takes of one file, for a game engine or another program."""

from pathlib import Path

import bpy

from ...bridge.accessors import armature_data, present
from ...bridge.exports.engines import ENDINGS, format_of
from ...bridge.exports.export import export_takes
from ...bridge.exports.writers import usd_name
from ...bridge.libraries import lost_character
from ...bridge.properties.action import action_settings
from ...bridge.properties.settings import settings_of
from ...bridge.recipe.export import ExportOptions
from ...bridge.results.combined import bake_shown
from ...bridge.results.look_again import unphysical_since
from ...bridge.rows.choices import Engine, FileFormat, RootMotion
from ...bridge.takes.takes import takes_of
from ...solver.data.faults import Fault, OutputNotWritable
from ..names import OperatorId
from ..operator_types import FROM_BLEND, OperatorResult
from ..solve.common import (
    TWEAK_MODE,
    FaultyOperator,
    chosen_armature,
    required_armature,
    said,
    tweaked,
)
from ..solve.results import performer_of, required_result
from .skin_text import skin_text
from .take_files import take_files

NO_NAME = "no file name is given"
NOT_ACCEPTED = "Accept a result first; what is exported are accepted results"
SCENE_LINKED = (
    "The scene is linked, and nothing can be added to it for the export; open its own file, or "
    "link the character into a scene of this one"
)
SHOWN_NOT_ACCEPTED = "The result that is shown is not accepted; accept it, or choose All Accepted"
NONE_ITS_OWN = "No accepted result is {}'s, which performs the one that is shown; show one"
LEFT_OUT = "; left out, as another armature performs them: {}"
UNPHYSICAL = "; {}: {}"
RENAMED = "; USD names have letters and digits alone, so {} bones are called otherwise in it"

ENGINES = (
    ("NONE", "None", "As the armature is in Blender; a single take keeps its frames"),
    ("UNREAL", "Unreal", "Centimetres, Z up, no bone for the armature, one root bone"),
    ("UNITY", "Unity", "Metres, Y up, no turn or scale on the armature"),
    ("GODOT", "Godot", "Metres, Y up; takes that repeat are called so that Godot repeats them"),
)
FORMATS = (
    ("BEST", "Best", "What the engine reads best: glTF for Godot, FBX for others"),
    ("FBX", "FBX", "Autodesk's exchange format, binary"),
    ("GLTF", "glTF", "Khronos' transmission format, one binary file"),
    ("USD", "USD", "Universal Scene Description, as text; it holds one take"),
)
ROOTS = (
    ("AS_IT_IS", "As It Is", "What carries it in Blender"),
    (
        "ROOT_BONE",
        "Root Bone",
        "A root bone stays under the hips on the floor and turns with them; one is added where "
        "the armature has none. The motion is the same",
    ),
    ("IN_PLACE", "In Place", "Left out; the figure stays where it stands at rest"),
)
TAKES = (
    ("SHOWN", "This Result", "The result that is shown"),
    ("ACCEPTED", "All Accepted", "Every result with a tick, each as a take of its own"),
    (
        "FILES",
        "A File for Each",
        "Every result with a tick, each in a file of its own that is called after it. Files that "
        "are there under these names are replaced",
    ),
)


class ExportTakesOperator(FaultyOperator, bpy.types.Operator):
    bl_idname = OperatorId.EXPORT
    bl_label = "Export"
    bl_description = (
        "Write the armature with accepted results as FBX, glTF or USD, with a key on every frame, "
        "as a game engine wants it. The scene stays as it is"
    )
    bl_options = {"PRESET"}

    filepath: bpy.props.StringProperty(subtype="FILE_PATH", options=FROM_BLEND)
    check_existing: bpy.props.BoolProperty(default=True, options={"HIDDEN"})
    filter_glob: bpy.props.StringProperty(
        default=";".join(f"*{ending}" for ending in ENDINGS.values()), options={"HIDDEN"}
    )
    engine: bpy.props.EnumProperty(name="Engine", description="For whom the file is", items=ENGINES)
    format: bpy.props.EnumProperty(name="Format", description="Of the file", items=FORMATS)
    takes: bpy.props.EnumProperty(name="Takes", description="What goes into it", items=TAKES)
    root: bpy.props.EnumProperty(
        name="Travel", description="What carries the way over the floor", items=ROOTS
    )
    skin: bpy.props.BoolProperty(
        name="Skin", description="Write the meshes that the bones deform, too"
    )
    at_origin: bpy.props.BoolProperty(
        name="Begin at Origin",
        description="Takes begin where the figure stands at rest, facing as it does there: moved "
        "and turned on the floor as wholes",
    )

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        armature = chosen_armature(context)
        if armature is None or not _accepted(armature):
            return NOT_ACCEPTED
        lost = lost_character(armature)
        if lost is not None:
            return said(lost)
        if not present(context.scene).is_editable:
            return SCENE_LINKED
        return TWEAK_MODE if tweaked(armature) else None

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> OperatorResult:
        folder = Path(bpy.data.filepath).parent if bpy.data.filepath else Path.home()
        name = _default_name(context, self.takes)
        self.filepath = str(folder / f"{name}{ENDINGS[format_of(self._options())]}")
        present(context.window_manager).fileselect_add(self)
        return {"RUNNING_MODAL"}

    def draw(self, _context: bpy.types.Context) -> None:
        layout = present(self.layout)
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("engine", "format", "takes", "root", "at_origin", "skin"):
            layout.prop(self, name)

    def check(self, context: bpy.types.Context) -> bool:
        """Let the name end as the chosen format's files do, and a name of ours fit the choice."""
        if not bpy.path.basename(self.filepath):  # a folder's name is not to end so
            return False
        path = Path(self.filepath)
        path = path.with_suffix("") if path.suffix.lower() in ENDINGS.values() else path
        if path.name in {_default_name(context, takes) for takes in ("SHOWN", "FILES")}:
            path = path.with_name(_default_name(context, self.takes))
        wanted = f"{path}{ENDINGS[format_of(self._options())]}"
        changed = bool(wanted != self.filepath)
        self.filepath = wanted
        return changed

    def run(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        if not bpy.path.basename(self.filepath):
            raise OutputNotWritable(self.filepath, NO_NAME)
        accepted, shown = _accepted(armature), required_result(context)
        if self.takes == "SHOWN" and shown not in accepted:
            return self.refuse(SHOWN_NOT_ACCEPTED)
        chosen = [shown] if self.takes == "SHOWN" else accepted
        performer = performer_of(armature)
        taken = [take for take in chosen if _performer(take, armature) == performer]
        if not taken:
            return self.refuse(NONE_ITS_OWN.format(performer.name))
        for take in taken:
            bake_shown(performer, take)
        options = self._options(bpy.path.abspath(self.filepath))
        ending = ENDINGS[format_of(options)]
        path = Path(bpy.path.ensure_ext(bpy.path.abspath(self.filepath), ending))
        files = {path: taken}
        if self.takes == "FILES":
            files = {file: [take] for file, take in take_files(path, taken, options.engine).items()}
        written: list[str] = []
        for file, held in files.items():
            try:
                skin = export_takes(performer, held, file, options, _pelvis(armature, performer))
            except Fault:
                if written:
                    self.report({"INFO"}, f"Exported {', '.join(written)}")
                raise
            written.append(file.name)
        left_out = [take.name for take in chosen if take not in taken]
        since = {take.name: unphysical_since(armature, take) for take in taken}
        said = ", ".join(written) + (skin_text(skin) if options.skin else "")
        self._tell(performer, said, options, left_out, since)
        return {"FINISHED"}

    def _options(self, path: str = "") -> ExportOptions:
        """As chosen; without a choice the format that a path's ending tells, else the engine's."""
        told = next((form for form, ending in ENDINGS.items() if path.endswith(ending)), None)
        form = told if self.format == "BEST" else FileFormat[self.format]
        root = RootMotion[self.root]
        return ExportOptions(Engine[self.engine], form, root, self.skin, self.at_origin)

    def _tell(
        self,
        performer: bpy.types.Object,
        name: str,
        options: ExportOptions,
        left_out: list[str],
        unphysical: dict[str, str],
    ) -> None:
        said = f"Exported {name}"
        if left_out:
            said += LEFT_OUT.format(", ".join(left_out))
        if format_of(options) is FileFormat.USD:
            renamed = [b for b in present(performer.pose).bones if usd_name(b.name) != b.name]
            said += RENAMED.format(len(renamed)) if renamed else ""
        said += "".join(UNPHYSICAL.format(take, why) for take, why in unphysical.items() if why)
        self.report({"WARNING"} if any(unphysical.values()) else {"INFO"}, said)


def _default_name(context: bpy.types.Context, takes: str) -> str:
    """Of a file: the shown result's; the armature's where takes get names of their own after it."""
    each = takes == "FILES"
    return bpy.path.clean_name((required_armature if each else required_result)(context).name)


def _accepted(armature: bpy.types.Object) -> list[bpy.types.Action]:
    """The results with a tick, in the order of the list of takes."""
    return [t.action for t in takes_of(armature) if action_settings(t.action).accepted]


def _pelvis(armature: bpy.types.Object, performer: bpy.types.Object) -> str | None:
    """The bone, where there still is one of the name that was found."""
    found = (part.bone for part in settings_of(armature).parts if part.name == "pelvis")
    return next((name for name in found if name in armature_data(performer).bones), None)


def _performer(take: bpy.types.Action, armature: bpy.types.Object) -> bpy.types.Object:
    performer: bpy.types.Object | None = action_settings(take).performer
    return performer or armature
