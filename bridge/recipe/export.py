"""Export options of a recipe: for whom the file with the result is. Keys: see problem.py."""

from dataclasses import dataclass

from ..recipe_syntax.items import Kind, choice
from ..rows.choices import Engine, FileFormat, RootMotion


@dataclass(frozen=True)
class ExportOptions:
    """How takes are written to a file. format: None is what the engine reads best."""

    engine: Engine = Engine.NONE
    format: FileFormat | None = None
    root: RootMotion = RootMotion.AS_IT_IS


EXPORT = Kind(
    "export",
    ExportOptions,
    (choice("engine", Engine), choice("format", FileFormat), choice("root", RootMotion)),
    named=False,
)
