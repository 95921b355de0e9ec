"""Bones that requests name, looked at before anything is solved."""

from collections.abc import Iterator

from ..body.character import Character
from ..body.proportions import bone_index
from ..data.recording import Recording
from ..data.requests import BodyChange, Requests


def check_bones(requests: Requests, character: Character, recording: Recording) -> None:
    """Refuses requests for bones that are not there. Raises StillBone, UnknownBone."""
    for name, bone in _moved(requests):
        character.moved_by(name, bone)
    for name, bone in _changed(requests.body):
        bone_index(recording, name, bone)


def _moved(asked: Requests) -> Iterator[tuple[str, str]]:
    """Requests' names, and the bones that must move a body."""
    for kind in (asked.points, asked.angles, asked.cones, asked.twists, asked.orientations):
        yield from ((each.name, each.bone) for each in kind)
    for kinds in (asked.torques, asked.poses, asked.clears, asked.shapes):
        yield from ((each.name, bone) for each in kinds for bone in each.bones)


def _changed(body: BodyChange) -> Iterator[tuple[str, str]]:
    """Names of changes of the body, and the recording's bones that they are about."""
    yield from ((added.name, added.bone) for added in body.added)
    yield from ((limb.name, bone) for limb in body.limbs for bone in limb.bones)
