"""The clips' figures in tables, for the terminal, and docs/validation.md, which has them too."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from .columns import LANDED, LANDINGS, MOTION, MOTIONS, SMOOTHED, TABLES, smoothing
from .limits import KNOWN_DEFECTS, ValidationFigure
from .result import TrialResult

T = TypeVar("T")
HEAD = """# Against force plates

`python3 dev.py validate [FOLDER] --page` wrote this page. It takes recordings with measured
ground forces, finds the contacts, fits, and sets the contact forces beside the plates'. The fit
knows the recording and the body's mass, nothing of the forces. `examples/recordings` holds one
such trial, `BMC_run`; the others here may not be redistributed (README of their folder), but
any folder in the same format will do.

- **Format.** `X.bvh` in centimetres, Y up, forward +Z, left +X. `X_grf.csv`: per foot force on
  the body (N) and centre of pressure (m) in the same axes, zero below 20 N. `X_com.csv`: the
  centre of mass of the laboratory's own model. `X.json`: `subject_mass_kg`, `kind`, `bvh_fps`,
  `bvh_frames`, `valid_window_s`, `baseline_window_s`, `direct_differentiation_baseline`.
- **Frames.** Those of the valid window, in which all support was measured; read through Blender,
  as `dev.py adapt` reads a clip.
- **Filter.** Butterworth of order 2, both ways (no delay), on both sides alike, at 10, 15 and 20
  Hz.
- **Window.** `baseline_window_s`: the valid window without the 60 ms that a filter's edge spoils,
  flights included; the same for all columns. Errors over the stances alone are told beside.
- **Plain differentiation**, the yardstick: the laboratory's centre of mass, by central
  differences twice, low-passed after. It needs no contacts and no body, and is no floor: the
  recording's own noise is in it. What it gives here is within 0.001 BW at 15 Hz of what the
  trials' files have stored.
- **A refused trial** is one in which something unseen carries the body (`unseen_support =
  "refuse"`): contact forces are not all then. It counts as missed, and no mean has it. A walk is
  judged by its error in body weights, for its baseline is near the noise.
- **Known misses** are declared in `devtools/validation/limits.py`, with the value that each must
  not pass meanwhile. The command ends with 1 for any other miss, any other refusal, and any crash.
  Means and medians are judged from five trials on; of fewer they are told.
- **Recordings**: jumps and runs of `examples/recordings` without force plates, of which the motion
  alone is judged.

**Constants.** Those of contact detection (`PointKind`, `contacts/force_timing.py`) were set on the
trials Subject4 and run200 and on the walk; some of them on recordings without plates
(`forward_jump_*`, `fair1_jumping`). Those of the fit (`FIT_COST_WEIGHTS`, `SMOOTHING_TIME`,
`LEVEL_SMOOTHING_TIME`, `SOLE_COMPLIANCE`, `SINKING_TIME`, `EDGE_SPAN`) were set on Subject4_DJ1,
DJ2 and run200; BMC_run, run400, LaiArnoldSubject5_DJ2 and the knees of `hops_in_place` were looked
at meanwhile. No constant knows a trial.

**Other values.** `--vary NAME=VALUE ...` measures with other values of constants, each in its own
unit: `SMOOTHING_TIME`, `LEVEL_SMOOTHING_TIME`, `IMPACT_DELAY`, `SOLE_COMPLIANCE`, `SINKING_TIME`,
`EDGE_SPAN`, and the weights of the fit's cost (`CostWeights`). With a shorter `SMOOTHING_TIME`
stiff landings come out higher (peaks of `LaiArnoldSubject5_DJ2`).

