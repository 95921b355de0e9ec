"""Export options of a recipe: for whom the file with the result is.

[export]
engine = "unreal"               # "unity", "godot"; default: "none", as the armature is in Blender
format = "fbx"                  # or "gltf", "usd"; default: what the engine reads best
root = "root bone"              # it carries the way; or "in place"; default: "as it is"
skin = true                     # with the meshes that the bones deform
"""

from dataclasses import dataclass

from ..recipe_syntax.items import Kind, choice, flag
from ..rows.choices import Engine, FileFormat, RootMotion


@dataclass(frozen=True)
class ExportOptions:
    """How takes are written to a file.

    format: None is what the engine reads best. skin: the meshes that the bones deform go along.
    """

    engine: Engine = Engine.NONE
    format: FileFormat | None = None
    root: RootMotion = RootMotion.AS_IT_IS
    skin: bool = False


EXPORT = Kind(
    "export",
    ExportOptions,
    (
        choice("engine", Engine),
        choice("format", FileFormat),
        choice("root", RootMotion),
        flag("skin"),
    ),
    named=False,
)
