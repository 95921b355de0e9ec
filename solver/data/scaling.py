"""Uniform length scaling of recordings, problems, schedules and results, about the origin."""

from dataclasses import replace

import numpy as np

from .contacts import ContactSchedule
from .problem import MotionProblem
from .recording import PoseTrack, Recording
from .requests import Bound, PointRequest, Vector
from .scene import SteadyMotion, SupportBox


def scaled_recording(recording: Recording, factor: float) -> Recording:
    """The recording with every length times `factor`, about the world's origin."""
    bones = tuple(
        replace(bone, head=factor * bone.head, tail=factor * bone.tail) for bone in recording.bones
    )
    return replace(recording, bones=bones, heads=factor * recording.heads)


def scaled_problem(problem: MotionProblem, factor: float) -> MotionProblem:
    """The problem with every length times `factor`: offsets, places, bounds, paths, objects."""
    pins = (
        replace(p, offset=_times(factor, p.offset), place=p.place and _times(factor, p.place))
        for p in problem.pins
    )
    requests = problem.requests
    added = (replace(m, offset=m.offset and _times(factor, m.offset)) for m in requests.body.added)
    requests = replace(
        requests,
        points=tuple(_scaled_point(point, factor) for point in requests.points),
        clears=tuple(replace(clear, by=factor * clear.by) for clear in requests.clears),
        body=replace(requests.body, added=tuple(added)),
    )
    scene = tuple(
        replace(
            thing,
            vertices=factor * thing.vertices,
            positions=factor * thing.positions,
            steady=thing.steady and _scaled_rates(thing.steady, factor),
        )
        for thing in problem.scene
    )
    skin = problem.skin and problem.skin.scaled(factor)
    return replace(problem, pins=tuple(pins), requests=requests, scene=scene, skin=skin)


def _scaled_rates(steady: SteadyMotion, factor: float) -> SteadyMotion:
    velocity, pivot, belt = (
        _times(factor, each) for each in (steady.velocity, steady.pivot, steady.belt)
    )
    return replace(steady, velocity=velocity, pivot=pivot, belt=belt)


def scaled_box(box: SupportBox, factor: float) -> SupportBox:
    """The box with every length times `factor`, about the origin."""
    return replace(box, size=_times(factor, box.size), place=_times(factor, box.place))


def _scaled_point(point: PointRequest, factor: float) -> PointRequest:
    def bound(ends: Bound) -> Bound:
        low, high = (None if end is None else factor * end for end in ends)
        return low, high

    path = point.path
    if path is not None:
        path = replace(path, places=tuple(_times(factor, place) for place in path.places))
    bounds = point.bounds
    if bounds is not None:
        x, y, z = map(bound, bounds)
        bounds = x, y, z
    return replace(
        point,
        offset=point.offset and _times(factor, point.offset),
        place=point.place and _times(factor, point.place),
        relative=_times(factor, point.relative),
        bounds=bounds,
        path=path,
    )


def _times(factor: float, vector: Vector) -> Vector:
    x, y, z = (factor * value for value in vector)
    return x, y, z


def scaled_schedule(schedule: ContactSchedule, factor: float) -> ContactSchedule:
    """The schedule with places, offsets and floor height times `factor`."""
    contacts = (
        replace(
            c,
            place=np.asarray(factor * c.place),
            offset=np.asarray(factor * c.offset),
            rise=(factor * c.rise[0], factor * c.rise[1]),
        )
        for c in schedule.contacts
    )
    return replace(schedule, contacts=tuple(contacts), floor_m=factor * schedule.floor_m)


def scaled_track(track: PoseTrack, factor: float) -> PoseTrack:
    """The pose track with the pelvis's positions times `factor`."""
    return replace(track, root_head=factor * track.root_head)
