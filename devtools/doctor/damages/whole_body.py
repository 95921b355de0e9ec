"""The whole body: of another size, lain down, elsewhere, drifting, off the floor, in place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....solver.data.recording import Recording
from ....solver.data.scaling import scaled_recording
from ....solver.doctor.examination.repair import turned
from ....solver.doctor.figure import figure_of
from ....solver.doctor.finding import FindingKind
from ....solver.doctor.repairs import Repairs, UpAxis
from .damage import VIDEO_RATE, Damage, Damaged, at_rate


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


def tilted(angle: float) -> Damage:
    """The whole world, as a camera has it that was not level: the floor slopes along the body's way
    by °, upwards."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        hips = recording.heads[:, figure_of(recording).bones[0], :2]
        way = (hips[-1] - hips[0]) / np.linalg.norm(hips[-1] - hips[0])
        x, y = np.degrees(np.arctan(-np.tan(np.radians(angle)) * way)).tolist()
        return Damaged(turned(recording, Repairs(tilt=(x, y))), recording)

    return Damage(f"floor tilted by {angle:+g}°", FindingKind.TILTED, do)


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
    """The hips' height left out, as exports in place and capture that is relative to them do."""

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
