"""Uniform length scaling of recordings, problems, schedules and results, about the origin."""

from dataclasses import replace

import numpy as np

from .contacts import ContactSchedule
from .problem import MotionProblem
from .recording import PoseTrack, Recording
from .requests import PointRequest, Vector


def scaled_recording(recording: Recording, factor: float) -> Recording:
    """The recording with every length times `factor`, about the world's origin."""
    bones = tuple(
        replace(bone, head=factor * bone.head, tail=factor * bone.tail) for bone in recording.bones
    )
    return replace(recording, bones=bones, heads=factor * recording.heads)


def scaled_problem(problem: MotionProblem, factor: float) -> MotionProblem:
    """The problem with every length times `factor`: offsets, places, bounds, paths."""

    def scaled(vector: tuple[float, float, float]) -> tuple[float, float, float]:
        x, y, z = (factor * value for value in vector)
        return x, y, z

    pins = (
        replace(
            pin, offset=scaled(pin.offset), place=None if pin.place is None else scaled(pin.place)
        )
        for pin in problem.pins
    )
    requests = problem.requests
    added = (
        m if m.offset is None else replace(m, offset=scaled(m.offset)) for m in requests.body.added
    )
    requests = replace(
        requests,
        points=tuple(_scaled_point(point, factor) for point in requests.points),
        body=replace(requests.body, added=tuple(added)),
    )
    return replace(problem, pins=tuple(pins), requests=requests)


def _scaled_point(point: PointRequest, factor: float) -> PointRequest:
    def scaled(vector: Vector) -> Vector:
        x, y, z = (factor * value for value in vector)
        return x, y, z

    bounds, path = point.bounds, point.path
    if bounds is not None:
        low_high = [tuple(None if b is None else factor * b for b in bound) for bound in bounds]
        bounds = tuple(low_high)  # type: ignore[assignment]
    if path is not None:
        path = replace(path, places=tuple(map(scaled, path.places)))
    return replace(
        point,
        offset=None if point.offset is None else scaled(point.offset),
        place=None if point.place is None else scaled(point.place),
        relative=scaled(point.relative),
        bounds=bounds,
        path=path,
    )


def scaled_schedule(schedule: ContactSchedule, factor: float) -> ContactSchedule:
    """The schedule with places, offsets and floor height times `factor`."""
    contacts = (
        replace(c, place=np.asarray(factor * c.place), offset=np.asarray(factor * c.offset))
        for c in schedule.contacts
    )
    return replace(schedule, contacts=tuple(contacts), floor_m=factor * schedule.floor_m)


def scaled_track(track: PoseTrack, factor: float) -> PoseTrack:
    """The pose track with the pelvis's positions times `factor`."""
    return replace(track, root_head=factor * track.root_head)
