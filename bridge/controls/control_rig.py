"""A rig's controls found: those that pose its bodies, of all that move them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import partial

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.faults import NoControls
from ..accessors import current_scene
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import metres_per_unit, sample
from .choice import Group, all_responses, felt_controls, used_groups
from .driven import candidates
from .followed import telling_frames
from .needed import Effects, effects_at
from .posing import Posing
from .responses import Freedom, Responses
from .targets import parents_of


@dataclass(frozen=True)
class RigLook:
    """What all controls do at a frame, and the turns that this is, (D, B, 3)."""

    responses: Responses
    effects: Effects
    turns: FloatArray


@dataclass(frozen=True)
class Felt:
    """All controls that move the bodies of a rig, by name, and looks at what they do."""

    posing: Posing
    looks: tuple[RigLook, ...]


@dataclass(frozen=True)
class ControlRig:
    """The controls that pose bodies. used: what of each; carriers: those that no other moves.

    turns: (L, D, B, 3) of the bodies by each degree of freedom at the frames where they were tried.
    felt: what they were chosen of, and groups: as what.
    """

    armature: bpy.types.Object
    controls: tuple[str, ...]
    bodies: tuple[str, ...]
    responses: Responses
    used: dict[str, set[Freedom]]
    carriers: tuple[str, ...]
    turns: FloatArray
    felt: Felt
    groups: tuple[Group, ...]

    @property
    def posing(self) -> Posing:
        """To pose them."""
        return Posing(self.armature, self.controls, self.bodies)


def found_controls(
    armature: bpy.types.Object,
    bodies: tuple[str, ...],
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[ControlRig]:
    """The controls of bodies, the first of which is the pelvis, at frames (T,).

    Raises NoControls.
    """
    at = yield from telling_frames(armature, frames, showing)
    names = candidates(armature, bodies)
    felt: set[str] = set()
    found = yield from in_slices(at, partial(_felt, armature, names, bodies), showing)
    for part in found:
        felt.update(part)
    names = [name for name in names if name in felt]
    if not names:
        raise NoControls(bodies)
    posing = Posing(armature, names, bodies)
    with showing():
        parents = parents_of(armature, sample(armature, frames[:1]), bodies)
    yield
    looked = yield from in_slices(at, partial(_looks, posing, parents), showing)
    looks = tuple(look for part in looked for look in part)
    groups = used_groups(posing, [(look.responses, look.effects) for look in looks])
    return rig_of(Felt(posing, looks), groups)


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


def _looks(posing: Posing, parents: list[int], frames: FloatArray) -> list[RigLook]:
    looks = []
    with posing.kept():
        for frame in frames:
            posing.go_to(float(frame))
            bases, world = posing.bases(), posing.object_to_world()
            responses, posed = all_responses(posing, bases), posing.look()
            unit = metres_per_unit(current_scene()) * float(np.cbrt(np.linalg.det(world[:3, :3])))
            effects = effects_at(responses, posed, bases, parents, unit)
            looks.append(RigLook(responses, effects, responses.columns(posed, bases)[0]))
    return looks


def rig_of(felt: Felt, groups: Sequence[Group]) -> ControlRig:
    """The rig of those groups of all controls, as it is at the middle one of the looks."""
    posing, looks = felt.posing, felt.looks
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
    turns = np.stack([look.turns[dofs] for look in looks])
    return ControlRig(
        posing.armature,
        controls,
        posing.bodies,
        middle,
        used,
        carriers,
        turns,
        felt,
        tuple(groups),
    )
