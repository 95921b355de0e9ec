"""Joint angles and centre of mass of a recording, and its candidate contact points."""

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..body.anatomy import Part, Side
from ..body.character import Character, body_rotations
from ..body.kinematics import BodyPoint
from ..contacts.contact_detection import detect_contacts
from ..contacts.events import numbered, snap
from ..contacts.flat_soles import lying
from ..contacts.known_contacts import Clock, with_known
from ..data.contacts import Contact, ContactPoint, ContactSchedule, Interval, PointKind
from ..data.recording import Recording, Skin
from ..data.scene import SceneObject
from ..numerics.interpolation import interpolate
from ..scene.support import LEAST_HEIGHT, StandingGround, boxes_beneath, level, on_boxes
from ..unseen.free_fall import clear_falls, falls_within, unseen_support, without_falls
from .skin import skin_of_bodies
from .soles import FootTracks, floor_height, foot_points

SNAP_FRAMES = 1.5
MIN_SNAP_TOLERANCE = 0.012  # s; instants nearer than this share a knot
DEPTHS = {  # of the height, from what a part rests on to its point
    "hand": 0.03,  # which is in the hand's bone, not on the palm
    "knee": 0.04,  # in the joint, which is 0.03 to 0.05 above
}
LEANING = 0.07  # of the height, above the floor; wrists and knees on it are at 0.03 to 0.05


@dataclass(frozen=True)
class Performance:
    """A recording in the character's coordinates, at the recording's frames (T,).

    rotations: (T, B, 3, 3) body to world. centres: (T, B, 3) m, joint centres as recorded.
    angles: (T, n_angles) rad. com: (T, 3) m. World frame. longer: the same with frames beyond the
    recording's, in its times, where there are any. skin: of the figure, where one tells its soles.
    """

    recording: Recording
    character: Character
    rotations: FloatArray
    centres: FloatArray
    angles: FloatArray
    com: FloatArray
    longer: "Performance | None" = None
    skin: Skin | None = None

    @property
    def take(self) -> "Performance":
        """All that is known: with the frames beyond."""
        return self.longer or self

    @property
    def times(self) -> FloatArray:
        """(T,) s."""
        return self.recording.times

    def points(self, points: tuple[BodyPoint, ...], times: FloatArray) -> FloatArray:
        """(N, P, 3) positions, m, world, of body points at instants (N,), s; cubic in between."""
        bodies = [p.body for p in points]
        local = np.stack([p.place for p in points])
        turned = np.einsum("tpij,pj->tpi", self.rotations[:, bodies], local)
        return interpolate(self.times, self.centres[:, bodies] + turned, times)


def perform(recording: Recording, character: Character, skin: Skin | None = None) -> Performance:
    """Joint angles and centre of mass of a recording (the inverse of forward kinematics)."""
    bones = [recording.index(body.bone) for body in character.bodies]
    rotations = body_rotations(recording, bones)
    centres = recording.heads[:, bones]
    columns = []
    for i, joint in enumerate(character.joints):
        relative = rotations[:, i]
        if joint.parent >= 0:
            relative = np.swapaxes(rotations[:, joint.parent], -1, -2) @ relative
        columns.append(joint.axes.angles(relative))
    masses = np.array([body.mass for body in character.bodies])
    local = np.stack([body.com for body in character.bodies])
    coms = centres + np.einsum("tbij,bj->tbi", rotations, local)
    com = np.einsum("b,tbi->ti", masses / masses.sum(), coms)
    angles = np.concatenate(columns, axis=1)
    return Performance(recording, character, rotations, centres, angles, com, skin=skin)


