"""Adapts real jumps to each other's landings: python3 dev.py pairs [CLIP:FIRST-LAST ...].

Of one performer, one jump (the source) is adapted to where another (the target) lands, and to
nothing else, and set beside it. Default: two broad jumps, and ten hops among each other; a run of
them all writes docs/pairs.md anew. The landings of the broad jumps, or of the given ones, are moved
by round distances too. Given jumps are set in pairs every two both ways. Ends with 1
where the first solution misses what it must reach.
"""

import argparse
import os
import sys
import tempfile
from collections.abc import Collection, Mapping, Sequence
from itertools import permutations
from pathlib import Path

from ...solver.data.faults import Fault
from ...solver.worker.pipeline import measure
from ..environment.problem import SetUpError
from ..environment.virtual_environment import ROOT
from ..reports import report_options
from .clips import Jump, broad_jumps, default_pairs, parse
from .compare import ComparedPair, RecordedJump, compare
from .jobs import SolvedJump, SolvedSource, SourceTask, solve_all
from .jump_frame import jump_frame, longest_flight
from .moved import FORWARD, moved_landings, moved_offsets
from .phased_jump import AROUND, recorded_phases
from .picture import draw
from .results import Results
from .solve import solver_options
from .table import page, text

DEFAULT = "implicit"
DOCS = ROOT / "docs"


def main(argv: list[str]) -> int:
    options = _options(argv)
    solutions = tuple(word.strip() for word in options.solutions.split(","))
    try:
        _ = [solver_options(solution) for solution in solutions]
        given = [parse(jump) for jump in options.jumps]
        chosen = [*permutations(given, 2)] if given else default_pairs(options.pairs)
        recorded = {jump.name: record(jump) for pair in chosen for jump in pair}
    except (SetUpError, Fault, ValueError) as problem:
        print(f"{type(problem).__name__}: {problem}", file=sys.stderr)
        return 2
    asked = [(source.name, target.name) for source, target in chosen]
    moved: list[str] = []
    if not options.only_pairs:
        asked += [(name, name) for name in recorded]  # its own landing: nothing should change
        moved = [jump.name for jump in given or broad_jumps() if jump.name in recorded]
    solved = solve(recorded, asked, solutions, moved, options.jobs)
    pairs = [
        compare(recorded[a], recorded[b], solution, solved[a], solved[b].fit)
        for a, b in asked
        for solution in solutions
    ]
    distances = {name: float(jump.frame.landing[0]) for name, jump in recorded.items()}
    results = Results.of(solutions, pairs, distances, moved_landings(solved, solutions))
    results.write(options.out / "figures.json")
    pictures = draw_some(results.moved(solutions[0]), recorded, solved, options.out)
    print(text(results))
    if not given and options.pairs is None and not options.only_pairs:
        (DOCS / "pairs.md").write_text(page(results), encoding="utf-8")
        for picture in pictures[:1]:
            (DOCS / "images" / "pairs.svg").write_bytes(picture.read_bytes())
    return 1 if results.missed() or results.failed else 0


def _options(argv: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="dev.py pairs", description=__doc__)
    parser.add_argument("jumps", nargs="*", metavar="CLIP:FIRST-LAST", help="two or more, BVH, AMC")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--pairs", type=int, metavar="N", help="so many of the default's 92")
    parser.add_argument(
        "--only-pairs", action="store_true", help="no null pairs, no round distances"
    )
    parser.add_argument(
        "--solutions", default=DEFAULT, metavar="A,B", help='methods, or objectives as "power"'
    )
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N")
    return report_options(parser, argv)


def record(jump: Jump) -> RecordedJump:
    """A jump as it was recorded. Raises SetUpError and what `measure` does."""
    subject = measure(jump.recording(), jump.problem)
    performance = subject.analysis.performance
    flight = longest_flight(subject.schedule)
    if min(flight.start, subject.schedule.duration - flight.end) < AROUND:
        raise SetUpError(f"{jump.name}: {AROUND} s are needed before take-off and after landing.")
    frame = jump_frame(performance, subject.schedule)
    joints = enumerate(performance.character.joints)
    bones = tuple((joint.parent, i) for i, joint in joints if joint.parent >= 0)
    return RecordedJump(jump, frame, recorded_phases(performance, flight, frame), bones)


def solve(
    recorded: Mapping[str, RecordedJump],
    asked: Sequence[tuple[str, str]],
    solutions: tuple[str, ...],
    moved: Collection[str],
    jobs: int,
) -> dict[str, SolvedSource]:
    """Every source's fit, and its adaptations to its targets by every solution.

    moved: the sources whose landings are moved by round distances too.
    """
    tasks = []
    for name, source in recorded.items():
        own = [target for other, target in asked if other == name]
        offsets = {target: source.frame.offset_to(recorded[target].frame) for target in own}
        if name in moved:
            offsets |= moved_offsets(source.frame, FORWARD)
        tasks.append(SourceTask(source.jump, offsets, solutions))
    with tempfile.TemporaryDirectory() as folder:
        return dict(zip(recorded, solve_all(tasks, Path(folder), jobs), strict=True))


def draw_some(
    pairs: Sequence[ComparedPair],
    recorded: Mapping[str, RecordedJump],
    solved: Mapping[str, SolvedSource],
    out: Path,
) -> list[Path]:
    """Pictures of the pair that goes furthest ahead, of that furthest back, and of the first."""
    ways = sorted(pairs, key=lambda pair: pair.further)
    chosen = dict.fromkeys((p.source, p.target) for p in (*ways[-1:], *ways[:1], *pairs[:1]))
    drawn = []
    for source, target in chosen:
        ours = solved[source].adapted[target, pairs[0].solution]
        assert isinstance(ours, SolvedJump)
        jumps = {"source": recorded[source].phases, "ours": ours.phases}
        drawn.append(out / f"{source} to {target}.svg".replace(" ", "_"))
        jumps["person"] = recorded[target].phases
        draw(jumps, recorded[source].bones, f"{source} to the landing of {target}", drawn[-1])
    return drawn
