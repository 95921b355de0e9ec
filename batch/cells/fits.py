"""Fits that the cells of a clip share: kept in the batch's folder by a hash of what they are of."""

from __future__ import annotations

import hashlib
import pickle
import shutil
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from pathlib import Path

import numpy as np

from ...solver.data.recording import digest
from ...solver.data.requests import Requests
from ...solver.fitting.fit import Fit
from ...solver.worker.pipeline import FITTING, Subject, fit_subject, unfitted
from ...solver.worker.possible import check_requested
from ...solver.worker.recent_fits import RecentFits
from ...solver.worker.stage_clock import StageClock
from ...solver.worker.stated_scale import own_lengths
from ...solver.worker.unpickling import Unreadable, unpickled
from ..records.aside import written_aside
from ..records.locks import held
from ..records.manifest import version
from ..records.result import FITS
from .reading import ReadClip

FILE = "fit.pickle"
Analysed = tuple[Subject, ReadClip]
IN_MEMORY = 2  # a fit's metrics are ten times as large as the fit


class SharedFits:
    """What the cells of a clip share. In place of `fit_possible`: a fit is solved once, by whoever
    needs it first; others wait. The last analysis is remembered by who holds this, and what stands
    for its fit while it is asked whether a request can be: always that, with the fit known or not,
    so that a cell's end does not hang on which one came first.

    Fits are pickles that can name the solver's own classes and numpy's arrays alone.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder / FITS
        self._recent = RecentFits(IN_MEMORY)
        self._analysed: tuple[str, Analysed] | None = None
        self._unfitted: tuple[str, Fit] | None = None

    def analysed(self, key: str, analyse: Callable[[], Analysed]) -> Analysed:
        """The last analysis where it was of the same, else a new one. Raises as `analyse`."""
        if self._analysed is None or self._analysed[0] != key:
            self._analysed = None
            self._analysed = key, analyse()
        return self._analysed[1]

    def __call__(self, subject: Subject, clock: StageClock) -> Fit:
        """Raises as `fit_possible` does, and OSError."""
        key = fit_key(subject)
        if self._unfitted is None or self._unfitted[0] != key:
            self._unfitted = key, unfitted(subject)
        with own_lengths(subject.factor):
            check_requested(self._unfitted[1], subject.problem)
        return self._fit(key, subject, clock)

    def fit(self, subject: Subject, clock: StageClock) -> Fit:
        """The fit, whatever is asked of it. Raises NotComputable, OSError."""
        return self._fit(fit_key(subject), subject, clock)

    def _fit(self, key: str, subject: Subject, clock: StageClock) -> Fit:
        return self._recent.of(key, clock, lambda: self._kept(key, subject, clock))

    def _kept(self, key: str, subject: Subject, clock: StageClock) -> Fit:
        """From the folder, else solved and put there."""
        found = self._read(key)
        if found is None:
            self._folder.mkdir(parents=True, exist_ok=True)
            with held(self._folder / f".{key}.lock"):
                found = self._read(key)
                if found is None:
                    found = fit_subject(subject, clock)
                    # As those who find it there read it: without what it can compute itself.
                    with written_aside(self._folder / key) as aside:
                        (aside / FILE).write_bytes(pickle.dumps(found))
                    return found
        with clock.stage(FITTING):
            return found

    def _read(self, key: str) -> Fit | None:
        try:
            fitted = unpickled((self._folder / key / FILE).read_bytes())
        except FileNotFoundError:
            return None
        except Unreadable:
            fitted = None
        if not isinstance(fitted, Fit):
            shutil.rmtree(self._folder / key, ignore_errors=True)  # a disk's fault: solved anew
            return None
        return fitted


def fit_key(subject: Subject) -> str:
    """SHA-256, hexadecimal, of all that a subject's fit depends on: the recording with what lies
    about it, mass and bones, the contacts, and the objects that the recording is on."""
    problem, on = subject.problem, subject.stood_on
    known = replace(
        problem,
        pins=(),
        scene=tuple(thing for thing in problem.scene if thing.name in on),
        skin=None,
        requests=Requests(),
        bones=dict(sorted(problem.bones.items())),
    )
    performance = subject.analysis.performance
    recordings = (performance.recording, performance.take.recording)
    recorded = [digest(each) for each in recordings]
    return digest_of(version(), recorded, known, subject.analysis.schedule, subject.cycle)


def digest_of(*values: object) -> str:
    """SHA-256, hexadecimal, of records and what is in them."""
    content = hashlib.sha256()
    for part in _parts(values):
        content.update(part)
    return content.hexdigest()


def _parts(value: object) -> Iterator[bytes]:
    """A record as bytes, the same for equal ones, to the last bit of its numbers."""
    if isinstance(value, np.ndarray):
        yield f"{value.dtype}{value.shape}".encode()
        yield value.tobytes()
    elif isinstance(value, Enum):
        yield repr(value.value).encode()
    elif is_dataclass(value):
        yield type(value).__name__.encode()
        for one in fields(value):
            yield one.name.encode()
            yield from _parts(getattr(value, one.name))
    elif isinstance(value, tuple | list | dict):
        yield f"{type(value).__name__}{len(value)}".encode()
        for each in value.items() if isinstance(value, dict) else value:
            yield from _parts(each)
    else:
        assert value is None or isinstance(value, bool | int | float | str), value
        yield repr(value).encode()
