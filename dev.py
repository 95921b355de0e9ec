#!/usr/bin/env python3
"""Hangtime outside Blender: python3 dev.py COMMAND [--blender VERSION] [options of the command]

  demo [--out DIR]                        fetch a real recording, move one hop's landing, adapt it
  adapt CLIP --recipe RECIPE --out DIR    the same for any clip (BVH, FBX, ASF/AMC)
  analyze CLIP [--write-recipe FILE]      what touches when, and a recipe to start from
  batch CLIPS... --recipes R... --out DIR many clips with many recipes; goes on where it ended
  doctor CLIP [--write-recipe FILE]       what is wrong with a clip, and remedies
  doctor --table [FOLDER] --out DIR       clean clips, damaged, diagnosed and repaired: a table
  doctor --fits [FOLDER] --out DIR        the same, fitted after the repair
  test [pytest arguments]                 run the tests
  figures --out DIR                       measure everything that the project promises
  gallery [NAMES...] [--out DIR]          the thesis's results and the scene's, with a table
  pairs [CLIP:FIRST-LAST ...] [--out DIR] adapt real jumps to each other's landings, and compare
  reach [--out DIR]                       how the body shares a reach, joint by joint
  solid [NAMES...] [--out DIR]            how solid the world is and how human the body, by MuJoCo
  survey [NAMES...] [--out DIR]           every kind of edit on every jump: solved, told, how long
  rigs [NAMES...] [--out DIR]             map skeletons of all conventions, adapt one jump on each
  keys [--out DIR]                        what reduced keys leave of adapted jumps, in Blender
  loop [--out DIR]                        runs made loops: the seam in Blender, and by MuJoCo
  validate [FOLDER] [--out DIR]           forces of the fit against force plates, with a table
  compare BEFORE AFTER [--within X]       whether two folders of results hold the same motions
  campaign [--cases N] [--seed S]         thousands of hostile cases: files, requests, sessions
  window [--out DIR]                      drive the zip in a real Blender's window, and measure
  benchmark [--quick] [--out DIR]         compare with other solvers on the same problem
  farm [--quick] [--out DIR]              batches here, on Dask and OpenJD: equal, fast, unharmed
  farm --tests [pytest arguments]         the tests of Dask, Flamenco, OpenJD and the wheel
  build [--out DIR]                       make and validate the extension's zips, and the wheel
  lint                                    ruff, mypy, import contracts, limits of the house

Makes its own environment in .hangtime/ on first use; needs Python alone. Without --blender it takes
the newest Blender with long-term support that this Python can run.
"""

from __future__ import annotations

import os
import subprocess
import sys

from devtools.environment import pythons, virtual_environment
from devtools.environment.problem import SetUpError
from devtools.environment.virtual_environment import FARM, PEERS, Requirements
from solver.kept_memory import KEPT_MEMORY
from solver.one_thread import ONE_THREAD

# command: module of the package, arguments before the user's, whether it needs dev.txt, or what it
# needs in place of Blender
COMMANDS: dict[str, tuple[str, list[str], bool | Requirements]] = {
    "demo": ("devtools.demo", [], False),
    "adapt": ("operators.headless.cli", ["adapt"], False),
    "analyze": ("operators.headless.cli", ["analyze"], False),
    "batch": ("batch.cli", [], False),
    "doctor": ("devtools.doctor.main", [], False),
    "test": ("devtools.checks.testing", [], True),
    "figures": ("devtools.figures.main", [], True),
    "gallery": ("devtools.gallery.main", [], True),
    "pairs": ("devtools.pairs.main", [], True),
    "survey": ("devtools.survey.main", [], False),
    "rigs": ("devtools.rigs.main", [], True),
    "reach": ("devtools.reach.main", [], False),
    "solid": ("devtools.solid.main", [], True),
    "keys": ("devtools.keys.main", [], True),
    "loop": ("devtools.loop.main", [], True),
    "validate": ("devtools.validation.main", [], True),
    "compare": ("devtools.gallery.compare", [], False),
    "window": ("devtools.window.main", [], False),
    "campaign": ("devtools.campaign.main", [], True),
    "benchmark": ("benchmarks.benchmark", [], PEERS),
    "farm": ("devtools.farm.main", [], FARM),
    "build": ("devtools.build", [], False),
    "lint": ("devtools.checks.lint", [], True),
}


def split_arguments(argv: list[str]) -> tuple[str, str | None, list[str]]:
    """The command, the Blender asked for, and the rest, which belongs to the command."""
    command, rest = argv[0], argv[1:]
    if command not in COMMANDS:
        raise SetUpError(f"Unknown command '{command}'; dev.py --help lists them all.")
    if "--blender" not in rest:
        return command, None, rest
    at = rest.index("--blender")
    if at + 1 == len(rest):
        raise SetUpError("--blender needs a version, such as 4.5.")
    return command, rest[at + 1], rest[:at] + rest[at + 2 :]


def main(argv: list[str]) -> int:
    if not argv or argv[0] in ("-h", "--help"):
        print(__doc__)
        return 0
    try:
        command, wanted, rest = split_arguments(argv)
        module, leading, needed = COMMANDS[command]
        blender, python = pythons.choose(wanted)
        if isinstance(needed, Requirements):
            env = virtual_environment.prepare_without_blender(blender, python, needed)
        else:
            env = virtual_environment.prepare(blender, python, needed)
    except SetUpError as problem:
        print(problem, file=sys.stderr)
        return 2
    # Several threads of linear algebra add up in another order, which ends in another motion; and
    # what is measured here has memory as the worker in Blender has.
    variables = env.variables() | ONE_THREAD | KEPT_MEMORY
    launcher = os.path.join(virtual_environment.ROOT, "devtools", "package.py")
    words = [env.python, launcher, module, *leading, *rest]
    if os.name == "posix":  # one process, so that whoever ends this one ends the command
        if sys.stdout is not None:  # as one that was closed from the start is
            sys.stdout.flush()
        os.execve(env.python, words, variables)
    code = subprocess.call(words, env=variables)
    return code if code >= 0 else 128 - code  # a signal, the way shells count it


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
