"""A CasADi function at many points at once."""

from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from ..arrays import FloatArray
from .parallel import in_threads

MIN_POINTS_PER_THREAD = 32  # worth a thread of their own


class BatchFunction:
    """A function of one vector x, evaluated in numpy's memory and in plain threads.

    Plain threads: CasADi's own threaded map was slower than the serial one.
    """

    def __init__(self, name: str, x: ca.SX, outputs: Sequence[ca.SX]) -> None:
        """x: (n, 1). outputs: vectors (r, 1) or matrices (r, c)."""
        self._function = ca.Function(name, [x], [ca.densify(each) for each in outputs])
        self._shapes = [(o.shape[0],) if o.shape[1] == 1 else o.shape[::-1] for o in outputs]

    def __call__(self, x: FloatArray) -> list[FloatArray]:
        """Outputs (N, r) of vectors, (N, c, r) of matrices, at rows of x (N, n).

        CasADi stores columns first.
        """
        inputs = np.ascontiguousarray(x, dtype=float)
        outputs = [np.empty((len(x), *shape)) for shape in self._shapes]
        in_threads(
            lambda part: self._fill(inputs[part], [out[part] for out in outputs]),
            len(x),
            MIN_POINTS_PER_THREAD,
        )
        return outputs

    def _fill(self, inputs: FloatArray, outputs: Sequence[FloatArray]) -> None:
        """Evaluates into the given memory, without the conversions that would cost more than it."""
        buffer: Any  # CasADi's stubs give its methods C's arguments
        buffer, run = self._function.map(len(inputs)).buffer()
        buffer.set_arg(0, inputs.data)
        for i, out in enumerate(outputs):
            buffer.set_res(i, out.data)
        run()
