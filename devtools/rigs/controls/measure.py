"""The process that measures one control rig: builds, adapts, writes to the controls, and looks.

What the writer says of itself does not count: bones are where Blender evaluates them, on every
frame, and should be where forward kinematics of the solution's own joint angles has them.
"""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np

from ....bridge.armature.incremental import complete
from ....bridge.armature.read import record
from ....bridge.controls.refusals import require_posable
from ....bridge.recipe.result import ResultOptions
from ....bridge.takes.plan import AdaptedMotion
from ....bridge.takes.write_result import write_result
from ....operators.headless.quiet import quiet
from ....operators.words.messages import sentence
from ....solver.arrays import FloatArray, IntArray
from ....solver.body.anatomy import map_anatomy
from ....solver.data.contacts import Contact
from ....solver.data.faults import Fault
from ....solver.data.recording import Recording
from ....solver.numerics.rotations import rotation_vector
from ....solver.worker.pipeline import AdaptationResult, StageClock, measure, solve
from ...figures.clips import EDITS
from ...processes import dump
from ..actor import CLIP
from ..controlled import ControlResult, Worst
from .cases import ControlCase, cases, performer
from .skin import add_skin, own_vertices, skin_at, skin_at_rest

EDIT = next(iter(EDITS))
RESULT = "result.pickle"


def main(argv: list[str]) -> int:
    folder, key = Path(argv[0]), argv[1]
    dump(measured(next(case for case in cases() if case.key == key)), folder / RESULT)
    return 0


def measured(case: ControlCase) -> ControlResult:
    """The figures' first edit on a control rig."""
    take = performer()
    with quiet():
        rig = case.build(take)
        recording = record(rig, take.frames)
    parts = {recording.bones[s.bone].name: s.part for s in map_anatomy(recording.bones)}
    bodies = tuple(parts)
    deforming = case.deforming([bone.name for bone in recording.bones], bodies)
    skin = add_skin(rig, {bone: parts[body] for bone, body in deforming.items()})
    count = len(recording.bones)
    mapped = set(deforming.values()) == set(bodies)
    try:
        complete(require_posable(rig, bodies, take.frames))
        problem = replace(CLIP.problem(EDIT), frames=(take.frames[0], take.frames[-1]))
        answer = solve(measure(recording, problem), StageClock())
        motion = AdaptedMotion(answer.track, answer.times, answer.moved, ResultOptions())
        began = time.perf_counter()
        with quiet():
            write_result(rig, motion, name=EDIT)
        seconds = time.perf_counter() - began
    except Fault as fault:
        return ControlResult(case.key, case.name, count, mapped, refused=sentence(fault))
    off, turned, skinned = _missed(rig, skin, answer, deforming)
    drift = _drift(rig, answer, case.foot) if case.foot else None
    return ControlResult(
        case.key, case.name, count, mapped, off, turned, skinned, drift, "", seconds
    )


def _missed(
    rig: bpy.types.Object,
    skin: bpy.types.Object,
    answer: AdaptationResult,
    deforming: dict[str, str],
) -> tuple[Worst, Worst, Worst]:
    """The largest distance of any deforming bone's head, mm, its largest turn, degrees, and the
    largest distance of its own skin, mm, from the solution.

    Of bones that share out a limb's twist the turn of their direction counts, and no skin.
    """
    frames, times = answer.adaptation.motion.frames(answer.recording)
    shown = record(rig, frames)
    names = tuple(deforming)
    columns = [shown.index(name) for name in names]
    heads, rotations = _wanted(answer, times, shown, deforming)
    off = 1e3 * np.linalg.norm(shown.heads[:, columns] - heads, axis=2)
    shares = np.array([name != body for name, body in deforming.items()])
    apart = np.swapaxes(rotations, -1, -2) @ shown.rotations[:, columns]
    whole = np.linalg.norm(rotation_vector(apart.reshape(-1, 3, 3)), axis=1).reshape(off.shape)
    along = np.arctan2(np.linalg.norm(apart[..., [0, 2], 1], axis=-1), apart[..., 1, 1])
    turned = np.degrees(np.where(shares, along, whole))
    return (
        _worst(off, names, frames),
        _worst(turned, names, frames),
        _skin_off(
            skin,
            shown,
            {n: (heads[:, k], rotations[:, k]) for k, n in enumerate(names) if not shares[k]},
        ),
    )


