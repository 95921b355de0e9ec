"""Which bone moves which part of the body: what was found by name, and the artist's choices."""

from __future__ import annotations

import bpy
import numpy as np

from ...solver.body.anatomy import guess_anatomy
from ...solver.data.recording import Bone
from ..accessors import armature_data
from ..properties.settings import HangtimeSettings, settings_of

_NEEDED = ("head", "upper arm", "forearm", "thigh", "shank", "foot")


def find_parts(armature: bpy.types.Object) -> None:
    """Fills the settings' parts from the bones' names; what the artist chose stays."""
    settings = settings_of(armature)
    chosen = chosen_parts(settings)
    settings.parts.clear()
    for label, bone in guess_anatomy(named_bones(armature)).items():
        part = settings.parts.add()
        part.name, part.found = label, bone or ""
        part.bone = chosen.get(label, part.found)
        part.needed = label.endswith(_NEEDED)


def chosen_parts(settings: HangtimeSettings) -> dict[str, str]:
    """The bones that the artist chose, by part."""
    return {p.name: p.bone for p in settings.parts if p.bone and p.bone != p.found}


def missing_parts(settings: HangtimeSettings) -> list[str]:
    """Parts that the physics needs and that no bone moves."""
    return [part.name for part in settings.parts if part.needed and not part.bone]


def named_bones(armature: bpy.types.Object) -> list[Bone]:
    """The bones by name and parent alone, parents first."""
    bones = sorted(armature_data(armature).bones, key=lambda bone: len(bone.parent_recursive))
    names = [bone.name for bone in bones]
    nowhere = np.zeros(3)
    return [
        Bone(b.name, names.index(b.parent.name) if b.parent else -1, nowhere, nowhere, np.eye(3))
        for b in bones
    ]
