"""Primal-dual active set method for the small program of a step (Hintermüller, Ito, Kunisch 2002).

A semismooth Newton method: the set of rows at a bound is guessed, the multipliers are solved for,
and the set is corrected by both. From a good guess it ends after one or two linear systems of that
set's size, exactly; it may also cycle, and then says so.
"""

import numpy as np

from ..arrays import FloatArray

ROUNDING = 1e-12  # of the largest multiplier
MAX_SETS = 12  # systems solved before it is given up; most programs take one to four


def multipliers_by_active_set(
    stiffness: FloatArray, lower: FloatArray, upper: FloatArray, guess: FloatArray
) -> FloatArray | None:
    """Multipliers u (m,) of min 1/2 u'S u + support, lower <= -S u <= upper, S (m, m) positive.

    u > 0 where a row is at its upper bound, u < 0 at its lower, 0 in between. guess: (m,) the signs
    of u to begin with. None where no set was found that reproduces itself.
    """
    # Of rows in their own units none is lost in the rounding of another's.
    scale = np.sqrt(np.diagonal(stiffness))
    stiffness = stiffness / np.outer(scale, scale)
    lower, upper, u = lower / scale, upper / scale, np.zeros(len(guess))
    side = np.where(np.isfinite(np.where(guess > 0.0, upper, lower)), np.sign(guess), 0.0)
    for _ in range(MAX_SETS):
        active = np.flatnonzero(side)
        bound = np.where(side > 0.0, upper, lower)[active]
        u[:] = 0.0
        u[active] = np.linalg.solve(stiffness[np.ix_(active, active)], -bound)
        reached = -stiffness[:, active] @ u[active]
        rounding = ROUNDING * np.abs(u).max(initial=0.0)
        above = u + reached - upper > rounding
        below = u + reached - lower < -rounding
        found = np.where(above, 1.0, np.where(below, -1.0, 0.0))
        if (found == side).all():
            return np.asarray(u / scale)
        side = found
    return None
