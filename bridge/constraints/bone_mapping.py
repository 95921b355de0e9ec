"""Which bone moves which part of the body: what was found by itself, and the artist's choices."""

from __future__ import annotations

from collections.abc import Mapping

import bpy

from ...solver.skeleton.mapping import Evidence, guess_bones, labels_of
from ...solver.skeleton.parts import LABELS, REQUIRED_KEYS
from ...solver.skeleton.tree import tree_of
from ..accessors import armature_data
from ..armature.read import named_bones
from ..properties.settings import HangtimePart, HangtimeSettings, settings_of
from ..rows.copying import rows_named


def find_parts(armature: bpy.types.Object) -> None:
    """Fills the settings' parts from the bones' names and places; what the artist chose stays."""
    settings = settings_of(armature)
    chosen = chosen_parts(settings)
    bones = named_bones(armature)
    found = guess_bones(tree_of(bones))
    settings.convention = found.convention
    labels = labels_of(found, bones)
    parts = rows_named(settings.parts, list(labels))
    for part, (label, guess) in zip(parts, labels.items(), strict=True):
        part.found, part.evidence = ("", "") if guess is None else (guess[0], guess[1].value)
        part.bone = chosen.get(label, part.found)
        part.needed = LABELS[label] in REQUIRED_KEYS


def chosen_parts(settings: HangtimeSettings) -> dict[str, str]:
    """The bones that the artist chose, by part."""
    return {p.name: p.bone for p in settings.parts if p.bone and p.bone != p.found}


def missing_parts(settings: HangtimeSettings) -> list[str]:
    """Parts that the physics needs and that no bone moves."""
    return [part.name for part in settings.parts if part.needed and not part.bone]


def evidence_of(part: HangtimePart) -> Evidence | None:
    """What tells that a part's bone is the right one; None where there is none, or nobody knows."""
    if part.bone and part.bone != part.found:
        return Evidence.CHOSEN
    return Evidence(part.evidence) if part.bone and part.evidence else None


def choose_parts(armature: bpy.types.Object, bones: Mapping[str, str]) -> list[str]:
    """Lets these bones move the parts, by label; the others are found anew.

    Returns the bones that the armature lacks, whose parts stay as found.
    """
    settings = settings_of(armature)
    for part in settings.parts:  # none is the artist's choice any more
        part.bone = part.found
    find_parts(armature)
    there = armature_data(armature).bones
    for part in settings.parts:
        bone = bones.get(part.name)
        if bone is not None and bone in there:
            part.bone = bone
    return [bone for bone in bones.values() if bone not in there]
