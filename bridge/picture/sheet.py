"""Contents of a picture of motions: strobe figures of each, one row above the other."""

from dataclasses import dataclass
from math import radians

from ...solver.arrays import FloatArray
from .annotations import Mark


@dataclass(frozen=True)
class Limb:
    """One rigid body, drawn as a solid.

    size: (3,) extents m of its box: width, depth, length along the axes of the body's frame.
    centre: (T, 3) m, world. rotation: (T, 3, 3), body to world.
    """

    name: str
    size: FloatArray
    centre: FloatArray
    rotation: FloatArray


@dataclass(frozen=True)
class SheetRow:
    """One motion of the picture; world frame, m, Z up.

    times: (T,) s, increasing. com: (T, 3) centre of mass. pins: (P, 3) contact points of the feet:
    red spheres, with a step below those above the ground.
    key_times: instants (s) to be shown before others, such as take-off, landing and apex; the most
    wanted first.
    pin_times: for each pin the first and last instant (s) it holds, shown at least once; where left
    out, a pin holds whenever the body touches it.
    marks: what else is drawn. ground: height m of the floor; where left out, the lowest pin's.
    """

    title: str
    times: FloatArray
    limbs: tuple[Limb, ...]
    com: FloatArray
    pins: FloatArray
    key_times: tuple[float, ...] = ()
    pin_times: tuple[tuple[float, float], ...] = ()
    marks: tuple[Mark, ...] = ()
    ground: float | None = None


@dataclass(frozen=True)
class View:
    """Camera and density of the rows.

    figures: about how many in a row. elevation: rad, of the viewer above the horizon. heading:
    (x, y) world direction drawn to the right; where left out, that of the travel. in_place: figures
    stand where they are, though they hide each other, and so does the scene around them. above:
    whether all rows are shown once more, from above.
    """

    figures: int = 10
    elevation: float = radians(15.0)
    heading: tuple[float, float] | None = None
    in_place: bool = False
    above: bool = False
