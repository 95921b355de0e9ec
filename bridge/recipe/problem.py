"""Recipes: a MotionProblem in the artist's words, as a TOML or JSON text that people write.

clip = "hop.bvh"                # optional, relative to the recipe
frames = [140, 260]             # scene frames, optional
mass = 70.0                     # kg
height = 1.69                   # m, 0.3 to 3, optional
mass_table = "thesis"           # or "de leva"
unseen_support = "show"         # fits and tells where something unseen carries; or "refuse"
mirrored = false                # left does what right did; pins and contacts change sides as well
good_enough = 0.002             # m by which a contact that cannot be held exactly may be off
[bones]                         # optional: part of the body = bone
"left foot" = "Fuss.L"
[[pin]]                         # any number of them
name = "Landing"                # optional
phase = "ground 2"              # as the analysis prints them, in any capitals
points = ["Left heel"]          # or bones = [...]; default: everything that touches in the phase;
                                # or step = "Left heel 2": that foot, heel and toe, this once
forward = 0.3                   # m along the travel; left, up; back, right, down;
                                # or offset = [x, y, z], world
place = [0.0, 1.0, 0.2]         # m, world: where the middle of the points goes, optional
turn = 90                       # degrees, counter-clockwise from above
on = "Crate"                    # the points then stand on that object's faces, below or above
[[contact]]                     # corrects a contact that the analysis found
name = "Left toe 2"
start_frame = 183.5             # and / or end_frame; or remove = true
[[add_contact]]                 # touches, though the analysis did not find it
point = "Left heel"
start_frame = 183
end_frame = 200
[result]                        # the rest of the take that the frames are part of
after = "carry"                 # goes with the last stance; or "return", to where it was; or "cut"
return_frame = 400              # of the recording, by which it is back; default: after a second
blend_in = 30                   # frames before the adapted ones, and
blend_out = 30                  # after them, that are blended; default: a quarter of a second
lock_others = true              # channels that physics does not own keep their times
written_as = "strip"            # on top of the take, in the NLA; "combine": as the difference from
                                # the take; "slot": of the take's action; default: "action"
markers = "action"              # where limbs come down and go up; or "timeline"; default: "none"
contact_channels = true         # a property of the armature for each limb, 1 while it touches
[loop]                          # the motion repeats: its end meets its start, solved so
root = "hips"                   # carry the travel; or "in place", or "root bone"
[file]                          # how the clip is read: the keys are in recording.py
unit = 0.0254                   # m per unit of length
[recording]                     # its repairs: the keys are in recording.py
repair = ["spikes"]
[keys]                          # of the adapted frames
on = "every frame"              # or "reduced": the fewest; "as the take": where the recording has
distance = 0.002                # m by which reduced keys may move a joint, in the world; and
angle = 0.2                     # degrees by which they may turn a bone
[export]                        # the file with the result: the keys are in export.py
engine = "unreal"               # "unity", "godot"; default: "none", as the armature is in Blender

Objects of the scene are in objects.py, and what may be asked for beside in requests.py.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ...solver.body.anatomy import SIDED_PARTS
from ...solver.data.constants import STATURES
from ...solver.data.faults import (
    BadDimensions,
    BadRecipe,
    BesideFrames,
    BoneTaken,
    DependentRows,
    Fault,
    FitNeedsSupport,
    MissingPart,
    NotBetweenFrames,
    NothingLeft,
    OddScale,
    OptionNotTaken,
    SceneFault,
    UnknownContactName,
    UnknownReductionBone,
    WrongWeights,
)
from ...solver.data.problem import MassTable, MotionProblem, Unseen
from ...solver.doctor.repairs import Repairs
from ...solver.skeleton.mirror import swapped
from ..recipe_syntax.source_lines import KeyPath
from ..recipe_syntax.table import ABOVE_ZERO, NOT_NEGATIVE, NumberRange, Source, Table
from ..recipe_syntax.toml_text import entries, sections
from ..recipe_syntax.values import recipe_values
from .contacts import ADDED, CONTACT, PIN, SPAN, point_name
from .export import EXPORT, ExportOptions
from .keys import KEYS, KeyOptions
from .loop import LOOP, LoopOptions
from .object_texts import object_text
from .objects import HEADER as OBJECT
from .objects import Under, default_name, object_files, read_objects
from .recording import FILE, RECORDING, FileReading
from .requests import NAMED, REQUEST_KEYS, read_requests, request_texts
from .result import RESULT, ResultOptions

OWN_KEYS = (
    *("clip", "frames", "mass", "height", "mass_table", "bones", "pin", "contact"),
    *("file", "recording", "keys", "loop", "export"),
)
TOP_KEYS = (
    *OWN_KEYS,
    "unseen_support",
    "good_enough",
    "mirrored",
    "add_contact",
    OBJECT,
    *REQUEST_KEYS,
    RESULT.header,
)
# What a text of the .blend file that the armature points to may hold; the panels have the rest.
TEXT_KEYS = (*REQUEST_KEYS, RESULT.header, KEYS.header, LOOP.header)
INSTEAD = {  # of keys that are not among these
    **dict.fromkeys(("clip", FILE.header), "the recording is the armature's action"),
    "frames": "the panel Recording has the frame range",
    RECORDING.header: "the panel Recording has the repairs",
    **dict.fromkeys(("mass", "height"), "the panel Character has it"),
    "bones": "the panel Bones has them",
    "mass_table": "the panel Bones has it",
    PIN.header: "a stance of the panel Contacts has the landing",
    **dict.fromkeys((CONTACT.header, ADDED.header), "the panel Contacts has its frames"),
    OBJECT: "the panel World has the surfaces",
    EXPORT.header: "the panel Export has the file",
    "good_enough": "the panel Solve has it, under Advanced",
}
STATURE = NumberRange(
    f"from {STATURES[0]:g} to {STATURES[1]:g} m, as people are",
    lambda value: STATURES[0] <= value <= STATURES[1],
)
REDUCTION = ("solution", "reduction")
CULPRITS = ("pin", "request", "name", "second", "first")  # fields of faults that name a record
PARTS = (
    "pelvis",
    "head",
    *(f"{side} {p.value}" for p in SIDED_PARTS for side in ("left", "right")),
)


@dataclass(frozen=True)
class Recipe:
    """Parsed recipe. clip: a path as written, relative to the recipe; None where not given.

    file: how the clip is read. under: objects of which the analysis is to tell the places. repairs:
    of the recording. result, keys, loop, export: None where not given. meshes: files that objects
    were read from.
    """

    problem: MotionProblem
    clip: str | None = None
    under: tuple[Under, ...] = ()
    result: ResultOptions | None = None
    keys: KeyOptions | None = None
    loop: LoopOptions | None = None
    export: ExportOptions | None = None
    repairs: Repairs | None = None
    meshes: tuple[Path, ...] = ()
    file: FileReading = field(default_factory=FileReading)


def read_recipe_text(path: str | Path) -> str:
    """The text of a recipe's file. Raises BadRecipe."""
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise BadRecipe(str(path), None, "not a text; save it as UTF-8") from error
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise BadRecipe(str(path), None, f"cannot be read ({reason}); check its path") from error


