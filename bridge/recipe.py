"""Recipes: a MotionProblem in the artist's words, as a TOML or JSON text that people write.

clip = "hop.bvh"                # optional, relative to the recipe
frames = [140, 260]             # scene frames, optional
mass = 70.0                     # kg
height = 1.69                   # m, optional
mass_table = "thesis"           # or "de leva"
[bones]                         # optional: part of the body = bone
"left foot" = "Fuss.L"
[[pin]]                         # any number of them
name = "Landing"                # optional
phase = "ground 2"              # as the analysis prints them
points = ["Left heel"]          # or bones = [...]; default: everything that touches in the phase
forward = 0.3                   # m along the travel; left, up; or offset = [x, y, z], world
place = [0.0, 1.0, 0.2]         # m, world: where the middle of the points goes, optional
turn = 90                       # degrees, counter-clockwise from above
[[contact]]                     # corrects a contact that the analysis found
name = "Left toe 2"
start_frame = 183.5             # and / or end_frame; or remove = true
"""

import json
import math
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

from ..solver.anatomy import SIDED
from ..solver.body_tables import MassTable
from ..solver.faults import BadRecipe, ContradictoryPins, Fault, MissingPart, UnknownContactName
from ..solver.problem import Axes3, ContactEdit, MotionProblem, Pin, UnknownContact, UnknownPhase
from .recipe_table import Source, Table, listed
from .source_lines import Path, json_lines, toml_lines

TOP_KEYS = ("clip", "frames", "mass", "height", "mass_table", "bones", "pin", "contact")
WHICH_KEYS = ("name", "phase", "points", "bones")
TRAVEL_KEYS = ("forward", "left", "up")
PIN_KEYS = (*WHICH_KEYS, *TRAVEL_KEYS, "offset", "place", "turn")
CONTACT_KEYS = ("name", "start_frame", "end_frame", "remove")
PARTS = ("pelvis", "head", *(f"{side} {p.value}" for p in SIDED for side in ("left", "right")))

_ABSURD = (ValueError, RecursionError)  # a number of 5,000 digits; 1,000 brackets


@dataclass(frozen=True)
class Recipe:
    """What a recipe says. clip: a path as written, relative to the recipe; None where not given."""

    problem: MotionProblem
    clip: str | None = None


def read_recipe_text(path: str | FilePath) -> str:
    """The text of a recipe's file. Raises BadRecipe."""
    try:
        return FilePath(path).read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise BadRecipe(str(path), None, "not a text; save it as UTF-8") from error
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise BadRecipe(str(path), None, f"cannot be read ({reason}); check its path") from error


def parse_recipe(text: str, path: str = "recipe") -> Recipe:
    """The recipe in a text, TOML or (where it starts with a brace) JSON.

    path is for faults alone. Raises BadRecipe with the line of what is wrong.
    """
    values, lines = _parse(text, path)
    table = Table(Source(path, lines), (), values, TOP_KEYS)
    problem = MotionProblem(
        frames=_frames(table),
        mass=table.positive("mass") or MotionProblem.mass,
        height=table.positive("height"),
        mass_table=_mass_table(table),
        bones=_bones(table.table("bones", PARTS, "part of the body")),
        contacts=tuple(map(_contact, table.tables("contact", CONTACT_KEYS))),
        pins=_pins(table.tables("pin", PIN_KEYS)),
    )
    return Recipe(problem, table.word("clip"))


def locate(text: str, fault: Fault) -> int | None:
    """The line of a valid recipe that a fault raised later is about, None where it is about none.

    Raises BadRecipe.
    """
    values, lines = _parse(text, "recipe")
    return next((lines[place] for place in _places(values, fault) if place in lines), None)


def _places(values: dict[str, Any], fault: Fault) -> list[Path]:
    """Where in a recipe a fault may come from, best first."""
    match fault:
        case UnknownPhase():
            return [("pin", i, "phase") for i in _called(values, "pin", fault.pin)]
        case UnknownContact():
            return [
                ("pin", i, key, values["pin"][i][key].index(fault.what))
                for i in _called(values, "pin", fault.pin)
                for key in ("points", "bones")
                if fault.what in values["pin"][i].get(key, ())
            ]
        case UnknownContactName():
            return [("contact", i, "name") for i in _called(values, "contact", fault.name)]
        case ContradictoryPins():
            pins = _called(values, "pin", fault.second) + _called(values, "pin", fault.first)
            return [("pin", i) for i in pins]
        case MissingPart():
            return [("bones", fault.part)]
    return []


def _called(values: dict[str, Any], kind: str, name: str) -> list[int]:
    """Indices of the pins or contacts that are called so."""
    entries = enumerate(values.get(kind, []))
    return [i for i, entry in entries if entry.get("name", _default_name(i)) == name]


def _default_name(i: int) -> str:
    return f"Pin {i + 1}"


# ---------------------------------------------------------------- reading


def _parse(text: str, path: str) -> tuple[dict[str, Any], dict[Path, int]]:
    """A recipe's values, and the line of each key and element."""
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


