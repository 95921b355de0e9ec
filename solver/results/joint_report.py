"""Measures how far joints turned from the recording, and how far that goes beyond a person's."""

from math import degrees

import numpy as np

from ..arrays import FloatArray
from ..data.reports.joints import FastJoint, JointChange, RecordedRange
from ..human.limb_speed import too_fast
from ..numerics.rotations import rotation_vector
from ..stages.implicit import Adaptation
from .flight_summary import scene_frame

RATE = 120.0  # Hz
MOST_TOLD = 3


def joint_changes(adaptation: Adaptation) -> tuple[JointChange, ...]:
    """The joints that changed most against the recording's fit, most changed first."""
    motion = adaptation.motion
    times = np.linspace(0.0, motion.duration, 1 + int(np.ceil(motion.duration * RATE)))
    turns = joint_turns(adaptation, times)
    bodies, worst = motion.transcription.character.bodies, turns.argmax(axis=0)
    most = turns.max(axis=0)
    return tuple(
        JointChange(
            bodies[i].bone, degrees(most[i]), scene_frame(adaptation.fit, float(times[worst[i]]))
        )
        for i in np.argsort(-most)[:MOST_TOLD].tolist()
    )


def joint_turns(adaptation: Adaptation, times: FloatArray) -> FloatArray:
    """(T, B) rad by which each body's joint is turned from the fit's at the same (warped) instant;
    0 of the root, whose place in the world is no joint's. times: (T,) s."""
    line = adaptation.setup.context.timeline
    now = adaptation.motion.joint_rotations(times)
    was = adaptation.fit.motion.joint_rotations(line.to_old(times))
    turned = np.swapaxes(was, -1, -2) @ now
    turns = np.zeros(turned.shape[:2])
    turns[:, 1:] = np.linalg.norm(rotation_vector(turned[:, 1:]), axis=2)
    return turns


def recorded_ranges(adaptation: Adaptation) -> tuple[RecordedRange, ...]:
    """Where the recording itself is beyond a person's ranges, worst first; none where the figure is
    no human."""
    human = adaptation.setup.human
    if human is None:
        return ()
    return tuple(
        RecordedRange(each.name, degrees(each.amount), scene_frame(adaptation.fit, each.time))
        for each in human.recorded
    )


def fast_joint(adaptation: Adaptation) -> FastJoint | None:
    """The joint of a person that is too fast, or would be; None where none is."""
    if adaptation.setup.human is None:
        return None
    bodies = adaptation.motion.transcription.character.bodies
    fast = too_fast(adaptation.motion, adaptation.fit.motion)
    if fast is not None:
        return FastJoint(bodies[fast.body].bone, fast.speed, calmed=False)
    if (calmed := adaptation.calmed) is not None:
        return FastJoint(bodies[calmed.body].bone, calmed.speed, calmed=True)
    return None