def find_contacts(performance: Performance, scene: Sequence[SceneObject] = ()) -> ContactSchedule:
    """Contact schedule of feet and hands, event times snapped so that no span is too short.

    Found in the whole take, and told as far as they are within the recording. Ground of the scene
    counts where the floor alone leaves support unseen: elsewhere the recording knows nothing of
    what is put into its way. Where something unseen carries the body for a while (what feet rest on
    in mid-air, what hands hold) and it then clearly falls, only the former is unseen support.
    Places on ground that moves are as seen from it. What is known is not sought.
    """
    take = performance.take
    points, floor_m = contact_points(take)
    duration = float(performance.times[-1])
    detect = partial(
        detect_contacts, take.times, points, floor_m=floor_m, com=take.com, duration_s=duration
    )
    schedule, ground = detect(), StandingGround.of(floor_m, scene, performance.recording)
    heights = level(floor_m)
    if schedule.unseen and not ground.bare:
        heights = ground.heights
        detect = partial(detect, carriers=ground.carriers)
        schedule = ground.named(detect(ground=heights))
    falls: tuple[Interval, ...] = ()
    boxes = [b for gap in schedule.unseen for b in boxes_beneath(take.times, points, gap, floor_m)]
    if boxes:  # they would tell when the feet leave them, and so where the body flies
        flights = detect(ground=on_boxes(boxes, heights)).flights
        falls = clear_falls(take.times, take.com, flights)
        schedule = _falling(schedule, falls)
    alone = falls_within(take.times, take.com, schedule.unseen)
    falls, schedule = (*falls, *alone), _falling(schedule, alone)
    first, last = take.recording.ends
    if known := [each for each in take.recording.known if each.first < last and each.last > first]:
        clock = Clock(take.recording.frames, take.times)
        contacts = with_known(schedule.contacts, known, clock, points, duration)
        carried = unseen_support(contacts, duration, take.times, take.com, falls=falls)
        schedule = ground.named(replace(schedule, contacts=numbered(contacts), unseen=carried))
    return snap(schedule, snap_tolerance(performance))


def _falling(schedule: ContactSchedule, falls: Sequence[Interval]) -> ContactSchedule:
    """The schedule, with flights where falls are in what is unseen."""
    unseen = (piece for gap in schedule.unseen for piece in without_falls(gap, falls))
    return replace(schedule, unseen=tuple(unseen))


def snap_tolerance(performance: Performance) -> float:
    """Tolerance, s, within which event times are merged."""
    frame = float(np.median(np.diff(performance.times)))
    return max(SNAP_FRAMES * frame, MIN_SNAP_TOLERANCE)


def contact_points(performance: Performance) -> tuple[dict[str, ContactPoint], float]:
    """Candidate contact points by name (heel and toe of each foot, hands, knees), and floor height,
    m."""
    if performance.longer is not None:
        points, floor_m = contact_points(performance.longer)
        first = int(np.searchsorted(performance.longer.times, performance.times[0]))
        within = slice(first, first + len(performance.times))
        return {name: point.part(within) for name, point in points.items()}, floor_m
    feet = [_foot(performance, side) for side in (Side.LEFT, Side.RIGHT)]
    stature_m = performance.character.height
    floor_m = floor_height(performance.times, feet, stature_m)
    points = foot_points(performance.times, feet, floor_m, stature_m)
    for side in (Side.LEFT, Side.RIGHT):
        hand, shank = (performance.character.body(part, side) for part in (Part.HAND, Part.SHANK))
        if hand is not None:
            name = f"{side.value.capitalize()} hand"
            points[name] = _palm(performance, name, hand)
        if shank is not None:
            name = f"{side.value.capitalize()} knee"
            points[name] = _knee(performance, name, shank)
    return points, floor_m


def point_depth(point: str, character: Character) -> float:
    """M from what a part rests on to its point, such as "Left hand"; 0 of what is on a sole."""
    return DEPTHS.get(point.rpartition(" ")[2], 0.0) * character.height


def above_ground(contacts: Sequence[Contact], character: Character, floor_m: float) -> FloatArray:
    """(k,) m by which the recorded points of contacts are above what they rest on: a palm's and a
    knee's by its depth, or less where the floor, at floor_m, is nearer."""
    depths = [point_depth(contact.point, character) for contact in contacts]
    return np.clip([contact.place[2] - floor_m for contact in contacts], 0.0, depths)


