"""Feet that slide and tremble: from frame to frame noise moves them faster than the whole body
drifts, also once it is smoothed. A line through a whole stance tells its speed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ...arrays import BoolArray, FloatArray
from ...data.recording import Recording
from ...numerics.runs import runs
from ...skeleton.parts import SIDES
from ..figure import Figure
from .flat_feet import FLAT, FLAT_SPEED, STANDING_SPEED_UP, agreed, foot_ends, may_stand

WINDOW = 0.2  # s, of the lines that tell which feet stand; a stance's own is as long as itself
# Noise of 3 mm and 1°, as one camera has it, leaves this much of these lines' speeds.
TREMOR = 0.1  # m/s
LIFTED = 0.05  # m above the other foot: a foot that is lifted, and no noise
LEAST_STANCE, FEWEST = 0.25, 6  # s; and frames, so that a cubic leaves something
LEAST_STANDING, LEAST_SHARE = 0.3, 0.1  # s in all, and of a clip
ROLLING = 0.015  # m, by which honest feet go in a stance; twice that is the most
# A stance's ends are not sharp, so that feet which roll count as sliding: 3 cm more than of others.
LEAST_SLID = 0.09  # m, in all stances
# m/s; who cannot tell a drift as nearly as this tells none.
SLOWEST = 0.04
# Standard deviations: those of feet are told by the few stances themselves.
SURE = 4.0
TOLD_WITHIN = 0.25  # of a drift's way in a stance
# Of a drift, by which a cubic through the speeds of all stances may leave it, rms: drifts of 9 cm/s
# in noise leave 0.1 to 0.9, and what wanders by 3 cm leaves 0.7 and more.
STEADY = 0.7
TREMBLING = 0.003  # m, rms, that smoothing leaves of noise; clean feet have 2 mm
ALIKE_FOR = 0.15  # s, for which what smoothing leaves of noise is alike
ROUNDS = 8  # of choosing stances by the drift that they tell


@dataclass(frozen=True)
class _Stances:
    """Lines through N stances: their seconds (N,), speeds along the floor (N, 2), m/s, and mean
    squares of what is off them, and off cubics, (N,) m². standing: s, in which a foot stands or
    both do. course: (F, 2) m/s, speeds in all their frames by one cubic over the clip."""

    seconds: FloatArray
    speeds: FloatArray
    off: FloatArray
    off_cubics: FloatArray
    standing: float
    course: FloatArray

    @property
    def tremble(self) -> bool:
        """Whether noise is left in them, which no cubic follows as it does feet that turn."""
        return bool(np.average(self.off_cubics, weights=self.seconds) > TREMBLING**2)

    @property
    def unsure(self) -> FloatArray:
        """(N,) m, standard deviations of their ways, for rolling and for noise."""
        alike = np.minimum(12.0 * ALIKE_FOR / self.seconds, 12.0)
        noise = np.average(self.off, weights=self.seconds)
        return np.asarray(np.sqrt(ROLLING**2 + alike * noise))

    def drift(self) -> tuple[FloatArray, float]:
        """The speed (2,), m/s, that all tell together, and its standard deviation."""
        weights = (self.seconds / self.unsure) ** 2
        speed = np.asarray(weights @ self.speeds / weights.sum())
        return speed, float(weights.sum() ** -0.5)

    def agree(self, drift: FloatArray) -> bool:
        """Whether each goes the drift's way (2,), m/s, as nearly as it can be told."""
        left = np.linalg.norm(self.speeds - drift, axis=1) * self.seconds
        way = float(np.linalg.norm(drift)) * self.seconds
        return bool((left < np.maximum(SURE * self.unsure, TOLD_WITHIN * way)).all())

    def is_steady(self, drift: FloatArray) -> bool:
        """Whether the speed stays at the drift (2,), m/s, over the clip, as that of what floats
        about does not."""
        left = np.sqrt(np.mean(np.sum((self.course - drift) ** 2, axis=1)))
        return bool(left < STEADY * np.linalg.norm(drift))


def drift_of_stances(recording: Recording, figure: Figure) -> tuple[float, float] | None:
    """M/s, along the floor, at which feet that tremble slide in all stances, where it is sure."""
    stances = _stances(recording, figure)
    seconds = float(recording.times[-1])
    if stances is None or not stances.tremble:
        return None
    if stances.standing < max(LEAST_STANDING, LEAST_SHARE * seconds):
        return None
    drift, unsure = stances.drift()
    x, y = map(float, drift)
    speed = float(np.hypot(x, y))
    sure = unsure < SLOWEST and speed > max(SLOWEST, SURE * unsure) and stances.agree(drift)
    sure = sure and stances.is_steady(drift)
    return (x, y) if sure and speed * stances.standing > LEAST_SLID else None


