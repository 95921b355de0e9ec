"""What the extension has stored in the file that is open, read by walking Blender's own tables.

Knows no class of the extension, so that it tells the same of a file whatever the code is like.
"""

from __future__ import annotations

from collections.abc import Iterator
from hashlib import sha256
from typing import Any

import bpy

ATTRIBUTE = "hangtime"  # under which the carriers have their settings
DIGITS = 6

Groups = dict[str, dict[str, Any]]  # properties by group, such as "objects Rig constraints 3"


def stored() -> Groups:
    """Every value that is stored: settings, ID properties, and the texts that belong to them."""
    groups: Groups = {}
    for path, owner in owners():
        for where, group in groups_of(path, getattr(owner, ATTRIBUTE)):
            groups[where] = {name: plain(value) for name, value in values_of(group)}
        own = [key for key in owner.keys() if key.startswith(f"{ATTRIBUTE}_")]  # noqa: SIM118
        if own:
            groups[f"{path} ID properties"] = {key: plain(owner[key]) for key in sorted(own)}
    for text in bpy.data.texts:
        groups[f"texts {text.name}"] = {"content": text.as_string()}
    return groups


def owners() -> Iterator[tuple[str, bpy.types.bpy_struct]]:
    """Everything in the file that can carry settings, by a path of words; of bones the marked."""
    for table in bpy.data.bl_rna.properties:
        if table.type != "COLLECTION":
            continue
        for owner in getattr(bpy.data, table.identifier):
            if hasattr(owner, ATTRIBUTE):
                yield f"{table.identifier} {owner.name}", owner
    for armature in bpy.data.armatures:
        for bone in armature.bones:
            if bone.hangtime.key:
                yield f"bones {armature.name} {bone.name}", bone


def groups_of(
    path: str, group: bpy.types.PropertyGroup
) -> Iterator[tuple[str, bpy.types.PropertyGroup]]:
    """A group and those in it, by path."""
    yield path, group
    for prop in own_properties(group):
        inner = getattr(group, prop.identifier)
        if prop.type == "COLLECTION":
            for i, row in enumerate(inner):
                yield from groups_of(f"{path} {prop.identifier} {i}", row)
        elif is_group(prop):
            yield from groups_of(f"{path} {prop.identifier}", inner)


def values_of(group: bpy.types.PropertyGroup) -> Iterator[tuple[str, object]]:
    """A group's own values; of a list, how many rows it has."""
    for prop in own_properties(group):
        value = getattr(group, prop.identifier)
        if prop.type == "COLLECTION":
            yield prop.identifier, len(value)
        elif not is_group(prop):
            yield prop.identifier, value


def own_properties(group: bpy.types.PropertyGroup) -> list[bpy.types.Property]:
    return [prop for prop in group.bl_rna.properties if prop.identifier != "rna_type"]


def is_group(prop: bpy.types.Property) -> bool:
    """Whether it is a group within a group, not a pointer to something of the file's."""
    return prop.type == "POINTER" and not issubclass(
        bpy.types.bpy_struct.bl_rna_get_subclass_py(prop.fixed_type.identifier) or bpy.types.ID,
        bpy.types.ID,
    )


def plain(value: object) -> object:
    """A value as JSON can hold it: floats rounded, bytes by their digest, data by name."""
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}")
    if isinstance(value, bytes):
        return {"bytes": len(value), "sha256": sha256(value).hexdigest()}
    if isinstance(value, bpy.types.ID):
        return f"{value.bl_rna.identifier} {value.name}"
    if value is None or isinstance(value, bool | int | str):
        return value
    return [plain(each) for each in value]
