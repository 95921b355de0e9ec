"""The command line of batches: `dev.py batch …`, `blender --command hangtime batch …`.

  batch CLIPS… --recipes RECIPES… --out DIR   plan, run and collect; the same command again goes on
  batch plan …                                the same words: only write DIR/manifest.jsonl
  batch cell DIR CELL                         solve one cell
  batch collect DIR                           make table, contact sheet and page anew
Exit codes: 0 all done; 2 wrong input, in sentences on the standard error; 3 some have no solution;
1 some failed by no fault of what was asked; 130 interrupted.
"""

from __future__ import annotations

import os
import sys

from ..solver.one_thread import ONE_CORE


def main(argv: list[str] | None = None) -> int:
    """Runs a batch, or a part of one; the exit code. argv: by default the program's own."""
    for name, value in ONE_CORE.items():
        os.environ.setdefault(name, value)
    from .commands import run  # loads numpy, which reads them

    return run(sys.argv[1:] if argv is None else argv)
