"""A rig's controls found, and posed such that its bodies follow a track."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import cache, partial

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.faults import NoControls
from ...solver.data.recording import PoseTrack
from ..accessors import current_scene
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import Poses, metres_per_unit, sample
from .choice import Group, all_responses, moved_by_controls, used_groups
from .driven import candidates
from .followed import FAINT, influences_over, rig_digest, telling_frames
from .inverse import Inverse, Inverted
from .leading import movers
from .needed import Effects, effects_at
from .posing import Posing
from .responses import Freedom, Responses
from .targets import move_of_pelvis, moved_bases, parents_of, targets_of

FELT = 1e-5  # of a pose's entries, by which a control must move a body to be one of its own
_REMEMBERED = 8  # rigs, of a shot's characters
_Tried = tuple[int, tuple[str, ...], str, bytes, bytes]


@dataclass(frozen=True)
class ControlRig:
    """The controls that pose bodies. used: what of each; carriers: those that no other moves.

    effects: of the degrees of freedom, at each of the frames where they were tried. moving: (C,)
    which controls move any body, by state of the switches, as bytes of which constraints act.
    """

    armature: bpy.types.Object
    controls: tuple[str, ...]
    bodies: tuple[str, ...]
    responses: Responses
    used: dict[str, set[Freedom]]
    carriers: tuple[str, ...]
    effects: tuple[Effects, ...]
    moving: dict[bytes, BoolArray]

    @property
    def posing(self) -> Posing:
        """To pose them."""
        return Posing(self.armature, self.controls, self.bodies)

    def followers(self, control: str) -> BoolArray:
        """(B,) the bodies that any degree of freedom of a control moves."""
        index, responses = self.controls.index(control), self.responses
        own = [d for d, dof in enumerate(responses.dofs) if dof.control == index]
        return np.asarray(responses.follow[own].any(0))


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

    They are remembered: to try them takes seconds, and each solve asks. Raises NoControls.
    """
    acts = yield from influences_over(armature, frames, showing)
    with showing():
        made = rig_digest(armature)
    key = armature.session_uid, bodies, made, frames.tobytes(), acts.round(3).tobytes()
    remembered = _remembered()
    if key in remembered:
        return replace(remembered[key], armature=armature)
    at = telling_frames(acts > FAINT)
    found = yield from _tried(armature, bodies, frames[at], acts[at] > FAINT, showing)
    with showing():
        unchanged = rig_digest(armature) == made
    if unchanged:
        while len(remembered) >= _REMEMBERED:
            del remembered[next(iter(remembered))]
        remembered[key] = found
    return found


@cache
def _remembered() -> dict[_Tried, ControlRig]:
    """The rigs that were tried last, by what they were, with what."""
    return {}


def _tried(
    armature: bpy.types.Object,
    bodies: tuple[str, ...],
    at: FloatArray,
    states: BoolArray,
    showing: Callable[[], AbstractContextManager[object]],
) -> Incremental[ControlRig]:
    """The controls of bodies, tried at frames (L,). states: (L, N), which constraints act there.
    Raises NoControls."""
    names = candidates(armature, bodies)
    if not names:
        raise NoControls(bodies)
    every = Posing(armature, names, bodies)
    found = yield from in_slices(at, partial(_moved, every), showing, fewest=1)
    moved, count = np.concatenate(found), len(bodies)
    felt = (moved[:, :, :count] > FELT).any((0, 2))
    if not felt.any():
        raise NoControls(bodies)
    posing = Posing(armature, np.array(names)[felt].tolist(), bodies)
    with showing():
        parents = parents_of(armature, sample(armature, at[:1]), bodies)
    yield None
    kept = np.append(np.ones(count, bool), felt)
    tried = dict(zip(at.tolist(), moved[:, felt][:, :, kept] > 0.0, strict=True))
    looked = yield from in_slices(at, partial(_looks, posing, parents, tried), showing, fewest=1)
    looks = [look for part in looked for look in part]
    groups = used_groups(posing, [(look.responses, look.effects) for look in looks])
    if not groups:  # they move something, but nothing that hangs together
        raise NoControls(bodies)
    return _rig(posing, looks, groups, states)


@dataclass(frozen=True)
class _Look:
    """What all controls do at a frame."""

    responses: Responses
    effects: Effects