def _stances(recording: Recording, figure: Figure) -> _Stances | None:
    """Those that go with the drift that they tell; None where there are none."""
    half = max(round(0.5 * WINDOW * recording.rate), 1)
    if len(recording.times) <= 2 * half:
        return None
    ends = [foot_ends(recording, figure, side) for side in SIDES]
    middles = [0.5 * (ankle + ball) for ankle, ball in ends]
    ankles, balls = (
        [slopes(end, half, recording.rate) for end in each] for each in zip(*ends, strict=True)
    )
    speeds = [0.5 * (ankle + ball) for ankle, ball in zip(ankles, balls, strict=True)]
    lowest = np.min([middle[:, 2] for middle in middles], axis=0)
    level = [
        (np.linalg.norm(ankle - ball, axis=1) < FLAT + TREMOR)
        & (np.abs(speed[:, 2]) < STANDING_SPEED_UP)
        & (middle[:, 2] < lowest + LIFTED)
        & may_stand(recording, figure, side)
        for ankle, ball, speed, middle, side in zip(
            ankles, balls, speeds, middles, SIDES, strict=True
        )
    ]
    slow = np.concatenate([speed[on, :2] for speed, on in zip(speeds, level, strict=True)])
    if not len(slow):
        return None
    drift, _ = agreed(slow)
    found = None
    for _ in range(ROUNDS):
        stands = [
            on & (np.linalg.norm(speed[:, :2] - drift, axis=1) < FLAT_SPEED + TREMOR)
            for speed, on in zip(speeds, level, strict=True)
        ]
        found = _lines(recording, middles, stands)
        if found is None:
            return None
        drift, _ = found.drift()
    return found


def _lines(
    recording: Recording, middles: Iterable[FloatArray], stands: Iterable[BoolArray]
) -> _Stances | None:
    """Through the places (T, 3) m of each foot in the stances that are long enough."""
    times, standing = recording.times, np.zeros(len(recording.times), bool)
    lines: list[tuple[float, FloatArray, float, float]] = []
    ways: list[tuple[FloatArray, FloatArray]] = []
    for middle, on in zip(middles, stands, strict=True):
        for part in _long(on, recording.rate):
            since = times[part] - times[part].mean()
            way = middle[part, :2] - middle[part, :2].mean(axis=0)
            line, cubic = (np.polyfit(since, way, degree) for degree in (1, 3))
            off_line, off_cubic = (
                float(np.mean((way - np.vander(since, len(fit)) @ fit) ** 2))
                for fit in (line, cubic)
            )
            lines.append((float(np.ptp(since)), line[0], off_line, off_cubic))
            ways.append((times[part], way))
            standing[part] = True
    if not lines:
        return None
    seconds, speeds, off, off_cubics = map(np.array, zip(*lines, strict=True))
    stood = float(standing.sum()) / recording.rate
    return _Stances(seconds, speeds, off, off_cubics, stood, _course(ways))


def _course(ways: Sequence[tuple[FloatArray, FloatArray]]) -> FloatArray:
    """(F, 2) m/s, the speeds of one cubic in time, by the ways of stances: each by its times
    (n,), s, and places (n, 2), m, about their mean. F: frames of all."""
    powers = np.arange(4)
    grown = [times[:, None] ** (powers + 1) / (powers + 1) for times, _ in ways]
    about = np.concatenate([each - each.mean(axis=0) for each in grown])
    fit, *_ = np.linalg.lstsq(about, np.concatenate([way for _, way in ways]), rcond=None)
    return np.asarray(np.concatenate([times[:, None] ** powers for times, _ in ways]) @ fit)


def _long(stands: BoolArray, rate: float) -> Iterator[slice]:
    """Frames of the stances that tell a speed."""
    for first, last in runs(stands):
        if last - first >= max(LEAST_STANCE * rate, FEWEST - 1):
            yield slice(first, last + 1)


def slopes(track: FloatArray, half: int, rate: float) -> FloatArray:
    """(T, 3) m/s, of lines through the frames up to `half` before and after each, or next to an end
    through as many. track: (T, 3) m, T more than twice `half`. rate: frames a second."""
    since = np.arange(-half, half + 1) / rate
    inner = sliding_window_view(track, len(since), axis=0) @ (since / (since @ since))
    return np.pad(inner, ((half, half), (0, 0)), mode="edge")
