"""Whether what touches can carry the body. Who sits or leans has the feet on the floor, and the
weight on something else: the zero-moment point (Vukobratović & Borovac 2004), where one force that
gave the body its recorded movement would meet the ground, is then beside the feet."""

from collections.abc import Iterator

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..body.anatomy import Part
from ..body.dynamics import MomentFunction
from ..data.constants import STANDARD_GRAVITY, UP
from ..data.contacts import ContactSchedule, Interval, PointKind
from ..numerics.local_regression import derivative
from ..numerics.runs import runs
from ..unseen.support_force import HAND_OVER
from .accelerations import SMOOTHING_FRAMES
from .performance import LEANING, Performance, contact_points

BESIDE = 0.1  # m from what touches: half a foot's breadth, and as much by which masses err
LASTS = 0.2  # s; walks, runs and jumps have up to 0.13, a hop that lands on one foot's toes 0.3
SURELY_LASTS = 0.5  # s; longer than these, and than what joints that tremble by 9 mm make of it
SMOOTHING = 0.06  # s, standard deviation; who leans does so for longer
LOADED = 0.3  # body weights, upwards; a smaller force meets the ground anywhere
STILL = 0.1  # m/s; slower is the pelvis of who sits, or stands and leans
_AROUND = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
_WAYS = np.stack([np.cos(_AROUND), np.sin(_AROUND)])  # (2, W) unit vectors along the ground


def off_balance(
    performance: Performance, schedule: ContactSchedule, lasts: float = LASTS
) -> tuple[Interval, ...]:
    """Where points touch and the weight is for so long, s, so far beside them that they cannot
    carry it, from when it leaves them until it is back; but where something unseen carries."""
    times, beside = performance.times, _beside(performance, schedule)
    found = []
    for first, last in runs(beside > 0.0):
        far = runs(beside[first : last + 1] > BESIDE)
        if any(times[first + b] - times[first + a] >= lasts for a, b in far):
            found.append(Interval(float(times[first]), float(times[last])))
    return tuple(found)


def _beside(performance: Performance, schedule: ContactSchedule) -> FloatArray:
    """(T,) m, how far the zero-moment point is outside the hull of what touches; 0 where nothing
    does, or something unseen may carry."""
    times, (points, _) = performance.times, contact_points(performance)
    touching = np.array([touches_during(times, schedule, name) for name in points])
    tracks = np.array([point.track for point in points.values()])
    known = touching.any(axis=0)
    for unseen in schedule.unseen:
        known &= (times < unseen.start - HAND_OVER) | (times > unseen.end + HAND_OVER)
    count = np.maximum(touching.sum(axis=0), 1)
    ground = np.where(touching, tracks[..., 2], 0.0).sum(axis=0) / count
    point, loaded = _zero_moment_point(performance, ground)
    return np.where(loaded & known, outside(point, tracks[..., :2], touching), 0.0)


def outside(point: FloatArray, tracks: FloatArray, touching: BoolArray) -> FloatArray:
    """(T,) m, how far a point (T, 2) on the ground is outside the hull of those that touch; 0 where
    none does. tracks: (P, T, 2) m. touching: (P, T)."""
    # As far as it is beyond all points along the way in which that is furthest.
    reached = np.where(touching[..., None], tracks @ _WAYS, -np.inf).max(axis=0)
    some = touching.any(axis=0)[:, None]
    return np.asarray((point @ _WAYS - reached).max(axis=1, where=some, initial=0.0))


def touches_during(times: FloatArray, schedule: ContactSchedule, point: str) -> BoolArray:
    """(T,) whether a point touches."""
    touches = np.zeros(len(times), dtype=np.bool_)
    for contact in schedule.contacts:
        if contact.point == point:
            touches |= (times >= contact.start) & (times <= contact.end)
    return touches


def _zero_moment_point(
    performance: Performance, ground: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """(T, 2) m, where one force on the ground, at a height (T,) m, would give the body its recorded
    movement, but for a moment about the vertical; and whether that force is large enough to tell.
    """
    times, take, character = performance.times, performance.take, performance.character
    width = smoothing(performance)
    speeds, turning = (derivative(take.times, take.angles, times, width, n) for n in (1, 2))
    moment = MomentFunction(character).value(performance.angles, speeds, turning)
    moment *= STANDARD_GRAVITY  # by mass, as the force is
    force = derivative(take.times, take.com, times, width, 2) + character.gravity * UP
    loaded = force[:, 2] > LOADED * character.gravity
    up, high = np.where(loaded, force[:, 2], np.inf), performance.com[:, 2] - ground
    ahead = -(moment[:, 1] + high * force[:, 0]) / up
    aside = (moment[:, 0] - high * force[:, 1]) / up
    return performance.com[:, :2] + np.stack([ahead, aside], axis=1), loaded


def palms_at_rest(performance: Performance) -> dict[str, BoolArray]:
    """(T,) each, by hand, whether its palm is as near to the floor as where a body leans on it, and
    does not slide along it: contacts, which are sought where nothing is amiss, ask for more."""
    points, floor_m = contact_points(performance)
    high = floor_m + LEANING * performance.character.height
    return {
        name: (point.track[:, 2] < high)
        & (_speed(performance, point.track[:, :2]) < PointKind.HAND.value.max_slip_speed)
        for name, point in points.items()
        if point.kind is PointKind.HAND
    }


def low_palms(performance: Performance) -> dict[str, BoolArray]:
    """(T,) each, by hand, whether its palm is as low as one that touches, however it moves: palms
    that a body vaults over roll too fast for contacts to be found."""
    points, floor_m = contact_points(performance)
    hands = ((name, p) for name, p in points.items() if p.kind is PointKind.HAND)
    return {name: p.track[:, 2] - floor_m < p.max_height for name, p in hands}


def pelvis_at_rest(performance: Performance) -> tuple[BoolArray, BoolArray]:
    """(T,) each, whether the pelvis rests, and whether it is as near to the floor as where the body
    sits or lies on it. Above that it does not rest that is higher than the arms' shoulders."""
    track, (_, floor_m) = performance.centres[:, 0], contact_points(performance)
    arms = [i for i, b in enumerate(performance.character.bodies) if b.part is Part.UPPER_ARM]
    low = np.asarray(track[:, 2] - floor_m < LEANING * performance.character.height)
    upright = track[:, 2] < performance.centres[:, arms, 2].mean(axis=1)
    return (_speed(performance, track) < STILL) & (low | upright), low


def lasting(
    performance: Performance, mask: BoolArray, gap: Interval, lasts: float
) -> Iterator[Interval]:
    """The parts of a gap in which something (T,) is true for so long, s."""
    times = performance.times
    for first, last in runs(mask & (times >= gap.start) & (times <= gap.end)):
        if times[last] - times[first] >= lasts:
            yield Interval(float(times[first]), float(times[last]))


def smoothing(performance: Performance) -> float:
    """S, standard deviation, with which accelerations and speeds are told."""
    return max(SMOOTHING, SMOOTHING_FRAMES / performance.recording.rate)


def _speed(performance: Performance, track: FloatArray) -> FloatArray:
    """(T,) m/s, of a track (T, n) m."""
    speeds = derivative(performance.times, track, performance.times, smoothing(performance), 1)
    return np.asarray(np.linalg.norm(speeds, axis=1))
