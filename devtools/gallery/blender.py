"""The process with Blender: reads a result's clip; writes its action, FBX and picture, and checks
on the written action that everything is where it was asked to be."""

from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import bpy

from ...bridge.armature.read import read_recording, record
from ...bridge.armature.write import write_action
from ...bridge.exports.export import export_takes
from ...bridge.files.import_clip import import_clip
from ...bridge.files.reproportioned import build_reproportioned
from ...bridge.picture.render import draw_sheet
from ...bridge.picture.sheet import View
from ...operators.terminal.quiet import quiet
from ...solver.arrays import FloatArray
from ...solver.data.recording import BEYOND, Recording
from ..checks.penetrations import SolidCheck
from ..processes import dump, undump
from .checks import Check, PointCheck
from .jobs import Json, Page, Result, load, write_json

FIGURES = 9
WIDTH = 1600


def main(argv: list[str]) -> int:
    task, name, place = argv[0], argv[1], Path(argv[2])
    result = load(name)
    if not result.clip.is_file():
        print(f"there is no recording {result.clip.name}")
        return 2
    with quiet():
        bpy.ops.wm.read_factory_settings(use_empty=True)
        armature = import_clip(result.clip).armature
    if task == "read":
        dump(_recording(armature, result), place)
        return 0
    _write(armature, result, place, picture="--no-picture" not in argv)
    return 0


def _recording(armature: bpy.types.Object, result: Result) -> Recording:
    first, last = result.problem.frames or (None, None)
    return read_recording(armature, first=first, last=last, beyond=BEYOND)


def _write(armature: bpy.types.Object, result: Result, folder: Path, *, picture: bool) -> None:
    drawn: dict[str, Any] = undump(folder / "drawn.pickle")
    track, found = drawn["track"], drawn["checks"]
    if result.problem.requests.body.limbs:
        armature, track, turns = build_reproportioned(drawn["recording"], track)
        found = _turned(found, turns)
    action = write_action(armature, track, name=result.name)
    shown = record(armature, track.frames)
    content: Json = {"checks": [_checked(check, shown) for check in found]}
    content |= _solid(drawn["solid"], shown)
    with quiet():
        export_takes(armature, [action], folder / "adapted.fbx")
        if picture:
            scene = result.page is Page.SCENE
            view = View(figures=FIGURES, heading=drawn["heading"], in_place=scene)
            draw_sheet([drawn["row"]], folder / "sheet.png", view, width=WIDTH)
    write_json(content, folder / "written.json")


def _solid(check: SolidCheck, shown: Recording) -> Json:
    """What is in each other and what stands on objects, by MuJoCo."""
    return {
        "penetrations": [
            asdict(each) | {"keeper": each.keeper.value} for each in check.worst(shown)
        ],
        "standing": [asdict(each) for each in check.standing(shown)],
    }


def _checked(check: Check, shown: Recording) -> Json:
    return {
        "name": check.name,
        "kind": check.kind,
        "worst": check.worst(shown),
        "unit": check.unit,
        "by": "Blender's action",
    }


def _turned(checks: list[Check], turns: dict[str, FloatArray]) -> list[Check]:
    """Checks in the axes of an armature of other proportions."""
    return [
        replace(check, offset=turns[check.bone].T @ check.offset)
        if isinstance(check, PointCheck)
        else check
        for check in checks
    ]
