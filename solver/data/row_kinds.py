"""Constraint types and their violations, as reports and faults name them; without CasADi.

BW is the body's weight, mass times standard gravity.
"""

from dataclasses import dataclass
from enum import Enum
from math import degrees


class RowKind(Enum):
    """Constraint type: label, unit of its value, feasibility tolerance in that unit.

    Moment and pins hold at their nodes ten times better than an adaptation must between them
    (fitting/fit.py): closer, weak rows ask for long ways, and nobody has anything of it.
    """

    BALANCE = ("balance", "BW", 1e-5)
    MOMENT = ("moment", "BW·m", 1e-4)
    PIN = ("pin", "m", 4e-5)
    PIN_SPEED = ("pin's speed", "m/s", 1e-3)
    POINT = ("point", "m", 3e-4)
    BEND = ("bend", "rad", 2e-3)
    CONE = ("cone", "rad", 2e-3)
    TWIST = ("twist", "rad", 2e-3)
    ORIENTATION = ("orientation", "rad", 2e-3)
    POSE = ("pose", "rad", 2e-3)
    PUSH = ("push", "BW of pull", 0.01)
    FRICTION = ("friction", "BW beyond friction", 0.01)
    PEAK = ("peak", "BW beyond the cap", 0.01)
    TORQUE = ("torque", "BW·m beyond the limit", 2e-5)
    SOLID = ("solid", "m", 1e-3)
    RANGE = ("joint range", "rad", 2e-3)

    @property
    def label(self) -> str:
        return self.value[0]

    @property
    def unit(self) -> str:
        return self.value[1]

    @property
    def tolerance(self) -> float:
        return self.value[2]

    @property
    def guards(self) -> bool:
        """Whether nobody asks for it: it is kept where it can be, and else told."""
        return self in (RowKind.SOLID, RowKind.RANGE)

    @property
    def reported_unit(self) -> str:
        """The unit that people read: mm, degrees and N·m for m, rad and BW·m."""
        if self is RowKind.TORQUE:
            return "N·m beyond the limit"
        return {"m": "mm", "rad": "degrees"}.get(self.unit, self.unit)

    def reported(self, amount: float, weight: float) -> float:
        """An amount of `unit` in `reported_unit`. weight: the body's, N."""
        if self is RowKind.TORQUE:
            return amount * weight
        match self.unit:
            case "m":
                return 1000.0 * amount
            case "rad":
                return degrees(amount)
        return amount


@dataclass(frozen=True)
class Violation:
    """Worst violation of one constraint; name: the artist's, or a contact's or a phase's.

    amount: in the kind's `reported_unit`. frame: the scene's, where it is the worst; None where it
    is not at one.
    """

    name: str
    kind: RowKind
    amount: float
    frame: float | None = None
