"""Ways in which recordings are damaged, each at several strengths."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...solver.analysis.performance import perform
from ...solver.arrays import FloatArray, IntArray
from ...solver.body.anatomy import Part
from ...solver.body.character import build_character
from ...solver.data.problem import Mend
from ...solver.data.recording import Recording
from ...solver.data.scaling import scaled_recording
from ...solver.doctor.examination.repair import turned
from ...solver.doctor.falls import each_fall
from ...solver.doctor.figure import figure_of
from ...solver.doctor.finding import FindingKind
from ...solver.doctor.frames.exchanges import KINDS, LIMBS
from ...solver.doctor.limbs import partners
from ...solver.doctor.local_poses import LocalPoses
from ...solver.doctor.repairs import Repairs, UpAxis
from ...solver.doctor.retimed import LONG
from ...solver.numerics.interpolation import interpolate
from ...solver.numerics.rotations import axis_rotation, rotation_matrix

SEED = 7
AROUND = 6  # frames about a flight, that are retimed with it
VIDEO_RATE, FAST_RATE = 30.0, 120.0  # Hz, of one camera and of several


@dataclass(frozen=True)
class Damaged:
    """original: at the damaged recording's frames. scale: which the damage multiplied durations or
    lengths by; None where it is of another kind."""

    recording: Recording
    original: Recording
    scale: float | None = None


@dataclass(frozen=True)
class Damage:
    """kind: of the finding that names it rightly, and also: others that do so together with it.
    possible: whether a recording can be damaged so."""

    name: str
    kind: FindingKind
    do: Callable[[Recording, np.random.Generator], Damaged]
    also: tuple[FindingKind, ...] = ()
    possible: Callable[[Recording], bool] = lambda _: True

    def of(self, recording: Recording) -> Damaged:
        """The damage done to a recording, alike in every run."""
        return self.do(recording, np.random.default_rng(SEED))


def slowed(factor: float) -> Damage:
    """Played too slowly, or where the factor is below 1 too fast."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        return Damaged(replace(recording, times=factor * recording.times), recording, factor)

    return Damage(f"time × {factor:g}", FindingKind.TIME_SCALE, do)


def ramped(factor: float) -> Damage:
    """A flight, of several, with some frames around it, played too slowly, or too fast."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        flights = _long_flights(recording)
        first, last = flights[int(rng.integers(len(flights)))]
        inside = (recording.frames >= first - AROUND) & (recording.frames < last + AROUND)
        steps = np.diff(recording.times) * np.where(inside[:-1], factor, 1.0)
        times = np.concatenate([[0.0], np.cumsum(steps)])
        return Damaged(at_rate(replace(recording, times=times), recording.rate), recording)

    name = f"a flight's time × {factor:.2g}"
    return Damage(name, FindingKind.RETIMED, do, possible=lambda r: len(_long_flights(r)) > 1)


def _long_flights(recording: Recording) -> list[tuple[float, float]]:
    """First and last scene frames of those that tell a clock."""
    found, spans = each_fall(perform(recording, build_character(recording)))
    return [span for span, (_, seconds) in zip(spans, found, strict=True) if seconds > LONG]


def sized(factor: float, name: str) -> Damage:
    """Read at a wrong unit of length."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        return Damaged(scaled_recording(recording, factor), recording, factor)

    return Damage(name, FindingKind.SIZE, do)


