"""The hostile campaign: python3 dev.py campaign --cases N --seed S --out DIR.

Each case is drawn from the seed and its number, so that --case K does one of them again. It ends
with 1 where a case crashed, hung, changed what it should not or left something behind.
"""

import argparse
import os
from pathlib import Path

from ..reports import report_options
from .families.all_families import FAMILIES, family_of
from .protocol.case import CaseOutcome
from .runner import run_cases
from .table import table


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py campaign", description=__doc__)
    parser.add_argument("--cases", type=int, default=1000, metavar="N")
    parser.add_argument("--seed", type=int, default=0, metavar="S")
    parser.add_argument("--case", type=int, action="append", metavar="K", help="this one alone")
    parser.add_argument("--family", help="cases of this family alone")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="J")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    options = report_options(parser, argv)
    folder: Path = options.out.resolve()
    numbers = options.case or range(options.cases)
    every = [n for n in numbers if options.family in (None, family_of(n, options.seed).name)]
    outcomes = run_cases(every, options.seed, folder / "cases", options.jobs, tell)
    text = table(outcomes, FAMILIES, options.seed)
    lines = [f"{o.number} {o.family}, {o.seconds:.1f} s: {o.ending}: {o.detail}" for o in outcomes]
    (folder / "cases.txt").write_text("\n".join([*lines, ""]), encoding="utf-8")
    (folder / "campaign.md").write_text(text, encoding="utf-8")
    print(text)
    return 0 if all(outcome.ending.good for outcome in outcomes) else 1


def tell(outcome: CaseOutcome) -> None:
    """Prints a case that ended as it should not."""
    if not outcome.ending.good:
        print(f"case {outcome.number}, {outcome.family}: {outcome.ending}")
        print(outcome.detail, flush=True)
