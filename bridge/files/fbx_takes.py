"""What of an FBX file is read: one armature, under one of the takes in which its bones move.

Blender's importer makes an action of each take and thing, and assigns each thing its first. Its own
exporter gives each take keys of everything, so an armature's first may be of a crate that moves.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import bpy
import numpy as np
from mathutils import Matrix

from ...solver.data.faults import NoAction, NoArmature, NotInFile
from ...solver.data.reports.recording import ChosenTake
from ..accessors import armature_data, current_action, pose_of
from ..action_slots import all_curves
from ..app_handlers import add_handler
from ..armature import fcurves

Places: TypeAlias = "dict[str, Mapping[str | None, Matrix]]"
"""By armatures' names, their own place (None) and their bones', as `matrix_basis` has them."""

_STILL = 1e-5  # of a curve's largest value, at least 1: what single precision leaves of one value


@dataclass(frozen=True)
class _Take:
    """An armature's action of a take. name: as the file's author gave it. moves: its bones do."""

    name: str
    action: bpy.types.Action
    moves: bool


@dataclass(frozen=True)
class _Figure:
    """An armature and its takes, in the file's order."""

    armature: bpy.types.Object
    takes: tuple[_Take, ...]

    @property
    def moves(self) -> bool:
        return any(take.moves for take in self.takes)

    @property
    def own(self) -> _Take:
        """The take that is read where none is asked for: the first in which bones move."""
        return next((take for take in self.takes if take.moves), self.takes[0])

    def named(self, name: str) -> _Take | None:
        """The take of that name, which may also be what the file or Blender calls it."""
        for take in self.takes:
            whole = take.action.name
            if _among(name, (take.name, whole.partition("|")[2], whole)):
                return take
        return None


def choose_take(
    path: Path,
    objects: Iterable[bpy.types.Object],
    actions: Collection[bpy.types.Action],
    places: Places,
    *,
    armature: str | None,
    take: str | None,
) -> tuple[bpy.types.Object, ChosenTake]:
    """Assign an armature of an FBX file the take to read, and tell what was not.

    objects, actions: as imported. places: as `places_without_keys` gave them. armature, take: names
    asked for; else the armature with the most bones among those that move, and its first take in
    which they do. Raises NoArmature, NoAction, NotInFile.
    """
    armatures = [o for o in objects if o.type == "ARMATURE"]
    if not armatures:
        raise NoArmature(path.name)
    armatures.sort(key=lambda each: len(armature_data(each).bones), reverse=True)
    made = (_Figure(each, _takes(each, actions)) for each in armatures)
    figures = sorted((each for each in made if each.takes), key=lambda each: not each.moves)
    if not figures:
        raise NoAction(armatures[0].name)
    able = figures if armature is None else _called(path, figures, armature)
    figure, chosen = able[0], able[0].own
    if take is not None:
        figure, chosen = _with_take(path, able, take)
    _assign(figure.armature, chosen.action, places)
    others = [each.armature.name for each in figures if each.moves and each is not figure]
    return figure.armature, ChosenTake(
        figure.armature.name,
        chosen.name,
        tuple(others) if armature is None else (),
        tuple(each.name for each in figure.takes if each is not chosen) if take is None else (),
    )


def _called(path: Path, figures: Sequence[_Figure], name: str) -> list[_Figure]:
    found = [each for each in figures if _among(name, [each.armature.name])]
    if not found:
        known = tuple(each.armature.name for each in figures)
        raise NotInFile(str(path), "armature", name, known)
    return found


def _with_take(path: Path, figures: Sequence[_Figure], name: str) -> tuple[_Figure, _Take]:
    """The first armature that has a take of that name, and the take."""
    for figure in figures:
        found = figure.named(name)
        if found is not None:
            return figure, found
    known = dict.fromkeys(take.name for figure in figures for take in figure.takes)
    raise NotInFile(str(path), "take", name, tuple(known))


def _among(name: str, names: Iterable[str]) -> bool:
    return name.casefold() in (each.casefold() for each in names)


# ---------------------------------------------------------------- an armature's takes


