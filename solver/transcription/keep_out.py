"""Keep-out rows: distances between solids that may not fall below a bound.

They begin with no instants at all and get them where a dense grid finds one solid in another
(solid/solid_world.py), so each row has its own pair of solids, instant and bound.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..numerics.splines import SplineBasis
from .constraint import ConstraintFunction
from .sampling import Instants


@dataclass(frozen=True)
class KeepOut:
    """U rows. names: of the items, such as "Left hand in right thigh"; items: (U,) of the rows.

    function: gives (U, 1) m, row by row. times: (U,) s. lower: (U,) m.
    """

    names: tuple[str, ...]
    items: IntArray
    times: FloatArray
    lower: FloatArray
    function: ConstraintFunction

    def instants(self, basis: SplineBasis) -> Instants:
        """Each row's own."""
        return Instants(basis, self.times)

    def limits(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lower and upper (U, 1), m."""
        return self.lower[:, None], np.full((len(times), 1), np.inf)
