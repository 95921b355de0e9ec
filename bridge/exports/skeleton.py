"""The bones that go into a file, and their hierarchy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.skeleton.tree import bare
from ..accessors import armature_data
from ..armature.channels import proper
from ..armature.pose_basis import carrier_of

ROOT_NAMES = ("root", "root_motion")  # of an added root: the first that no bone has
_ROOT_LENGTH = 0.25  # m, of an added root; nothing but its look depends on it


@dataclass(frozen=True)
class Outline:
    """Names of bones, parents first, and their parents' indices, -1 for none.

    root: the topmost bone above the pelvis, if there is one; added: whether the armature lacks it.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    root: int | None
    added: bool

    @property
    def taken(self) -> tuple[str, ...]:
        """The bones that the armature has."""
        return self.names[1:] if self.added else self.names


@dataclass(frozen=True)
class Skeleton:
    """Bones of a file at rest.

    rest: (B, 4, 4), bone to object, without scale. lengths: (B,). Both as the file counts. deforms:
    whether a bone moves skin.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    rest: FloatArray
    lengths: FloatArray
    deforms: tuple[bool, ...]


def outline(
    armature: bpy.types.Object, pelvis: str | None, *, clean: bool, root: bool, one_root: bool
) -> Outline:
    """The bones that a file gets.

    clean: those alone that deform, with the root bone; each hangs on the nearest that is left, or
    on what stands for its parent among them, as in generated rigs. root: a root bone is needed;
    one_root: one is where several bones hang on none.
    """
    bones = sorted(armature_data(armature).bones, key=lambda bone: len(bone.parent_recursive))
    top = _top(armature, pelvis)
    kept = [b for b in bones if not clean or b.use_deform or b == top]
    if not any(bone.use_deform for bone in kept):
        kept = bones
    left = {bone.name for bone in kept}
    stands_for = {bare(name): name for name in left if bare(name) != name}
    parents = _sorted({bone.name: _above(bone, left, stands_for) for bone in kept})
    names = tuple(parents)
    above = tuple(-1 if p is None else names.index(p) for p in parents.values())
    tops = [i for i, parent in enumerate(above) if parent < 0]
    if len(tops) == 1 and top is not None and names[tops[0]] == top.name:
        return Outline(names, above, tops[0], added=False)
    if root or (one_root and len(tops) > 1):
        name = next(n for n in (*ROOT_NAMES, "_".join(names)) if n not in names)
        return Outline((name, *names), (-1, *(p + 1 for p in above)), 0, added=True)
    return Outline(names, above, None if top is None else names.index(top.name), added=False)


def skeleton(armature: bpy.types.Object, found: Outline, to_file: FloatArray) -> Skeleton:
    """The bones at rest. to_file (4, 4): from the armature's space, with one scale."""
    size = scale_of(to_file)
    bones = [armature_data(armature).bones[name] for name in found.taken]
    rest = [rigid(to_file @ np.array(bone.matrix_local)) for bone in bones]
    lengths = [size * bone.length for bone in bones]
    deforms = [bone.use_deform for bone in bones]
    if found.added:
        rest, lengths = [np.eye(4), *rest], [_ROOT_LENGTH * size, *lengths]
        deforms = [False, *deforms]
    return Skeleton(found.names, found.parents, np.stack(rest), np.array(lengths), tuple(deforms))


def scale_of(matrix: FloatArray) -> float:
    """How many times as long a similarity (4, 4) makes things."""
    return float(np.cbrt(abs(np.linalg.det(matrix[:3, :3]))))


def rigid(matrix: FloatArray) -> FloatArray:
    """A similarity (4, 4) without its scale, which the place keeps."""
    found = matrix.copy()
    found[:3, :3] = proper(matrix[:3, :3])
    return found


def _top(armature: bpy.types.Object, pelvis: str | None) -> bpy.types.Bone | None:
    """The topmost bone above the pelvis that moves it without being of it."""
    if pelvis is None:
        return None
    bone = carrier_of(armature_data(armature).bones[pelvis])
    return bone.parent_recursive[-1] if bone.parent is not None else None


def _above(bone: bpy.types.Bone, kept: set[str], stands_for: Mapping[str, str]) -> str | None:
    """The kept bone that a bone hangs on. stands_for: by names without a family's prefix."""
    for above in (each.name for each in bone.parent_recursive):
        if above in kept:
            return str(above)
        twin = stands_for.get(bare(above), bone.name)
        if twin != bone.name:
            return twin
    return None


def _sorted(parents: Mapping[str, str | None]) -> dict[str, str | None]:
    """The same, parents first."""

    def depth(name: str | None) -> int:
        return 0 if name is None else 1 + depth(parents[name])

    return {name: parents[name] for name in sorted(parents, key=depth)}
