"""Edits jumps as an artist would: python3 dev.py survey [NAMES...] [--out DIR].

Every kind of edit in devtools/survey/edits.toml on jumps of the recordings held here. NAMES are
recordings' names, or folders with more (BVH, ASF/AMC). Prints a line an edit and a row a kind, and
writes survey.json. Ends with 1 where an edit ends by an exception that is no fault in words.
"""

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict
from operator import attrgetter
from pathlib import Path

from ..environment.problem import SetUpError
from ..processes import run_module, undump
from ..recordings import find
from ..reports import report_options
from .result import EditEnding, EditResult
from .solve import RESULTS
from .table import line, table
from .windows import LONGEST_EDITS, MOST, QUICK, edits, held, recordings

SOLVE = "devtools.survey.solve"
LONGEST = 120.0  # s, that an edit, a fit or the reading may take on average, on a busy machine too


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py survey", description=__doc__)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="recordings, folders; default: all"
    )
    parser.add_argument("--edits", nargs="+", metavar="EDIT", help="kinds of edits; default: all")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--quick", action="store_true", help="one jump, without limp legs")
    options = report_options(parser, argv)
    wrong = [edit for edit in options.edits or () if edit not in edits()]
    if wrong:
        print(f"No edit '{wrong[0]}'; there are: {', '.join(edits())}.", file=sys.stderr)
        return 2
    try:
        clips = chosen(options.names or (QUICK if options.quick else ()))
    except SetUpError as problem:
        print(problem, file=sys.stderr)
        return 2
    began, results, failed = time.perf_counter(), list[EditResult](), list[str]()
    for name, path in clips.items():
        print(f"{name} ...", flush=True)
        found, said = surveyed(path, options.edits or kinds(options.quick))
        print(*map(line, found), sep="\n", flush=True)
        results += found
        failed += [f"{name}: {said}"] if said else []
    return tell(results, failed, time.perf_counter() - began, options.out)


def kinds(quick: bool) -> list[str]:
    """Names of the edits."""
    return [name for name in edits() if not quick or name not in LONGEST_EDITS]


def chosen(names: Sequence[str]) -> dict[str, Path]:
    """Recordings by name. Raises SetUpError."""
    known = held()
    found: dict[str, Path] = {}
    for name in names or known:
        if name in known:
            found[name] = find(known[name])
            continue
        more = recordings(Path(name)) if Path(name).is_dir() else {}
        if not more:
            there = ", ".join(known)
            raise SetUpError(f"'{name}' is no recording and no folder of them; there are: {there}.")
        found |= more
    return found


def surveyed(clip: Path, names: Sequence[str]) -> tuple[list[EditResult], str | None]:
    """All edits of a recording in a process of its own, for a crash is its own too; and why there
    are no more of them."""
    with tempfile.TemporaryDirectory() as folder:
        said = run_module(SOLVE, [str(clip), folder, *names], MOST * LONGEST * (len(names) + 2))
        path = Path(folder) / RESULTS
        found: list[EditResult] = undump(path) if path.is_file() else []
    return found, said


def tell(results: Sequence[EditResult], failed: Sequence[str], seconds: float, out: Path) -> int:
    """Prints the table and writes survey.json; 1 where anything crashed, or nothing was edited."""
    content = {"edits": [*map(asdict, results)], "failed": [*failed]}
    text = json.dumps(content, indent=1, ensure_ascii=False, default=attrgetter("value")) + "\n"
    (out / "survey.json").write_text(text, encoding="utf-8")
    if results:
        print(f"\n{table(results)}\n")
    crashed = [result for result in results if result.ending is EditEnding.CRASHED]
    for told in (*map(line, crashed), *failed):
        print(f"failed: {told}")
    print(f"{len(results)} edits in {seconds:.0f} s; all in {out / 'survey.json'}")
    nothing = all(result.ending is EditEnding.SKIPPED for result in results)
    return 1 if crashed or failed or nothing else 0
