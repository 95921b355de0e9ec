"""What is found about control rigs, what they must reach, and their rows on the page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from .limits import RigFigure

OFF_MM, OFF_AIM_MM = 1.0, 0.1
TURNED_DEGREES, TURNED_AIM_DEGREES = 0.2, 0.05
DRIFT_MM, DRIFT_AIM_MM = 1.0, 0.1
# Rigify's limbs in inverse kinematics, and its spine, stretch: bones end where they should, but the
# halves of a thigh, and the skin about the spine, are not of their usual size.
KNOWN_OFF_MM, KNOWN_SKIN_MM = 5.0, 30.0
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
)
NOTES = """
## Control rigs

The jump at 24 frames a second on the controls of Rigify's generated human, and of a rig laid out
as Auto-Rig Pro's (`devtools/rigs/controls/auto_rig_pro.toml`), with the limbs in forward (FK) and
in inverse kinematics (IK). The landing is moved by 0.3 m, the result written to the controls.

- **Places, turns**: every bone that deforms, as Blender evaluates it on every frame, against
  forward kinematics of the solution's joint angles; what the writer says of itself does not count.
  Bones that share out a limb's twist count by where they point.
- **Skin**: vertices of a tube about each such bone that move with it alone, likewise.
- **Foot's keys**: how far over the ground the keys of a foot's IK control carry its heel while it
  is pinned.
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


def control_figures(results: Sequence[ControlResult]) -> list[RigFigure]:
    """Every figure that these control rigs give."""
    if not results:
        return []
    refused = [r for r in results if r.off is None]
    unmapped = [r.name for r in results if not r.mapped]
    count = len(results)
    found = [
        RigFigure(
            "control rigs mapped with no hand work",
            count - len(unmapped),
            "1",
            count,
            count,
            ", ".join(unmapped),
            least=True,
        ),
        RigFigure(
            "control rigs to which the edit was written",
            count - len(refused),
            "1",
            count,
            count,
            ", ".join(r.name for r in refused),
            least=True,
        ),
    ]
    told: tuple[tuple[str, str, str, float, float, float | None], ...] = (
        (
            "off",
            "control rig: deform bones off the solution",
            "mm",
            OFF_MM,
            OFF_AIM_MM,
            KNOWN_OFF_MM,
        ),
        (
            "turned",
            "control rig: deform bones turned off the solution",
            "°",
            TURNED_DEGREES,
            TURNED_AIM_DEGREES,
            None,
        ),
        ("skin", "control rig: skin off the solution", "mm", OFF_MM, OFF_AIM_MM, KNOWN_SKIN_MM),
        (
            "drift",
            "control rig: slide of the pinned foot's keys",
            "mm",
            DRIFT_MM,
            DRIFT_AIM_MM,
            None,
        ),
    )
    for quantity, name, unit, must, aim, known in told:
        tried = [(getattr(r, quantity), r.name) for r in results if getattr(r, quantity)]
        if tried:
            worst, rig = max(tried, key=lambda each: each[0].value)
            where = f"{rig}: {worst.place}"
            found.append(RigFigure(name, worst.value, unit, must, aim, where, known=known))
    return found


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


def _worst(worst: Worst | None) -> tuple[str, str]:
    return (f"{worst.value:.3f}", worst.place) if worst else ("", "")
