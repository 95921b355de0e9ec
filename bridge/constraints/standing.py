"""Points that stand: whether a result's keys have them where they were solved to be."""

from __future__ import annotations

import bpy
import numpy as np

from ...solver.data.contacts import ContactSchedule
from ...solver.data.reports.keys import MissedContact
from ...solver.data.traces import Traces
from ..accessors import current_scene
from ..armature.incremental import Incremental, sample_incrementally
from ..armature.poses import frames_per_second
from ..armature.read import recording_of
from ..armature.steady_joints import unsteady_scales

TOLD_MM = 1.0  # from which on a miss is told; a foot that slides by more is seen


def missed_contacts(
    armature: bpy.types.Object, schedule: ContactSchedule, solved: Traces
) -> Incremental[tuple[MissedContact, ...]]:
    """Contacts that a result, which the armature shows, misses, the worst first; in slices.

    schedule: of the solved motion, in s from the first of its frames on.
    """
    frames = solved.frames
    poses = yield from sample_incrementally(armature, frames)
    told = [each for each in schedule.contacts if each.point in solved.contacts]
    touching = poses.of(sorted({each.bone for each in told}))
    shown, rate = recording_of(armature, frames, touching), frames_per_second(current_scene())
    times, missed = (frames - frames[0]) / rate, []
    for each in told:
        rows = np.flatnonzero((times >= each.start) & (times <= each.end))
        if not len(rows):
            continue
        bone = shown.index(each.bone)
        at = shown.heads[rows, bone] + shown.rotations[rows, bone] @ each.offset
        wanted = solved.points[rows, solved.contacts.index(each.point)]
        off = 1e3 * np.linalg.norm(at - wanted, axis=1)
        if off.max() >= TOLD_MM:
            frame = float(frames[rows[off.argmax()]])
            scaled = tuple(unsteady_scales(armature, poses, each.bone))
            missed.append(MissedContact(each.name, float(off.max()), frame, scaled))
    return tuple(sorted(missed, key=lambda miss: -miss.mm))
