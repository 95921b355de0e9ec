"""Export options of a recipe: for whom the file with the result is.

[export]
engine = "unreal"               # "unity", "godot"; default: "none", as the armature is in Blender
format = "fbx"                  # or "gltf", "usd"; default: what the engine reads best
root = "root bone"              # it carries the way; or "in place"; default: "as it is"
skin = true                     # with the meshes that the bones deform
at_origin = true                # begins where the figure stands at rest, and faces as it does there
"""

from dataclasses import dataclass

from ..recipe_syntax.items import Kind, choice, flag
from ..rows.choices import Engine, FileFormat, RootMotion


@dataclass(frozen=True)
class ExportOptions:
    """How takes are written to a file.

    format: None is what the engine reads best. skin: the meshes that the bones deform go along.
    at_origin: takes are moved and turned on the floor, as wholes, to begin as it stands at rest.
    """

    engine: Engine = Engine.NONE
    format: FileFormat | None = None
    root: RootMotion = RootMotion.AS_IT_IS
    skin: bool = False
    at_origin: bool = False

    @property
    def needs_pelvis(self) -> bool:
        """Whether it has to be known where the figure is on the floor."""
        return self.at_origin or self.root is not RootMotion.AS_IT_IS


EXPORT = Kind(
    "export",
    ExportOptions,
    (
        choice("engine", Engine),
        choice("format", FileFormat),
        choice("root", RootMotion),
        flag("skin"),
        flag("at_origin"),
    ),
    named=False,
)
