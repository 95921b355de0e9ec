"""What a recording is made of, by its parts: which of them are others since it was analysed."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any
from zlib import crc32

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ...solver.analysis.motion_sketch import MotionSketch
from ...solver.data.faults import ChangedMeanwhile
from ...solver.data.recording import Recording
from ..accessors import armature_data, pose_of
from ..armature.actions import recorded_action
from ..armature.fcurves import holder_in, slot_identifier
from ..armature.keys_digest import stored
from ..hidden_texts import HiddenText, entries, word
from ..properties.settings import settings_of
from ..results.digests import take_digest
from ..scene.surfaces_digest import Conditions
from ..takes.options import loop_options

_TOLD = {  # by Blender: of the frame that is shown, and of the slots that an action has now
    *("error_location", "error_rotation"),
    *("action_suitable_slots", "last_slot_identifier"),
}
_DIGITS = 3  # Blender units, and of axes, which going in and out of edit mode turns by 1e-6

BONES, KEYS, PLACE = "its bones", "its keys", "its place"
_FEW = 3  # bones that are named


@dataclass(frozen=True)
class AnalysedState:
    """Of an armature and its recording. digests: of its other parts, by what these are called to
    the artist; each another text where the part is another."""

    conditions: Conditions
    digests: Mapping[str, str]

    @staticmethod
    def of(armature: bpy.types.Object) -> AnalysedState:
        """What it is now."""
        settings, action = settings_of(armature), recorded_action(armature)
        digests = {
            BONES: _digest(_bones(armature)),
            "its constraints": _digest(_constraints(armature)),
            KEYS: take_digest(armature, action) if action is not None else "",
            "its repairs": settings.repairs,
            "Loop": str(loop_options(settings) is not None),
        }
        return AnalysedState(Conditions.of(armature), digests)

    def as_text(self) -> str:
        """To be kept in a property, see `STATE`."""
        return json.dumps(asdict(self))

    def since(self, before: AnalysedState) -> tuple[str, ...]:
        """In words, the parts that are others than before; of those that were not kept, nothing."""
        now, then = self.conditions, before.conditions
        rate = ("the scene's frame rate",) if now.replayed(then) else ()
        kept = before.digests
        changed = [part for part, text in self.digests.items() if kept.get(part, text) != text]
        told = (part for part in changed if part != KEYS or BONES not in changed)  # keys name bones
        return (*rate, *_placed(now, then), *told)


def changed_since_analysis(armature: bpy.types.Object, recording: Recording) -> tuple[str, ...]:
    """In words, the parts that are others than were analysed, where there are none the poses of the
    recording; nothing where no earlier ones were kept."""
    settings = settings_of(armature)
    before = STATE.of(settings.analysed_state)
    parts = () if before is None else AnalysedState.of(armature).since(before)
    return parts or posed_otherwise(MotionSketch.from_text(settings.analysed_motion), recording)


def posed_otherwise(before: MotionSketch | None, recording: Recording) -> tuple[str, ...]:
    """In words, the bones that a recording poses otherwise than a motion before; nothing where that
    was of other bones or frames, or is not known."""
    apart = None if before is None else before.apart(MotionSketch.of(recording))
    if apart is None or not apart.bones:
        return ()
    names = [recording.bones[bone].name for bone in apart.bones]
    more = len(names) - _FEW
    told = ", ".join(names[:_FEW]) + (f" and {more} more" if more > 0 else "")
    return (f"the pose of {told}, most at frame {recording.frames[apart.frame]:g}",)


def require_in_place(armature: bpy.types.Object) -> None:
    """Refuse an armature that was moved or scaled since the analysis, whose contacts stay where
    they were found; without reading its recording. Raises ChangedMeanwhile."""
    before = STATE.of(settings_of(armature).analysed_state)
    changed = () if before is None else _placed(Conditions.of(armature), before.conditions)
    if changed:
        raise ChangedMeanwhile(armature.name, while_solving=False, changed=changed)


def _placed(now: Conditions, then: Conditions) -> tuple[str, ...]:
    """In words, how an armature is placed otherwise than it was; another size moves it, too."""
    if now.resized(then):
        return ("its scale or the scene's unit scale",)
    return (PLACE,) if now.moved(then) else ()


def _digest(part: object) -> str:
    return str(crc32(repr(part).encode()))


def _bones(armature: bpy.types.Object) -> list[object]:
    """The bones, and where they are at rest."""
    return [
        (each.name, each.parent and each.parent.name, _rounded(each.matrix_local, each.tail_local))
        for each in armature_data(armature).bones
    ]


def _rounded(matrix: Matrix, tail: Vector) -> list[float]:
    values = np.append(np.array(matrix), np.array(tail))
    return list((np.round(values, _DIGITS) + 0.0).tolist())  # no -0.0


def _constraints(armature: bpy.types.Object) -> list[object]:
    """What is set of the constraints of an armature and its bones, but for what keys and drivers
    change from frame to frame."""
    data, action = armature.animation_data, recorded_action(armature)
    curves = holder_in(action, slot_identifier(armature)) if action is not None else None
    changing = [] if data is None else [each.data_path for each in data.drivers]
    changing += [] if curves is None else [each.data_path for each in curves.fcurves]
    moving = defaultdict[str, set[str]](set)
    for path in changing:
        owner, _, name = path.rpartition(".")
        moving[owner].add(name)
    return [
        (owner.name if owner != armature else "", stored(each, _TOLD | moving[each.path_from_id()]))
        for owner in (armature, *pose_of(armature).bones)
        for each in owner.constraints
    ]


def _read(content: Any) -> AnalysedState:
    told = entries(content)
    digests = {part: word(digest) for part, digest in entries(told.get("digests", {})).items()}
    return AnalysedState(Conditions.told(told["conditions"]), digests)


STATE: HiddenText[AnalysedState | None] = HiddenText("analysed_state", _read, None)
