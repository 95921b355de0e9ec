"""A rig's controls found, and posed such that its bodies follow a track."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.faults import NoControls
from ...solver.data.recording import PoseTrack
from ..accessors import current_scene
from ..armature.channels import proper
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import Poses, metres_per_unit
from .choice import all_responses, by_control, felt_controls, used_dofs
from .driven import candidates
from .inverse import Inverse, Inverted
from .posing import Posing
from .responses import Freedom, Responses
from .targets import targets_of

FAR_MM, TURNED_DEG = 1.0, 0.2  # by which a body may miss; beyond, it is told as a miss
LOOKS = 3  # frames at which the controls are sought: a switch may be thrown in between


@dataclass(frozen=True)
class ControlRig:
    """The controls that pose bodies. used: what of each; carriers: those that no other moves.

    turns: (D, B, 3) of the bodies by each degree of freedom where they were tried.
    """

    armature: bpy.types.Object
    controls: tuple[str, ...]
    bodies: tuple[str, ...]
    responses: Responses
    used: dict[str, set[Freedom]]
    carriers: tuple[str, ...]
    turns: FloatArray

    @property
    def posing(self) -> Posing:
        """To pose them."""
        return Posing(self.armature, self.controls, self.bodies)


@dataclass(frozen=True)
class ControlPoses:
    """Pose bases (T, 4, 4) by control; what is left by frame and body (T, B), m and rad."""

    bases: dict[str, FloatArray]
    bodies: tuple[str, ...]
    off: FloatArray
    turned: FloatArray
    tries: int = 0


def found_controls(
    armature: bpy.types.Object,
    bodies: tuple[str, ...],
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[ControlRig]:
    """The controls of bodies, the first of which is the pelvis, at frames (T,).

    Raises NoControls.
    """
    at = frames[np.linspace(0, len(frames) - 1, LOOKS).round().astype(int)]
    names = candidates(armature, bodies)
    felt: set[str] = set()
    found = yield from in_slices(at, partial(_felt, armature, names, bodies), showing)
    for part in found:
        felt.update(part)
    names = [name for name in names if name in felt]
    if not names:
        raise NoControls(bodies)
    with showing():
        used = _used(armature, names, bodies, float(at[len(at) // 2]))
    yield
    controls = tuple(name for name in names if any(name == own for own, _, _ in used))
    with showing():
        return _measured(armature, controls, bodies, used, float(at[len(at) // 2]))


def _felt(
    armature: bpy.types.Object, names: list[str], bodies: tuple[str, ...], frames: FloatArray
) -> set[str]:
    posing = Posing(armature, names, bodies)
    found: set[str] = set()
    with posing.kept():
        for frame in frames:
            posing.go_to(float(frame))
            found.update(names[i] for i in felt_controls(posing, posing.bases()))
    return found


def _used(
    armature: bpy.types.Object, names: list[str], bodies: tuple[str, ...], frame: float
) -> list[tuple[str, Freedom, int]]:
    posing = Posing(armature, names, bodies)
    with posing.kept():
        posing.go_to(frame)
        bases = posing.bases()
        responses = all_responses(posing, bases)
        world = posing.object_to_world()
        unit = metres_per_unit(current_scene()) * float(np.cbrt(np.linalg.det(world[:3, :3])))
        rows = used_dofs(posing, bases, responses, unit)
    dofs = [responses.dofs[d] for d in rows]
    return [(names[dof.control], dof.freedom, dof.axis) for dof in dofs]


def _measured(
    armature: bpy.types.Object,
    controls: tuple[str, ...],
    bodies: tuple[str, ...],
    used: list[tuple[str, Freedom, int]],
    frame: float,
) -> ControlRig:
    posing = Posing(armature, controls, bodies)
    with posing.kept():
        posing.go_to(frame)
        bases = posing.bases()
        responses, posed = all_responses(posing, bases), posing.look()
    chosen = [
        d
        for d, dof in enumerate(responses.dofs)
        if (controls[dof.control], dof.freedom, dof.axis) in used
    ]
    responses = responses.part(chosen)
    turns, _ = responses.columns(posed, bases)
    free = [name for c, name in enumerate(controls) if not responses.moved[:, c].any()]
    parts = by_control(responses.dofs, controls)
    carriers = tuple(name for name in free if Freedom.SHIFT in parts[name])
    return ControlRig(armature, controls, bodies, responses, parts, carriers, turns)


def control_poses(
    rig: ControlRig,
    poses: Poses,
    track: PoseTrack,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[ControlPoses]:
    """Controls such that the bodies follow a track. poses: the rig's at the track's frames, as
    `showing` lets it perform them."""
    posing = rig.posing
    inverse = Inverse(posing, rig.responses, targets_of(rig.armature, poses, track))
    index = {float(frame): t for t, frame in enumerate(track.frames)}

    def look(frames: FloatArray) -> list[Inverted]:
        with posing.kept():
            return [inverse.solve(index[float(frame)]) for frame in frames]

    parts = yield from in_slices(track.frames, look, showing)
    solved = [each for part in parts for each in part]
    bases = np.stack([each.bases for each in solved])
    return ControlPoses(
        {name: bases[:, c] for c, name in enumerate(rig.controls)},
        rig.bodies,
        np.stack([each.off for each in solved]),
        np.stack([each.turned for each in solved]),
        inverse.tries,
    )


@dataclass(frozen=True)
class KeptByControls:
    """How near bodies that controls pose are to where they should be.

    The worst in mm and degrees, each with its bone and frame; and how many controls have keys.
    """

    mm: float
    far_bone: str
    far_frame: float
    degrees: float
    turned_bone: str
    turned_frame: float
    controls: int

    @property
    def kept(self) -> bool:
        """Whether all is as near as is promised."""
        return self.mm <= FAR_MM and self.degrees <= TURNED_DEG


def kept_by(posed: ControlPoses, frames: FloatArray) -> KeptByControls:
    """The worst over frames (T,) and bodies."""
    far = np.unravel_index(int(posed.off.argmax()), posed.off.shape)
    turned = np.unravel_index(int(posed.turned.argmax()), posed.turned.shape)
    return KeptByControls(
        1e3 * float(posed.off[far]),
        posed.bodies[int(far[1])],
        float(frames[far[0]]),
        float(np.degrees(posed.turned[turned])),
        posed.bodies[int(turned[1])],
        float(frames[turned[0]]),
        len(posed.bases),
    )


def carried_controls(
    rig: ControlRig,
    poses: Poses,
    track: PoseTrack,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[dict[str, FloatArray]]:
    """Pose bases (T, 4, 4) of the carriers that take the whole figure along with its pelvis.

    track: of the pelvis alone. poses: the rig's, at the track's frames.
    """
    names = list(rig.carriers)
    posing = Posing(rig.armature, names, track.bones[:1])
    index = {float(frame): t for t, frame in enumerate(track.frames)}
    wanted = targets_of(rig.armature, poses, track)

    def look(frames: FloatArray) -> list[FloatArray]:
        with posing.kept():
            return [at(float(frame)) for frame in frames]

    def at(frame: float) -> FloatArray:
        t = index[frame]
        posing.go_to(frame)
        posed = posing.look()
        goal = posed.bodies[0].copy()
        turn = wanted.rotations[t, 0] @ proper(posed.bodies[0, :3, :3]).T
        goal[:3, :3] = turn @ posed.bodies[0, :3, :3]
        goal[:3, 3] = wanted.heads[t, 0]
        move = goal @ np.linalg.inv(posed.bodies[0])
        return np.asarray(np.linalg.solve(posed.frames, move @ posed.controls))

    parts = yield from in_slices(track.frames, look, showing)
    bases = np.stack([each for part in parts for each in part])
    return {name: bases[:, c] for c, name in enumerate(names)}