def parse_recipe(text: str, path: str = "recipe") -> Recipe:
    """The recipe in a text, TOML or (where it starts with a brace) JSON.

    path is for faults alone. Raises BadRecipe with the line of what is wrong.
    """
    values, lines = recipe_values(text, path)
    return recipe_of(values, Source(path, lines))


def parse_text(text: str, name: str) -> Recipe:
    """The recipe in a text of the .blend file, in which `TEXT_KEYS` count.

    What does not count is refused, for whoever writes it believes that it does. Raises BadRecipe.
    """
    values, lines = recipe_values(text, name)
    source = Source(name, lines)
    for key in values:
        if key in TOP_KEYS and key not in TEXT_KEYS:
            instead = f"; here {INSTEAD[key]}" if key in INSTEAD else ""
            source.refuse((key,), f'"{key}" counts in a recipe\'s file only{instead}')
    return recipe_of(values, source)


def recipe_of(values: dict[str, Any], source: Source) -> Recipe:
    """The recipe that a text's values say. source: tells their lines. Raises BadRecipe."""
    table = Table(source, (), values, TOP_KEYS)
    scene, under = read_objects(table)
    problem = MotionProblem(
        frames=_frames(table),
        mass=_mass(table),
        height=table.number("height", STATURE),
        mass_table=table.choice("mass_table", MassTable) or MotionProblem.mass_table,
        bones=_bones(table.table("bones", PARTS, "part of the body")),
        contacts=CONTACT.read_all(table),
        added=ADDED.read_all(table),
        pins=PIN.read_all(table),
        scene=scene,
        requests=read_requests(table),
        loop=LOOP.header in table.values,
        unseen=table.choice("unseen_support", Unseen) or MotionProblem.unseen,
        good_enough=_good_enough(table),
        mirrored=table.flag("mirrored"),
    )
    if problem.mirrored:
        problem = swapped(problem)
    _refuse_same_names(table)
    result = RESULT.read(table) if RESULT.header in table.values else None
    keys = KEYS.read(table) if KEYS.header in table.values else None
    loop = LOOP.read(table) if problem.loop else None
    export = EXPORT.read(table) if EXPORT.header in table.values else None
    repairs = RECORDING.read(table) if RECORDING.header in table.values else None
    meshes, file = object_files(values, source.path), FILE.read(table)
    clip = table.word("clip")
    return Recipe(problem, clip, under, result, keys, loop, export, repairs, meshes, file)


