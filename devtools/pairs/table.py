"""What the pairs tell: lines for a terminal, and docs/pairs.md."""

import math
from collections.abc import Iterable, Iterator, Sequence
from statistics import fmean, median

from ...solver.data.status import Status
from .compare import ComparedPair, Distances
from .limits import MEASURES, PairsFigure, with_distance
from .results import Results

Row = Sequence[str]
HEAD = """# Real pairs

`python3 dev.py pairs` measures these anew and wrote this page; `figures.json` in its folder has
every number. One real jump (the source) is adapted to where another jump of the same performer
lands (the target), and to nothing else: no time is given. Then it is set beside the target as it
was recorded.

![A pair: source, ours and the person at four instants](images/pairs.svg)
"""
HOW = """
## How

- Jumps: two broad jumps (`examples/recordings`) and ten hops (CMU 01_01), each hop cut 0.9 s before
  its take-off and after its landing. Every two of a performer make two pairs, there and back.
- Frame: the take-off place of the balls of the feet, on the floor, is the origin; forward is to
  where they land. All of the landing's contacts are moved, rigidly and without a turn, by the
  difference of the two jumps' lengths in this frame. A step up or down of less than 3 cm is the
  recordings' noise.
- Joint centres are compared at the same phase: the last 0.4 s before take-off, the flight, the
  first 0.4 s after landing. *Slid* is the recording moved along the floor evenly during its flight,
  so that the feet land where they should. *Its fit* is the physical fit of the target itself.
- Changes are those against the source's fit; the person's are from the source's fit to the
  target's. Crouch: lowest pelvis in the last 0.5 s before take-off. Velocities: of the centre of
  mass at take-off. Lean and reach: it before the feet at take-off, the feet before it at landing.
  Apex: its highest place. Arm swing: range of the upper arms' flexion against the trunk, in the
  plane of the jump, from 0.5 s before take-off to landing. Push time: from the lowest pelvis to
  take-off. Peak push: vertical force of all contacts, low-passed at 15 Hz.
- Slope: found change by the person's, least squares through the origin; 1 is all of it.
- Shares are left out where the person changed by less than 1 cm, 0.05 m/s, 10 ms, 5° or 0.1 BW.
- Null pairs: each jump adapted to its own landing, and pairs that land within 2 cm of each other.
"""
APART = """
Mean distance of the joint centres to the target, cm, in crouch / flight / landing. Two takes of one
jump are as far from each other as the last row tells: nothing that knows only the landing can be
expected to come much nearer.
"""
LANDINGS = """
## Landings moved by round distances

What ours change against the fit, where nothing but the landing is moved.
"""
SOLUTIONS = """
## The solutions side by side

Mean difference to the first solution's motions, mean distance of the joint centres to the person
in crouch / flight / landing, and the median of the seconds from the fit.
"""
TOLD_OF_SOLUTIONS = (
    "crouch_cm",
    "take_off_speed",
    "flight_time_ms",
    "arm_swing_deg",
    "peak_push_bw",
)
TOLD = """What changes in proportion to the distance, by least squares over the pairs: the
person's, and ours. The share is that of the squares of the person's changes which this explains; it
is also the slope that so good a prediction would have. The rest differs from take to take: no
landing's place tells it.
"""


def text(results: Results) -> str:
    """For a terminal."""
    parts: list[Iterable[str]] = [aligned(pair_rows(results, s)) for s in results.solutions]
    parts += (
        [f"{f.source} → {f.target}, {f.solution}: failed: {f.why}" for f in results.failed],
        [""],
    )
    parts += [aligned(jump_rows(results)), [""], aligned(told_rows(results)), [""]]
    parts += [aligned(landing_rows(results)), [""], aligned(solution_rows(results)), [""]]
    parts += [aligned(distance_rows(results)), [""], aligned(figure_rows(results))]
    return "\n".join(line for part in parts for line in part)


def page(results: Results) -> str:
    """docs/pairs.md."""
    lines = [HEAD, "## Figures\n", *markdown(figure_rows(results)), APART]
    lines += [*markdown(distance_rows(results)), HOW]
    lines += ["## The performers' own jumps\n", *markdown(jump_rows(results))]
    lines += ["", TOLD, *markdown(told_rows(results))]
    if len(results.solutions) > 1:
        lines += [SOLUTIONS, *markdown(solution_rows(results))]
    lines += [LANDINGS, *markdown(landing_rows(results)), "\n## The pairs"]
    for solution in results.solutions:
        lines += [f"\n{solution.capitalize()}:\n", *markdown(pair_rows(results, solution))]
    failed = [f"- {f.source} → {f.target}, {f.solution}: {f.why}" for f in results.failed]
    lines += ["\nFailed:\n", *failed] if failed else []
    return "\n".join(lines).rstrip() + "\n"


def figure_rows(results: Results) -> Iterator[Row]:
    """A figure a row, a solution a column."""
    yield ("figure", *results.solutions, "unit", "pairs", "must", "aim")
    for name, own in results.by_name().items():
        first = own[0]
        values = [_value(f, judged=f is first) for f in own]
        yield (name, *values, first.unit, str(first.count), _limits(first.must), _limits(first.aim))