def lain(up: UpAxis, *, rest: bool = True) -> Damage:
    """Another axis than Z up. rest: at rest too, not in the motion alone, as of a turned object."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        damaged = recording
        for _turn in range(3):  # the turn that mends it is the fourth
            damaged = turned(damaged, Repairs(up=up))
        return Damaged(damaged if rest else replace(damaged, bones=recording.bones), recording)

    name = f"{up.value} up{'' if rest else ' in the motion alone'}"
    return Damage(name, FindingKind.UP_AXIS, do)


def begun_at_rest(frames: int, arms: float = 0.0) -> Damage:
    """The rest pose on the first frames. arms: °, by which both are turned in it: as in a T pose
    where the rest hangs them."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        rotations, heads = recording.rotations.copy(), recording.heads.copy()
        rotations[:frames] = np.stack([bone.rotation for bone in recording.bones])
        heads[:frames] = np.stack([bone.head for bone in recording.bones])
        damaged = replace(recording, rotations=rotations, heads=heads)
        local, bones = LocalPoses.of(damaged), figure_of(recording).of(Part.UPPER_ARM)
        for bone, degrees in zip(bones, (arms, -arms), strict=True):
            turn = axis_rotation(0, np.radians(degrees))
            local.rotations[:frames, bone] = local.rotations[:frames, bone] @ turn
        return Damaged(local.posed(damaged), recording.part(slice(frames, None)))

    name = f"rest pose{', arms turned' if arms else ''}, {frames} frames"
    return Damage(name, FindingKind.BIND_POSE, do)


def ended_at_rest(frames: int) -> Damage:
    """The rest pose on the last frames."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        rotations, heads = recording.rotations.copy(), recording.heads.copy()
        rotations[-frames:] = np.stack([bone.rotation for bone in recording.bones])
        heads[-frames:] = np.stack([bone.head for bone in recording.bones])
        damaged = replace(recording, rotations=rotations, heads=heads)
        return Damaged(damaged, recording.part(slice(None, -frames)))

    return Damage(f"rest pose on the last {frames} frames", FindingKind.BIND_POSE, do)


def spiked(degrees: float) -> Damage:
    """Five joints off, each on one frame."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        figure, local = figure_of(recording), LocalPoses.of(recording)
        bones = [bone for bone, part in figure.parts if part is not Part.TOE]
        for frame in rng.choice(np.arange(4, len(recording.frames) - 4), 5, replace=False):
            axis = rng.normal(size=3)
            turn = np.radians(degrees) * axis / np.linalg.norm(axis)
            bone = rng.choice(bones)
            local.rotations[frame, bone] = local.rotations[frame, bone] @ rotation_matrix(turn)
        return Damaged(local.posed(recording), recording)

    return Damage(f"spikes of {degrees:g}°", FindingKind.SPIKE, do)


def burst(frames: int) -> Damage:
    """An arm off by 50° on some frames."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        local, bone = LocalPoses.of(recording), _bone(recording, Part.UPPER_ARM)
        first = int(rng.integers(12, len(recording.frames) - frames - 12))
        axis = rng.normal(size=3)
        turn = rotation_matrix(np.radians(50.0) * axis / np.linalg.norm(axis))
        own = local.rotations[first : first + frames, bone]
        local.rotations[first : first + frames, bone] = own @ turn
        return Damaged(local.posed(recording), recording)

    return Damage(f"spike of 50°, {frames} frames", FindingKind.SPIKE, do)


def leapt(metres: float, frames: int) -> Damage:
    """The whole body ahead on its way for some frames, at the rate of video."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        original = at_rate(recording, VIDEO_RATE)
        quarter = len(original.frames) // 4
        first = int(rng.integers(quarter, 3 * quarter - frames))
        root, heads = figure_of(original).bones[0], original.heads.copy()
        way = (heads[first + frames, root] - heads[first - 1, root]) * [1.0, 1.0, 0.0]
        heads[first : first + frames] += metres * way / np.linalg.norm(way)
        return Damaged(replace(original, heads=heads), original)

    name = f"{VIDEO_RATE:g} Hz, {100 * metres:g} cm ahead, {frames} frames"
    return Damage(name, FindingKind.SPIKE, do)