def locate(text: str, fault: Fault) -> int | None:
    """The line of a valid recipe that a fault raised later is about, None where it is about none.

    Raises BadRecipe.
    """
    values, lines = recipe_values(text, "recipe")
    return next((lines[place] for place in _places(values, fault) if place in lines), None)


def _places(values: dict[str, Any], fault: Fault) -> list[KeyPath]:
    """Candidate origins of a fault in a recipe, best first."""
    match fault:
        case UnknownContactName():
            tables = ((CONTACT.header, "name"), (ADDED.header, "point"))
            return [
                (header, i, key)
                for header, key in tables
                for i, entry in enumerate(values.get(header, ()))
                if fault.name in (entry[key], point_name(entry[key]))
            ]
        case FitNeedsSupport():
            return [("unseen_support",)]
        case OptionNotTaken():
            return [(FILE.header, fault.option)]
        case OddScale():
            return [(RECORDING.header, "scale")]
        case NotBetweenFrames():
            return [(RECORDING.header, "missing")]
        case NothingLeft():
            keys = ("trim", "trim_end") if fault.trim >= fault.trim_end else ("trim_end", "trim")
            return [(RECORDING.header, key) for key in keys]
        case MissingPart():
            return [("bones", fault.by if isinstance(fault, BoneTaken) else fault.part)]
        case UnknownReductionBone() | WrongWeights():
            return [(*REDUCTION, "matrix", fault.row - 1)]
        case DependentRows():
            return [(*REDUCTION, "matrix")]
        case SceneFault():
            return [place for place, called in _names(values) if called == fault.thing]
        case BadDimensions():
            return [(*REDUCTION, "dimensions"), REDUCTION]
        case BesideFrames() if added := _added(values, fault):
            return added
    named = [getattr(fault, name) for name in CULPRITS if hasattr(fault, name)]
    places = [place for name in named for place, called in _names(values) if called == name]
    return [inner for place in places for inner in _inside(values, place, fault)]


def _added(values: dict[str, Any], fault: BesideFrames) -> list[KeyPath]:
    """The contacts to add that are beside the frames."""
    return [
        (ADDED.header, i, key)
        for i, entry in enumerate(values.get(ADDED.header, ()))
        for key in SPAN
        if entry[key] == fault.at and point_name(entry["point"]) == fault.request
    ]


