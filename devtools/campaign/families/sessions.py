"""Random sequences of operators in Blender, with what artists do between them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from shutil import copyfile
from typing import Any

import bpy

from ....bridge.accessors import armature_data, current_scene, present, source_of
from ....bridge.properties.settings import settings_of
from ....operators.names import OperatorId
from ...environment.virtual_environment import ROOT
from ...recordings import HELD, JUMP
from ..protocol.blender_file import MARK, enable, marked, must_be_same, recorded_file, refusals
from ..protocol.case import Changed, Family, HostileCase, Said

OPERATORS: Any = bpy.ops  # of which the stubs do not know all
FRAMES = 150, 260
MODES = ("OBJECT", "POSE", "EDIT")
LANDED = sorted((ROOT / "tests" / "data").glob("*.blend"))
SOLVING = (OperatorId.ADAPT, OperatorId.FIT, OperatorId.REFINE, OperatorId.UPDATE)
OTHERS = tuple(name for name in OperatorId if name not in SOLVING)


def quick(case: HostileCase) -> None:
    """Operators that only analyse, list, show and write."""
    recorded_file(HELD / JUMP, *FRAMES)
    _session(case, 0.0)


def solving(case: HostileCase) -> None:
    """Solves among them."""
    recorded_file(HELD / JUMP, *FRAMES)
    _session(case, 0.25)


def landed(case: HostileCase) -> None:
    """On a file that an earlier state of the extension saved, results and settings in it."""
    enable()
    path = case.folder / "old.blend"
    copyfile(case.pick(LANDED), path)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    for action in bpy.data.actions:
        if source_of(action) is None:
            action[MARK] = action.name
    if not marked():
        raise Changed("no recording is in the file")
    case.taken_on = True
    _session(case, 0.1)


def _session(case: HostileCase, solves: float) -> None:
    before = marked()
    if case.chance(0.7):
        _tried(lambda: OPERATORS.hangtime.analyze())
    for _ in range(int(case.rng.integers(3, 12))):
        if case.chance(solves):
            case.taken_on |= operator(case, case.pick(SOLVING))
        elif case.chance(0.55):
            finished = operator(case, case.pick(OTHERS))
            case.taken_on |= finished and not solves
        else:
            case.pick(STEPS)(case)
        must_be_same(before, marked())


def _tried(act: Callable[[], object]) -> None:
    try:
        with refusals():
            act()
    except Said:
        pass  # in words, as it should be


def operator(case: HostileCase, name: str) -> bool:
    """One operator, with random properties, as a script calls it; whether it did its work."""
    package, _, own = name.partition(".")
    call = getattr(getattr(bpy.ops, package), own)
    values: dict[str, object] = {}
    for prop in call.get_rna_type().properties:
        if prop.identifier != "rna_type" and not prop.is_readonly and case.chance(0.6):
            values |= _value(case, prop)
    done: set[str] = set()
    _tried(lambda: done.update(call(**values)))
    return "FINISHED" in done


def _value(case: HostileCase, prop: Any) -> dict[str, object]:
    match prop.type:
        case "BOOLEAN" if not prop.is_array:
            return {prop.identifier: case.chance(0.5)}
        case "INT" if not prop.is_array:
            return {prop.identifier: case.pick((-1, 0, 1, 2, 5, 100000))}
        case "FLOAT" if not prop.is_array:
            return {prop.identifier: case.pick((-1.0, 0.0, 0.5, 1.0, 180.0, 1e9))}
        case "ENUM" if not prop.is_enum_flag and len(prop.enum_items):
            return {prop.identifier: case.pick([item.identifier for item in prop.enum_items])}
        case "STRING":
            if prop.subtype in ("FILE_PATH", "DIR_PATH"):
                name = case.pick(("out.fbx", "out", "no/such/folder/out.usd", "out.toml", "a.csv"))
                return {prop.identifier: str(case.folder / name)}
            return {prop.identifier: case.pick(("", "LeftFoot", "Landing", "骨", "ground 2"))}
    return {}


# ---------------------------------------------------------------- between operators


def _armature() -> bpy.types.Object | None:
    return next((o for o in bpy.data.objects if o.type == "ARMATURE"), None)


def _undo(_: HostileCase) -> None:
    _tried(lambda: bpy.ops.ed.undo())


def _redo(_: HostileCase) -> None:
    _tried(lambda: bpy.ops.ed.redo())


def _push(_: HostileCase) -> None:
    bpy.ops.ed.undo_push(message="campaign")


def _reloaded(case: HostileCase) -> None:
    path = str(case.folder / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)


def _renamed(case: HostileCase) -> None:
    armature = _armature()
    if armature is None:
        return
    name = case.pick(("Renamed", "", "x" * 63, "骨", "Another"))
    match int(case.rng.integers(3)):
        case 0:
            armature.name = name
        case 1 if armature.animation_data is not None and armature.animation_data.action:
            armature.animation_data.action.name = name
        case _ if armature.mode != "EDIT":
            case.pick(list(armature_data(armature).bones)).name = name


def _deleted(case: HostileCase) -> None:
    armature = _armature()
    if armature is None or armature.mode != "OBJECT":
        return
    match int(case.rng.integers(6)):
        case 0:
            bpy.data.objects.remove(armature)
        case 1:
            bpy.data.actions.remove(case.pick(list(bpy.data.actions)))
        case 2:
            armature.animation_data_clear()
        case 3:
            bpy.ops.object.delete()
        case _:
            other = bpy.data.objects.new("Passing", bpy.data.meshes.new("Passing"))
            present(bpy.context.collection).objects.link(other)
            present(bpy.context.view_layer).objects.active = other


def _mode(case: HostileCase) -> None:
    armature = _armature()
    if armature is not None:
        layer = present(bpy.context.view_layer)
        mode = case.pick(MODES)
        if armature.name in layer.objects:  # it may be in another scene
            layer.objects.active = armature
            _tried(lambda: OPERATORS.object.mode_set(mode=mode))


def _other_scene(case: HostileCase) -> None:
    if case.chance(0.5):
        kind = case.pick(("NEW", "EMPTY", "LINK_COPY", "FULL_COPY"))
        _tried(lambda: OPERATORS.scene.new(type=kind))
    window = present(bpy.context.window_manager).windows
    if len(window):
        window[0].scene = case.pick(list(bpy.data.scenes))


def _frame(case: HostileCase) -> None:
    current_scene().frame_set(int(case.rng.integers(-10, 500)))


def _settings(case: HostileCase) -> None:
    """Any stored setting, and any of a row."""
    armature = _armature()
    if armature is None:
        return
    settings: Any = settings_of(armature)
    groups = [settings]
    for prop in settings.bl_rna.properties:
        if prop.type == "COLLECTION":
            groups += list(getattr(settings, prop.identifier))
    group = case.pick(groups)
    for _ in range(int(case.rng.integers(1, 5))):
        prop = case.pick([p for p in group.bl_rna.properties if not p.is_readonly])
        for name, value in _value(case, prop).items():
            _tried(partial(setattr, group, name, value))


STEPS: tuple[Callable[[HostileCase], None], ...] = (
    *(_undo, _undo, _redo, _push, _push, _reloaded, _renamed, _deleted, _mode, _mode),
    *(_other_scene, _frame, _settings, _settings, _settings, _settings),
)

FAMILIES = (
    Family("sessions, quick", 3.0, 60.0, quick),
    Family("sessions with solves", 0.6, 120.0, solving),
    Family("files of landed versions", 0.8, 120.0, landed),
)
