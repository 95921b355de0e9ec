"""What is found about control rigs, what they must reach, and their rows on the page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ..figures.limits import WorstFigure

OFF_MM, OFF_AIM_MM = 1.0, 0.1
TURNED_DEGREES, TURNED_AIM_DEGREES = 0.2, 0.05
DRIFT_MM, DRIFT_AIM_MM = 1.0, 0.1
KEYS_OFF_MM, KEYS_DEGREES = 2.0, 0.2
KEYS_RATE, KEYS_RATE_AIM = 12.0, 6.0
KEYS_DRIFT_MM = 2.0
COLUMNS = (
    "control rig",
    "bones",
    "mapped",
    "places (mm)",
    "where",
    "turns (°)",
    "where",
    "skin (mm)",
    "where",
    "foot's keys (mm)",
    "writing (s)",
    "reduced keys (1/s)",
    "off (mm)",
    "turned (°)",
    "foot (mm)",
    "choosing (s)",
)
NOTES = """
## Control rigs

The jump at 24 frames a second on the controls of Rigify's generated human, and of a rig laid out
as Auto-Rig Pro's (`devtools/rigs/controls/auto_rig_pro.toml`), with the limbs in forward (FK) and
in inverse kinematics (IK). The landing is moved by 0.3 m, the result written to the controls.

- **Places, turns**: every bone that deforms, as Blender evaluates it on every frame, against
  forward kinematics of the solution's joint angles; what the writer says of itself does not count.
  Bones that share out a limb's twist count by where they point, and are at their share of the way
  between its joints: limbs that stretch are in the take, and in its figure, not as long as at rest.
- **Skin**: vertices of a tube about each bone of a body that move with it alone, against the same
  skin on a copy of the rig without controls and constraints, whose deform bones are put where the
  solution has them. Bendy bones bend there as well, by their own settings, as towards the neck:
  that is what their rigger wants, and rigid bodies say nothing of it.
- **Foot's keys**: how far over the ground the keys of a foot's IK control carry its heel while it
  is pinned.
- **Reduced keys**: Bézier keys within 2 mm and 0.2° instead of one on every frame, by second and
  channel; how far the bodies then are, on every frame as they play, from where they were with all
  keys; and the slide of the foot's control with these.
