"""One result of the gallery: what is solved, where its files lie, and the processes that make it.

Blender reads the clip, for all results that are made of it; a process of its own solves and
measures, Blender writes and draws: the solver's memory and any crash are each one's own.
"""

import json
import re
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from ...bridge.recipe.problem import parse_recipe, read_recipe_text
from ...solver.data.problem import MotionProblem
from ..environment.virtual_environment import ROOT
from ..processes import run_module

EXAMPLES = ROOT / "examples"
BLENDER, SOLVE = "devtools.gallery.blender", "devtools.gallery.solve"
LONGEST = 400.0  # s, that solving one result may take by all methods together
LEFT = ("sheet.png", "adapted.fbx", "report.json", "trajectory.npz")  # what a result leaves
SCRATCH = ("drawn.pickle", "measured.json", "written.json")
Json = dict[str, Any]


class Page(Enum):
    """A page of the gallery, by the folder of its recipes."""

    THESIS = "gallery"
    SCENE = "world"

    @property
    def folder(self) -> Path:
        return EXAMPLES / self.value


@dataclass(frozen=True)
class Result:
    """One recipe of the gallery. title: its first comment. clip: the recording's file."""

    name: str
    page: Page
    title: str
    problem: MotionProblem
    clip: Path

    @property
    def heading(self) -> str:
        """The title's first words, that fit above a picture."""
        return self.title.partition(":")[0]


def load(name: str) -> Result:
    """Raises BadRecipe, and KeyError for a recipe that names no clip."""
    page = next((page for page in Page if (page.folder / f"{name}.toml").is_file()), Page.THESIS)
    path = page.folder / f"{name}.toml"
    text = read_recipe_text(path)
    recipe = parse_recipe(text, str(path))
    if recipe.clip is None:
        raise KeyError(f"{path.name} names no clip")
    title = text.lstrip().splitlines()[0].lstrip("# ").rstrip(".")
    return Result(name, page, title, recipe.problem, (path.parent / recipe.clip).resolve())


def names(page: Page) -> list[str]:
    """Of the thesis jumps before runs, their fits first, by its figures where the title tells them;
    those in a scene by their numbers."""

    def order(path: Path) -> tuple[bool, bool, int, str]:
        with path.open(encoding="utf-8") as file:
            figure = re.search(r"(?:figure 6-|scene )(\d+)", file.readline())
        number = int(figure[1]) if figure else 0
        if page is Page.SCENE:
            return False, False, number, path.stem
        return path.stem.startswith("run_"), not path.stem.endswith("_fit"), number, path.stem

    return [path.stem for path in sorted(page.folder.glob("*.toml"), key=order)]


@dataclass(frozen=True)
class Effort:
    """What of a result is made. pictures: they too. quick: by the implicit solution alone. once:
    solved a single time, as how long it takes is not asked."""

    pictures: bool
    quick: bool
    once: bool


def work(result: Result, folder: Path, recordings: Path, effort: Effort) -> Json:
    """Makes one result in a folder; what was measured, with "failed" where something went wrong.

    recordings: folder of the clips that were read so far, as they are given to the solver.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name in (*LEFT, *SCRATCH):
        (folder / name).unlink(missing_ok=True)
    first, last = result.problem.frames or ("first", "last")
    recording = recordings / f"{result.clip.name}.{first}-{last}.pickle"
    said = None
    if not recording.is_file():
        said = run_module(BLENDER, ["read", result.name, str(recording)], LONGEST)
    if said is not None:
        recording.unlink(missing_ok=True)  # it may be half written
    if said is None:
        words = ["--quick"] if effort.quick or result.page is Page.SCENE else []
        words += ["--once"] if effort.once else []
        said = run_module(SOLVE, [result.name, str(folder), str(recording), *words], LONGEST)
    found = _read(folder / "measured.json")
    if said is None and (folder / "drawn.pickle").is_file():
        words = ["write", result.name, str(folder), *([] if effort.pictures else ["--no-picture"])]
        said = run_module(BLENDER, words, LONGEST)
    if said is not None:
        found["failed"] = said
    found |= {"name": result.name, "page": result.page.value, "title": result.title}
    found |= _read(folder / "written.json")
    for scratch in SCRATCH:
        (folder / scratch).unlink(missing_ok=True)
    return found


def _read(path: Path) -> Json:
    try:
        content: Json = json.loads(path.read_text(encoding="utf-8"))
    except OSError:
        return {}
    return content


def write_json(content: Json, path: Path) -> None:
    path.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
