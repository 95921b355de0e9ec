"""The process that does cases: told a number a line, it answers a line of JSON; a crash ends it."""

import argparse
import json
import os
import sys
from dataclasses import asdict
from pathlib import Path

from .families.all_families import family_of
from .protocol.case import run_case


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="child", description=__doc__)
    parser.add_argument("seed", type=int)
    parser.add_argument("folder", type=Path)
    options = parser.parse_args(argv)
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever Blender prints goes to the error stream
    for line in sys.stdin:
        number = int(line)
        family = family_of(number, options.seed)
        outcome = run_case(family, number, options.seed, options.folder / str(number))
        print(json.dumps(asdict(outcome)), file=answers, flush=True)
    return 0
