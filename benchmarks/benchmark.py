"""python3 dev.py benchmark: our solutions, other solvers on the same problem, and how it scales.

Everything runs in one process with one thread of linear algebra, one after the other.
"""

import argparse
import sys
from pathlib import Path

from ..devtools.environment.problem import SetUpError
from ..devtools.environment.virtual_environment import ROOT
from ..devtools.recordings import HOPS, find
from ..devtools.reports import report_options
from .measure import Benchmark, Extent
from .tables import Table, write_json

DOCUMENT = ROOT / "docs" / "benchmark.md"
HEAD = """# The benchmark

Written by `python3 dev.py benchmark --write-docs` from a measured run; `benchmark.json` has the
seconds too. Only what means the same on any machine is told here. The hops, Drake
(with SNOPT) and Pinocchio come from the package registry.

A peer that does not finish is stopped at its limit and told with its violation at the end: 1 is
solved, by our rows and tolerances and not by its own word. "Set-up" is what a solver prepares for
a problem before it starts; ours is part of the stored fit. Our times are those of the whole
adaptation, stages and added knots included. SNOPT's iterations are the times that it asked for the
rows: most of its time goes into its first quadratic programs, as it must find its Hessian from
gradients. On figures of a few joints it and the others find the same motion
(`tests/benchmarks/test_benchmark.py`).
"""


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py benchmark", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--limit", type=float, metavar="SECONDS", help="for each peer, else 60")
    parser.add_argument("--quick", action="store_true", help="10 s a peer, the quick ones")
    parser.add_argument("--write-docs", action="store_true", help="rewrite docs/benchmark.md")
    options = report_options(parser, argv)
    try:
        find(HOPS)  # before anything is measured
    except SetUpError as problem:
        print(problem, file=sys.stderr)
        return 2
    extent = Extent.quick(options.limit or 10.0) if options.quick else Extent(options.limit or 60.0)
    tables: list[Table] = []
    for table in Benchmark(extent).tables():
        tables.append(table)
        print(f"{table.text()}\n", flush=True)
    path = options.out / "benchmark.json"
    write_json(tables, path)
    print(f"All of it, with every digit: {path}")
    if options.write_docs:
        parts = [HEAD, *(table.without_seconds().markdown() + "\n" for table in tables)]
        DOCUMENT.write_text("\n".join(parts), encoding="utf-8")
        print(f"Written: {DOCUMENT.relative_to(ROOT)}")
    return 0