def joined(metres: float) -> Damage:
    """The whole body elsewhere from some frame on, as where two takes were joined."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        quarter = len(recording.frames) // 4
        heads = recording.heads.copy()
        heads[int(rng.integers(quarter, 3 * quarter)) :] += metres * np.array([0.8, 0.6, 0.0])
        return Damaged(replace(recording, heads=heads), recording)

    return Damage(f"jump of {metres:g} m", FindingKind.JUMP, do)


def exchanged(frames: int, *limbs: Mend, last: bool = False, angles: bool = False) -> Damage:
    """Left and right limbs exchanged on some frames, from where they differ most, or on the last:
    as video capture mistakes them, each bone 5° off, for it exchanges nothing exactly, or their
    angles, as programs do."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        figure, damaged = figure_of(recording), recording
        pairs = [partners(recording, figure, LIMBS[each])[angles] for each in limbs]
        apart = np.linalg.norm(np.diff(pairs[0].ways(recording)[:, :, 0], axis=1), axis=(1, 2))
        count = len(recording.frames)
        first = count - frames if last else 12 + int(np.argmax(apart[12 : -frames - 12]))
        where = (np.arange(count) >= first) & (np.arange(count) < first + frames)
        for pair in pairs:
            damaged = pair.exchanged(damaged, where)
        local = LocalPoses.of(damaged)
        for bone in () if angles else np.concatenate([pair.bones.ravel() for pair in pairs]):
            axis = rng.normal(size=3)
            off = rotation_matrix(np.radians(5.0) * axis / np.linalg.norm(axis))
            local.rotations[where, bone] = local.rotations[where, bone] @ off
        return Damaged(local.posed(damaged), recording)

    what = " and ".join(each.value.removeprefix("exchanged ") for each in limbs)
    kinds = [KINDS[each] for each in limbs]
    which = f"{'the last ' if last else ''}{frames} frames"
    name = f"{what}{' by angles' if angles else ''} exchanged, {which}"
    return Damage(name, kinds[0], do, tuple(kinds[1:]))


def flipped(frames: int) -> Damage:
    """A thigh turned by half a turn about its own axis."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        local = LocalPoses.of(recording)
        bone = _bone(recording, Part.THIGH)
        first = int(rng.integers(10, len(recording.frames) - frames - 10))
        half = rotation_matrix(np.array([0.0, np.pi, 0.0]))
        local.rotations[first : first + frames, bone] = (
            local.rotations[first : first + frames, bone] @ half
        )
        return Damaged(local.posed(recording), recording)

    return Damage(f"thigh flipped, {frames} frames", FindingKind.FLIP, do)


def wrapped(part: Part, frames: int, channel: int = 0, rate: float | None = None) -> Damage:
    """An Euler channel (0 to 2: Z, X, Y) that leaps from 180° to -180°, and was interpolated over
    some frames. rate: Hz, at which the recording is sampled first; None: its own."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        original = recording if rate is None else at_rate(recording, rate)
        local, bone, count = LocalPoses.of(original), _bone(original, part), len(original.frames)
        ramp = np.clip(np.arange(count) - rng.integers(8, count - frames - 8), 0, frames + 1)
        angles = _euler(local.rotations[:, bone])
        angles[:, channel] -= 2.0 * np.pi * ramp / (frames + 1)
        z, x, y = (axis_rotation(a, angles[:, i]) for i, a in enumerate((2, 0, 1)))
        local.rotations[:, bone] = z @ x @ y
        return Damaged(local.posed(original), original)

    at = "" if rate is None else f", {rate:g} Hz"
    name = f"{part.value} turned around, {frames} frames{at}"
    return Damage(name, FindingKind.FULL_TURN, do)


def _euler(rotations: FloatArray) -> FloatArray:
    """(T, 3) rad, of rotations (T, 3, 3) about Z, X and Y; not of those at gimbal lock."""
    x = np.arcsin(np.clip(rotations[:, 2, 1], -1.0, 1.0))
    z = np.arctan2(-rotations[:, 0, 1], rotations[:, 1, 1])
    y = np.arctan2(-rotations[:, 2, 0], rotations[:, 2, 2])
    return np.stack([z, x, y], axis=1)