def _skin_off(
    skin: bpy.types.Object, shown: Recording, wanted: dict[str, tuple[FloatArray, FloatArray]]
) -> Worst:
    """The largest distance, mm, of the vertices that a bone alone moves from where they would be
    on it at its wanted heads (T, 3) and rotations (T, 3, 3)."""
    at_rest, seen = skin_at_rest(skin), skin_at(skin, shown.frames)
    off = []
    for name, (heads, rotations) in wanted.items():
        bone, vertices = shown.bones[shown.index(name)], own_vertices(skin, name)
        local = (at_rest[vertices] - bone.head) @ bone.rotation
        there = heads[:, None] + local @ np.swapaxes(rotations, -1, -2)
        off.append(1e3 * np.linalg.norm(seen[:, vertices] - there, axis=2).max(1))
    return _worst(np.stack(off, axis=1), tuple(wanted), shown.frames)


def _wanted(
    answer: AdaptationResult, times: FloatArray, shown: Recording, deforming: dict[str, str]
) -> tuple[FloatArray, FloatArray]:
    """Heads (T, N, 3) m and rotations (T, N, 3, 3) of deforming bones, each rigid to its body."""
    motion = answer.adaptation.motion
    character = motion.transcription.character
    index = {body.bone: i for i, body in enumerate(character.bodies)}
    joined = dict(character.joined)
    posed, centres = motion.pose(times).rotations, motion.joint_centres(times)
    heads, rotations = [], []
    for name, body in deforming.items():
        moves = joined.get(body, body)
        i = index[moves]
        rest, from_body = shown.bones[shown.index(name)], shown.bones[shown.index(moves)].head
        heads.append(centres[:, i] + posed[:, i] @ (rest.head - from_body))
        rotations.append(posed[:, i] @ rest.rotation)
    return np.stack(heads, axis=1), np.stack(rotations, axis=1)


def _worst(values: FloatArray, names: tuple[str, ...], frames: FloatArray) -> Worst:
    t, n = np.unravel_index(int(values.argmax()), values.shape)
    return Worst(float(values[t, n]), names[int(n)], float(frames[t]))


def _drift(rig: bpy.types.Object, answer: AdaptationResult, foot: str) -> Worst:
    """How far over the ground, mm, a foot's control carries the heel from where it is pinned, by
    its keys, from frame to frame of each stance."""
    frames, times = answer.adaptation.motion.frames(answer.recording)
    shown = record(rig, frames)
    found = []
    for contact in answer.schedule.contacts:
        rows = np.flatnonzero((times >= contact.start) & (times <= contact.end))
        if "heel" in contact.point and len(rows):
            found.append(slide(shown, contact, rows, foot))
    return max(found, key=lambda each: each.value)


def slide(shown: Recording, contact: Contact, rows: IntArray, foot: str) -> Worst:
    """How far over the ground, mm, a foot's control carries a contact's point from where it has it
    in the middle of some frames, by their rows. foot: as in ControlCase."""
    side = contact.point[0].lower()
    names = [bone.name for bone in shown.bones]
    control = next(n for n in names if n in (foot.format(s=side), foot.format(s=side.upper())))
    heads = shown.heads[rows, names.index(control)]
    turned = shown.rotations[rows, names.index(control)]
    middle = len(rows) // 2
    bone = names.index(contact.bone)
    heel = shown.heads[rows[middle], bone] + shown.rotations[rows[middle], bone] @ contact.offset
    held = heads + turned @ (turned[middle].T @ (heel - heads[middle]))
    slid = 1e3 * np.linalg.norm((held - held[middle])[:, :2], axis=1)
    return _worst(slid[:, None], (control,), shown.frames[rows])
