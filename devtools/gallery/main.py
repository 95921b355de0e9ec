"""Makes the thesis's gallery: python3 dev.py gallery [NAMES...] [--out DIR].

Each result comes from its recipe in examples/gallery: a picture, an FBX, its report, its
trajectory, and a row of docs/gallery.md, which a run of the whole gallery writes anew. Ends with 1
where a result is not as it should be.
"""

import argparse
from dataclasses import asdict
from pathlib import Path

from ...solver.data.faults import BadRecipe
from ..environment.virtual_environment import ROOT
from .jobs import Json, load, names, work, write_json
from .limits import faults, figures
from .table import line, page

PAGE = ROOT / "docs" / "gallery.md"


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py gallery", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="recipes; default: all")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--no-pictures", action="store_true", help="leave out the drawing")
    parser.add_argument("--quick", action="store_true", help="the implicit solution alone")
    options = parser.parse_args(argv)
    known = names()
    unknown = [name for name in options.names if name not in known]
    if unknown:
        print(f"No recipe '{unknown[0]}' in examples/gallery; there are: {', '.join(known)}.")
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
    for result in chosen:
        folder, pictures = options.out / result.name, not options.no_pictures
        rows.append(work(result, folder, pictures=pictures, quick=options.quick))
        print(line(rows[-1]), flush=True)
    return tell(rows, options.out, whole=not options.names and not options.quick)


def tell(rows: list[Json], out: Path, *, whole: bool) -> int:
    """Writes the figures, and the page of the whole gallery; 1 where anything failed."""
    found = figures(rows)
    content = {"figures": [asdict(figure) for figure in found], "results": rows}
    write_json(content, out / "figures.json")
    if whole:
        PAGE.write_text(page(rows), encoding="utf-8")
    bad = [row["name"] for row in rows if faults(row)]
    missed = [f for f in found if f.result == "all" and not f.ok]
    for figure in missed:
        print(f"missed: {figure.name}: {figure.value:.3g} {figure.unit} (must {figure.must:g})")
    wrong = [figure for figure in missed if figure.unit != "s"]  # times depend on the machine
    print(f"{len(rows) - len(bad)} of {len(rows)} results in order; figures in {out}/figures.json")
    return 1 if bad or wrong else 0
