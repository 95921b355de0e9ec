"""Bones that were renamed while another action was shown, or in another armature that shares it:
Blender renames the curves of the armature's shown action alone, so a recording's keys move a bone
that is not there any more, and the bone itself stays at rest."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import bpy

from ...solver.data.faults import DeadKeys, RenamedBones
from ...solver.skeleton.mapping import guess_labels
from ...solver.skeleton.names import names_part
from ...solver.skeleton.parts import LABELS, REQUIRED_KEYS
from ..accessors import armature_data, present
from ..action_slots import home_of
from ..armature import fcurves
from ..armature.actions import recorded_action, showing_recorded
from ..armature.read import named_bones
from ..controls.driven import followed_by, moved_beside_keys
from ..properties.settings import settings_of
from ..takes.difference import difference_shown
from ..takes.takes import takes_of

_FEWEST_LETTERS = 3  # of a name that another one ends in, by which both may be one bone's
_SAME_JOINT = 0.05  # of a bone's length, from its joint to its control's


@dataclass(frozen=True)
class KeyedBones:
    """Which bones a recording moves. dead: those that its keys move and the armature lacks.
    unkeyed: the armature's that neither keys nor drivers nor constraints move. parts: the bone of
    each part, by its label."""

    dead: tuple[str, ...]
    unkeyed: tuple[str, ...]
    parts: Mapping[str, str]

    @staticmethod
    def of(armature: bpy.types.Object) -> KeyedBones:
        """What they are now."""
        with showing_recorded(armature)():
            moved = {*_keyed(armature), *moved_beside_keys(armature)}
        names = [bone.name for bone in armature_data(armature).bones]
        unkeyed = tuple(name for name in names if name not in moved)
        return KeyedBones(dead_bones(armature), unkeyed, _parts(armature))


def require_keyed(armature: bpy.types.Object) -> DeadKeys | None:
    """Refuse a recording whose keys lack a bone that was renamed, of the body or followed by it.

    Returns what is to be said where it has keys of other bones that the armature lacks. To be asked
    before parts are found anew, which forgets what they were called. Raises RenamedBones.
    """
    if not dead_bones(armature):
        return None
    action, keyed = present(recorded_action(armature)).name, KeyedBones.of(armature)
    renamed = _names_now(armature, keyed)
    needed = {bone for label, bone in keyed.parts.items() if LABELS[label] in REQUIRED_KEYS}
    missed = {bone for bone in needed if not _carried(armature, bone, keyed)}
    missed |= followed_by(armature, keyed.parts.values()).intersection(renamed.values())
    if missed:
        paired = not missed.isdisjoint(renamed.values())
        raise RenamedBones(action, keyed.dead, tuple(sorted(missed)), paired)
    return DeadKeys(action, keyed.dead)


def dead_bones(armature: bpy.types.Object) -> tuple[str, ...]:
    """The bones that a recording's keys move and the armature does not have."""
    bones = armature_data(armature).bones
    return tuple(name for name in _keyed(armature) if name not in bones)


def renamed_bones(armature: bpy.types.Object) -> dict[str, str]:
    """Of bones that a recording's keys move what they are called now, as far as that is told."""
    return _names_now(armature, KeyedBones.of(armature))


def _names_now(armature: bpy.types.Object, keyed: KeyedBones) -> dict[str, str]:
    """Of a part of the body its bone, as it was known or as the old name tells; of others the only
    one whose name is alike."""
    known = {row.bone: row.name for row in settings_of(armature).parts}
    labels = {bone: label for label, bone in keyed.parts.items()}
    found: dict[str, str] = {}
    for alike in (
        lambda old, new: new in labels and known.get(old) == labels[new],
        lambda old, new: new in labels and names_part(old, LABELS[labels[new]]),
        _same_but_for_prefix,
    ):
        for old in keyed.dead:
            taken = set(found.values())
            like = [bone for bone in keyed.unkeyed if bone not in taken and alike(old, bone)]
            if old not in found and len(like) == 1:
                found[old] = like[0]
    return found


def _same_but_for_prefix(one: str, other: str) -> bool:
    """Such as rig_Tail and Tail, but neither Detail and Tail nor Head.L and L."""
    tail, whole = sorted((one, other), key=len)
    prefix = whole.removesuffix(tail)
    letters = sum(map(str.isalpha, tail))
    return letters >= _FEWEST_LETTERS and prefix != whole and not prefix[-1:].isalnum()