def _parse_json(text: str, path: str) -> tuple[dict[str, Any], dict[Path, int]]:
    try:
        values = json.loads(text)
    except json.JSONDecodeError as error:
        raise BadRecipe(path, error.lineno, f"not JSON ({error.msg}); correct the line") from error
    except _ABSURD as error:
        raise BadRecipe(path, None, "not JSON that can be read; see the examples") from error
    lines: dict[Path, int] = {}
    for place, line in json_lines(text):
        if place in lines:
            raise BadRecipe(path, line, f'"{place[-1]}" is there twice; keep one')
        lines[place] = line
    return values, lines


def _frames(table: Table) -> tuple[float, float] | None:
    frames = table.numbers("frames", "[first, last]")
    if frames is None:
        return None
    first, last = frames
    if first >= last:
        table.refuse("frames", f"the last frame, {last:g}, must come after the first, {first:g}")
    return first, last


def _mass_table(table: Table) -> MassTable:
    name = table.word("mass_table") or MotionProblem.mass_table.value
    known = [t.value for t in MassTable]
    if name not in known:
        table.refuse("mass_table", f'unknown mass table "{name}"; known: {listed(known)}')
    return MassTable(name)


def _bones(table: Table) -> dict[str, str]:
    return {part: table.needed_word(part) for part in table.values}


def _pins(tables: Iterable[Table]) -> tuple[Pin, ...]:
    pins: list[Pin] = []
    for i, table in enumerate(tables):
        pin = _pin(table, _default_name(i))
        if any(pin.name == other.name for other in pins):
            table.refuse("name", f'a second pin called "{pin.name}"; give it its own name')
        pins.append(pin)
    return tuple(pins)


def _pin(table: Table, default_name: str) -> Pin:
    table.not_both("offset", TRAVEL_KEYS)
    table.not_both("points", ("bones",))
    forward, left, up = (table.number(key) or 0.0 for key in TRAVEL_KEYS)
    offset = table.numbers("offset", "[x, y, z]")
    place = table.numbers("place", "[x, y, z]")
    return Pin(
        name=table.word("name") or default_name,
        phase=table.needed_word("phase"),
        touching=table.words("points") + table.words("bones"),
        offset=(forward, left, up) if offset is None else (offset[0], offset[1], offset[2]),
        axes=Axes3.TRAVEL if offset is None else Axes3.WORLD,
        place=None if place is None else (place[0], place[1], place[2]),
        turn=math.radians(table.number("turn") or 0.0),
    )


def _contact(table: Table) -> ContactEdit:
    table.not_both("remove", ("start_frame", "end_frame"))
    name, remove = table.needed_word("name"), table.flag("remove")
    start, end = table.number("start_frame"), table.number("end_frame")
    if start is not None and end is not None and start >= end:
        table.refuse("end_frame", f"the end, {end:g}, must come after the start, {start:g}")
    return ContactEdit(name, start, end, remove)


# ---------------------------------------------------------------- writing


def write_recipe(problem: MotionProblem, *, clip: str | None = None) -> str:
    """The TOML text that `parse_recipe` reads as this problem."""
    top = {
        "clip": clip,
        "frames": problem.frames,
        "mass": problem.mass,
        "height": problem.height,
        "mass_table": problem.mass_table.value,
    }
    parts = [_entries(top)]
    if problem.bones:
        parts.append("[bones]\n" + _entries(problem.bones))
    parts += ["[[pin]]\n" + _entries(_pin_values(pin)) for pin in problem.pins]
    parts += ["[[contact]]\n" + _entries(_contact_values(edit)) for edit in problem.contacts]
    return "\n".join(parts)


def _pin_values(pin: Pin) -> dict[str, object]:
    values: dict[str, object] = {"name": pin.name, "phase": pin.phase}
    values["points"] = pin.touching or None
    if pin.axes is Axes3.WORLD:
        values["offset"] = pin.offset
    else:
        pairs = zip(TRAVEL_KEYS, pin.offset, strict=True)
        values |= {key: amount for key, amount in pairs if amount}
    return values | {"place": pin.place, "turn": _degrees(pin.turn) if pin.turn else None}


def _contact_values(edit: ContactEdit) -> dict[str, object]:
    if edit.remove:
        return {"name": edit.name, "remove": True}
    return {"name": edit.name, "start_frame": edit.start_frame, "end_frame": edit.end_frame}


def _entries(values: Any) -> str:
    """Lines `key = value`; what is None is left out."""
    pairs = [(k, v) for k, v in values.items() if v is not None]
    return "".join(f"{_key(key)} = {_value(value)}\n" for key, value in pairs)


def _key(key: str) -> str:
    return key if key.replace("_", "").isalnum() and key.isascii() else _text(key)


def _value(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return _text(value)
        case int() | float():
            return _number(float(value))
        case tuple():
            return f"[{', '.join(map(_value, value))}]"
    raise TypeError(value)


def _text(text: str) -> str:
    # JSON's escapes are TOML's, but for the one control character that JSON lets stand.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _number(number: float) -> str:
    return str(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def _degrees(angle: float) -> float:
    """The roundest number of degrees that is read as this angle again."""
    degrees = math.degrees(angle)
    rounded = (round(degrees, digits) for digits in range(13))
    return next((r for r in rounded if math.radians(r) == angle), degrees)