def jump_rows(results: Results) -> Iterator[Row]:
    """A jump's fit a row, by distance."""
    yield ("jump", "distance (m)", *(f"{words} ({unit})" for words, unit, _ in MEASURES.values()))
    for jump in sorted(results.jumps, key=lambda jump: jump.distance):
        values = (getattr(jump.measures, name) for name in MEASURES)
        yield (jump.name, f"{jump.distance:.2f}", *(f"{value:.4g}" for value in values))


def told_rows(results: Results) -> Iterator[Row]:
    """What distance alone tells of the person's changes, and what ours are by it."""
    first = results.solutions[0]
    yield ("change per 10 cm further", "person", "ours", "unit", "share explained", "10 cm or more")
    for measure, (words, unit, _) in MEASURES.items():
        every, far = (with_distance(p, measure) for p in (results.moved(first), results.far(first)))
        slopes = (
            ("–", "–") if every is None else (f"{0.1 * x:+.2g}" for x in (every.person, every.ours))
        )
        shares = ("–" if told is None else f"{told.share:.2f}" for told in (every, far))
        yield (words, *slopes, unit, *shares)


def distance_rows(results: Results) -> Iterator[Row]:
    """Mean distances to the target over pairs, by phase."""
    first = results.solutions[0]
    fixed = ("unchanged", "slid", "bound")
    yield ("landing", "pairs", "unchanged", "slid", "its fit", *results.solutions)
    for words, some in (
        ("all", results.moved),
        ("moved by 10 cm or more", results.far),
        ("within 2 cm: two takes", results.near),
    ):
        if not some(first):
            continue
        distances = [[getattr(pair, kind) for pair in some(first)] for kind in fixed]
        distances += [[pair.ours for pair in some(solution)] for solution in results.solutions]
        yield (words, str(len(some(first))), *(_mean(each) for each in distances))


def solution_rows(results: Results) -> Iterator[Row]:
    """A solution a row: how its motions differ from the first solution's, mean over the pairs, how
    far they are from the person, and the seconds that they took."""
    words = (f"{MEASURES[name][0]} ({MEASURES[name][1]})" for name in TOLD_OF_SOLUTIONS)
    yield ("solution", "pairs", *words, "from the person (cm)", "seconds")
    first = {(p.source, p.target): p for p in results.moved(results.solutions[0])}
    for solution in results.solutions:
        mine = [p for p in results.moved(solution) if (p.source, p.target) in first]
        if not mine:
            continue
        others = [first[p.source, p.target] for p in mine]
        both = list(zip(mine, others, strict=True))
        changes = (
            fmean(p.found_change(name) - other.found_change(name) for p, other in both)
            for name in TOLD_OF_SOLUTIONS
        )
        seconds = f"{median(p.seconds for p in mine):.1f}"
        told = (f"{change:+.2g}" for change in changes)
        yield (solution, str(len(mine)), *told, _mean([p.ours for p in mine]), seconds)


def landing_rows(results: Results) -> Iterator[Row]:
    """A moved landing a row: what ours change."""
    heads = (f"{words} ({unit})" for words, unit, _ in MEASURES.values())
    yield ("jump", "landing (m)", "solution", *heads)
    for each in results.landings:
        changes = (f"{each.change(measure):+.2g}" for measure in MEASURES)
        status = "" if each.status == Status.SOLVED.value else f" ({each.status})"
        yield (each.source, f"{each.forward:+.1f}", each.solution + status, *changes)


def pair_rows(results: Results, solution: str) -> Iterator[Row]:
    """A pair a row: distances by phase, and shares of the person's change."""
    kinds = ("unchanged", "slid", "ours", "its fit")
    yield ("pair", "further (cm)", *kinds, *(words for words, _, _ in MEASURES.values()))
    for pair in results.moved(solution):
        distances = (pair.unchanged, pair.slid, pair.ours, pair.bound)
        yield (
            f"{pair.source} → {pair.target}",
            f"{100.0 * pair.further:+.0f}",
            *(" / ".join(f"{x:.1f}" for x in each.values()) for each in distances),
            *(_share(pair, measure) for measure in MEASURES),
        )


def aligned(rows: Iterable[Row]) -> Iterator[str]:
    """Columns as wide as they need, the first to the left."""
    table = [list(row) for row in rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for row in table:
        cells = [cell.rjust(width) for cell, width in zip(row, widths, strict=True)]
        yield "  ".join([row[0].ljust(widths[0]), *cells[1:]])


def markdown(rows: Iterable[Row]) -> Iterator[str]:
    """A table of markdown."""
    for i, row in enumerate(rows):
        yield f"| {' | '.join(row)} |"
        if i == 0:
            yield "|---" * len(row) + "|"


def _value(figure: PairsFigure, *, judged: bool) -> str:
    if figure.value is None:
        return "–"
    missed = judged and not figure.ok
    return f"{figure.value:.2f}" + (" MISSED" if missed else "")


def _share(pair: ComparedPair, measure: str) -> str:
    value, least = pair.share(measure), MEASURES[measure][2]
    told = value is not None and abs(pair.persons_change(measure)) >= least
    return f"{value:.2f}" if told else "–"


def _mean(distances: Sequence[Distances]) -> str:
    """Mean by phase, cm."""
    if not distances:
        return "–"
    return " / ".join(f"{fmean(each[phase] for each in distances):.1f}" for phase in distances[0])


def _limits(limits: tuple[float, float]) -> str:
    """Such as 0.5 to 1.2; empty where anything will do."""
    return "" if math.isinf(limits[1]) else f"{limits[0]:g} to {limits[1]:g}"
