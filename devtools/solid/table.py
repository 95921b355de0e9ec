"""docs/solid.md: the figures, and every case's row."""

from collections.abc import Iterator, Sequence

from ..checks.penetrations import Keeper
from .cases import Source
from .limits import SolidFigure, faults
from .result import CaseResult

HEAD = """# The solid world

`python3 dev.py solid --out DIR` measures these anew (about {minutes:.0f} minutes on a busy machine
with 2 cores) and wrote this page; `DIR/figures.json` has every number.
"""
NOTES = """
- **Penetration**: by MuJoCo's distances (`mj_geomDistance`), on capsules, balls and a plane built
  from the solver's shapes and moved by the bones of the action as written into Blender, at every
  frame of it. *New* is what is deeper than in the fit at the same (warped) instant, by MuJoCo too;
  of the scene, whose meshes are MuJoCo's as convex solids, everything is new.
- **Joints**: degrees beyond the human range (`solver/human/ranges.py`) or beyond what the
  recording does, whichever is wider, by the written bones' rotations; so the fit's own count too.
- **Time**: of an adaptation from the stored fit with floor and own limbs solid, over that without;
  by turns in one process that has nothing beside it, the least of two or three runs each. Results
  in a scene do not count: without solids there is no scene.
- **Physics**: what nothing explains by MuJoCo's inverse dynamics at 960 Hz, of the motion that the
  action was written from; force in body weights and moment in body weights x m, rms.
- **Known misses** are declared in `devtools/solid/limits.py`, with the value that each must not
  pass meanwhile. The command ends with 1 for any other.
"""
COLUMNS = (
    "case",
    *(f"{keeper.value} (mm)" for keeper in Keeper),
    "joints (°)",
    "free (s)",
    "solid (s)",
    "ratio",
    "flight",
    "ground",
    "",
)


def page(results: Sequence[CaseResult], found: Sequence[SolidFigure], minutes: float) -> str:
    """The whole page."""
    parts = [HEAD.format(minutes=minutes), *_limits(found), NOTES]
    for source in Source:
        mine = [r for r in results if r.source is source]
        if mine:
            parts += [f"## {source.value}", "", *_table(mine), ""]
    return "\n".join(parts).rstrip() + "\n"


def text(found: Sequence[SolidFigure]) -> str:
    """The figures for a terminal."""
    width = max(len(f.name) for f in found)
    lines = [
        f"{f.name:{width}} {f.value:9.3g} {f.unit:8} {_or(f.must):>6} {_or(f.aim):>7}  "
        f"{_verdict(f):10} {f.where}"
        for f in found
    ]
    return "\n".join([f"{'figure':{width}} {'worst':>9} {'':8} {'must':>6} {'aim':>7}", *lines])


def line(result: CaseResult) -> str:
    """One case in a terminal's line."""
    deepest = max((p.deeper_mm for p in result.penetrations), default=0.0)
    degrees = result.joint.degrees if result.joint else 0.0
    time = f"{result.free_seconds:6.2f} s free {result.seconds:6.2f} s solid"
    wrong = "; ".join(faults(result)) or "in order"
    return f"{result.name:46}{deepest:6.1f} mm {degrees:5.1f}° {time}  {wrong}"


def _limits(found: Sequence[SolidFigure]) -> Iterator[str]:
    yield "| figure | worst | unit | must | aim | | where |"
    yield "|---|---|---|---|---|---|---|"
    for f in found:
        yield (
            f"| {f.name} | {f.value:.3g} | {f.unit} | {_or(f.must)} | {_or(f.aim)} "
            f"| {_verdict(f)} | {f.where} |"
        )


def _table(results: Sequence[CaseResult]) -> Iterator[str]:
    yield f"| {' | '.join(COLUMNS)} |"
    yield f"|{'---|' * len(COLUMNS)}"
    for result in results:
        yield f"| {' | '.join(_cells(result))} |"


def _cells(result: CaseResult) -> Iterator[str]:
    yield result.name
    deep = {p.keeper: p for p in result.penetrations}
    for keeper in Keeper:
        each = deep.get(keeper)
        yield "" if each is None else _depth(each.deeper_mm, each.what, each.frame)
    joint = result.joint
    yield "" if joint is None else _depth(joint.degrees, joint.joint, joint.frame)
    yield f"{result.free_seconds:.2f}"
    yield f"{result.seconds:.2f}"
    yield "" if result.ratio is None else f"{result.ratio:.2f}"
    physics = result.physics
    yield f"{physics.flight_force:.1g}; {physics.flight_moment:.1g}" if physics else ""
    yield f"{physics.ground_force:.1g}; {physics.ground_moment:.1g}" if physics else ""
    wrong = faults(result)
    yield f"**{'; '.join(wrong)}**" if wrong else "in order"


def _depth(value: float, what: str, frame: float) -> str:
    return f"{value:.1f} ({what}, {frame:g})" if value >= 0.05 else "0"


def _or(value: float | None) -> str:
    return "" if value is None else f"{value:g}"


def _verdict(found: SolidFigure) -> str:
    if found.must is None:
        return "told"
    if not found.ok:
        return "known miss" if found.known else "MISSED"
    return "aim" if found.aim is None or found.value <= found.aim else "must"