def _names(values: dict[str, Any]) -> list[tuple[tuple[str, int], str]]:
    """Key path and name of each pin, each request and each object."""
    kinds = [(kind.header, kind.default_name) for kind in (PIN, *NAMED)]
    return [
        ((header, i), entry.get("name", default(i)))
        for header, default in (*kinds, (OBJECT, default_name))
        for i, entry in enumerate(values.get(header, ()))
    ]


def _inside(values: dict[str, Any], place: tuple[str, int], fault: Fault) -> list[KeyPath]:
    """The keys and elements of a record that a fault quotes, then the record itself."""
    header, i = place
    texts = [getattr(fault, each.name) for each in fields(fault) if each.name not in CULPRITS]
    quoted = [text for text in texts if isinstance(text, str)]
    found: list[KeyPath] = []
    for key, held in values[header][i].items():
        if isinstance(held, list):
            found += [(*place, key, j) for j, element in enumerate(held) if element in quoted]
        elif key != "name" and held in quoted:
            found.append((*place, key))
    return [*found, place]


def _frames(table: Table) -> tuple[float, float] | None:
    frames = table.pair("frames", "[first, last]")
    if frames is None:
        return None
    first, last = frames
    if first >= last:
        table.refuse("frames", f"the last frame, {last:g}, must come after the first, {first:g}")
    return first, last


def _mass(table: Table) -> float:
    if isinstance(table.values.get("mass"), list):
        table.refuse("mass", '"mass" is of the body, in kg; what is carried is a [[load]]')
    return table.number("mass", ABOVE_ZERO) or MotionProblem.mass


def _good_enough(table: Table) -> float:
    limit = table.number("good_enough", NOT_NEGATIVE)
    return MotionProblem.good_enough if limit is None else limit


def _bones(table: Table) -> dict[str, str]:
    return {part: table.needed_word(part) for part in table.values}


def _refuse_same_names(top: Table) -> None:
    """Refuses a name that a pin or request before it in the text has already."""
    lines = top.source.lines
    taken: set[str] = set()
    for place, name in sorted(_names(top.values), key=lambda named: lines.get(named[0], 0)):
        if name in taken:
            problem = (
                f'another pin, request or object is called "{name}", too; give each its own name'
            )
            top.source.refuse((*place, "name"), problem)
        taken.add(name)


def write_recipe(
    problem: MotionProblem,
    *,
    clip: str | None = None,
    files: Mapping[str, str] = MappingProxyType({}),
    result: ResultOptions | None = None,
    keys: KeyOptions | None = None,
    repairs: Repairs | None = None,
) -> str:
    """The TOML text that `parse_recipe` reads as this problem.

    files: of objects' meshes, by the objects' names; what has none is written out. result, keys,
    repairs: left out where they are the usual ones, which a recipe that says nothing means.
    """
    if problem.mirrored:
        problem = swapped(problem)  # a recipe names what the recording has
    top = {
        "clip": clip,
        "frames": problem.frames,
        "mass": problem.mass,
        "height": problem.height,
        "mass_table": problem.mass_table.value,
        "unseen_support": None if problem.unseen is Unseen.SHOW else problem.unseen.value,
        "good_enough": None
        if problem.good_enough == MotionProblem.good_enough
        else problem.good_enough,
        "mirrored": problem.mirrored or None,
    }
    parts = [entries(top)]
    if problem.bones:
        parts.append("[bones]\n" + entries(problem.bones))
    parts += sections(RESULT.header, RESULT.write(result)) if result is not None else []
    parts += sections(KEYS.header, KEYS.write(keys)) if keys is not None else []
    if repairs is not None:
        parts += sections(RECORDING.header, RECORDING.write(repairs))
    if problem.loop:
        parts.append(f"[{LOOP.header}]")
    parts += PIN.text(problem.pins) + CONTACT.text(problem.contacts)
    parts += ADDED.text(problem.added)
    parts += [object_text(thing, files.get(thing.name)) for thing in problem.scene]
    return "\n".join(parts + request_texts(problem.requests))
