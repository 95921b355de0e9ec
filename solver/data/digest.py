"""Content hash and approximate equality of recordings."""

import hashlib

import numpy as np

from .recording import Recording

POSE_TOLERANCE = 1e-5  # m and rad; going into edit mode and back moves bones by less


def digest(recording: Recording) -> str:
    """SHA-256, hexadecimal, of name, bones, rest pose, frames, times and poses."""
    content = hashlib.sha256(recording.name.encode())
    for bone in recording.bones:
        content.update(f"\0{bone.name}\0{bone.parent}".encode())
        for rest in (bone.head, bone.tail, bone.rotation):
            content.update(rest.tobytes())
    for samples in (recording.frames, recording.times, recording.heads, recording.rotations):
        content.update(samples.tobytes())
    return content.hexdigest()


def same_motion(one: Recording, other: Recording) -> bool:
    """Whether two recordings are the same motion of the same bones, to POSE_TOLERANCE."""
    if [(b.name, b.parent) for b in one.bones] != [(b.name, b.parent) for b in other.bones]:
        return False
    pairs = [
        (one.frames, other.frames),
        (one.times, other.times),
        (one.heads, other.heads),
        (one.rotations, other.rotations),
        *((a.rotation, b.rotation) for a, b in zip(one.bones, other.bones, strict=True)),
    ]
    return all(
        a.shape == b.shape and np.allclose(a, b, rtol=0.0, atol=POSE_TOLERANCE) for a, b in pairs
    )