def leans(performance: Performance, floor_m: float) -> BoolArray:
    """(T,) whether another part of the body than a foot, such as a hand or a knee, is as near to
    the floor as where the body leans or lies on it, whatever contacts tell."""
    bodies = performance.character.bodies
    joints = [i for i, body in enumerate(bodies) if body.part not in (Part.FOOT, Part.TOE)]
    ends = [i for i in joints if bodies[i].part in (Part.HEAD, Part.FOREARM, Part.HAND)]
    tips = np.stack([performance.rotations[:, i] @ bodies[i].tip for i in ends], axis=1)
    low = np.minimum(
        performance.centres[:, joints, 2].min(axis=1),
        (performance.centres[:, ends] + tips)[..., 2].min(axis=1),
    )
    return np.asarray(low - floor_m < LEANING * performance.character.height)


def low_feet(points: Mapping[str, ContactPoint], floor_m: float) -> BoolArray:
    """(T,) whether a point of a foot is as low as one that stands, however it moves."""
    feet = {name: point for name, point in points.items() if point.kind.is_of_foot}
    above = {name: point.track[:, 2] - floor_m for name, point in feet.items()}
    low = [
        (above[name] < feet[name].max_height) & ~(flat >= LEAST_HEIGHT)
        for name, flat in lying(above).items()
    ]
    return np.asarray(np.any(low, axis=0))


def _palm(performance: Performance, name: str, hand: int) -> ContactPoint:
    """Contact point in the middle of a hand."""
    body, recording = performance.character.bodies[hand], performance.recording
    place = 0.5 * body.tip
    track = performance.centres[:, hand] + performance.rotations[:, hand] @ place
    rest = recording.bones[recording.index(body.bone)].rotation
    depth = point_depth(name, performance.character)
    return ContactPoint(PointKind.HAND, body.bone, rest.T @ place, track, depth=depth)


def _knee(performance: Performance, name: str, shank: int) -> ContactPoint:
    """Contact point in the joint of a knee, about which the shank turns while it rests."""
    bone, track = performance.character.bodies[shank].bone, performance.centres[:, shank]
    depth = point_depth(name, performance.character)
    return ContactPoint(PointKind.KNEE, bone, np.zeros(3), track, depth=depth)


def _foot(performance: Performance, side: Side) -> FootTracks:
    """Joint tracks of one foot."""
    character, recording = performance.character, performance.recording
    foot, toe = character.body(Part.FOOT, side), character.body(Part.TOE, side)
    thigh, shank = character.body(Part.THIGH, side), character.body(Part.SHANK, side)
    assert foot is not None
    assert thigh is not None
    assert shank is not None
    last = foot if toe is None else toe
    ankle = performance.centres[:, foot]
    tip = performance.centres[:, last] + performance.rotations[:, last] @ character.bodies[last].tip
    bones = [recording.bones[recording.index(character.bodies[i].bone)] for i in (foot, last)]
    joints = [recording.index(character.bodies[i].bone) for i in (thigh, shank, foot)]
    leg = [recording.bones[i].head for i in joints]
    return FootTracks(
        side=side.value.capitalize(),
        foot_bone=character.bodies[foot].bone,
        toe_bone=character.bodies[last].bone,
        hip=performance.centres[:, thigh],
        ankle=ankle,
        ball=tip if toe is None else performance.centres[:, toe],
        tip=tip,
        foot_rotation=performance.rotations[:, foot],
        toe_rotation=performance.rotations[:, last],
        foot_rest=bones[0].rotation,
        toe_rest=bones[1].rotation,
        leg=float(np.linalg.norm(np.diff(leg, axis=0), axis=1).sum()),
        skin=_skin_of(performance, {foot, last}, bones[0].head),
    )


def _skin_of(performance: Performance, bodies: Set[int], origin: FloatArray) -> FloatArray:
    """(N, 3) m, points of bodies' skin in the rest pose, from a place (3,) of it."""
    if performance.skin is None:
        return np.zeros((0, 3))
    recording, character = performance.recording, performance.character
    points = skin_of_bodies(performance.skin, recording, character)
    heads = {i: recording.bones[recording.index(character.bodies[i].bone)].head for i in bodies}
    return np.concatenate([points[i] + heads[i] - origin for i in bodies])
