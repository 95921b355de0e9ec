"""A figure that kneels on both knees, upright."""

from dataclasses import replace

import numpy as np
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.recording import Recording
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.helpers.clips import JUMP, load_recording

LAID_BACK = {"Leg": ("Foot", 180.0), "Foot": ("ToeBase", 200.0)}  # degrees from forward, by bone


def kneeling(height: float = 0.07, speed: float = 0.0, tilt: float = 0.0) -> Recording:
    """Who stands still in the jump's first frame, with shanks and feet laid back.

    height: m, of the lower knee's joint above 0. speed: m/s, at which all of it slides aside.
    tilt: degrees, by which shanks and feet slope down from the knees.
    """
    stands = load_recording(JUMP).window(1.0, 90.0)
    heads, rotations = stands.heads[0].copy(), stands.rotations[0].copy()
    for side in ("Left", "Right"):
        for bone, (end, degrees) in LAID_BACK.items():
            joint = stands.index(side + bone)
            along = heads[stands.index(side + end)] - heads[joint]
            angle = np.radians(degrees + tilt) - np.arctan2(along[2], along[1])
            _turn(stands, joint, angle, heads, rotations)
    knees = [stands.index(f"{side}Leg") for side in ("Left", "Right")]
    heads[:, 2] -= heads[knees, 2].min() - height
    slid = np.multiply.outer(speed * stands.times, np.eye(3)[0])
    turned = np.broadcast_to(rotations, stands.rotations.shape).copy()
    return replace(stands, heads=heads + slid[:, None], rotations=turned)


def _turn(
    recording: Recording, first: int, angle: float, heads: FloatArray, rotations: FloatArray
) -> None:
    """Turns a bone and all below it about its head and the X axis, in place."""
    below = [first]
    for i, each in enumerate(recording.bones):
        if each.parent in below:
            below.append(i)
    turn = axis_rotation(0, np.array([angle]))[0]
    heads[below] = (heads[below] - heads[first]) @ turn.T + heads[first]
    rotations[below] = turn @ rotations[below]
