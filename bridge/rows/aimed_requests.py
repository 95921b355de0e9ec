"""Requests about bones that go on being aimed: the result would not have what they ask for."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ...solver.data.faults import AimedBone
from ...solver.data.recording import Bone
from ...solver.data.requests import PoseRequest, Requests


def require_unaimed(requests: Requests, aimed: Sequence[str], bones: Sequence[Bone]) -> None:
    """aimed: names of bones that stay aimed. bones: the recording's, parents first.

    Raises AimedBone. Of poses that reach further the rest is meant, see `apart_from_aimed`.
    """
    led = _led(requests, aimed, bones)
    for request, name in _named(requests, led):
        if name in led:
            raise AimedBone(request, name)


def apart_from_aimed(requests: Requests, aimed: Sequence[str], bones: Sequence[Bone]) -> Requests:
    """The requests, poses without what is aimed; arguments as above."""
    led = _led(requests, aimed, bones)
    poses = (replace(pose, apart=led) if _reaches(pose, led) else pose for pose in requests.poses)
    return replace(requests, poses=tuple(poses))


def _led(requests: Requests, aimed: Sequence[str], bones: Sequence[Bone]) -> tuple[str, ...]:
    """What is aimed, and what hangs on it."""
    if requests.body.limbs:  # an armature of its own performs those, and nothing aims
        return ()
    led = list(aimed)
    for bone in bones:
        if bone.parent >= 0 and bones[bone.parent].name in led and bone.name not in led:
            led.append(bone.name)
    return tuple(led)


def _reaches(pose: PoseRequest, led: Sequence[str]) -> bool:
    """Whether the pose is about aimed bones among others."""
    return bool(led) and (not pose.bones or not set(pose.bones).isdisjoint(led))


def _named(requests: Requests, led: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Names of requests about what bones do, and of these bones."""
    alone = (requests.points, requests.angles, requests.cones, requests.twists)
    for one in (*(each for kind in alone for each in kind), *requests.orientations):
        yield one.name, one.bone
    for limit in requests.torques:
        yield from ((limit.name, bone) for bone in limit.bones)
    for pose in requests.poses:
        if pose.weight is None or set(pose.bones).issubset(led):
            yield from ((pose.name, bone) for bone in pose.bones)
