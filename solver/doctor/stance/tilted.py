"""A floor that slopes, as capture by a camera has it that was not level: heights at which feet
stand lie in a plane, whoever is in the air falls along it, and whoever stands on it leans."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import atan, degrees, radians, tan

import numpy as np

from ...analysis.performance import Performance
from ...arrays import FloatArray
from ...data.recording import Recording
from ...numerics.runs import runs
from ...scene.support import Heights
from ...skeleton.parts import SIDES
from ..figure import Figure
from ..finding import Finding, FindingKind
from ..plumb import Plumb, find_plumb
from ..repairs import STEEPEST, Repairs
from .flat_feet import STANDING_SPEED_UP, foot_ends, may_stand

# Of clean clips up to 0.6°. Steps and boxes slope by 8° and more, but there nobody leans.
LEAST, MOST = 0.7, 4.0  # °
LEANING = radians(3.5)  # in the mean, by which who moves on a level floor leans, or less
SURELY_LEANS = 3.0  # times that, which nobody does who stands
# Falls are bent where the body sways, and several of them each otherwise; feet slide then, too.
SEVERAL = 3
STILL, LEAST_STANDING = 0.06, 0.2  # m/s, of the median stance of so many s
REACH = 0.05  # s, before and after, over which a ball's speed is told; a run's stands for 0.15 s
SLOW = 0.4  # m/s, along the floor, of a ball that stands; one that is lifted goes faster
LIFTED = 0.08  # m above the other foot's
LEAST_STANCE = 0.03  # s
FEWEST = 3  # stances: a plane through fewer leaves nothing to tell it by
UNEVEN = 0.01  # m, standard deviation of places' heights; honest ones by up to that
OFF = 0.012  # m, rms, by which balls that stand miss the plane; honest ones by up to 0.008
# Of how much the places' heights differ, by the plane, for each degree of freedom; a single kerb
# leaves 0.45, and a walk of four stances on a level floor 0.55.
LEFT = 0.4
# A rise leaves so much less than the plane where it is why; in runs, whose short stances tell the
# one hardly from the other, and whose balls sink as they are loaded, a camera is likelier off.
SURELY_RISES = 1.5
DOUBTFUL = 2.0  # times what one of a plane and a rise leaves, that the other one does
# Of the plane: places tell heights to 8 mm; it slopes by about 1.5°, and the balls' joints of both
# feet, which skeletons have up to 1 cm apart, are else taken for a slope across the way.
HEIGHT, SLOPE, APART = 0.008, tan(radians(1.5)), 0.01
MOST_APART = 0.012  # m; of feet on steps more


def find_tilt(performance: Performance, figure: Figure, beneath: Heights) -> Finding | None:
    """Feet that stand on a plane that slopes by a few degrees, or else, as short stances may leave
    it open, on a floor that rises, or sinks, at one speed. Falls tell a ramp, or a kerb, from a
    camera that was not level, and how far that was off where feet stand on one spot.

    performance: in its right size and time. beneath: ground that is known, which may slope itself.
    """
    stances = list(_stances(performance.recording, figure, beneath))
    plane = _Plane.through(stances) if len(stances) >= FEWEST else None
    plumb = find_plumb(performance)
    if plumb is None and plane is not None:
        steep = plane.angle > MOST
        return _by_lean(stances, plane, performance) if steep else _by_stances(stances, plane)
    if plumb is None:
        return None
    along = plane is not None and plumb.is_along(plane.slope)
    confirmed = along and plane is not None and plane.explains(stances)
    if plumb.is_sloping and (confirmed or _is_no_movement(plumb, stances, performance)):
        return _by_falls(stances, plumb)
    return _by_stances(stances, _Plane.through(stances, plumb)) if along else None


def _by_stances(stances: list[_Stance], plane: _Plane) -> Finding | None:
    """What the places of three or more tell."""
    off = plane.off(stances)
    if not LEAST < plane.angle < STEEPEST or off > OFF or not plane.explains(stances):
        return None
    rise, risen_off = _rise(stances, plane.apart)
    risen = Repairs(rise=rise)
    if off < SURELY_RISES * risen_off:
        other = risen if risen_off < min(DOUBTFUL * off, LEFT * _uneven(stances)) else None
        return replace(plane.finding, alternative=other)
    if off < DOUBTFUL * risen_off:
        tilted = plane.finding.remedy
        return Finding(FindingKind.RISING, rise, "m/s", remedy=risen, alternative=tilted)
    return None


def _by_falls(stances: list[_Stance], plumb: Plumb) -> Finding | None:
    """What falls tell for sure, where no level floor denies it; with boxes they tell it alone."""
    alone, level = _Plane(plumb.slope, 0.0, 0.0), _Plane(np.zeros(2), 0.0, 0.0)
    plane = _Plane.through(stances, plumb) if stances else alone
    if plane.off(stances) > OFF and level.off(stances) < OFF:
        return None
    boxes = plane.off(stances) > OFF or not plumb.agrees(plane.slope)
    found = alone if boxes else plane
    return found.finding if found.angle < STEEPEST else None


def _is_no_movement(plumb: Plumb, stances: list[_Stance], performance: Performance) -> bool:
    """Whether falls are bent by the camera, and not as the body sways, which several of them are
    otherwise, and in which feet slide, or by a swing from a bar, at whose ends it goes down as if
    it fell. Of a camera that is far off the level whoever stands leans."""
    slope = float(np.linalg.norm(plumb.slope))
    leans = bool(stances) and _lean(stances, performance).is_along(plumb.slope)
    if stances and slope > SURELY_LEANS * LEANING:
        return leans
    still = plumb.falls >= SEVERAL or _stand_still(stances)
    return still or (leans and slope > LEANING)


def _by_lean(stances: list[_Stance], plane: _Plane, performance: Performance) -> Finding | None:
    """What the places tell of a steep floor, along which the body leans."""
    leaning = _lean(stances, performance)
    found = _Plane.through(stances, leaning)
    leans = float(np.linalg.norm(leaning.slope)) > leaning.unsure and leaning.is_along(plane.slope)
    if not leans or not found.explains(stances) or found.angle > STEEPEST:
        return None
    return found.finding


def _lean(stances: list[_Stance], performance: Performance) -> Plumb:
    """Where down is, if the centre of mass is in the mean above the balls that stand: those of who
    goes or runs are as far ahead of it as behind."""
    above = []
    for stance in stances:
        first = int(np.searchsorted(performance.times, stance.times[0]))
        above.append(performance.com[first : first + len(stance.times)] - stance.places)
    mean = np.concatenate(above).mean(axis=0)
    return Plumb(-mean[:2] / mean[2], LEANING, falls=0)


def _stand_still(stances: list[_Stance]) -> bool:
    """Whether balls keep their places, by lines through stances that are long enough: half of the
    time or more, where there is any."""
    long = [stance for stance in stances if np.ptp(stance.times) > LEAST_STANDING]
    seconds = np.array([np.ptp(stance.times) for stance in long])
    speeds = np.array([stance.speed for stance in long])
    return bool(seconds[speeds < STILL].sum() >= 0.5 * seconds.sum() > 0.0)


@dataclass(frozen=True)
class _Stance:
    """Of one foot: seconds (n,), the ball's places (n, 3), m, above the ground, and 1 of a left
    one, -1 of a right one."""

    times: FloatArray
    places: FloatArray
    side: float

    @property
    def place(self) -> FloatArray:
        """(3,) m."""
        return np.asarray(np.median(self.places, axis=0))

    @property
    def speed(self) -> float:
        """M/s along the floor, of a line through it."""
        since = self.times - self.times.mean()
        return float(np.linalg.norm(since @ self.places[:, :2]) / (since @ since))


def _stances(recording: Recording, figure: Figure, beneath: Heights) -> Iterator[_Stance]:
    """While a ball stands: in walks and in runs the longest that any part of a foot does."""
    reach = max(round(REACH * recording.rate), 1)
    if len(recording.times) <= 2 * reach:
        return
    balls = [foot_ends(recording, figure, side)[1] for side in SIDES]
    lowest = np.min([ball[:, 2] for ball in balls], axis=0)
    for ball, foot, side in zip(balls, SIDES, (1.0, -1.0), strict=True):
        inner = (ball[2 * reach :] - ball[: -2 * reach]) * (recording.rate / (2 * reach))
        velocity = np.pad(inner, ((reach, reach), (0, 0)), mode="edge")
        stands = np.linalg.norm(velocity[:, :2], axis=1) < SLOW
        stands &= np.abs(velocity[:, 2]) < STANDING_SPEED_UP
        stands &= ball[:, 2] < lowest + LIFTED
        stands &= may_stand(recording, figure, foot)
        for first, last in runs(stands):
            if last - first >= max(LEAST_STANCE * recording.rate, 1.0):
                part = slice(first, last + 1)
                times, places = recording.times[part], ball[part].copy()
                places[:, 2] -= beneath(times, places)
                yield _Stance(times, places, side)


@dataclass(frozen=True)
class _Plane:
    """Its slope (2,), upwards along x and y, and how far, m, left balls are above it and right ones
    below. spent: degrees of freedom that its places' heights lose to these, 0 to 3."""

    slope: FloatArray
    apart: float
    spent: float

    @staticmethod
    def through(stances: list[_Stance], plumb: Plumb | None = None) -> _Plane:
        """Least squares, with what is likely of a slope where the places tell little, or what falls
        tell of it."""
        places = np.stack([stance.place for stance in stances])
        known = np.column_stack([places[:, :2], [stance.side for stance in stances]])
        known = known - known.mean(axis=0)
        likely, slope = np.zeros(3), SLOPE
        if plumb is not None:
            likely[:2], slope = plumb.slope, plumb.unsure
        surely = np.diag((HEIGHT / np.array([slope, slope, APART])) ** 2)
        inverse = np.linalg.inv(known.T @ known + surely)
        found = inverse @ (known.T @ places[:, 2] + surely @ likely)
        return _Plane(found[:2], float(found[2]), float(np.trace(inverse @ known.T @ known)))

    @property
    def angle(self) -> float:
        """°, of the steepest way up."""
        return degrees(atan(float(np.hypot(*self.slope))))

    @property
    def finding(self) -> Finding:
        """With the remedy that makes it level."""
        x, y = (degrees(atan(each)) for each in self.slope.tolist())
        return Finding(FindingKind.TILTED, self.angle, "°", remedy=Repairs(tilt=(x, y)))

    def explains(self, stances: list[_Stance]) -> bool:
        """Whether it is why heights differ, and not that feet are on things of their own. By what
        is left for each degree of freedom: near three or four stances some plane goes always."""
        uneven, free = _uneven(stances), len(stances) - 1.0
        left = float(np.std([self._above(each, each.place[None]).item() for each in stances]))
        left *= np.sqrt(free / (free - self.spent))
        return uneven > UNEVEN and left < LEFT * uneven and abs(self.apart) < MOST_APART

    def off(self, stances: list[_Stance]) -> float:
        """M, rms, by which all that stands misses it."""
        if not stances:
            return 0.0
        return float(np.std(np.concatenate([self._above(each, each.places) for each in stances])))

    def _above(self, stance: _Stance, places: FloatArray) -> FloatArray:
        """(n,) m, by which places (n, 3) of a foot are above a plane through the origin."""
        apart = self.apart * stance.side
        return np.asarray(places[:, 2] - places[:, :2] @ self.slope - apart)


def _uneven(stances: list[_Stance]) -> float:
    """M, standard deviation of their heights."""
    return float(np.std([stance.place[2] for stance in stances]))


def _rise(stances: list[_Stance], apart: float) -> tuple[float, float]:
    """M/s, at which all that stands rises, and m, rms, by which it misses that. apart: m, as of a
    plane."""
    times = np.concatenate([stance.times for stance in stances])
    heights = np.concatenate([each.places[:, 2] - apart * each.side for each in stances])
    rise = float(np.polyfit(times, heights, 1)[0])
    return rise, float(np.std(heights - rise * times))
