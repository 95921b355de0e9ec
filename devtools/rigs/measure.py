"""The process that measures one rig: builds, maps, adapts, writes the action, reads it again."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np

from ...bridge.armature.read import record
from ...bridge.armature.write import write_action
from ...operators.terminal.quiet import quiet
from ...solver.data.faults import Fault
from ...solver.skeleton.mapping import guess_bones
from ...solver.skeleton.parts import KEYS, Part, Side, label_of
from ...solver.skeleton.tree import tree_of
from ...solver.worker.pipeline import measure, solve
from ...solver.worker.stage_clock import StageClock
from ..figures.clips import EDITS
from ..processes import dump
from .actor import CLIP, JOINTS, Actor, actor
from .build import build
from .files import round_trips
from .layout import Layout, layouts
from .result import Edited, RigResult

EDIT = next(iter(EDITS))
RESULT, EDITED = "result.pickle", "edited.pickle"


def main(argv: list[str]) -> int:
    folder, key = Path(argv[0]), argv[1]
    layout = next(layout for layout in layouts() if layout.key == key)
    performer = actor()
    with quiet():
        armature = build(layout, performer)
    result = mapped(layout, armature, performer)
    dump(result, folder / RESULT)
    if result.mapped and "--map" not in argv:
        try:
            dump(edited(layout, armature, performer), folder / EDITED)
        except Fault as fault:
            dump(replace(result, failed=f"{type(fault).__name__}: {fault}"), folder / RESULT)
    return 0


def mapped(layout: Layout, armature: bpy.types.Object, performer: Actor) -> RigResult:
    """What the names and the shape tell of a rig, and how truly Blender plays the jump on it."""
    shown = record(armature, performer.frames[::20])
    guess = guess_bones(tree_of(shown.bones))
    wrong = []
    for key in KEYS:
        bone = shown.bones[guess.bones[key]].name if key in guess.bones else "none"
        if bone != layout.parts.get(_joint(*key), "none"):
            wrong.append(f"{label_of(key)}: {bone}")
    columns = [shown.index(layout.parts[joint]) for joint in JOINTS]
    off = np.linalg.norm(shown.heads[:, columns] - performer.heads[::20], axis=2)
    return RigResult(
        layout.key,
        layout.name,
        layout.unknown,
        len(layout.bones),
        guess.convention,
        tuple(wrong),
        tuple(Counter(e.value for e in guess.evidence.values()).items()),
        recording_mm=1e3 * float(off.max()),
    )


def edited(layout: Layout, armature: bpy.types.Object, performer: Actor) -> Edited:
    """The figures' first edit, as written into Blender. Raises Fault."""
    recording = record(armature, performer.frames)
    result = solve(measure(recording, CLIP.problem(EDIT)), StageClock())
    write_action(armature, result.track, name=EDIT)
    shown = record(armature, result.track.frames)
    columns = [shown.index(layout.parts[joint]) for joint in JOINTS]
    with quiet():
        files = round_trips(armature, shown)
    return Edited(shown.frames, shown.heads[:, columns], result.adaptation.solved, files)


def _joint(part: Part, side: Side) -> str:
    """The actor's joint at which a part begins."""
    name = part.value.replace(" ", "_")
    return name if side is Side.MIDDLE else f"{name}.{side.value[0]}"
