"""docs/rigs.md: the figures, and every rig's row."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..figures.limits import WorstFigure
from .controlled import ControlResult, control_page
from .result import RigResult

HEAD = """# Rigs

`python3 dev.py rigs --out DIR` measures these anew (about {minutes:.0f} minutes on a busy machine
with 2 cores) and wrote this page; `DIR/figures.json` has every number.
"""
NOTES = """
One recorded jump is carried onto skeletons that are named and laid out as programs do it
(`devtools/rigs/layouts`): their rest poses, bone axes and rolls, units, rotation modes, roots,
twist and helper bones differ, their joint centres do not. Bones between the recording's joints are
rigid to it.

- **Mapped**: every part of the body has its bone, by itself. By what: *name and shape* agree; by
  *name*, where the skeleton's shape tells less; by its *shape* alone.
- **Same edit**: the landing moved by 0.3 m, adapted on each rig, written and read again; the
  largest distance of a joint centre from where it is on the first rig. Empty: only mapped.
- **File round trip**: the adapted action of each rig as FBX, glTF and USD, for Unreal, Unity, Godot
  and for no engine, read by Blender's importers (FBX by the add-on and by the native one); the
  largest difference of any bone's place and turn at any frame, in glTF of its turn since the first.
- The command ends with 1 where a limit (`devtools/rigs/limits.py`) is missed.
"""
COLUMNS = ("rig", "bones", "named as", "mapped", "by", "same edit (mm)", "worst")


def page(
    results: Sequence[RigResult],
    controlled: Sequence[ControlResult],
    found: Sequence[WorstFigure],
    minutes: float,
) -> str:
    """The whole page."""
    rows = [f"| {' | '.join(_cells(result))} |" for result in results]
    parts = [
        HEAD.format(minutes=minutes),
        "| figure | found | unit | must | aim | | where |",
        "|---|---|---|---|---|---|---|",
        *(
            f"| {f.name} | {f.value:.3g} | {f.unit} | {f.must:g} | {f.aim:g} | {_verdict(f)} "
            f"| {f.where} |"
            for f in found
        ),
        NOTES,
        f"| {' | '.join(COLUMNS)} |",
        f"|{'---|' * len(COLUMNS)}",
        *rows,
        *control_page(controlled),
    ]
    return "\n".join(parts) + "\n"


def text(found: Sequence[WorstFigure]) -> str:
    """The figures for a terminal."""
    width = max(len(f.name) for f in found)
    return "\n".join(
        f"{f.name:{width}} {f.value:8.3g} {f.unit:3} must {f.must:g}, aim {f.aim:g}  "
        f"{_verdict(f):6} {f.where}"
        for f in found
    )


def line(result: RigResult) -> str:
    """One rig in a terminal's line."""
    said = "mapped" if result.mapped else result.failed or "; ".join(result.wrong)
    if result.difference_mm is not None:
        said += f", {result.difference_mm:.2f} mm ({result.joint}, frame {result.frame:g})"
    return f"{result.name:30}{result.bones:4} bones  {said}"


def _cells(result: RigResult) -> Iterator[str]:
    yield result.name
    yield str(result.bones)
    yield result.convention or "unknown"
    yield "yes" if result.mapped else f"**{result.failed or '; '.join(result.wrong)}**"
    yield ", ".join(f"{word} {count}" for word, count in result.evidence)
    tried = result.difference_mm is not None
    yield f"{result.difference_mm:.2f}" if tried else ""
    yield f"{result.joint}, frame {result.frame:g}" if tried and result.difference_mm else ""


def _verdict(found: WorstFigure) -> str:
    if not found.ok:
        return "MISSED"
    return "aim" if found.reached else "must"