def held(count: int) -> Damage:
    """Single frames dropped, the one before held in their place."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        rotations, heads = recording.rotations.copy(), recording.heads.copy()
        for frame in _moving(recording, rng, count):
            rotations[frame], heads[frame] = rotations[frame - 1], heads[frame - 1]
        return Damaged(replace(recording, rotations=rotations, heads=heads), recording)

    return Damage(f"{count} frames held", FindingKind.HELD_FRAMES, do)


def frozen(seconds: float, *, repeated: bool = False) -> Damage:
    """A pose that is held amid fast movement: over others, or by frames that are put in."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        count = round(seconds * recording.rate)
        moving = _moving(recording, rng, len(recording.frames))
        at = next(t for t in moving if t + count + 4 < len(recording.frames))
        if repeated:
            rows = np.insert(np.arange(len(recording.frames)), at, np.full(count, at))
        else:
            rows = np.arange(len(recording.frames))
            rows[at + 1 : at + count + 1] = at
        index = np.arange(len(rows))
        damaged = replace(
            recording,
            frames=recording.frames[0] + index,
            times=index / recording.rate,
            heads=recording.heads[rows],
            rotations=recording.rotations[rows],
        )
        return Damaged(damaged, recording)

    kind = FindingKind.REPEATED_FRAMES if repeated else FindingKind.HELD_FRAMES
    what = "put in" if repeated else "held"
    return Damage(f"a pose {what} for {seconds:g} s", kind, do)


def dropped(count: int) -> Damage:
    """Single frames missing, so that the rest comes earlier."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        gone = set(_moving(recording, rng, count))
        keep = np.array([t for t in range(len(recording.frames)) if t not in gone])
        return _without(recording, keep)

    return Damage(f"{count} frames missing", FindingKind.DROPPED_FRAMES, do)


def gap(count: int, every: int = 1) -> Damage:
    """Frames missing in one place, as where capture stalls. every: 2 of every second one."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        moving = _moving(recording, rng, len(recording.frames))
        at = next(t for t in moving if t + every * count + 4 < len(recording.frames))
        gone = slice(at, at + every * count, every)
        return _without(recording, np.delete(np.arange(len(recording.frames)), gone))

    where = "in a row" if every == 1 else f"{every} apart"
    return Damage(f"{count} frames missing {where}", FindingKind.DROPPED_FRAMES, do)


def _without(recording: Recording, keep: IntArray) -> Damaged:
    """With some frames alone, so that the rest comes earlier."""
    size = len(keep)
    less = replace(
        recording,
        frames=recording.frames[:size],
        times=recording.times[:size],
        heads=recording.heads[keep],
        rotations=recording.rotations[keep],
    )
    return Damaged(less, recording)


def sliding(speed: float) -> Damage:
    """The whole body drifts along the floor."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        away = recording.times[:, None] * speed * np.array([0.8, 0.6, 0.0])
        return Damaged(replace(recording, heads=recording.heads + away[:, None]), recording)

    return Damage(f"drift {speed:g} m/s", FindingKind.SLIDING, do)


def rising(speed: float) -> Damage:
    """The whole body drifts upwards, as capture by video lets it."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        away = recording.times[:, None] * speed * np.array([0.0, 0.0, 1.0])
        return Damaged(replace(recording, heads=recording.heads + away[:, None]), recording)

    return Damage(f"rise {speed:g} m/s", FindingKind.RISING, do)


