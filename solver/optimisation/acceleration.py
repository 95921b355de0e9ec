"""Anderson acceleration of a fixed-point iteration (Walker and Ni 2011)."""

import numpy as np

from ..arrays import FloatArray


class Anderson:
    """Proposes the next point of y <- y + f(y) from all so far, as GMRES would for linear f."""

    def __init__(self) -> None:
        self._points: list[FloatArray] = []
        self._changes: list[FloatArray] = []

    def next(self, y: FloatArray, f: FloatArray) -> FloatArray:
        """The point, of y's shape, where a combination of the changes f would be least."""
        plain = y + f
        if self._points:
            bend = np.stack([(f - each).ravel() for each in self._changes], axis=1)
            shares = np.linalg.lstsq(bend, f.ravel(), rcond=None)[0]
            for share, point, change in zip(shares, self._points, self._changes, strict=True):
                plain = plain - share * (y + f - point - change)
        self._points.append(y)
        self._changes.append(f)
        return np.asarray(plain)
