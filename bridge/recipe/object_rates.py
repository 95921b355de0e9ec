"""Steady motion of an object of a recipe's scene, and of a belt on its surface.

velocity = [3, 0, 0]            # m/s, from the first frame on
spin = 30                       # degrees a second about the vertical, counter-clockwise from above
pivot = [0, 0, 0]               # ... through here, which goes along; default: the world's origin
belt = [0, -2, 0]               # m/s of the surface in the object's axes; the object stays
"""

import math

from ...solver.data.scene import SceneObject, SteadyMotion
from ..recipe_syntax.items import Values
from ..recipe_syntax.table import Table
from ..recipe_syntax.toml_text import degrees

RATE_KEYS = ("velocity", "spin", "pivot", "belt")


def read_rates(table: Table) -> SteadyMotion | None:
    """The rates of an object's table, None where it has none. Raises BadRecipe."""
    if not set(RATE_KEYS) & set(table.values):
        return None
    if "pivot" in table.values and "spin" not in table.values:
        table.refuse("pivot", 'a "pivot" is what an object spins about; add a "spin"')
    none = SteadyMotion()
    return SteadyMotion(
        velocity=table.vector("velocity") or none.velocity,
        spin=math.radians(table.number("spin") or 0.0),
        pivot=table.vector("pivot") or none.pivot,
        belt=table.vector("belt") or none.belt,
    )


def rate_values(thing: SceneObject) -> Values:
    """The keys that `read_rates` reads as the object's steady motion."""
    steady, none = thing.steady, SteadyMotion()
    if steady is None:
        return {}
    values = {key: getattr(steady, key) for key in RATE_KEYS}
    kept = {key: value for key, value in values.items() if value != getattr(none, key)}
    return kept | ({"spin": degrees(steady.spin)} if steady.spin else {})
