"""Helper bones of a loop: what keeps its place on the body in the recording keeps it there."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import armature_data
from ..armature import fcurves
from ..armature.actions import slices_showing
from ..armature.incremental import Incremental, sample_incrementally
from ..armature.poses import Poses
from ..companions.found import Companions
from ..companions.moves import differs, following_bases
from ..takes.owned import company_channels
from .cyclic_keys import write_cyclic

_STAYS = 1e-4  # bone lengths, by which a bone that does not travel ends away from its start


def keep_followers(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    curves: fcurves.CurveHolder,
    company: Companions,
    frames: FloatArray,
    poses: Poses,
) -> Incremental[Companions]:
    """Key followers where they are on the body; returns those that had left it. curves: the
    action's, in which the cycle is written. poses: the recording's at frames (T,)."""
    if not company.followers:
        return company
    action.update_tag()
    showing = slices_showing(armature, action)
    now = yield from sample_incrementally(armature, frames, showing)
    bases = following_bases(armature, company.followers, _closed(poses), now)
    left = {name for name, basis in bases.items() if differs(armature, now, name, basis)}
    with showing():
        channels = company_channels(armature, curves, company, None)[1]
        rests = {c: c.at_rest(armature) for c in channels if c.bone in left}
    for channel, rest in rests.items():
        basis = bases[channel.bone]
        values = channel.values(armature, basis, rest[None])
        goes_on = channel.attribute == "location" and _goes_on(armature, channel.bone, basis)
        write_cyclic(curves, channel.path, channel.bone, frames, values, goes_on=goes_on)
        yield None
    return replace(company, followers=tuple(each for each in company.followers if each[0] in left))


def _closed(poses: Poses) -> Poses:
    """With the first pose at the last frame, too: on the body as it ends where it began."""
    return replace(poses, matrices=np.concatenate([poses.matrices[:-1], poses.matrices[:1]]))


def _goes_on(armature: bpy.types.Object, bone: str, basis: FloatArray) -> bool:
    """Whether a basis (T, 4, 4) travels with the cycle: what it hangs on does not."""
    length = armature_data(armature).bones[bone].length
    return bool(np.abs(basis[-1, :3, 3] - basis[0, :3, 3]).max() > _STAYS * length)
