"""Compares the fit's contact forces with force plates: python3 dev.py validate [FOLDER].

FOLDER holds trials: X.bvh, X_grf.csv, X_com.csv and X.json; examples/recordings has one. Each goes
the way of `dev.py adapt` up to the fit. Of recordings without plates the fit's motion is judged.
Leaves figures.json and a picture of each trial's curves. Ends with 1 where a limit is missed that
is not known to be, where a trial is refused that should not be, and after a crash.
"""

import argparse
import json
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from functools import partial
from operator import attrgetter
from pathlib import Path

from ..environment.virtual_environment import ROOT
from ..processes import run_module, undump
from ..reports import report_options
from .causes.vary import unknown
from .limits import figures
from .recorded import RECORDINGS
from .result import TrialResult
from .table import page, tables
from .trials import names

HELD = ROOT / "examples" / "recordings"
PAGE = ROOT / "docs" / "validation.md"
SOLVE = "devtools.validation.solve"
LONGEST = 600.0  # s, that one clip may take, on a busy machine too


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py validate", description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=HELD, metavar="FOLDER")
    parser.add_argument(
        "--only", nargs="+", metavar="NAME", help="trials, recordings; default: all"
    )
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="trials at once")
    parser.add_argument("--no-curves", action="store_true", help="leave out the pictures")
    parser.add_argument(
        "--vary", nargs="+", default=[], metavar="NAME=VALUE", help="constants with other values"
    )
    parser.add_argument("--page", action="store_true", help="write docs/validation.md anew")
    options = report_options(parser, argv)
    trials = names(options.folder)
    known = [*trials, *RECORDINGS]
    chosen = options.only or known
    missing = [name for name in chosen if name not in known]
    if missing or not trials:
        what = f"trial '{missing[0]}'" if missing else "trial"
        there = ", ".join(known) if trials else "none"
        print(f"No {what} in {options.folder}; there are: {there}.")
        return 2
    if wrong := unknown(options.vary):
        print(wrong)
        return 2
    if options.vary and options.page:
        print("The page tells of the constants as they are; leave out --vary or --page.")
        return 2
    curves = [] if options.no_curves else ["--curves"]
    said = [*curves, *options.vary]
    work = partial(solve, options.folder, options.out, options=said)
    with ThreadPoolExecutor(options.jobs) as pool:
        results = tuple(pool.map(work, chosen))
    return tell(results, options.out, write_page=options.page)


def tell(results: Sequence[TrialResult], out: Path, *, write_page: bool) -> int:
    """Prints the tables and the misses; writes figures.json and, where asked, the page.

    1 where a miss is not a known one.
    """
    found = tuple(figures(results))
    content = {"figures": [*map(asdict, found)], "trials": [*map(asdict, results)]}
    text = json.dumps(content, indent=1, ensure_ascii=False, default=attrgetter("value")) + "\n"
    (out / "figures.json").write_text(text, encoding="utf-8")
    parts = tables(results, found)
    print("\n\n".join(part.text for part in (*parts[1:], parts[0])))
    if write_page:
        PAGE.write_text(page(parts), encoding="utf-8")
    missed = [f for f in found if not f.ok]
    wrong = [f for f in missed if not f.known]
    print(f"\n{len(results)} clips, {len(missed)} limits missed, {len(wrong)} of them unexpectedly")
    for f in wrong:
        print(f"missed: {f.name}: {f.value:.3g} {f.unit} (must {f.must:g}) {f.trial}")
    print(f"all in {out / 'figures.json'}")
    return 1 if wrong else 0


def solve(folder: Path, out: Path, name: str, *, options: Sequence[str]) -> TrialResult:
    """Measures one trial in a process of its own, for a crash is its own too."""
    path = out / f"{name}.pickle"
    path.unlink(missing_ok=True)
    said = run_module(SOLVE, [str(folder), name, str(out), *options], LONGEST)
    if said is not None:
        return TrialResult(name, refused=said, crashed=True)
    result: TrialResult = undump(path)
    path.unlink()
    return result
