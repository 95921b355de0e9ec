"""Names for recordings by their content, to tell whether one is still the same."""

import hashlib

import numpy as np

from .recording import Recording

SAME = 1e-5  # m and rad; going into edit mode and back moves bones by less


def digest(recording: Recording) -> str:
    """Hexadecimal; differs if anything does: name, bones, rest, frames, rate or poses."""
    content = hashlib.sha256(recording.name.encode())
    for bone in recording.bones:
        content.update(f"\0{bone.name}\0{bone.parent}".encode())
        for rest in (bone.head, bone.tail, bone.rotation):
            content.update(rest.tobytes())
    for samples in (recording.frames, recording.times, recording.heads, recording.rotations):
        content.update(samples.tobytes())
    return content.hexdigest()


def alike(one: Recording, other: Recording) -> bool:
    """Whether two recordings show the same motion of the same bones, but for rounding."""
    if [(b.name, b.parent) for b in one.bones] != [(b.name, b.parent) for b in other.bones]:
        return False
    pairs = [
        (one.frames, other.frames),
        (one.times, other.times),
        (one.heads, other.heads),
        (one.rotations, other.rotations),
        *((a.rotation, b.rotation) for a, b in zip(one.bones, other.bones, strict=True)),
    ]
    return all(a.shape == b.shape and np.allclose(a, b, rtol=0.0, atol=SAME) for a, b in pairs)
