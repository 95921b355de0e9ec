"""What carries a recording beside its floor: ground of the scene, and boxes that would.

A recording that steps down from a box shows feet that rest in mid-air. Ground of the scene beneath
them explains it; where there is none, a box from the floor to the resting soles is what would.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.constants import DEFAULT_FRICTION
from ..data.contacts import Contact, ContactPoint, ContactSchedule, Interval
from ..data.recording import Recording
from ..data.scene import SceneObject, SceneRole, SupportBox
from ..numerics.runs import runs
from .carrier import REACH, Carrier
from .object_motion import ObjectMotion
from .triangle_mesh import placed_mesh

LEAST_REST = 0.1  # s, for which feet stay where they are carried
LEAST_HEIGHT = 0.04  # m of a box; less is a floor that is not level
STAYS = 0.05  # m from its median place, of a foot that stands
SOLE_MARGIN = 0.05  # m around the soles' lines, which run through the middle of feet 0.1 m broad

# m, of the ground at instants (N,) s beneath points (N, 3) m
Heights = Callable[[FloatArray, FloatArray], FloatArray]


def level(floor_m: float) -> Heights:
    """The ground of a level floor."""
    return lambda _, points: np.full(len(points), floor_m)


@dataclass(frozen=True)
class StandingGround:
    """A level floor and objects upon it, as feet find them from above while they stand on them.

    still: objects that do not move. carriers: those that do; feet that rest on them move with them.
    """

    floor_m: float
    still: tuple[ObjectMotion, ...]
    carriers: tuple[Carrier, ...]

    @staticmethod
    def of(floor_m: float, scene: Sequence[SceneObject], recording: Recording) -> "StandingGround":
        """Of all ground in the scene, moving by the recording's clock."""
        first, rate = float(recording.frames[0]), recording.rate
        ground = (each for each in scene if each.role is SceneRole.GROUND)
        things = tuple(ObjectMotion.of(each, first, rate) for each in ground)
        still = tuple(each for each in things if not each.thing.moves)
        return StandingGround(
            floor_m, still, tuple(Carrier(each) for each in things if each.thing.moves)
        )

    @property
    def bare(self) -> bool:
        """Whether there is the floor alone."""
        return not (self.still or self.carriers)

    def heights(self, _times: FloatArray, points: FloatArray) -> FloatArray:
        """(N,) m, of the highest still ground that points (N, 3) m may be on."""
        return self._below(points)[0]

    def named(self, schedule: ContactSchedule) -> ContactSchedule:
        """The schedule, each contact with the name of the object that it is on."""
        places = np.array([c.place for c in schedule.contacts]).reshape(-1, 3)
        owners = self._below(places)[1]
        contacts = (
            replace(contact, on=self.still[owner].thing.name)
            if contact.on is None and owner >= 0
            else contact
            for contact, owner in zip(schedule.contacts, owners, strict=True)
        )
        return replace(schedule, contacts=tuple(contacts))

    def at(self, place: FloatArray) -> str | None:
        """Name of the still object whose highest face a place (3,) m is at; None of the floor."""
        height, owner = self._below(place[None])
        on = owner[0] >= 0 and place[2] < height[0] + REACH
        return self.still[int(owner[0])].thing.name if on else None

    def carrier(self, contact: Contact) -> Carrier | None:
        """What moves beneath a contact; its place is as seen from there until `placed`."""
        return next((each for each in self.carriers if each.name == contact.on), None)

    def beneath(self, contact: Contact) -> float:
        """Height, m, of what a contact is on: the floor, or the object that it names."""
        carrier = self.carrier(contact)
        if carrier is not None:
            height = float(carrier.heights(np.zeros(1), contact.place[None])[0])
            return height if np.isfinite(height) else float(contact.place[2])
        still = tuple(each for each in self.still if each.thing.name == contact.on)
        only = StandingGround(self.floor_m, still, ())
        return float(only._below(contact.place[None])[0][0])

    def placed(self, schedule: ContactSchedule) -> ContactSchedule:
        """The schedule with what rides where it is when its stance begins."""
        contacts = []
        for contact in schedule.contacts:
            carrier = self.carrier(contact)
            if carrier is not None:
                began = schedule.stance(contact).start
                contact = replace(contact, place=carrier.placed(contact.place, began))
            contacts.append(contact)
        return replace(schedule, contacts=tuple(contacts))

    def _below(self, points: FloatArray) -> tuple[FloatArray, IntArray]:
        """The still ground beneath points (N, 3): heights (N,) m, and which thing it is of, or -1
        for the floor."""
        height = np.full(len(points), self.floor_m)
        owner = np.full(len(points), -1)
        for i, thing in enumerate(self.still):
            top = placed_mesh(thing.thing).heights(points[:, :2]).z
            on = (top > height) & (top < points[:, 2] + REACH)
            height[on], owner[on] = top[on], i
        return height, owner


# ---------------------------------------------------------------- boxes that would carry


@dataclass(frozen=True)
class _Rests:
    """Of feet at rest, N samples: places (N, 3) m, and which way the foot points (N, 2) m."""

    places: FloatArray
    ahead: FloatArray