def ragged(frames: int) -> Damage:
    """An arm off by 60°, each time elsewhere, on the last frames, where capture loses it."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        local, bone = LocalPoses.of(recording), _bone(recording, Part.UPPER_ARM)
        axes = rng.normal(size=(frames, 3))
        turns = np.radians(60.0) * axes / np.linalg.norm(axes, axis=1, keepdims=True)
        local.rotations[-frames:, bone] = local.rotations[-frames:, bone] @ rotation_matrix(turns)
        return Damaged(local.posed(recording), recording)

    return Damage(f"the last {frames} frames ragged", FindingKind.JUMP, do)


def floating(metres: float, seconds: float) -> Damage:
    """The whole body floats up and down by so much, over and over, as capture by one camera has
    it."""
    return _swaying(f"floats ±{100 * metres:g} cm in {seconds:g} s", metres, seconds, (0, 0, 1))


def swaying(metres: float, seconds: float) -> Damage:
    """Its feet slide to and fro by so much."""
    return _swaying(f"sways ±{100 * metres:g} cm in {seconds:g} s", metres, seconds, (0.8, 0.6, 0))


def _swaying(name: str, metres: float, seconds: float, way: tuple[float, float, float]) -> Damage:
    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        turns = 2.0 * np.pi * (recording.times / seconds + rng.uniform())
        away = metres * np.sin(turns)[:, None] * np.array(way)
        return Damaged(replace(recording, heads=recording.heads + away[:, None]), recording)

    return Damage(name, FindingKind.FLOATING, do)


def sunk(metres: float, seconds: float) -> Damage:
    """The whole body sinks for a moment and comes back, about where its hips are lowest, which is
    after a landing, before a take-off, or amid a step."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        hips = recording.heads[:, figure_of(recording).bones[0], 2]
        margin = round(seconds * recording.rate)
        middle = recording.times[margin + int(np.argmin(hips[margin:-margin]))]
        since = np.clip((recording.times - middle) / seconds, -0.5, 0.5)
        depth = metres * np.cos(np.pi * since) ** 2
        away = depth[:, None] * np.array([0.0, 0.0, 1.0])
        return Damaged(replace(recording, heads=recording.heads - away[:, None]), recording)

    return Damage(f"sinks {100 * metres:g} cm in {seconds:g} s", FindingKind.SINKING, do)


def raised(metres: float) -> Damage:
    """Off the floor, or in it."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        up = np.array([0.0, 0.0, metres])
        return Damaged(replace(recording, heads=recording.heads + up), recording)

    return Damage(f"{metres:+g} m up", FindingKind.FLOOR, do)


def levelled() -> Damage:
    """The hips' height left out, as exports in place may do."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        hips = recording.heads[:, figure_of(recording).bones[0], 2]
        away = (hips - hips.mean())[:, None] * np.array([0.0, 0.0, 1.0])
        return Damaged(replace(recording, heads=recording.heads - away[:, None]), recording)

    return Damage("hips level", FindingKind.LEVEL_HIPS, do)


def in_place() -> Damage:
    """The hips' way along the floor left out, as exports in place do."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        hips = recording.heads[:, figure_of(recording).bones[0]]
        away = (hips - hips[0]) * [1.0, 1.0, 0.0]
        return Damaged(replace(recording, heads=recording.heads - away[:, None]), recording)

    return Damage("in place", FindingKind.IN_PLACE, do)


def noisy(millimetres: float, degrees: float, rate: float = VIDEO_RATE) -> Damage:
    """As video capture gives it: white noise on the root's place and on all joints."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        original = at_rate(recording, rate)
        local = LocalPoses.of(original)
        turns = np.radians(degrees) * rng.normal(size=(*local.rotations.shape[:2], 3))
        rotations, heads = local.rotations @ rotation_matrix(turns), local.heads
        for b, bone in enumerate(original.bones):
            if bone.parent < 0:
                heads[:, b] += 1e-3 * millimetres * rng.normal(size=(len(heads), 3))
        return Damaged(LocalPoses(rotations, heads).posed(original), original)

    name = f"{rate:g} Hz, {millimetres:g} mm and {degrees:g}° noise"
    return Damage(name, FindingKind.NOISE, do)


