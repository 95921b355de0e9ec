"""Heel and toe contact points on the foot bones, and floor height, from standing frames.

Where the figure has a skin, its soles tell how high they are over the floor and how far they go.
Otherwise soles are such as a person may have under them, and alike under both feet.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.contacts import ContactPoint, PointKind
from ..numerics.rotations import unit

HEEL_OFFSET_RATIO = 0.3  # of the level distance from ankle to ball; where plates see it press
TOE_OFFSET_RATIO = 0.75  # of the way from ball to tip; what lies beyond cannot dip under the floor
PRESSING_RATIO = 0.3  # of the same way; where plates see it press until it leaves
ANKLE_HEIGHT = 0.039  # of the stature, of a bare foot (Drillis & Contini 1966)
BALL_HEIGHT = 0.013  # likewise; the ball is a third as high as the ankle
USUAL_SHOE = 0.01  # m that a shoe adds to these, where nothing tells
HEEL = 0.03  # m, of a shoe that one can still jump in
THINNER, THICKER = 0.02, 0.04  # m than the usual; soles of recordings whose floor is surely at 0
FIRMNESS = 2.0  # m that the floor goes for each by which a sole is too thick or thin
UNLIKE = 0.03  # m; feet that stand level differ by 0.026 at most in clean recordings
MAX_STANDING_SPEED = 0.25  # m/s; a foot slower than this stands
STANDING_HEIGHT_BAND = 0.02  # m; how much the height of a standing foot varies
MIN_STANDING_FRAMES = 4
LOW_SHARE = 10  # percent of a clip, at least, in which each foot of a runner is down
TILT_TIME = 0.1  # s; a centimetre off level counts as much as 0.1 m/s when a foot stands
FEWEST = 30  # points of skin that tell a foot's shape
OUTSIDE = 0.02  # share of them that lie further out than its sole's ends
HEEL_OF_SOLE = 0.67  # of the way from ankle to the heel's end; where plates see it press
# Of the way from ankle to the toes' end, the ball's: from the lengths in skeleton/ends.py.
BALL_OF_SOLE = 0.66


@dataclass(frozen=True)
class FootTracks:
    """Joint tracks of one foot over the clip, world, Z up.

    side: as in the points' names ("Left"). hip, ankle, ball, tip: (T, 3) m; the heads of the thigh,
    foot and toe bones, and the toe's end. foot_rotation, toe_rotation: (T, 3, 3), body to world;
    foot_rest, toe_rest: (3, 3) bone to body. A rig without toes names its foot bone twice, with
    the foot's tail as ball and tip. leg: m, from hip to ankle when it is straight. skin: (N, 3) m,
    points of foot and toes, in the foot's frame.
    """

    side: str
    foot_bone: str
    toe_bone: str
    hip: FloatArray
    ankle: FloatArray
    ball: FloatArray
    tip: FloatArray
    foot_rotation: FloatArray
    toe_rotation: FloatArray
    foot_rest: FloatArray
    toe_rest: FloatArray
    leg: float
    skin: FloatArray

    @property
    def has_toes(self) -> bool:
        """Whether a bone of their own moves the toes."""
        return self.toe_bone != self.foot_bone


@dataclass(frozen=True)
class _Sole:
    """A standing foot's sole: m from the ankle down, and along the floor back and ahead.

    ahead: (T, 3) unit vectors along the floor, from ankle to ball.
    """

    down: float
    back: float
    front: float
    ahead: FloatArray


@dataclass(frozen=True)
class _Stance:
    """How heel or ball of a foot stands.

    flat: (T,) frames in which it is as one that stands. ground: (T,) m, the height under it; where
    the foot floats in these frames that is over the floor.
    """

    flat: BoolArray
    ground: FloatArray


def floor_height(times: FloatArray, feet: Sequence[FootTracks], stature_m: float) -> float:
    """Floor height, m: from soles of skin, else from the lower foot's ball when it stands.

    The height 0 is taken where it can be the floor, since recordings are made upon it.
    """
    standing = [_standing(times, foot) for foot in feet]
    soles = [_sole(foot, flat) for foot, flat in zip(feet, standing, strict=True)]
    heights = np.array([_heights(f, flat) for f, flat in zip(feet, standing, strict=True)])
    under = [h[0] - sole.down for h, sole in zip(heights, soles, strict=True) if sole is not None]
    if len(under) == len(feet):
        return 0.0 if abs(min(under)) <= STANDING_HEIGHT_BAND else float(min(under))
    ankle, ball = heights.min(axis=0).tolist()
    if all(foot.has_toes for foot in feet):
        return _firm(ball - BALL_HEIGHT * stature_m - USUAL_SHOE)
    return _firm(ankle - ANKLE_HEIGHT * stature_m - USUAL_SHOE)  # their balls are tails: often lie


def _firm(height: float) -> float:
    """A floor's height, m, from the one at which soles are usual: 0 where that is near.

    Further away it is that height, and in between it is neither, so that it never leaps: firm
    shrinkage (Gao and Bruce, Statistica Sinica 7, 1997).
    """
    beyond = FIRMNESS * (height - np.clip(height, -THINNER, THICKER))
    return float(np.clip(beyond, min(height, 0.0), max(height, 0.0)))


def foot_points(
    times: FloatArray, feet: Sequence[FootTracks], floor_m: float, stature_m: float
) -> dict[str, ContactPoint]:
    """Heel and toe contact points: points of each sole that lie on the floor when it stands.

    times: (T,) s. floor_m: as from `floor_height`. Keys such as "Left heel", "Left toe".
    """
    points = {}
    for foot, stances in zip(feet, _stances(times, feet, floor_m, stature_m), strict=True):
        under_heel, under_ball = stances
        sole = _sole(foot, under_heel.flat)
        heel, ball, tip = _joint_places(foot) if sole is None else _sole_places(foot, sole)
        toe_head = foot.ball if foot.has_toes else foot.ankle
        toe, pressing = (
            _fixed_in(
                PointKind.TOE,
                foot.toe_bone,
                toe_head,
                foot.toe_rotation,
                foot.toe_rest,
                _on_ground(ball + ratio * _level(tip - ball), under_ball.ground),
                under_ball.flat,
            )
            for ratio in (TOE_OFFSET_RATIO, PRESSING_RATIO)
        )
        points[f"{foot.side} heel"] = replace(
            _fixed_in(
                PointKind.HEEL,
                foot.foot_bone,
                foot.ankle,
                foot.foot_rotation,
                foot.foot_rest,
                _on_ground(heel, under_heel.ground),
                under_heel.flat,
            ),
            hip=foot.hip,
        )
        points[f"{foot.side} toe"] = replace(toe, hip=foot.hip, pressing=pressing.track)
    return points


def _stances(
    times: FloatArray, feet: Sequence[FootTracks], floor_m: float, stature_m: float
) -> list[tuple[_Stance, _Stance]]:
    """How heel and ball of each foot stand: on the floor, where a person's sole may be so thick."""
    standing = [_standing(times, foot) for foot in feet]
    found = np.array([_heights(f, flat) for f, flat in zip(feet, standing, strict=True)]) - floor_m
    soles = _believable(feet, found, stature_m)
    stances = []
    for foot, flat, seen, sole in zip(feet, standing, found, soles, strict=True):
        stands = _Stance(flat, np.full(len(times), floor_m))
        level = _level_frames(times, foot, sole)
        heel, ball = (
            stands if thick == usual else _Stance(level, joint[:, 2] - usual)
            for joint, thick, usual in zip((foot.ankle, foot.ball), seen, sole, strict=True)
        )
        stances.append((heel, ball))
    return stances