def boxes_beneath(
    times: FloatArray, points: Mapping[str, ContactPoint], gap: Interval, floor_m: float
) -> tuple[SupportBox, ...]:
    """Boxes that would carry the feet that rest during `gap`, one for each height, lowest first.

    times: (T,) s. points: by name ("Left heel"). None where no foot rests above the floor, or on a
    wall alone.
    """
    during = (times >= gap.start) & (times <= gap.end)
    rests = _rests(times, points, during)
    order = np.argsort(rests.places[:, 2])
    steps = np.flatnonzero(np.diff(rests.places[order, 2]) > REACH) + 1
    found = []
    for there in np.split(order, steps) if len(order) else ():
        top = float(np.median(rests.places[there, 2]))
        if top - floor_m > LEAST_HEIGHT:
            found.append(_box(_Rests(rests.places[there], rests.ahead[there]), floor_m, top))
    return tuple(found)


def steps_on_walls(
    times: FloatArray, points: Mapping[str, ContactPoint], gap: Interval
) -> tuple[tuple[str, Interval], ...]:
    """The points of feet that rest on something steep during `gap`, in order of time, and when."""
    during = (times >= gap.start) & (times <= gap.end)
    steps = [
        (name, Interval(float(times[first]), float(times[last])))
        for name, point in _feet(points).items()
        for first, last in runs(_resting(times, point, during) & points_up(points, name))
    ]
    return tuple(sorted(steps, key=lambda step: step[1].start))


def on_boxes(boxes: Sequence[SupportBox], ground: Heights) -> Heights:
    """The ground with boxes upon it."""

    def heights(times: FloatArray, points: FloatArray) -> FloatArray:
        found = ground(times, points)
        for box in boxes:
            c, s = np.cos(box.turn), np.sin(box.turn)
            away = (points[:, :2] - box.place[:2]) @ np.array([[c, -s], [s, c]])
            beneath = (np.abs(away) <= 0.5 * np.array(box.size[:2])).all(axis=1)
            on = beneath & (box.top > found) & (box.top < points[:, 2] + REACH)
            found = np.where(on, box.top, found)
        return found

    return heights


def _rests(times: FloatArray, points: Mapping[str, ContactPoint], during: BoolArray) -> _Rests:
    """Where points of the feet rest but on walls: of those that do at an instant, the lowest
    carry."""
    feet = _feet(points)
    resting = np.array(
        [_resting(times, point, during) & ~points_up(feet, name) for name, point in feet.items()]
    )
    tracks = np.array([point.track for point in feet.values()])
    height = np.where(resting, tracks[..., 2], np.inf)
    carrying = resting & (height < height.min(axis=0) + REACH)
    ahead = np.array([_ahead(feet, name)[:, :2] for name in feet])
    return _Rests(tracks[carrying], ahead[carrying])


def _resting(times: FloatArray, point: ContactPoint, during: BoolArray) -> BoolArray:
    """(T,) when a point stays where it is for long enough."""
    speed = np.linalg.norm(np.gradient(point.track, times, axis=0), axis=1)
    slow = np.asarray(during & (speed < point.kind.value.max_speed))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], slow, [False]])))
    for first, last in edges.reshape(-1, 2):
        if times[last - 1] - times[first] < LEAST_REST:
            slow[first:last] = False
    return slow


def points_up(feet: Mapping[str, ContactPoint], name: str) -> BoolArray:
    """(T,) whether a point's sole points up, too steeply for anything but a wall: on level ground
    heels rise so far, over toes that lie flat, but no toes over heels."""
    ahead = _ahead(feet, name)
    across = np.linalg.norm(ahead[:, :2], axis=1)
    return np.asarray(ahead[:, 2] > DEFAULT_FRICTION * across)


def _ahead(feet: Mapping[str, ContactPoint], name: str) -> FloatArray:
    """(T, 3) m, from the heel to the toe of a point's foot."""
    side = name.rpartition(" ")[0]
    heel, toe = (feet[f"{side} {end}"].track for end in ("heel", "toe"))
    return np.asarray(toe - heel)


def feet_stay(points: Mapping[str, ContactPoint], during: BoolArray) -> bool:
    """Whether a foot keeps one place, with a sole that is not steep, in most of some frames (T,),
    as on a box. One that hangs down without swinging may, too."""
    feet = _feet(points)
    for name, point in feet.items():
        track, ahead = point.track[during], _ahead(feet, name)[during]
        away = np.linalg.norm(track - np.median(track, axis=0), axis=1)
        across = np.linalg.norm(ahead[:, :2], axis=1)
        lies = np.abs(ahead[:, 2]) <= DEFAULT_FRICTION * across
        if np.mean((away < STAYS) & lies) > 0.5:
            return True
    return False


def _feet(points: Mapping[str, ContactPoint]) -> dict[str, ContactPoint]:
    return {name: point for name, point in points.items() if point.kind.is_of_foot}


def _box(rests: _Rests, floor_m: float, top: float) -> SupportBox:
    """The box along the feet, from the floor to the soles."""
    ahead = rests.ahead.sum(axis=0)
    turn = float(np.arctan2(ahead[1], ahead[0]))
    c, s = np.cos(turn), np.sin(turn)
    axes = np.array([[c, -s], [s, c]])
    along = rests.places[:, :2] @ axes
    low, high = along.min(axis=0) - SOLE_MARGIN, along.max(axis=0) + SOLE_MARGIN
    x, y = (axes @ (0.5 * (low + high))).tolist()
    length, width = (high - low).tolist()
    return SupportBox((length, width, top - floor_m), (x, y, floor_m), turn)