**What is missed, and why.** *Runs at 3 and 4 m/s, joint centres*: when the plates begin to carry,
the heel is recorded centimetres up, and from the recorded hip the straight leg does not reach the
ground (*Landings as recorded*): the body must come down, and throughout, for its acceleration is
known better than its height. Later contacts (`--vary IMPACT_DELAY=0`), soles that give more than
soles do (`SOLE_COMPLIANCE=0.03`) and legs that may be thrown down (`acceleration_time=0.03`) each
take a part of it, at the price of touch-down times, of points that carry load above their place,
and of torques of the hips. *Hands of `fair1_jumping`*: feet come down fast, must stand with a
sole's give, and are braked before they touch; in flight nothing but the rest of the body can take
what brakes them, and it jerks. *`131_03_hop`*: the one foot that carries turns and slides; held in
one place, it takes the fit 2 cm away and the hands along.
"""


@dataclass(frozen=True)
class Table:
    """A heading, a note below it, the columns' names, and rows of as many words."""

    title: str
    note: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    @property
    def text(self) -> str:
        """For a terminal: columns of equal width, numbers to the right."""
        lines = [self.columns, *self.rows]
        columns = [self._aligned(column) for column in zip(*lines, strict=True)]
        return "\n".join([self.title, *("  ".join(x).rstrip() for x in zip(*columns, strict=True))])

    @staticmethod
    def _aligned(column: tuple[str, ...]) -> list[str]:
        width = max(map(len, column))
        words = any(cell[:1].isalpha() for cell in column[1:])
        return [cell.ljust(width) if words else cell.rjust(width) for cell in column]

    @property
    def markdown(self) -> str:
        lines = [self.columns, ("---",) * len(self.columns), *self.rows]
        parts = [f"## {self.title}", *([self.note] if self.note else [])]
        return "\n\n".join([*parts, "\n".join(f"| {' | '.join(line)} |" for line in lines)])


def tables(results: Sequence[TrialResult], found: Sequence[ValidationFigure]) -> list[Table]:
    """All of them: the limits, and a row for each clip that was solved."""
    measured = [(r.trial, r.measured) for r in results if r.measured]
    moved = [(r.trial, r.motion) for r in results if r.motion]
    refused = tuple((r.trial, r.refused) for r in results if r.refused)
    parts = [_limits(found)]
    parts += [_table(title, note, columns, measured) for title, note, columns in TABLES if measured]
    if moved:
        parts.append(_table("Motion", MOTIONS, MOTION, moved))
        parts.append(_table("Landings as recorded", LANDED, LANDINGS, moved))
    told = [r.measured for r in results if r.measured and r.kind != "walk"]
    if told:
        names = ("width", "vertical", "forward", "sideways")
        parts.append(Table("Smoothing", SMOOTHED, names, smoothing(told)))
    if refused:
        parts.append(Table("Refused", "", ("clip", "because"), refused))
    return parts


def _table(
    title: str,
    note: str,
    columns: Sequence[tuple[str, Callable[[T], str]]],
    rows: Sequence[tuple[str, T]],
) -> Table:
    cells = tuple((name, *(of(measures) for _, of in columns)) for name, measures in rows)
    return Table(title, note, ("clip", *(name for name, _ in columns)), cells)


def page(parts: Sequence[Table]) -> str:
    """The whole of docs/validation.md."""
    return "\n\n".join([HEAD.rstrip(), *(part.markdown for part in parts)]) + "\n"


def _limits(found: Sequence[ValidationFigure]) -> Table:
    return Table(
        "Limits",
        "\n".join(f"Not in these figures: {clip}; {why}." for clip, why in KNOWN_DEFECTS.items()),
        ("figure", "found", "unit", "must", "aim", "", "where"),
        tuple(
            (f.name, f"{f.value:.3g}", f.unit, _or(f.must), _or(f.aim), _verdict(f), f.trial)
            for f in found
        ),
    )


def _or(value: float | None) -> str:
    return "" if value is None else f"{value:g}"


def _verdict(found: ValidationFigure) -> str:
    if found.must is None:
        return "told"
    if not found.ok:
        return "known miss" if found.known else "MISSED"
    return "aim" if found.aim is None or found.value <= found.aim else "must"
