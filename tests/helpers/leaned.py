"""A figure that leans over, on nothing."""

from dataclasses import replace

import numpy as np
from hangtime.solver.data.recording import Recording
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.helpers.clips import JUMP, load_recording


def leaned(degrees: float) -> Recording:
    """Who stands, turned about the toes as a whole."""
    stands = load_recording(JUMP).window(1.0, 90.0)
    toes = [i for i, bone in enumerate(stands.bones) if "Toe" in bone.name]
    turn = axis_rotation(0, np.radians([degrees]))[0]
    hinge = stands.heads[0, toes].mean(axis=0) * [1.0, 1.0, 0.0]
    heads = (stands.heads - hinge) @ turn.T + hinge
    return replace(stands, heads=heads, rotations=turn @ stands.rotations)
