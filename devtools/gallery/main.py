"""Makes the thesis's gallery: python3 dev.py gallery [NAMES...] [--out DIR].

Each result comes from its recipe in examples/gallery, or examples/world: a picture, an FBX, its
report, its trajectory, and a row of docs/gallery.md, which a run of the whole gallery writes anew.
Ends with 1 where a result is not as it should be.
"""

import argparse
import tempfile
from dataclasses import asdict
from pathlib import Path

from ...solver.data.faults import BadRecipe
from ..environment.virtual_environment import ROOT
from ..reports import report_options
from .jobs import Effort, Json, Page, load, names, work, write_json
from .limits import faults, figures, of_page
from .scene_table import SCENE_HEAD, scene_section
from .table import line, page

PAGE = ROOT / "docs" / "gallery.md"


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py gallery", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="recipes; default: all")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--no-pictures", action="store_true", help="leave out the drawing")
    parser.add_argument("--quick", action="store_true", help="the implicit solution alone")
    parser.add_argument("--once", action="store_true", help="solve once, not thrice for the clock")
    parser.add_argument("--scene", action="store_true", help="only those in a scene")
    options = report_options(parser, argv)
    known = names(Page.SCENE) if options.scene else [*names(Page.THESIS), *names(Page.SCENE)]
    unknown = [name for name in options.names if name not in known]
    if unknown:
        print(f"No recipe '{unknown[0]}' in examples; there are: {', '.join(known)}.")
        return 2
    try:
        chosen = [load(name) for name in options.names or known]
    except (BadRecipe, KeyError) as problem:
        print(problem)
        return 2
    absent = [result for result in chosen if not result.clip.is_file()]
    if absent:
        print(f"{absent[0].name}: there is no recording {absent[0].clip}.")
        return 2
    rows: list[Json] = []
    effort = Effort(not options.no_pictures, options.quick, options.once)
    with tempfile.TemporaryDirectory() as scratch:
        for result in chosen:
            rows.append(work(result, options.out / result.name, Path(scratch), effort))
            print(line(rows[-1]), flush=True)
    if not options.names and (options.scene or not options.quick):
        write_page(rows, scene_alone=options.scene)
    return tell(rows, options.out)


def write_page(rows: list[Json], *, scene_alone: bool) -> None:
    """Writes docs/gallery.md; the thesis's part stays as it is where only the scene was made."""
    old = PAGE.read_text(encoding="utf-8").partition(SCENE_HEAD)[0]
    first = old if scene_alone else page(of_page(rows, Page.THESIS))
    section = scene_section(of_page(rows, Page.SCENE))
    PAGE.write_text(f"{first.rstrip()}\n\n{section}", encoding="utf-8")


def tell(rows: list[Json], out: Path) -> int:
    """Writes the figures; 1 where anything failed."""
    found = figures(rows)
    content = {"figures": [asdict(figure) for figure in found], "results": rows}
    write_json(content, out / "figures.json")
    bad = [row["name"] for row in rows if faults(row)]
    missed = [f for f in found if f.result == "all" and not f.ok]
    for figure in missed:
        print(f"missed: {figure.name}: {figure.value:.3g} {figure.unit} (must {figure.must:g})")
    wrong = [figure for figure in missed if figure.unit != "s"]  # times depend on the machine
    print(f"{len(rows) - len(bad)} of {len(rows)} results in order; figures in {out}/figures.json")
    return 1 if bad or wrong else 0