def takes_to_rename(
    armature: bpy.types.Object, names: Mapping[str, str]
) -> dict[bpy.types.Action, list[bpy.types.FCurve]]:
    """The armature's takes, and what results have more than others, with the curves that move bones
    by their old names. names: the new ones, by these."""
    takes = (take.action for take in takes_of(armature))
    found = {}
    for action in (each for take in takes for each in (take, difference_shown(take))):
        if action is not None:
            found[action] = _outdated(action, fcurves.slot_identifier(armature), names)
    return {action: curves for action, curves in found.items() if curves}


def rename_keys(curves: Iterable[bpy.types.FCurve], names: Mapping[str, str]) -> None:
    """Have curves move the bones as they are called now."""
    for curve in curves:
        name = present(fcurves.bone_of(curve.data_path))
        old, new = (bpy.utils.escape_identifier(each) for each in (name, names[name]))
        curve.data_path = curve.data_path.replace(f'["{old}"]', f'["{new}"]', 1)
        if curve.group is not None and curve.group.name == name:
            curve.group.name = names[name]


def moved_by_old_names(
    armature: bpy.types.Object, takes: Iterable[bpy.types.Action], names: Iterable[str]
) -> bpy.types.Object | None:
    """Another armature that has bones of these names, and that one of an armature's takes moves."""
    slot, old = fcurves.slot_identifier(armature), set(names)
    shared = {home[0] if (home := home_of(take)) is not None else take for take in takes}
    for other in bpy.data.objects:
        if other == armature or other.type != "ARMATURE" or not other.users_scene:
            continue
        plays = fcurves.slot_identifier(other) == slot and not shared.isdisjoint(_played(other))
        if plays and not old.isdisjoint(armature_data(other).bones.keys()):
            return other
    return None


def _played(armature: bpy.types.Object) -> set[bpy.types.Action | None]:
    data = armature.animation_data
    if data is None:
        return set()
    return {data.action, *(strip.action for track in data.nla_tracks for strip in track.strips)}


def _outdated(
    action: bpy.types.Action, slot: str | None, names: Mapping[str, str]
) -> list[bpy.types.FCurve]:
    """The curves that move bones by their old names; but of those that are keyed by the new one."""
    curves = fcurves.holder_in(action, slot)
    bones = [(c, fcurves.bone_of(c.data_path)) for c in curves.fcurves] if curves else []
    keyed = {bone for _, bone in bones}
    return [c for c, bone in bones if bone and bone in names and names[bone] not in keyed]


def _keyed(armature: bpy.types.Object) -> dict[str, None]:
    """The bones that a recording's keys move, in their order; those of muted curves move none."""
    action = recorded_action(armature)
    slot = fcurves.slot_identifier(armature)
    curves = fcurves.holder_in(action, slot) if action is not None else None
    moving = (c for c in curves.fcurves if len(c.keyframe_points) and not c.mute) if curves else ()
    bones = (fcurves.bone_of(curve.data_path) for curve in moving)
    return dict.fromkeys(name for name in bones if name is not None)


def _carried(armature: bpy.types.Object, name: str, keyed: KeyedBones) -> bool:
    """Whether a bone moves by itself, or with a control above it. Between two parts a control has
    its bone's joint; others, such as those of a neck, are bones of the body."""
    bone, bodies = armature_data(armature).bones[name], keyed.parts.values()
    above = bone.parent_recursive
    part = next((i for i, each in enumerate(above) if each.name in bodies), None)
    within = math.inf if part is None else _SAME_JOINT * bone.length
    moving = (each for each in (bone, *above[:part]) if each.name not in keyed.unkeyed)
    return any((each.head_local - bone.head_local).length <= within for each in moving)


def _parts(armature: bpy.types.Object) -> dict[str, str]:
    """The bone of each part, by its label: as the artist chose where that is there, else as found
    now."""
    bones = armature_data(armature).bones
    guessed = guess_labels(named_bones(armature))
    rows = settings_of(armature).parts  # in which a script may have left a part that there is not
    chosen = {row.name: row.bone for row in rows if row.name in LABELS and row.bone in bones}
    return {label: each[0] for label, each in guessed.items() if each is not None} | chosen
