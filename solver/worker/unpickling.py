"""Unpickling of this package's own records, which can name nothing else: so it runs no program.

Standard library only, as the protocol.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import is_dataclass
from enum import Enum
from importlib import import_module
from io import BytesIO
from typing import Any

_SOLVER = ".solver."
_NUMPY = {
    ("numpy", "ndarray"),
    ("numpy", "dtype"),
    *(
        (f"numpy.{core}.multiarray", name)
        for core in ("core", "_core")
        for name in ("_reconstruct", "scalar")
    ),
    *((f"numpy.{core}.numeric", "_frombuffer") for core in ("core", "_core")),
}
# What unpickling raises on nonsense.
_UNREADABLE = (
    pickle.UnpicklingError,
    AttributeError,
    EOFError,
    ImportError,
    LookupError,
    OverflowError,
    TypeError,
    ValueError,
)


class Unreadable(Exception):
    """Bytes that are no pickle, or name what is not expected."""


def is_data(kind: type) -> bool:
    """Whether a class is a data class or an enum."""
    return is_dataclass(kind) or issubclass(kind, Enum)


def unpickled(content: bytes, expected: Callable[[type], bool] = lambda _: True) -> Any:
    """What a pickle of the solver's records holds, whatever its writer calls the package.

    It may name numpy's arrays, and classes of the solver that are `expected`. Raises Unreadable,
    MemoryError.
    """
    try:
        return _Reader(content, expected).load()
    except _UNREADABLE as problem:
        raise Unreadable(str(problem)) from problem


class _Reader(pickle.Unpickler):
    def __init__(self, content: bytes, expected: Callable[[type], bool]) -> None:
        super().__init__(BytesIO(content))
        self._expected = expected

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) in _NUMPY:
            return super().find_class(module, name)
        package = __name__.rpartition(_SOLVER)[0]
        _, solver, below = module.rpartition(_SOLVER)
        if solver and below.replace(".", "_").isidentifier():
            own = f"{package}{_SOLVER}{below}"
            found = getattr(import_module(own), name)
            if isinstance(found, type) and found.__module__ == own and self._expected(found):
                return found
        raise pickle.UnpicklingError(f"{module}.{name} is not expected")
