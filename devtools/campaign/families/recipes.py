"""Recipes: those of the examples, damaged; their tables mixed; and any keys with any values."""

import json
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from ....bridge.recipe.contacts import ADDED, CONTACT, PIN
from ....bridge.recipe.export import EXPORT
from ....bridge.recipe.keys import KEYS
from ....bridge.recipe.loop import LOOP
from ....bridge.recipe.objects import HEADER
from ....bridge.recipe.objects import KEYS as OBJECT_KEYS
from ....bridge.recipe.problem import (
    OWN_KEYS,
    locate,
    parse_recipe,
    read_recipe_text,
    write_recipe,
)
from ....bridge.recipe.requests import BODY, NAMED
from ....bridge.recipe.result import RESULT
from ....bridge.recipe.solution import REDUCTION, SOLUTION
from ....bridge.recipe_syntax.items import Kind
from ....solver.data.faults import UnknownBone, UnknownPhase
from ...environment.virtual_environment import ROOT
from ..protocol.case import Family, HostileCase
from ..protocol.damage import damaged_text, write_damaged
from .requests import toml

ARRAYS: tuple[Kind[Any], ...] = (PIN, CONTACT, ADDED, *NAMED)
TABLES: tuple[Kind[Any], ...] = (BODY, SOLUTION, RESULT, KEYS, LOOP, EXPORT)
MANY = {kind.header: kind.keys for kind in ARRAYS} | {HEADER: OBJECT_KEYS}
ONCE = {
    **{kind.header: kind.keys for kind in TABLES},
    "solution.reduction": REDUCTION.keys,
    "solution.objectives": ("closeness", "power", '"mass displacement"', '"torque output"'),
}
NAMES = ("name", "under", "mesh")  # of another table, or a file
VALUES = (
    *("0", "1", "-1", "0.5", "1e300", "-1e300", "1e-300", "nan", "inf", "-inf", "150", "200.5"),
    *("9" * 400, "9" * 5000, "true", "false", '""', '" "', '"ground 2"', '"flight 1"', '"pca"'),
    *('"LeftFoot"', '"Hips"', '"explicit"', '"world"', '"surface"', '"apex"', '"fit"', '"\\u0000"'),
    *("[]", "[0, 0, 1]", "[1, nan, 0]", "[0, 0]", '["LeftFoot"]', "[[]]", "{}", "[{}]", "[1, [2]]"),
    *("{ z = 1 }", "{ z = nan }", "[{ frame = 1, place = [0, 0, 1] }]", "1979-05-27", "07:32:00"),
    *("{ up = 1e300 }", '[[{ bone = "Hips", weights = [1] }]]', "[[0, 0, 0], [1, 0, 0]]"),
    *("[[0, 1, 2]]", "[0.1, 0.1, 0.1]", '"crate.obj"', '"."', '"/dev/full"', '"matrix"'),
)


def damaged(case: HostileCase) -> None:
    """An example's recipe."""
    text = _examples()[int(case.rng.integers(len(_examples())))]
    path = case.folder / "recipe.toml"
    write_damaged(case, path, text)
    _read(case, path)


def made_up(case: HostileCase) -> None:
    """Any tables, keys and values, most of the keys where they belong."""
    _read(case, _written(case, _nonsense(case)))


def mixed(case: HostileCase) -> None:
    """Tables of the examples; some values are another table's of that kind, or nonsense."""
    wild = case.pick((0.0, 0.0, 0.1))
    lines = []
    for header in sorted({case.pick(list(_tables())) for _ in range(int(case.rng.integers(1, 6)))}):
        lines.append(f"[[{header}]]" if header in MANY else f"[{header}]")
        table = case.pick(_tables()[header])
        others = [each for each in _tables()[header] if case.chance(0.3)]
        for key, usual in table.items():
            values = [usual, *(each[key] for each in others if key in each)]
            value = case.pick(VALUES) if case.chance(wild) else toml(case.pick(values))
            lines.append(f"{key} = {value}")
    _read(case, _written(case, lines))


def _nonsense(case: HostileCase) -> list[str]:
    lines = [_entry(case, OWN_KEYS) for _ in range(int(case.rng.integers(3)))]
    for _ in range(int(case.rng.integers(1, 5))):
        many = case.chance(0.7)
        header = case.pick(list(MANY if many else ONCE))
        lines.append(f"[[{header}]]" if many != case.chance(0.03) else f"[{header}]")
        keys = (MANY | ONCE)[header]
        chosen = [k for k in keys if case.chance(min(1.0, 3.0 / len(keys)))]
        lines += [_entry(case, (key,)) for key in chosen]
    return lines


def _written(case: HostileCase, lines: list[str]) -> Path:
    path = case.folder / "recipe.toml"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def as_json(case: HostileCase) -> None:
    """JSON, which starts with a brace, damaged."""
    up = case.pick((0.1, -0.2, 0, 1e300, -1e300, float("nan"), True, None))
    values = {"frames": [1, 9], "pin": [{"phase": "ground 2", "up": up, "points": ["Left heel"]}]}
    path = case.folder / "recipe.json"
    text = json.dumps(values, indent=1)
    text = damaged_text(case, text) if case.chance(0.3) else text
    path.write_text(text, encoding="utf-8", newline="")
    _read(case, path)


def _entry(case: HostileCase, keys: tuple[str, ...]) -> str:
    return f"{case.pick(keys)} = {case.pick(VALUES)}"


def _read(case: HostileCase, path: Path) -> None:
    """As the command line does; what is read must be written so that it is read the same."""
    text = read_recipe_text(path)
    recipe = parse_recipe(text, str(path))
    case.taken_on = True
    for fault in (UnknownPhase("Landing", "x", ()), UnknownBone("Pin 1", "LeftFoot")):
        locate(text, fault)
    again = write_recipe(recipe.problem, result=recipe.result, keys=recipe.keys)
    if parse_recipe(again).problem.requests != recipe.problem.requests:
        raise ValueError(f"written otherwise than read:\n{again}")


@cache
def _tables() -> dict[str, list[dict[str, Any]]]:
    """The tables of the examples by their headers; those without what they only name by it."""
    found: dict[str, list[dict[str, Any]]] = {}
    for text in _examples():
        for header, content in tomllib.loads(text).items():
            if header in MANY | ONCE:
                tables = content if isinstance(content, list) else [content]
                named = ({k: v for k, v in t.items() if k not in NAMES} for t in tables)
                found.setdefault(header, []).extend(named)
    return found


@cache
def _examples() -> list[str]:
    return [p.read_text(encoding="utf-8") for p in sorted((ROOT / "examples").rglob("*.toml"))]


FAMILIES = (
    Family("recipes, damaged", 15.0, 10.0, damaged),
    Family("recipes, made up", 5.0, 10.0, made_up),
    Family("recipes, mixed", 25.0, 10.0, mixed),
    Family("recipes in JSON", 3.0, 10.0, as_json),
)
