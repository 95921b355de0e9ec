"""A body that is held in its recorded poses lands where it did: found before anything is solved.

Feet that stand and joints that are held tell where the whole body is. So it takes off as it did,
flies as it did, and pins that move one stance and not the other leave no motion. The steps towards
them do end, after minutes: everything that may give way is then at its bound.
"""

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from ..arrays import FloatArray
from ..data.faults import PoseHeld
from ..data.requests import BodyChange, PoseRequest, Requests
from ..transcription.contact_pins import PointContact
from ..transcription.motion import Motion
from .evaluation_context import EvaluationContext

STIFF = np.radians(1.0)  # of slack; with more in every joint a body reaches far
GIVES = 0.05  # m, more than soles, toes and a flight that takes other time leave it: 0.01 m
LANDED = 0.05  # s after a landing, in which the pose still holds


def check_poses(
    requests: Requests,
    context: EvaluationContext,
    motion: Motion,
    recorded: FloatArray,
    pinned: Mapping[str, str],
) -> None:
    """Refuses a pose of the whole body through stances that pins move apart.

    motion: with the contacts at their places. recorded: (n_contacts, 3) m, where they were. pinned:
    the pin that moves a contact, by names. Raises PoseHeld, and as `EvaluationContext.interval`.
    """
    if not context.timeline.unchanged or requests.body != BodyChange():
        return  # with other times or another gravity it would land elsewhere
    for pose in requests.poses:
        if not _holds_all(pose, context):
            continue
        start, end = context.interval(pose.name, pose.when)
        held = [
            (k, each.contact.name)
            for k, each in enumerate(motion.transcription.contacts)
            if _stands(each) and start <= each.contact.start and each.contact.start + LANDED <= end
        ]
        for (first, earlier), (second, later) in combinations(held, 2):
            before, after = recorded[[first, second]], motion.places[[first, second]]
            pin = pinned.get(later, pinned.get(earlier))
            if pin is not None and _moved_apart(before, after) > GIVES:
                way = np.diff(after - before, axis=0)
                raise PoseHeld(pose.name, pin, float(np.linalg.norm(way)))


def _holds_all(pose: PoseRequest, context: EvaluationContext) -> bool:
    """Whether a pose holds every joint, and hardly lets it move."""
    if pose.weight is not None or pose.slack > STIFF:
        return False
    bodies = {context.body(pose.name, bone) for bone in pose.bones}
    return not bodies or len(bodies | {0}) == len(context.character.bodies)


def _stands(contact: PointContact) -> bool:
    """Whether it is on ground that is still, in one place."""
    return contact.held is None and contact.track is None and contact.ride is None


def _moved_apart(before: FloatArray, after: FloatArray) -> float:
    """m, by which the level distance of two places (2, 3) changed; 0 where one is put higher or
    lower than the other: who falls for longer flies further."""
    was, now = before[1] - before[0], after[1] - after[0]
    if abs(now[2] - was[2]) > GIVES:
        return 0.0
    return float(abs(np.linalg.norm(now[:2]) - np.linalg.norm(was[:2])))
