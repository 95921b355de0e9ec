"""A made-up jump, stored with an armature as the operators store theirs."""

from __future__ import annotations

import bpy
import numpy as np
from hangtime.bridge.armature.traces_store import keep
from hangtime.solver.data.traces import FlightParabola, Traces
from hangtime.tests.blender.helpers import rigs

FIRST, LAST = 10.0, 110.0
FRAMES = np.arange(FIRST, LAST + 1.0)
TAKE_OFF, LANDING = 45.0, 70.0
WEIGHT = 700.0
CONTACTS = (
    ("Left heel 1", "Left heel", FIRST, 30.0),
    ("Left toe 1", "Left toe", FIRST, TAKE_OFF),
    ("Right toe 1", "Right toe", FIRST, TAKE_OFF),
    ("Left heel 2", "Left heel", LANDING, LAST),
    ("Left toe 2", "Left toe", 72.5, LAST),
    ("Right toe 2", "Right toe", LANDING, LAST),
)


def traces(*, adapted: bool) -> Traces:
    """With forces and torques, if adapted."""
    count = len(FRAMES)
    points, joints = (("Left toe", "Right toe"), ("shin", "foot")) if adapted else ((), ())
    forces = np.zeros((count, len(points), 3))
    forces[..., 2] = np.where((FRAMES < TAKE_OFF) | (FRAMES > LANDING), 0.6 * WEIGHT, 0.0)[:, None]
    torques = np.stack([(1.0 + j) * FRAMES for j in range(len(joints))], axis=1) if joints else None
    com = np.zeros((count, 3))
    com[:, 2] = 1.0 + 0.001 * FRAMES
    flight = FlightParabola("flight 1", TAKE_OFF, LANDING, np.zeros((25, 3)))
    return Traces(
        frames=FRAMES,
        bones=("hips",),
        heads=np.zeros((count, 1, 3)),
        tails=np.zeros((count, 1, 3)),
        com=com,
        velocity=np.tile((3.0, 0.0, 4.0), (count, 1)),
        momentum=np.zeros((count, 3)),
        contacts=points,
        points=np.zeros((count, len(points), 3)),
        forces=forces,
        weight=WEIGHT,
        joints=joints,
        torques=np.zeros((count, 0)) if torques is None else torques,
        flights=(flight,) if adapted else (),
    )


def analysed() -> bpy.types.Object:
    """An armature with contacts and the recording's traces, as after an analysis."""
    rigs.reset()
    armature = rigs.make_armature()
    settings = armature.hangtime
    settings.use_range = True
    settings.first_frame, settings.last_frame = int(FIRST), int(LAST)
    for name, point, start, end in CONTACTS:
        row = settings.contacts.add()
        row.name, row.point = name, point
        row.found_start = row.start_frame = start
        row.found_end = row.end_frame = end
    keep(armature, traces(adapted=False), armature.matrix_world)
    return armature


def adapted() -> bpy.types.Object:
    """The same with an adapted action."""
    armature = analysed()
    action = bpy.data.actions.new("Jump adapted")
    armature.hangtime.adapted = action
    keep(action, traces(adapted=True), armature.matrix_world)
    return armature