def _takes(armature: bpy.types.Object, actions: Collection[bpy.types.Action]) -> tuple[_Take, ...]:
    """Those that are about an armature's bones; where there are none the one that is assigned, if
    no other thing moves in it: of what moves the armature alone nothing is its own then."""
    first = current_action(armature)
    if first is None:
        return ()
    prefix = f"{armature.name}|"
    mine = [a for a in actions if a == first or a.name.startswith(prefix)]
    mine.sort(key=lambda action: action.session_uid)  # in the order in which they were made
    others = {_bare(a.name) for a in actions if a not in mine and _moved(all_curves(a))}
    about = [action for action in mine if _about_bones(action, others)]
    if not about and _bare(first.name) not in others:
        about = [first]
    names = _short_names([action.name.removeprefix(prefix) for action in about], prefix)
    return tuple(
        _Take(name, action, _moved(_bone_curves(action)))
        for name, action in zip(names, about, strict=True)
    )


def _short_names(names: Sequence[str], prefix: str) -> list[str]:
    """Names of takes without what Blender's exporter puts before them, and without the layer, where
    that is the same for all: "Hero|jump" to "jump", "mixamo.com|Layer0" to "mixamo.com"."""
    short = [name.removeprefix(prefix) or name for name in names]
    parts = [name.rpartition("|") for name in short]
    takes = [take for take, _, _ in parts]
    same_layer = len({layer for _, _, layer in parts}) == 1
    return takes if same_layer and all(takes) and len(set(takes)) == len(takes) else short


def _about_bones(action: bpy.types.Action, others: Collection[str]) -> bool:
    """Whether a take has keys of bones, and is not another thing's alone: Blender's exporter keeps
    them still there, and may let the armature go where that thing goes. others: takes in which
    other things move."""
    curves = all_curves(action)
    bones = _bone_curves(action)
    return bool(bones) and (_moved(bones) or not (_moved(curves) or _bare(action.name) in others))


def _bare(name: str) -> str:
    """What an action is called beside its owner: "jump" of "Hero|Hero|jump"."""
    owner, _, take = name.partition("|")
    return take.removeprefix(f"{owner}|")


def _bone_curves(action: bpy.types.Action) -> list[bpy.types.FCurve]:
    return [curve for curve in all_curves(action) if _keyed_bone(curve) is not None]


def _keyed_bone(curve: bpy.types.FCurve) -> str | None:
    return fcurves.bone_of(curve.data_path) if len(curve.keyframe_points) else None


def _moved(curves: Iterable[bpy.types.FCurve]) -> bool:
    """Whether any has two values; what is no number counts, so that it is read, and refused."""
    values = (fcurves.keys(curve)[:, 1] for curve in curves)
    return any(
        not np.isfinite(v).all() or np.ptp(v) > _STILL * max(1.0, np.abs(v).max())
        for v in values
        if len(v)
    )


def _assign(armature: bpy.types.Object, action: bpy.types.Action, places: Places) -> None:
    """Let a take animate its armature; what it has no keys of goes where the file puts it, for by
    now it is where the take before had it."""
    if action == current_action(armature):
        return
    fcurves.assign(armature, action)
    kept = {fcurves.bone_of(c.data_path) for c in all_curves(action) if len(c.keyframe_points)}
    bones = pose_of(armature).bones
    for name, place in places.get(armature.name, {}).items():
        if name not in kept:
            (armature if name is None else bones[name]).matrix_basis = place


@contextmanager
def places_without_keys() -> Iterator[Places]:
    """Context of an import: gets where the file puts armatures and their bones without any take.

    The importer sets these places and then the actions, and Blender evaluates the latter only as
    the import ends: a handler looks just before.
    """
    places: Places = {}

    def note(*_: object) -> None:
        for each in bpy.data.objects:
            if each.type == "ARMATURE" and current_action(each) and each.name not in places:
                own: dict[str | None, Matrix] = {None: each.matrix_basis.copy()}
                own |= {bone.name: bone.matrix_basis.copy() for bone in pose_of(each).bones}
                places[each.name] = own

    with ExitStack() as undo:
        add_handler(undo, bpy.app.handlers.depsgraph_update_pre, note)
        yield places
