"""Requests about bones that go on being aimed: the result would not have what they ask for."""

from collections.abc import Iterator, Sequence

from ...solver.data.faults import AimedBone
from ...solver.data.recording import Bone
from ...solver.data.requests import Requests


def require_unaimed(requests: Requests, aimed: Sequence[str], bones: Sequence[Bone]) -> None:
    """aimed: names of bones that stay aimed. bones: the recording's, parents first.

    Raises AimedBone. Whole-body poses name none.
    """
    led = set(aimed)
    for bone in bones:
        if bone.parent >= 0 and bones[bone.parent].name in led:
            led.add(bone.name)
    for request, name in _named(requests):
        if name in led:
            raise AimedBone(request, name)


def _named(requests: Requests) -> Iterator[tuple[str, str]]:
    """Names of requests about where bones are, and of these bones."""
    alone = (requests.points, requests.angles, requests.cones, requests.twists)
    for one in (*(each for kind in alone for each in kind), *requests.orientations):
        yield one.name, one.bone
    for pose in requests.poses:
        for bone in pose.bones:
            yield pose.name, bone
