"""Numbers of single precision, as Blender stores them, as a person would have written them."""

from __future__ import annotations

import math
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar

import numpy as np

_MOST = 1e30  # far within single precision

T = TypeVar("T")


def shortest(value: T) -> T:
    """A record or tuple in which every number of single precision is the shortest decimal that is
    it in that precision: 0.3, not 0.30000001192092896. Angles have round degrees."""
    return _shortest(value)  # type: ignore[no-any-return]


def _shortest(value: Any) -> Any:
    if isinstance(value, float):
        return _number(value)
    if type(value) is tuple:
        return tuple(_shortest(each) for each in value)
    if is_dataclass(value) and not isinstance(value, type):
        stated = {f.name: getattr(value, f.name) for f in fields(value) if f.init}
        changed = {name: _shortest(held) for name, held in stated.items()}
        return replace(value, **changed)
    return value


def _number(number: float) -> float:
    if number.is_integer() or not abs(number) < _MOST:
        return number
    single = np.float32(number)
    if float(single) != number:
        return number
    angle = math.radians(round(math.degrees(number), 1))
    return angle if np.float32(angle) == single else float(str(single))
