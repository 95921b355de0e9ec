"""Measures how solid the world is: python3 dev.py solid [NAMES...] [--out DIR].

Every edit of `figures` and every result of `gallery` is adapted with floor and limbs solid, and
without for the time that it takes; MuJoCo says how deep the written action has things in each
other. A run of all of them writes docs/solid.md anew. Ends with 1 where a limit is missed that is
not known to be.
"""

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from operator import attrgetter
from pathlib import Path

from ...solver.data.faults import BadRecipe
from ..environment.problem import SetUpError
from ..environment.virtual_environment import ROOT
from ..processes import dump, run_module, undump
from ..reports import report_options
from .cases import CASES, QUICK, RESULTS, Case, cases, groups
from .limits import figures
from .result import CaseResult
from .table import line, page, text

PAGE = ROOT / "docs" / "solid.md"
MEASURE = "devtools.solid.measure"

LONGEST = 120.0  # s, that one case may take, on a busy machine too


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py solid", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="cases; default: all")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--quick", action="store_true", help="a handful of cases, each timed once")
    options = report_options(parser, argv)
    try:
        known = {case.name: case for case in cases()}
    except (SetUpError, BadRecipe, KeyError) as problem:
        print(problem, file=sys.stderr)
        return 2
    wanted = options.names or (QUICK if options.quick else known)
    unknown = [name for name in wanted if name not in known]
    if unknown:
        print(f"No case '{unknown[0]}'; there are: {'; '.join(known)}.")
        return 2
    began = time.perf_counter()
    results = []
    for result in measured([known[name] for name in wanted], quick=options.quick):
        print(line(result), flush=True)
        results.append(result)
    minutes = (time.perf_counter() - began) / 60.0
    order = {name: i for i, name in enumerate(known)}
    results.sort(key=lambda result: order[result.name])
    whole = not options.names and not options.quick
    return tell(results, options.out, minutes, write_page=whole)


def measured(chosen: Sequence[Case], *, quick: bool) -> Iterator[CaseResult]:
    """Each fit's cases in a process of their own, for a crash is their own too."""
    for group in groups(chosen):
        with tempfile.TemporaryDirectory() as folder:
            dump(group, Path(folder) / CASES)
            words = [folder, *(["--quick"] if quick else [])]
            said = run_module(MEASURE, words, LONGEST * len(group))
            path = Path(folder) / RESULTS
            done: list[CaseResult] = undump(path) if path.is_file() else []
        yield from done
        for case in group[len(done) :]:
            yield CaseResult(case.name, case.source, failed=said or "no result")


def tell(results: Sequence[CaseResult], out: Path, minutes: float, *, write_page: bool) -> int:
    """Prints the figures and the misses; writes figures.json and, where asked, the page.

    1 where a miss is not a known one.
    """
    found = figures(results)
    content = {"figures": [*map(asdict, found)], "cases": [*map(asdict, results)]}
    words = json.dumps(content, indent=1, ensure_ascii=False, default=attrgetter("value"))
    (out / "figures.json").write_text(words + "\n", encoding="utf-8")
    if write_page:
        PAGE.write_text(page(results, found, minutes), encoding="utf-8")
    print(text(found))
    missed = [f for f in found if not f.ok]
    wrong = [f for f in missed if not f.known]
    print(f"{len(results)} cases in {minutes:.1f} minutes, {len(missed)} limits missed, ", end="")
    print(f"{len(wrong)} of them unexpectedly; all in {out / 'figures.json'}")
    return 1 if wrong else 0
