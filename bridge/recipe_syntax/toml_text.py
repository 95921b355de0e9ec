"""TOML serialisation in the style of a text that a person would write."""

import json
import math
from collections.abc import Iterable, Mapping


def entries(values: Mapping[str, object]) -> str:
    """Lines `key = value`; what is None is left out."""
    pairs = [(k, v) for k, v in values.items() if v is not None]
    return "".join(f"{_key(key)} = {_value(value)}\n" for key, value in pairs)


def sections(header: str, values: Mapping[str, object]) -> list[str]:
    """The table of the values and tables of those that are tables themselves; none is empty."""
    flat = {key: value for key, value in values.items() if not isinstance(value, dict)}
    texts = [f"[{header}]\n{entries(flat)}"] if flat else []
    for key, held in values.items():
        texts += sections(f"{header}.{key}", held) if isinstance(held, dict) else []
    return texts


def degrees(angle: float) -> float:
    """The roundest number of degrees that is read as this angle, in rad, again."""
    exact = math.degrees(angle)
    rounded = (round(exact, digits) for digits in range(13))
    return next((r for r in rounded if math.radians(r) == angle), exact)


def _key(key: str) -> str:
    return key if key.replace("_", "").isalnum() and key.isascii() else _text(key)


def _value(value: object, nested: bool = False) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return _text(value)
        case int() | float():
            return _number(float(value))
        case dict():
            pairs = (f"{_key(key)} = {_value(held, True)}" for key, held in value.items())
            return _bracketed("{ ", pairs, " }")
        case tuple() if not nested and any(isinstance(held, dict | tuple) for held in value):
            lines = (f"  {_value(held, True)},\n" for held in value)
            return _bracketed("[\n", lines, "]", "")
        case tuple():
            return _bracketed("[", (_value(held, True) for held in value), "]")
    raise TypeError(value)


def _bracketed(opening: str, parts: Iterable[str], closing: str, between: str = ", ") -> str:
    return f"{opening}{between.join(parts)}{closing}"


def _text(text: str) -> str:
    # JSON's escapes are TOML's, but for the one control character that JSON lets stand.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _number(number: float) -> str:
    return str(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)