def _believable(feet: Sequence[FootTracks], found: FloatArray, stature_m: float) -> FloatArray:
    """(F, 2) m, heights of ankles and balls over the floor when feet stand on it.

    found: the same in the frames in which each foot is stillest. One that is much higher than the
    other floats then, on a box or by a fault of the capture, and has the other's sole. One whose
    ankle is further above its ball than in any shoe is on tiptoe.
    """
    legs = np.array([[foot.leg] for foot in feet])
    raised = legs.max() - legs  # who has a shorter leg may stand on a thicker sole
    lower = found.min(axis=0)
    soles = np.where(found - raised > lower + UNLIKE, lower, found)
    steepest = (ANKLE_HEIGHT - BALL_HEIGHT) * stature_m + HEEL
    for foot, seen, sole in zip(feet, found, soles, strict=True):
        if not foot.has_toes:  # its ball is a tail, which may be anywhere
            sole[1] = seen[1] - (seen[0] - sole[0])
        elif len(foot.skin) < FEWEST and sole[0] - sole[1] > steepest + UNLIKE:
            sole[0] = sole[1] + steepest
    return soles


def _level_frames(times: FloatArray, foot: FootTracks, sole: FloatArray) -> BoolArray:
    """Mask (T,) of the frames in which a foot that floats is as level as one that stands, and slow.

    sole: (2,) m, heights of ankle and ball over the ground of one that stands.
    """
    tilt = np.abs(foot.ankle[:, 2] - foot.ball[:, 2] - (sole[0] - sole[1]))
    count = max(MIN_STANDING_FRAMES, len(times) * LOW_SHARE // 100)
    nearest = np.argsort(_foot_speed(times, foot) + tilt / TILT_TIME, kind="stable")[:count]
    return np.isin(np.arange(len(times)), nearest)


def _heights(foot: FootTracks, flat: BoolArray) -> tuple[float, float]:
    """Median heights, m, of ankle and ball in the frames flat (T,)."""
    return float(np.median(foot.ankle[flat, 2])), float(np.median(foot.ball[flat, 2]))


def _joint_places(foot: FootTracks) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Tracks (T, 3) m of what the heel stands over, of the ball and of the toes' end."""
    heel = foot.ankle - HEEL_OFFSET_RATIO * _level(foot.ball - foot.ankle)
    return heel, foot.ball, foot.tip


def _sole_places(foot: FootTracks, sole: _Sole) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The same by the sole. A rig without toes does not tell the ball: its tail may be anywhere."""
    heel = foot.ankle - HEEL_OF_SOLE * sole.back * sole.ahead
    tip = foot.ankle + sole.front * sole.ahead
    ball = foot.ball if foot.has_toes else foot.ankle + BALL_OF_SOLE * sole.front * sole.ahead
    return heel, ball, tip


def _sole(foot: FootTracks, flat: BoolArray) -> _Sole | None:
    """None where too little skin tells, or the ankle is not within it.

    flat: (T,) frames in which the foot stands.
    """
    ahead = _level(foot.ball - foot.ankle)
    lengths = np.linalg.norm(ahead, axis=1, keepdims=True)
    if len(foot.skin) < FEWEST or not lengths.all():
        return None
    ahead = ahead / lengths
    onwards = np.einsum("tji,tj->i", foot.foot_rotation[flat], ahead[flat])
    up = foot.foot_rotation[flat][:, 2].sum(axis=0)
    heights, along = foot.skin @ unit(up), foot.skin @ unit(onwards)
    down, back = -np.quantile(heights, OUTSIDE), -np.quantile(along, OUTSIDE)
    front = np.quantile(along, 1.0 - OUTSIDE)
    if min(down, back, front) <= 0.0:
        return None
    return _Sole(float(down), float(back), float(front), ahead)


def _standing(times: FloatArray, foot: FootTracks) -> BoolArray:
    """Mask (T,) of the frames in which the foot stands flat.

    A runner's foot never quite stands: then the slowest and lowest frames are taken. One on a
    treadmill stands while it moves with the belt, and is slow where it turns back in the air.
    """
    ankle, ball = foot.ankle[:, 2], foot.ball[:, 2]
    speed = _foot_speed(times, foot)
    flat = speed < 2 * MAX_STANDING_SPEED
    for height in (ball, ankle):
        if flat.any():
            flat &= height < np.percentile(height[flat], 20) + STANDING_HEIGHT_BAND
    if flat.sum() < MIN_STANDING_FRAMES:
        flat = np.zeros(len(times), dtype=np.bool_)
        flat[np.argsort(speed + (ankle + ball) / 0.1)[:MIN_STANDING_FRAMES]] = True
    carried = np.abs(np.gradient(ball, times)) < MAX_STANDING_SPEED
    carried &= ball < np.percentile(ball, LOW_SHARE) + STANDING_HEIGHT_BAND
    if carried.sum() >= MIN_STANDING_FRAMES:
        carried &= ankle < np.percentile(ankle[carried], 20) + STANDING_HEIGHT_BAND
        if np.median(ball[carried]) < np.median(ball[flat]) - 2.0 * STANDING_HEIGHT_BAND:
            flat = carried
    return flat


def _foot_speed(times: FloatArray, foot: FootTracks) -> FloatArray:
    """(T,) m/s, of ankle and ball together."""
    return _speed(times, foot.ankle) + _speed(times, foot.ball)


def _speed(times: FloatArray, track: FloatArray) -> FloatArray:
    """(T,) m/s of a track (T, 3), by central differences."""
    return np.asarray(np.linalg.norm(np.gradient(track, times, axis=0), axis=1))


def _level(vectors: FloatArray) -> FloatArray:
    """Horizontal components of (..., 3)."""
    return np.asarray(vectors * np.array([1.0, 1.0, 0.0]))


def _on_ground(points: FloatArray, heights: FloatArray) -> FloatArray:
    """(T, 3) m, points over or under those of (T, 3), at the heights (T,)."""
    return np.column_stack([points[:, :2], heights])


def _fixed_in(
    kind: PointKind,
    bone: str,
    head: FloatArray,
    rotation: FloatArray,
    rest: FloatArray,
    seen: FloatArray,
    flat: BoolArray,
) -> ContactPoint:
    """Bone-fixed point: the median of `seen` (T, 3) over the frames `flat`.

    It is taken along the body's axes, as it would be another one along those of another roll.
    """
    local = np.einsum("tji,tj->ti", rotation[flat], (seen - head)[flat])
    place = np.median(local, axis=0)
    return ContactPoint(kind, bone, rest.T @ place, head + rotation @ place)