def _moved(posing: Posing, frames: FloatArray) -> FloatArray:
    """(T, C, B + C) how much each control moves bodies and controls."""
    found = []
    with posing.kept():
        for frame in frames:
            posing.go_to(float(frame))
            found.append(moved_by_controls(posing, posing.bases()))
    return np.stack(found)


def _looks(
    posing: Posing, parents: list[int], moved: dict[float, BoolArray], frames: FloatArray
) -> list[_Look]:
    """moved: (C, B + C) what each control moves, by frame."""
    looks = []
    with posing.kept():
        for frame in frames.tolist():
            posing.go_to(frame)
            bases, world = posing.bases(), posing.object_to_world()
            responses, posed = all_responses(posing, bases, moved[frame]), posing.look()
            unit = metres_per_unit(current_scene()) * float(np.cbrt(np.linalg.det(world[:3, :3])))
            effects = effects_at(responses, posed, bases, parents, unit)
            looks.append(_Look(responses, effects))
    return looks


def _rig(posing: Posing, looks: list[_Look], groups: list[Group], states: BoolArray) -> ControlRig:
    """The rig of those groups of all controls, as it is at the middle one of the looks. states:
    (L, N), which constraints act there."""
    kept = sorted({group.control for group in groups})
    dofs = sorted(d for group in groups for d in group.dofs)
    parts = [look.responses.part(dofs, kept) for look in looks]
    middle = replace(
        parts[len(parts) // 2],
        follow=np.any([part.follow for part in parts], axis=0),
        moved=np.any([part.moved for part in parts], axis=0),
    )
    controls = tuple(posing.controls[c] for c in kept)
    used: dict[str, set[Freedom]] = {}
    for dof in middle.dofs:
        used.setdefault(controls[dof.control], set()).add(dof.freedom)
    free = [name for c, name in enumerate(controls) if not middle.moved[:, c].any()]
    carriers = tuple(name for name in free if Freedom.SHIFT in used[name])
    effects = tuple(look.effects.part(dofs) for look in looks)
    moving: dict[bytes, BoolArray] = {}
    for part, state in zip(parts, states, strict=True):
        key = state.tobytes()
        moving[key] = moving.get(key, False) | movers(part)
    about = posing.armature, controls, posing.bodies
    return ControlRig(*about, middle, used, carriers, effects, moving)


def control_poses(
    rig: ControlRig,
    poses: Poses,
    track: PoseTrack,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[ControlPoses]:
    """Controls such that the bodies follow a track. poses: the rig's at the track's frames, as
    `showing` lets it perform them."""
    posing = rig.posing
    targets = targets_of(rig.armature, poses, track)
    inverse = Inverse(posing, rig.responses, targets, rig.carriers, rig.moving)
    index = {float(frame): t for t, frame in enumerate(track.frames)}

    def look(frames: FloatArray) -> list[Inverted]:
        with posing.kept():
            return [inverse.solve(index[float(frame)]) for frame in frames]

    parts = yield from in_slices(track.frames, look, showing, fewest=1)
    solved = [each for part in parts for each in part]

    def look_again(frames: FloatArray) -> None:
        with posing.kept():
            for t in (index[float(frame)] for frame in frames):
                solved[t] = inverse.solve_again(t) or solved[t]

    yield from in_slices(track.frames[inverse.unmet()], look_again, showing)
    bases = np.stack([each.bases for each in solved])
    return ControlPoses(
        {name: bases[:, c] for c, name in enumerate(rig.controls)},
        rig.bodies,
        np.stack([each.off for each in solved]),
        np.stack([each.turned for each in solved]),
        inverse.tries,
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
        posing.go_to(frame)
        posed = posing.look()
        return moved_bases(posed, move_of_pelvis(posed, wanted, index[frame]))

    parts = yield from in_slices(track.frames, look, showing)
    bases = np.stack([each for part in parts for each in part])
    return {name: bases[:, c] for c, name in enumerate(names)}


def shifts_of_carriers(rig: ControlRig, frame: float, move: FloatArray) -> dict[str, FloatArray]:
    """By how much the locations (3,) of the carriers change where they take the whole figure along
    by a move (3,), world, m; as the frame is shown."""
    posing = Posing(rig.armature, rig.carriers, rig.bodies[:1])
    with posing.kept():
        posing.go_to(frame)
        units = move / metres_per_unit(current_scene())
        along = np.linalg.solve(posing.object_to_world()[:3, :3], units)
        axes = posing.look().places[:, :3, :3]
    return {name: np.linalg.solve(axes[c], along) for c, name in enumerate(rig.carriers)}
