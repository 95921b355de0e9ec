"""Adapts real jumps to each other's landings: python3 dev.py pairs [CLIP:FIRST-LAST ...].

Of one performer, one jump (the source) is adapted to where another (the target) lands, and to
nothing else, and set beside it. Default: two broad jumps, and ten hops among each other. Given
jumps are set in pairs every two both ways.
"""

import argparse
import os
import sys
import tempfile
from collections.abc import Sequence
from itertools import permutations
from pathlib import Path

from ...solver.data.faults import Fault
from ...solver.worker.pipeline import measure
from ..environment.problem import SetUpError
from . import table
from .clips import Jump, default_pairs, parse
from .compare import ComparedPair, FailedPair, RecordedJump, compare
from .jobs import SourceTask, solve_all
from .jump_frame import jump_frame, longest_flight
from .limits import figures
from .phased_jump import recorded_phases
from .solve import solver_options

DEFAULT = "implicit"


def main(argv: list[str]) -> int:
    options = _options(argv)
    solutions = tuple(word.strip() for word in options.solutions.split(","))
    try:
        _ = [solver_options(solution) for solution in solutions]
        given = [parse(text) for text in options.jumps]
        chosen = [*permutations(given, 2)] if given else default_pairs(options.pairs)
        recorded = {jump.name: record(jump) for pair in chosen for jump in pair}
    except (SetUpError, Fault, ValueError) as problem:
        print(f"{type(problem).__name__}: {problem}", file=sys.stderr)
        return 2
    options.out.mkdir(parents=True, exist_ok=True)
    names = [(source.name, target.name) for source, target in chosen]
    pairs = run(recorded, names, solutions, options.jobs)
    return tell(pairs, solutions, recorded, options.out)


def _options(argv: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="dev.py pairs", description=__doc__)
    parser.add_argument("jumps", nargs="*", metavar="CLIP:FIRST-LAST", help="two or more, BVH, AMC")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--pairs", type=int, metavar="N", help="so many of the default's 92")
    parser.add_argument("--solutions", default=DEFAULT, metavar="A,B", help="methods or objectives")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N")
    return parser.parse_args(argv)


def record(jump: Jump) -> RecordedJump:
    """A jump as it was recorded. Raises SetUpError and what `measure` does."""
    subject = measure(jump.recording(), jump.problem)
    performance = subject.analysis.performance
    flight = longest_flight(subject.schedule)
    frame = jump_frame(performance, subject.schedule)
    joints = enumerate(performance.character.joints)
    bones = tuple((joint.parent, i) for i, joint in joints if joint.parent >= 0)
    return RecordedJump(jump, frame, recorded_phases(performance, flight, frame), bones)


def run(
    recorded: dict[str, RecordedJump],
    names: Sequence[tuple[str, str]],
    solutions: tuple[str, ...],
    jobs: int,
) -> list[ComparedPair | FailedPair]:
    """Every (source, target) by every solution, and each source to its own landing."""
    asked = [*names, *((source, source) for source in recorded)]
    tasks = []
    for source in recorded.values():
        own = [target for name, target in asked if name == source.jump.name]
        offsets = {target: source.frame.offset_to(recorded[target].frame) for target in own}
        tasks.append(SourceTask(source.jump, offsets, solutions))
    with tempfile.TemporaryDirectory() as folder:
        done = solve_all(tasks, Path(folder), jobs)
    solved = dict(zip(recorded, done, strict=True))
    return [
        compare(recorded[a], recorded[b], solution, solved[a], solved[b].fit)
        for a, b in asked
        for solution in solutions
    ]


def tell(
    pairs: Sequence[ComparedPair | FailedPair],
    solutions: Sequence[str],
    recorded: dict[str, RecordedJump],
    out: Path,
) -> int:
    """Prints and writes everything; 1 where a figure of the first solution is missed."""
    compared = [pair for pair in pairs if isinstance(pair, ComparedPair)]
    failed = [pair for pair in pairs if isinstance(pair, FailedPair)]
    found = [figure for solution in solutions for figure in figures(compared, solution)]
    table.write_json(found, compared, failed, out / "figures.json")
    print(table.text(found, compared, failed))
    missed = [f for f in found if not f.ok and f.solution == solutions[0]]
    return 1 if missed or failed else 0
