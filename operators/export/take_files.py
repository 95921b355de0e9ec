"""Names of files where each take gets one of its own."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count
from pathlib import Path

import bpy

from ...bridge.rows.choices import Engine

_LONGEST = 240  # bytes of a file's name before its ending; systems take 255


def take_files(
    path: Path, takes: Sequence[bpy.types.Action], engine: Engine
) -> dict[Path, bpy.types.Action]:
    """Beside a path, under its name and the take's, with a number where two would be called alike.

    Unity takes what comes after an @ for the take's name.
    """
    beside = "@" if engine is Engine.UNITY else "_"
    found: dict[Path, bpy.types.Action] = {}
    taken: set[str] = set()  # in small letters, by which some systems tell files apart
    for take in takes:
        name = f"{path.stem}{beside}{bpy.path.clean_name(take.name)}"
        name = name.encode()[:_LONGEST].decode(errors="ignore")
        numbered = (name if number == 1 else f"{name}_{number}" for number in count(1))
        free = next(each for each in numbered if each.casefold() not in taken)
        taken.add(free.casefold())
        found[path.with_name(f"{free}{path.suffix}")] = take
    return found
