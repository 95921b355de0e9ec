"""The values of a recipe's text, TOML or JSON, with their lines."""

import json
import tomllib
from typing import Any

from ...solver.data.faults import BadRecipe
from .source_lines import KeyPath, json_lines, toml_lines

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
        message, _, place = str(error).rpartition(" (at ")
        # Past its last character tomllib says "end of document" instead of a line.
        line = place.split()[1].rstrip(",") if place.startswith("line ") else text.count("\n") + 1
        raise BadRecipe(path, int(line), f"not TOML ({message}); correct the line") from error
    except _ABSURD as error:
        raise BadRecipe(path, None, "not TOML that can be read; see the examples") from error
    return values, dict(toml_lines(text))


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
