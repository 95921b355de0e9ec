"""The first command: a real recording, one hop's landing moved, a physically valid hop back."""

import argparse
import sys

from ..operators.headless import cli
from .environment.problem import SetUpError
from .environment.virtual_environment import ROOT
from .recordings import HOPS, find

RECIPE = ROOT / "examples" / "demo_hop.toml"


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py demo", description=__doc__)
    parser.add_argument("--out", default="out", metavar="DIR", help="where to write (default: out)")
    arguments = parser.parse_args(argv)
    try:
        clip = find(HOPS)
    except SetUpError as problem:
        print(problem, file=sys.stderr)
        return 2
    command = ["adapt", str(clip), "--recipe", str(RECIPE), "--out", arguments.out]
    return int(cli.main(command))