def stretched(share: float) -> Damage:
    """A shank that grows by a share of its length in the middle of the clip, and back."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        local, foot = LocalPoses.of(recording), _bone(recording, Part.FOOT)
        grown = 1.0 + share * np.sin(np.pi * np.linspace(0.0, 1.0, len(recording.frames))) ** 8
        local.heads[:, foot] *= grown[:, None]
        return Damaged(local.posed(recording), recording)

    return Damage(f"shank {100 * share:+g} %", FindingKind.BONE_LENGTH, do)


def at_rate(recording: Recording, rate: float) -> Recording:
    """The recording sampled at another rate, Hz: cubic in places, nearest turns in between."""
    count = int(recording.times[-1] * rate) + 1
    times = np.arange(count) / rate
    local = LocalPoses.of(recording)
    flat = local.rotations.reshape(len(recording.frames), -1)
    mixed = interpolate(recording.times, flat, times).reshape(count, -1, 3, 3)
    u, _, vt = np.linalg.svd(mixed)
    heads = interpolate(recording.times, local.heads.reshape(len(flat), -1), times)
    made = LocalPoses(u @ vt, heads.reshape(count, -1, 3))
    frames = recording.frames[0] + np.arange(count)
    return made.posed(replace(recording, frames=frames, times=times))


def _bone(recording: Recording, part: Part) -> int:
    """Index of the first bone that moves a part of the body."""
    return figure_of(recording).of(part)[0]


def _moving(recording: Recording, rng: np.random.Generator, count: int) -> list[int]:
    """Frames amid fast movement, apart from each other."""
    steps = np.linalg.norm(np.diff(recording.heads, axis=0), axis=2).max(axis=1)
    fast = np.flatnonzero(steps > np.median(steps))
    fast = fast[(fast > 4) & (fast < len(steps) - 4)]
    found: list[int] = []
    for frame in rng.permutation(fast).tolist():
        if len(found) < count and all(abs(frame - other) > 4 for other in found):
            found.append(frame)
    return found


DAMAGES = (
    *map(slowed, (0.5, 0.8, 1.25, 2.0)),
    *map(ramped, (1.5, 1 / 1.5)),
    sized(1.6, "size × 1.6"),
    sized(2.54, "centimetres as inches"),
    sized(1 / 2.54, "inches as centimetres"),
    sized(0.01, "metres as centimetres"),
    *map(lain, (UpAxis.Y, UpAxis.X)),
    lain(UpAxis.X, rest=False),
    *map(begun_at_rest, (1, 5)),
    begun_at_rest(1, 80.0),
    ended_at_rest(5),
    *map(spiked, (20.0, 45.0, 120.0)),
    *map(burst, (2, 5)),
    leapt(0.13, 2),
    *map(joined, (0.1, 0.4)),
    ragged(8),
    *(exchanged(frames, limbs) for limbs in (Mend.LEGS, Mend.ARMS) for frames in (5, 15, 30)),
    exchanged(30, Mend.LEGS, last=True),
    exchanged(30, Mend.LEGS, angles=True),
    exchanged(30, Mend.LEGS, Mend.ARMS),
    *map(flipped, (2, 12)),
    *(wrapped(part, n) for part in (Part.PELVIS, Part.THIGH) for n in (2, 6)),
    *map(held, (1, 6)),
    *(frozen(0.3, repeated=each) for each in (False, True)),
    *map(dropped, (1, 4)),
    *map(gap, (3, 6)),
    gap(2, 2),
    *map(sliding, (0.05, 0.1, 0.2, 0.5)),
    rising(0.1),
    floating(0.05, 2.0),
    floating(0.15, 3.0),
    swaying(0.1, 3.0),
    *(sunk(0.1, seconds) for seconds in (0.2, 0.4)),
    *map(raised, (-0.2, -0.05, 0.1, 0.5)),
    levelled(),
    in_place(),
    noisy(3.0, 1.0),
    noisy(3.0, 1.0, FAST_RATE),
    noisy(6.0, 2.0),
    *map(stretched, (0.05, 0.15)),
)