"""


@dataclass(frozen=True)
class Worst:
    """The largest of a quantity, and where: at which bone and frame."""

    value: float
    bone: str
    frame: float

    @property
    def place(self) -> str:
        """Its bone and frame in words."""
        return f"{self.bone}, frame {self.frame:g}"


@dataclass(frozen=True)
class SparseKeys:
    """What reduced keys leave: keys a second and channel; by how much bodies, as they play, are off
    the keys on every frame, mm and degrees; drift: as of ControlResult; seconds: of choosing."""

    rate: float
    off: Worst
    turned: Worst
    seconds: float
    drift: Worst | None = None


def worst_of(values: FloatArray, names: Sequence[str], frames: FloatArray) -> Worst:
    """The largest of values (T, N), by name and frame."""
    t, n = np.unravel_index(int(values.argmax()), values.shape)
    return Worst(float(values[t, n]), names[int(n)], float(frames[t]))


@dataclass(frozen=True)
class ControlResult:
    """The edit on one control rig. mapped: whether its bones were found by themselves, and rightly.

    off, turned, skin: mm, degrees, and mm of the skin's vertices from the solution; None where
    nothing was written. drift: mm that
    the keys of a foot's control slide while its heel is pinned; None in FK. refused: why nothing
    was written, in words; seconds: of writing.
    """

    key: str
    name: str
    bones: int
    mapped: bool
    off: Worst | None = None
    turned: Worst | None = None
    skin: Worst | None = None
    drift: Worst | None = None
    refused: str = ""
    seconds: float = 0.0
    sparse: SparseKeys | None = None


def control_figures(results: Sequence[ControlResult]) -> list[WorstFigure]:
    """Every figure that these control rigs give."""
    if not results:
        return []
    refused = [r for r in results if r.off is None]
    unmapped = [r.name for r in results if not r.mapped]
    count = len(results)
    found = [
        WorstFigure(
            "control rigs mapped with no hand work",
            count - len(unmapped),
            "1",
            count,
            count,
            ", ".join(unmapped),
            least=True,
        ),
        WorstFigure(
            "control rigs to which the edit was written",
            count - len(refused),
            "1",
            count,
            count,
            ", ".join(r.name for r in refused),
            least=True,
        ),
    ]
    told = (
        ("off", "control rig: deform bones off the solution", "mm", OFF_MM, OFF_AIM_MM),
        (
            "turned",
            "control rig: deform bones turned off the solution",
            "°",
            TURNED_DEGREES,
            TURNED_AIM_DEGREES,
        ),
        ("skin", "control rig: skin off the solution", "mm", OFF_MM, OFF_AIM_MM),
        ("drift", "control rig: slide of the pinned foot's keys", "mm", DRIFT_MM, DRIFT_AIM_MM),
    )
    for quantity, name, unit, must, aim in told:
        tried = [(getattr(r, quantity), r.name) for r in results if getattr(r, quantity)]
        if tried:
            worst, rig = max(tried, key=lambda each: each[0].value)
            where = f"{rig}: {worst.place}"
            found.append(WorstFigure(name, worst.value, unit, must, aim, where))
    return found + _sparse_figures([(r.name, r.sparse) for r in results if r.sparse])


def _sparse_figures(found: Sequence[tuple[str, SparseKeys]]) -> list[WorstFigure]:
    """Of reduced keys on controls; the worst rig of each."""
    figures = []
    if found:
        rig, most = max(found, key=lambda each: each[1].rate)
        figures.append(
            WorstFigure(
                "reduced keys on controls, a second and channel",
                most.rate,
                "1",
                KEYS_RATE,
                KEYS_RATE_AIM,
                rig,
            )
        )
    told = (
        ("off", "reduced keys on controls: bones off", "mm", KEYS_OFF_MM, KEYS_OFF_MM),
        ("turned", "reduced keys on controls: bones turned", "°", KEYS_DEGREES, KEYS_DEGREES),
        ("drift", "reduced keys on controls: slide of the pinned foot", "mm", KEYS_DRIFT_MM, 0.5),
    )
    for quantity, name, unit, must, aim in told:
        tried = [(getattr(keys, quantity), rig) for rig, keys in found if getattr(keys, quantity)]
        if tried:
            worst, rig = max(tried, key=lambda each: each[0].value)
            figures.append(WorstFigure(name, worst.value, unit, must, aim, f"{rig}: {worst.place}"))
    return figures


def control_line(result: ControlResult) -> str:
    """One rig in a terminal's line."""
    said = result.refused
    if result.off is not None and result.turned is not None:
        said = f"{result.off.value:.3f} mm ({result.off.place}), "
        said += f"{result.turned.value:.3f}° ({result.turned.place})"
    if result.drift is not None:
        said += f", foot's keys {result.drift.value:.3f} mm"
    return f"{result.name:30}{result.bones:4} bones  {said}"


def control_page(results: Sequence[ControlResult]) -> list[str]:
    """The page's part on control rigs, in blocks of lines."""
    rows = [f"| {' | '.join(_cells(result))} |" for result in results]
    return [NOTES, f"| {' | '.join(COLUMNS)} |", f"|{'---|' * len(COLUMNS)}", *rows]


def _cells(result: ControlResult) -> Iterator[str]:
    yield result.name
    yield str(result.bones)
    yield "yes" if result.mapped else "**no**"
    if result.off is None:
        yield "**refused**"
        yield result.refused
        yield from [""] * (len(COLUMNS) - 5)
        return
    yield from _worst(result.off)
    yield from _worst(result.turned)
    yield from _worst(result.skin)
    yield f"{result.drift.value:.3f}" if result.drift else ""
    yield f"{result.seconds:.0f}"
    keys = result.sparse
    if keys is None:
        yield from [""] * 5
        return
    yield f"{keys.rate:.1f}"
    yield f"{keys.off.value:.2f}"
    yield f"{keys.turned.value:.3f}"
    yield f"{keys.drift.value:.2f}" if keys.drift else ""
    yield f"{keys.seconds:.0f}"


def _worst(worst: Worst | None) -> tuple[str, str]:
    return (f"{worst.value:.3f}", worst.place) if worst else ("", "")
