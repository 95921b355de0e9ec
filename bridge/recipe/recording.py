"""Keys of a recipe's recording: how its file is read, and repairs that it gets then.

[file]                          # as the command line's options say it, which go before these
unit = 0.0254                   # m per unit of length
up = "Y"                        # or "Z": the axis that points up
rate = 120                      # frames a second, of an AMC or BVH file
asf = "01.asf"                  # an AMC file's skeleton, relative to the recipe; not in batches
armature = "Rig"                # whose motion, of an FBX file or a .blend that holds several
take = "Jump"                   # which, of an FBX file that holds several

[recording]
up = "Y"                        # the axis, as it was read, that is to become Z; "-X" ...
tilt = [0.2, -1.5]              # degrees by which its floor slopes upwards along x and y, once Z is
                                # up, which is turned level; 30 at most
missing = { 57 = 4, 103 = -36 } # after frame 57 four frames are missing: they are put in; after
                                # frame 103 thirty-six are too many: they are taken out
trim = 1                        # frames left out at the beginning of the whole clip
trim_end = 60                   # and at its end; those that `frames` names are of what is left
repair = ["full turns", "held frames", "exchanged legs", "exchanged arms", "flips",
          "spikes", "bone lengths", "noise", "level hips", "in place", "floating",
          "sinking"]
time_scale = 0.8                # durations times this: played 1.25 times too slowly
scale = 0.625                   # lengths times this, which makes a person of 0.3 to 3 m
drift = [0.1, 0.0]              # m/s along the floor, x and y, that is taken out; 15 at most
rise = 0.05                     # m/s upwards, likewise
floor = 0.12                    # m; the height that becomes 0
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import hypot
from typing import get_args

from ...solver.data.problem import Mend
from ...solver.doctor.repairs import MOST_MISSING, STEEPEST, MissingFrames, Repairs, UpAxis
from ..formats.motion_clip import UpAxis as FileUpAxis
from ..recipe_syntax.items import Item, Kind, Values, choice, number, one, whole, word
from ..recipe_syntax.table import ABOVE_ZERO, NumberRange, Table

FASTEST_DRIFT = 15.0  # m/s; treadmills go to 12
WHOLE = re.compile(r"-?\d+")
SOME = NumberRange(
    f"a whole number from 1 to {MOST_MISSING}, or from -1 to -{MOST_MISSING}",
    lambda value: 1.0 <= abs(value) <= MOST_MISSING and value.is_integer(),
)
SCALE = NumberRange("from 0.0001 to 10000", lambda value: 1e-4 <= value <= 1e4)  # any unit's
RATE = NumberRange("from 0.0001 to 10000 frames a second", lambda value: 1e-4 <= value <= 1e4)
NEAR_LEVEL = NumberRange("from -5 to 5 m/s", lambda value: abs(value) <= 5.0)
COUNT = NumberRange("a whole number, 0 or more", lambda value: value >= 0.0 and value.is_integer())


def _read_missing(table: Table) -> Values:
    given = table.values.get("missing")
    counts = table.table("missing", tuple(given) if isinstance(given, dict) else (), "frame")
    for frame in counts.values:
        if not WHOLE.fullmatch(frame):
            counts.refuse(frame, f'"{frame}" is no frame; write such as "missing = {{ 57 = 4 }}"')
    gaps = [MissingFrames(int(f), int(counts.number(f, SOME) or 0)) for f in counts.values]
    return {"missing": tuple(sorted(gaps, key=lambda gap: gap.after))}


def _write_missing(repairs: Repairs) -> Values:
    return {"missing": {str(gap.after): gap.count for gap in repairs.missing} or None}


def _read_drift(table: Table) -> Values:
    drift = table.pair("drift", "[x, y]")
    if drift is not None and hypot(*drift) > FASTEST_DRIFT:
        fastest = f"at most {FASTEST_DRIFT:g} m/s"
        table.refuse("drift", f'"drift" must be {fastest}, not {hypot(*drift):g}')
    return {} if drift is None else {"drift": drift}


def _write_drift(repairs: Repairs) -> Values:
    return {"drift": repairs.drift if any(repairs.drift) else None}


def _read_tilt(table: Table) -> Values:
    tilt = table.pair("tilt", "[x, y]")
    if tilt is not None and max(map(abs, tilt)) > STEEPEST:
        steepest = f"at most {STEEPEST:g}° either way"
        table.refuse("tilt", f'"tilt" must be {steepest}, not [{tilt[0]:g}, {tilt[1]:g}]')
    return {} if tilt is None else {"tilt": tilt}


def _write_tilt(repairs: Repairs) -> Values:
    return {"tilt": repairs.tilt if any(repairs.tilt) else None}


def _read_mend(table: Table) -> Values:
    known = {mend.value: mend for mend in Mend}
    words = table.words("repair")
    for each in words:
        if each not in known:
            table.refuse("repair", f'"{each}" is no repair; known: {", ".join(known)}')
    return {"mend": tuple(mend for word, mend in known.items() if word in words)}


def _write_mend(repairs: Repairs) -> Values:
    return {"repair": tuple(mend.value for mend in repairs.mend) or None}


@dataclass(frozen=True)
class FileReading:
    """What is stated of how a clip's file is read; None where the file tells, or it is guessed.

    unit: m per unit of length. up: the axis that points up. rate: Hz. asf: an AMC file's skeleton,
    relative to the recipe. armature, take: which of those in the file.
    """

    unit: float | None = None
    up: FileUpAxis | None = None
    rate: float | None = None
    asf: str | None = None
    armature: str | None = None
    take: str | None = None


def _read_up(table: Table, key: str) -> str | None:
    axis, known = table.word(key), get_args(FileUpAxis)
    if axis not in known:
        table.refuse(key, f'unknown axis "{axis}"; known: {", ".join(known)}')
    return axis


FILE = Kind(
    "file",
    FileReading,
    (
        number("unit", ABOVE_ZERO),
        one("up", _read_up),
        number("rate", RATE),
        word("asf"),
        word("armature"),
        word("take"),
    ),
    named=False,
)

RECORDING = Kind(
    "recording",
    Repairs,
    (
        choice("up", UpAxis),
        Item(("tilt",), _read_tilt, _write_tilt),
        Item(("missing",), _read_missing, _write_missing),
        whole("trim", COUNT),
        whole("trim_end", COUNT),
        Item(("repair",), _read_mend, _write_mend),
        number("time_scale", ABOVE_ZERO),
        number("scale", SCALE),
        Item(("drift",), _read_drift, _write_drift),
        number("rise", NEAR_LEVEL),
        number("floor"),
    ),
    named=False,
)
