"""Keys for a result, as the artist asks for them, and what they leave of it in the world."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.reports.keys import KeysReport
from ..recipe.keys import KeyOptions
from ..rows.choices import KeyChoice
from .bezier import BezierKeys
from .bone_channels import BoneChannels
from .events import KeyEvents
from .figure import KeyableFigure
from .hermite import fitted
from .reduction import reduced

TIGHTENINGS = 4  # where errors to first order promise too much, as with bones that inherit in part
SAFETY = 0.99


class PosedChannels(Protocol):
    """Channels at frames (T,), and the bones whose poses they make, by name."""

    @property
    def frames(self) -> FloatArray: ...

    @property
    def channels(self) -> tuple[BoneChannels, ...]: ...

    @property
    def bones(self) -> Sequence[str]: ...

    def errors(
        self, values: list[FloatArray]
    ) -> Generator[float | None, None, tuple[FloatArray, FloatArray]]:
        """Distances (T, B) m of the bones' heads from where they should be, and angles (T, B) rad,
        with other values (T, n) of the channels; in slices."""

    def keyed_figure(self, events: KeyEvents, error: KeyOptions) -> KeyableFigure:
        """What the channels move, with the points that may be off by no more."""


@dataclass(frozen=True)
class ChosenKeys:
    """Keys by bone with channels; None for each where every frame has one, linear in between."""

    keys: list[BezierKeys] | None
    report: KeysReport


def chosen_keys(
    posed: PosedChannels,
    options: KeyOptions,
    events: KeyEvents,
    taken: dict[str, FloatArray],
    rate: float,
) -> Generator[float | None, None, ChosenKeys]:
    """Keys for bones whose channels are known at every frame, in slices of some 20 ms.

    taken: frames of the take's own keys by bone, within the range. rate: frames a second.
    """
    match options.on:
        case KeyChoice.EVERY_FRAME:
            keys = None
        case KeyChoice.TAKE:
            keys = _as_taken(posed, taken)
        case KeyChoice.REDUCED:
            keys = yield from _within(posed, options, events)
    yield None
    done = KeyChoice.EVERY_FRAME if keys is None else options.on
    report = yield from _report(posed, done, keys, rate)
    return ChosenKeys(keys, report)


def _within(
    posed: PosedChannels, error: KeyOptions, events: KeyEvents
) -> Generator[float | None, None, list[BezierKeys] | None]:
    """The fewest keys that keep an error."""
    asked = _times(error, SAFETY)
    for _ in range(TIGHTENINGS):
        keys = yield from reduced(posed.keyed_figure(events, asked))
        apart, turned = yield from posed.errors([own.at(posed.frames) for own in keys])
        yield None
        beyond = max(apart.max() / error.distance, turned.max() / error.angle)
        if beyond <= 1.0:
            return keys
        asked = _times(asked, SAFETY / beyond)
    return None


def _times(error: KeyOptions, share: float) -> KeyOptions:
    return replace(error, distance=share * error.distance, angle=share * error.angle)


def _as_taken(posed: PosedChannels, taken: dict[str, FloatArray]) -> list[BezierKeys]:
    """Keys where the take has them, and at the ends; for bones without any, where others have."""
    ends = posed.frames[[0, -1]]
    everywhere = np.concatenate([ends, *taken.values()])
    return [
        fitted(
            own.values,
            posed.frames,
            np.unique(np.concatenate([ends, taken.get(own.bone, everywhere)])),
        )
        for own in posed.channels
    ]


def _report(
    posed: PosedChannels, choice: KeyChoice, keys: list[BezierKeys] | None, rate: float
) -> Generator[float | None, None, KeysReport]:
    channels = [own.values.shape[1] for own in posed.channels]
    if keys is None:
        values, counts = [own.values for own in posed.channels], [len(posed.frames)] * len(channels)
    else:
        values, counts = [own.at(posed.frames) for own in keys], [len(own.frames) for own in keys]
    apart, turned = yield from posed.errors(values)
    (at, moved), (when, turning) = (np.unravel_index(e.argmax(), e.shape) for e in (apart, turned))
    names = posed.bones
    return KeysReport(
        choice=choice.value,
        keys=int(np.dot(counts, channels)),
        channels=sum(channels),
        seconds=float(posed.frames[-1] - posed.frames[0]) / rate,
        largest_error_mm=1000.0 * float(apart.max()),
        error_bone=names[int(moved)],
        error_frame=float(posed.frames[at]),
        largest_turn_deg=float(np.degrees(turned.max())),
        turn_bone=names[int(turning)],
        turn_frame=float(posed.frames[when]),
    )
