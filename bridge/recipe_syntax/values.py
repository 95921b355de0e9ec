"""The values of a recipe's text, TOML or JSON, with their lines."""

import json
import re
import tomllib
from typing import Any

from ...solver.data.faults import BadRecipe
from .source_lines import KeyPath, json_lines, toml_lines

# What people write who do not know TOML, by how it begins.
_HINTS = (
    (re.compile(r"[+-]?\.\d"), "a number begins with a digit, such as 0.5"),
    (re.compile(r"[^\W\d]"), "a text needs quotes, and true and false are lower case"),
)
# A table's name as tomllib tells it, ('body', 'parts').
_PYTHON_KEY, _PART = re.compile(r"\(('[^']*',? ?)+\)"), re.compile(r"'([^']*)'")
_ABSURD = (ValueError, RecursionError)  # a number of 5,000 digits; 1,000 brackets


def recipe_values(text: str, path: str) -> tuple[dict[str, Any], dict[KeyPath, int]]:
    """A recipe's values as they are written, and the line of each key and element.

    path is for faults alone. Raises BadRecipe.
    """
    if text.lstrip().startswith("{"):
        return _parse_json(text, path)
    try:
        values = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _no_toml(text, path, str(error)) from error
    except _ABSURD as error:
        raise BadRecipe(path, None, "not TOML that can be read; see the examples") from error
    return values, dict(toml_lines(text))


def _no_toml(text: str, path: str, why: str) -> BadRecipe:
    """The fault of a text of which tomllib says why it is no TOML: what stands there, and what
    was probably meant."""
    message, _, place = why.rpartition(" (at ")
    message = _PYTHON_KEY.sub(lambda key: f"[{'.'.join(_PART.findall(key[0]))}]", message)
    told = re.fullmatch(r"line (\d+), column (\d+)\)", place)
    if told is None:  # past the last character
        return BadRecipe(path, text.count("\n") + 1, f"not TOML ({message}); correct the line")
    line, column = int(told[1]), int(told[2])
    there = text.split("\n")[line - 1][column - 1 :].strip()
    hints = _HINTS if message == "Invalid value" else ()
    hint = next((f" ({hint})" for begins, hint in hints if begins.match(there)), "")
    at = f" at “{there[:40]}”" if there else ""
    return BadRecipe(path, line, f"not TOML{at} ({message}); correct it{hint}")


def _parse_json(text: str, path: str) -> tuple[dict[str, Any], dict[KeyPath, int]]:
    try:
        values = json.loads(text)
    except json.JSONDecodeError as error:
        raise BadRecipe(path, error.lineno, f"not JSON ({error.msg}); correct the line") from error
    except _ABSURD as error:
        raise BadRecipe(path, None, "not JSON that can be read; see the examples") from error
    lines: dict[KeyPath, int] = {}
    for place, line in json_lines(text):
        if place in lines:
            raise BadRecipe(path, line, f'"{place[-1]}" is there twice; keep one')
        lines[place] = line
    return values, lines
