"""Names for recordings by their content, to tell whether one is still the same."""

import hashlib

from .recording import Recording


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
