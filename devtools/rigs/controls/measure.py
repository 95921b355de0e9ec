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

from ....bridge.accessors import armature_data, present
from ....bridge.armature.incremental import complete
from ....bridge.armature.read import record
from ....bridge.controls.refusals import require_posable
from ....bridge.properties.attached_groups import ensure_groups
from ....bridge.recipe.result import ResultOptions
from ....bridge.takes.plan import AdaptedMotion
from ....bridge.takes.write_result import write_result
from ....operators.terminal.quiet import quiet
from ....operators.words.messages import sentence
from ....solver.arrays import FloatArray, IntArray
from ....solver.body.anatomy import map_anatomy
from ....solver.body.character import Character
from ....solver.data.contacts import Contact
from ....solver.data.faults import Fault
from ....solver.data.recording import Recording
from ....solver.numerics.rotations import rotation_matrix, rotation_vector
from ....solver.worker.pipeline import AdaptationResult, measure, solve
from ....solver.worker.stage_clock import StageClock
from ...figures.clips import EDITS
from ...processes import dump
from ..actor import CLIP
from ..controlled import ControlResult, Worst, worst_of
from .cases import ControlCase, cases, performer
from .reference import skin_on_bones
from .skin import add_skin, own_vertices, skin_at
from .sparse import sparse_keys

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
        ensure_groups()
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
            action, written = write_result(rig, motion, name=EDIT)
        seconds = time.perf_counter() - began
    except Fault as fault:
        return ControlResult(case.key, case.name, count, mapped, refused=sentence(fault))
    off, turned, skinned = _missed(rig, skin, answer, deforming)
    drift = _drift(rig, answer, case.foot) if case.foot else None
    sparse = sparse_keys(rig, action, answer, present(present(written).rig))
    if case.foot:
        sparse = replace(sparse, drift=_drift(rig, answer, case.foot))
    return ControlResult(
        case.key, case.name, count, mapped, off, turned, skinned, drift, "", seconds, sparse
    )


def _missed(
    rig: bpy.types.Object,
    skin: bpy.types.Object,
    answer: AdaptationResult,
    deforming: dict[str, str],
) -> tuple[Worst, Worst, Worst]:
    """The largest distance of any deforming bone's head, mm, its largest turn, degrees, and the
    largest distance of its own skin, mm, from the solution.

    Bones that share out a limb's twist count by where they point, and their skin does not.
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
    seen = shown.rotations[:, columns]
    swung = turned_onto(seen, rotations[..., :, 1])
    wanted = {
        name: _poses(swung[:, k] if shares[k] else rotations[:, k], heads[:, k])
        for k, name in enumerate(names)
    }
    for bone in (b for b in armature_data(rig).bones if b.use_deform and b.name not in wanted):
        i = shown.index(bone.name)  # that no body tells of: as the rig has it
        wanted[bone.name] = _poses(shown.rotations[:, i], shown.heads[:, i])
    return (
        worst_of(off, names, frames),
        worst_of(turned, names, frames),
        _skin_off(rig, skin, frames, wanted, {n for n, b in deforming.items() if n != b}),
    )


def _skin_off(
    rig: bpy.types.Object,
    skin: bpy.types.Object,
    frames: FloatArray,
    wanted: dict[str, FloatArray],
    shares: set[str],
) -> Worst:
    """The largest distance, mm, of the vertices that a bone alone moves from where they would be
    with all bones at wanted poses (T, 4, 4), at frames (T,). shares: bones that share out a limb,
    whose skin does not count."""
    apart = skin_at(skin, frames) - skin_on_bones(rig, skin, frames, wanted, set(wanted) - shares)
    groups = {group.name for group in skin.vertex_groups}
    names = tuple(name for name in wanted if name in groups - shares)
    off = [np.linalg.norm(apart[:, own_vertices(skin, name)], axis=2).max(1) for name in names]
    return worst_of(1e3 * np.stack(off, axis=1), names, frames)


def turned_onto(rotations: FloatArray, along: FloatArray) -> FloatArray:
    """Rotations (..., 3, 3) with their Y axes turned onto directions (..., 3) the nearest way."""
    axis = np.cross(rotations[..., :, 1], along)
    sine = np.linalg.norm(axis, axis=-1, keepdims=True)
    angle = np.arctan2(sine, (rotations[..., :, 1] * along).sum(-1, keepdims=True))
    turns = rotation_matrix((axis / np.maximum(sine, 1e-12) * angle).reshape(-1, 3))
    return np.asarray(turns.reshape(rotations.shape) @ rotations)


def _poses(rotations: FloatArray, heads: FloatArray) -> FloatArray:
    """(T, 4, 4) of rotations (T, 3, 3) and heads (T, 3)."""
    poses = np.tile(np.eye(4), (len(heads), 1, 1))
    poses[:, :3, :3], poses[:, :3, 3] = rotations, heads
    return poses


def _wanted(
    answer: AdaptationResult, times: FloatArray, shown: Recording, deforming: dict[str, str]
) -> tuple[FloatArray, FloatArray]:
    """Heads (T, N, 3) m and rotations (T, N, 3, 3) of deforming bones, each rigid to its body.

    The halves of a limb are apart as its joints are in the solution: where inverse kinematics
    stretches, a take's limb may be longer or shorter than at rest all along, and so is the figure.
    """
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
        apart = rest.head - from_body
        if name != body:
            apart = apart * _longer(character, shown, i)
        heads.append(centres[:, i] + posed[:, i] @ apart)
        rotations.append(posed[:, i] @ rest.rotation)
    return np.stack(heads, axis=1), np.stack(rotations, axis=1)


def _longer(character: Character, shown: Recording, body: int) -> float:
    """How much longer a body is from its joint to the next in the solution than at rest."""
    below = next(i for i, joint in enumerate(character.joints) if joint.parent == body)
    ends = [shown.bones[shown.index(character.bodies[i].bone)].head for i in (body, below)]
    now = np.linalg.norm(character.joints[below].offset)
    return float(now / np.linalg.norm(ends[1] - ends[0]))


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
    return worst_of(slid[:, None], (control,), shown.frames[rows])
