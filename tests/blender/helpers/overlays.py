"""A figure with a recorded and an adapted motion, and what the viewport's overlays show of it."""

from __future__ import annotations

import bpy
import numpy as np
from hangtime.bridge.armature.poses import sample
from hangtime.bridge.armature.traces_store import keep
from hangtime.bridge.rows.kind import ConstraintKind
from hangtime.solver.data.traces import FlightParabola, Traces
from hangtime.tests.blender.helpers import rigs
from hangtime.ui.overlay.context.figure_cache import FigureCache
from hangtime.ui.overlay.context.layer import Layer, Part
from hangtime.ui.overlay.context.view_context import ViewContext
from hangtime.ui.overlay.geometry.shapes import Label, Look, Shape
from hangtime.ui.overlay.layer_selection import layers
from mathutils import Euler, Matrix, Vector

WORLD = Matrix.LocRotScale(Vector((3.0, -2.0, 0.5)), Euler((0.4, -0.3, 1.1)), Vector((2.5,) * 3))
WHERE = {"as made": Matrix.Identity(4), "scaled and turned": WORLD}
FIGURE = rigs.MOVING
ENDS = {"hips": "spine", "spine": "head", "thigh": "shin", "shin": "foot"}  # where they go on
METRES = 0.01  # of a Blender unit
THICK = 0.03  # m, radius of the solid shapes
FRAME = 9.0


def adapted(where: Matrix) -> bpy.types.Object:
    """Recorded and adapted, in a scene of centimetres; the adapted motion is a metre further."""
    rigs.reset()
    bpy.context.scene.unit_settings.scale_length = METRES
    armature = rigs.make_armature()
    rigs.animate(armature)
    armature.matrix_world = where
    action = bpy.data.actions.new("Adapted")
    settings = armature.hangtime
    settings.adapted = action
    keep(armature, traced(armature), armature.matrix_world)
    keep(action, traced(armature, adapted=True), armature.matrix_world)
    for name, start, end in (("Left heel 1", 1.0, 12.0), ("Left heel 2", 18.0, 24.0)):
        row = settings.contacts.add()
        row.name, row.point, row.bone, row.phase = name, "Left heel", "foot", f"ground {name[-1]}"
        row.found_start = row.start_frame = start
        row.found_end = row.end_frame = end
    bpy.context.scene.frame_set(int(FRAME))
    return armature


def traced(armature: bpy.types.Object, *, adapted: bool = False) -> Traces:
    """The armature's own motion, as the solver would tell of it."""
    frames = np.array(rigs.FRAMES, dtype=float)
    poses = sample(armature, frames)
    world = poses.object_to_world[:, None] @ poses.matrices
    places = [poses.bones.index(name) for name in FIGURE]
    heads = METRES * world[:, places][:, :, :3, 3]
    tails = heads.copy()
    for body, name in enumerate(FIGURE):
        end = ENDS.get(name)
        own = world[:, places[body]] @ (0.0, armature.data.bones[name].length, 0.0, 1.0)
        tails[:, body] = METRES * own[:, :3] if end is None else heads[:, FIGURE.index(end)]
    shift = np.array((1.0, 0.0, 0.0)) if adapted else np.zeros(3)
    count, contacts = len(frames), int(adapted)
    forces = np.tile((0.0, 0.0, 1400.0), (count, contacts, 1))
    forces[11:17] = 0.0
    return Traces(
        frames,
        FIGURE,
        heads + shift,
        tails + shift,
        com=heads.mean(axis=1) + shift,
        velocity=np.zeros((count, 3)),
        momentum=np.tile((0.0, 10.0, 0.0), (count, 1)),
        contacts=("Left heel",) * contacts,
        points=np.tile(shift, (count, contacts, 1)),
        forces=forces.reshape(count, contacts, 3),
        weight=700.0,
        joints=(),
        torques=np.zeros((count, 0)),
        flights=(FlightParabola("flight 1", 12.0, 18.0, np.eye(3)),) * contacts,
        solids=FIGURE,
        solid_starts=heads + shift,
        solid_ends=tails + shift,
        solid_radii=np.full(len(FIGURE), THICK),
    )


def constrain(
    armature: bpy.types.Object, kind: ConstraintKind, *bones: str, **values: object
) -> bpy.types.PropertyGroup:
    row = armature.hangtime.constraints.add()
    row.name, row.kind = f"{kind.label} {len(armature.hangtime.constraints)}", kind.name
    for bone in bones:
        row.bones.add().name = bone
    for name, value in values.items():
        setattr(row, name, value)
    return row


def seen(armature: bpy.types.Object, frame: float = FRAME) -> ViewContext:
    view = bpy.context.scene.hangtime.view
    metres = bpy.context.scene.unit_settings.scale_length
    return ViewContext(armature, armature.hangtime, view, frame, metres)


def shown(armature: bpy.types.Object, frame: float = FRAME) -> dict[Part, Layer]:
    return {layer.part: layer for layer in layers(seen(armature, frame), FigureCache())}


def in_world(layer: Layer, *looks: Look) -> np.ndarray:
    """Points of a layer's shapes with these looks, all if none is given; (N, 3), Blender units."""
    shapes = [s for s in layer.build() if isinstance(s, Shape) and (not looks or s.look in looks)]
    points = np.concatenate([s.points for s in shapes]).astype(float)
    matrix = np.array(layer.matrix.copy())  # numpy cannot look into frozen ones
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def words(layer: Layer) -> list[str]:
    return [each.words for each in layer.build() if isinstance(each, Label)]


def bone_in_world(armature: bpy.types.Object, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Head and tail of a bone as Blender poses it now."""
    bone = armature.pose.bones[name]
    return np.array(armature.matrix_world @ bone.head), np.array(armature.matrix_world @ bone.tail)
