"""Texts that Hangtime keeps in properties, as JSON, and how they are read.

Scripts, add-ons and other versions may leave anything there, so each states what it must be.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite
from typing import Any, Generic, NoReturn, TypeVar

T = TypeVar("T")
Spans = tuple[tuple[float, float], ...]
"""First and last frame of each."""

# What reading raises of what is of another type, length or size.
_OTHERWISE = (ValueError, TypeError, LookupError, ArithmeticError, RecursionError)


@dataclass(frozen=True)
class HiddenText(Generic[T]):
    """A kind of text. name: of the property that holds it. read: from its JSON; raises ValueError,
    TypeError, LookupError or ArithmeticError where that is something else. nothing: what an empty
    one means."""

    name: str
    read: Callable[[Any], T]
    nothing: T

    def of(self, stored: object) -> T:
        """What a property holds; nothing where that is not Hangtime's, which `is_ours` tells."""
        try:
            return self._read(stored)
        except _OTHERWISE:
            return self.nothing

    def is_ours(self, stored: object) -> bool:
        """Whether a property holds what Hangtime may have written."""
        try:
            self._read(stored)
        except _OTHERWISE:
            return False
        return True

    def _read(self, stored: object) -> T:
        if stored is None or stored == "":
            return self.nothing
        if not isinstance(stored, str):
            raise TypeError(stored)
        return self.read(json.loads(stored, parse_constant=_no_number))


def _no_number(constant: str) -> NoReturn:
    """Of NaN and Infinity, which JSON does not have and Python reads all the same."""
    raise ValueError(constant)


def number(value: Any) -> float:
    """A finite number."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise TypeError(value)
    return float(value)


def whole(value: Any) -> int:
    """A whole number, from 0 on."""
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise TypeError(value)
    return value


def word(value: Any) -> str:
    """A text."""
    if not isinstance(value, str):
        raise TypeError(value)
    return value


def entries(value: Any) -> dict[str, Any]:
    """A table."""
    if not isinstance(value, dict):
        raise TypeError(value)
    return value


def listed(value: Any) -> list[Any]:
    """A list; neither a text nor a table, which Python would go through too."""
    if not isinstance(value, list):
        raise TypeError(value)
    return value


def spans_text(name: str) -> HiddenText[Spans]:
    """Such as "[[12.0, 20.0], [31.0, 31.0]]", in a property of this name."""
    return HiddenText(name, _spans, ())


def _spans(value: Any) -> Spans:
    found = tuple((number(first), number(last)) for first, last in map(listed, listed(value)))
    if any(last < first for first, last in found):
        raise ValueError(value)
    return found
