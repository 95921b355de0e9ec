"""What a recording is made of, by its parts: which of them are others since it was analysed."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any
from zlib import crc32

import bpy

from ...solver.data.faults import ChangedMeanwhile
from ..accessors import armature_data, pose_of
from ..armature.actions import recorded_action
from ..armature.fcurves import holder_in, slot_identifier
from ..armature.keys_digest import stored
from ..hidden_texts import HiddenText, entries, word
from ..properties.settings import settings_of
from ..scene.surfaces_digest import Conditions
from ..takes.options import loop_options
from ..takes.takes import take_digest

_TOLD = {"error_location", "error_rotation"}  # by inverse kinematics, of the frame that is shown

BONES = "its bones"
RATE = "the scene's frame rate"
SIZE = "its scale or the scene's unit scale"
PLACE = "its place"
CONSTRAINTS = "its constraints"
KEYS = "its keys"
REPAIRS = "its repairs"
LOOP = "Loop"


@dataclass(frozen=True)
class AnalysedState:
    """Of an armature and its recording. bones, constraints, keys: numbers, others where these are;
    repairs: as they are stored; loop: whether it is to be one."""

    conditions: Conditions
    bones: str
    constraints: str
    keys: str
    repairs: str
    loop: bool

    @staticmethod
    def of(armature: bpy.types.Object) -> AnalysedState:
        """What it is now."""
        settings, action = settings_of(armature), recorded_action(armature)
        bones = [(b.name, b.parent and b.parent.name) for b in armature_data(armature).bones]
        return AnalysedState(
            Conditions.of(armature),
            str(crc32(repr(bones).encode())),
            str(crc32(repr(_constraints(armature)).encode())),
            take_digest(armature, action) if action is not None else "",
            settings.repairs,
            loop_options(settings) is not None,
        )

    def as_text(self) -> str:
        """To be kept in a property, see `STATE`."""
        return json.dumps(asdict(self))

    def since(self, before: AnalysedState) -> tuple[str, ...]:
        """In words, the parts that are others than before."""
        now, then = self.conditions, before.conditions
        renamed, resized = self.bones != before.bones, now.resized(then)
        changes = {
            BONES: renamed,
            RATE: now.replayed(then),
            SIZE: resized,
            PLACE: not resized and now.moved(then),
            CONSTRAINTS: self.constraints != before.constraints,
            KEYS: not renamed and self.keys != before.keys,  # which name the bones
            REPAIRS: self.repairs != before.repairs,
            LOOP: self.loop != before.loop,
        }
        return tuple(told for told, differs in changes.items() if differs)


def changed_since_analysis(armature: bpy.types.Object) -> tuple[str, ...]:
    """In words, the parts that are others than were analysed; nothing where no earlier ones were
    kept."""
    before = STATE.of(settings_of(armature).analysed_state)
    return () if before is None else AnalysedState.of(armature).since(before)


def require_in_place(armature: bpy.types.Object) -> None:
    """Refuse an armature that was moved or scaled since the analysis, whose contacts stay where
    they were found; without reading its recording. Raises ChangedMeanwhile."""
    before = STATE.of(settings_of(armature).analysed_state)
    if before is None:
        return
    now, then = Conditions.of(armature), before.conditions
    changed = SIZE if now.resized(then) else PLACE if now.moved(then) else None
    if changed is not None:
        raise ChangedMeanwhile(armature.name, while_solving=False, changed=(changed,))


def _constraints(armature: bpy.types.Object) -> list[object]:
    """What is set of the constraints of an armature and its bones, but for what keys and drivers
    change from frame to frame."""
    data, action = armature.animation_data, recorded_action(armature)
    curves = holder_in(action, slot_identifier(armature)) if action is not None else None
    changing = [] if data is None else [each.data_path for each in data.drivers]
    changing += [] if curves is None else [each.data_path for each in curves.fcurves]
    found: list[object] = []
    for owner in (armature, *pose_of(armature).bones):
        for each in owner.constraints:
            path = f"{each.path_from_id()}."
            moving = {p.removeprefix(path) for p in changing if p.startswith(path)}
            found.append((owner.name if owner != armature else "", stored(each, _TOLD | moving)))
    return found


def _read(content: Any) -> AnalysedState:
    told = entries(content)
    words = {name: word(told[name]) for name in ("bones", "constraints", "keys", "repairs")}
    conditions = Conditions.told(told["conditions"])
    return AnalysedState(conditions=conditions, loop=told["loop"] is True, **words)


STATE: HiddenText[AnalysedState | None] = HiddenText("analysed_state", _read, None)
