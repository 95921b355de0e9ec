"""The summed contact force against the plates': errors, shape, peaks and impulse."""

from dataclasses import dataclass

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.requests import Vector
from .filters import CUT_OFFS, differentiated, low_pass, resampled
from .trials import GroundForces, Trial

LOADED = 20.0  # N, under which the plates' files have zero
PEAK_CUT_OFF = 20.0  # Hz, for peaks and loading rates, which are told of both sides alike
STEP = 0.002  # s
UP = 2


@dataclass(frozen=True)
class RmsError:
    """Rms error of the summed force, body weights, each (3,): forward, left, up.

    stance: the same where the plates carry. stored: of plain differentiation, by the trial's file.
    """

    cut_off: float
    ours: Vector
    baseline: Vector
    stored: Vector
    ours_stance: Vector
    baseline_stance: Vector


def rms_errors(trial: Trial, ours: GroundForces) -> list[RmsError]:
    """Both sides low-passed alike, at the instants of the trial's centre of mass."""
    at = trial.com_times
    inside = (at >= trial.compared[0] - 1e-9) & (at <= trial.compared[1] + 1e-9)
    stance = inside & (resampled(trial.plates.times, trial.plates.total, at)[:, UP] > 0.0)
    rate = (len(at) - 1) / float(at[-1] - at[0])
    plain = differentiated(trial.com, rate)
    found = []
    for cut_off in CUT_OFFS:
        measured = filtered(trial.plates, cut_off, at)
        wrong = filtered(ours, cut_off, at) - measured
        wrong_plain = low_pass(plain, rate, cut_off) - measured
        found.append(
            RmsError(
                cut_off,
                _rms(wrong[inside]),
                _rms(wrong_plain[inside]),
                _vector(trial.stored_baseline(cut_off)),
                _rms(wrong[stance]),
                _rms(wrong_plain[stance]),
            )
        )
    return found


def filtered(forces: GroundForces, cut_off: float, at: FloatArray) -> FloatArray:
    """(U, 3) summed force, low-passed, at instants (U,) s."""
    return resampled(forces.times, low_pass(forces.total, forces.rate, cut_off), at)


def _rms(errors: FloatArray) -> Vector:
    return _vector(np.sqrt((errors**2).mean(axis=0)))


def _vector(values: FloatArray) -> Vector:
    forward, left, up = values.tolist()
    return forward, left, up


def total_variation(forces: GroundForces, window: tuple[float, float]) -> float:
    """Total variation of the vertical force within a window, body weights, as it was sampled."""
    return float(np.abs(np.diff(forces.total[_inside(forces.times, window), UP])).sum())


def largest_step(
    forces: GroundForces, window: tuple[float, float], explained: list[float]
) -> tuple[float, float]:
    """Largest change of the vertical force within 2 ms, body weights, and its instant, s.

    explained: s, instants at which the whole body lands or leaves; steps across them do not count.
    """
    count = max(1, round(STEP * forces.rate))
    vertical = forces.total[:, UP]
    steps = np.abs(vertical[count:] - vertical[:-count])
    start, end = forces.times[:-count], forces.times[count:]
    counted = (start >= window[0]) & (end <= window[1])
    slack = 1e-3 / forces.rate
    for instant in explained:
        counted &= (end < instant - slack) | (start > instant + slack)
    if not counted.any():
        return 0.0, window[0]
    at = int(np.argmax(np.where(counted, steps, -1.0)))
    return float(steps[at]), float(start[at])


@dataclass(frozen=True)
class Stance:
    """One stance of the whole body as the plates saw it, start to end, s; ours beside theirs.

    peak: body weights. peak_time: s. impulse: body weights x s. loading_rate: body weights / s.
    """

    start: float
    end: float
    peak: tuple[float, float]
    peak_time: tuple[float, float]
    impulse: tuple[float, float]
    loading_rate: tuple[float, float]


def stances(trial: Trial, ours: GroundForces) -> list[Stance]:
    """The stances that lie wholly within the valid seconds and our motion."""
    loaded = trial.plates.total[:, UP] > 0.0
    return [
        _stance(trial.plates, ours, start, end)
        for start, end in loaded_intervals(trial.plates.times, loaded)
        if start > trial.valid[0] and end < trial.valid[1] and end < trial.plates.times[-1]
    ]


def _stance(plates: GroundForces, ours: GroundForces, start: float, end: float) -> Stance:
    mine, theirs = _facts(ours, start, end), _facts(plates, start, end)
    peak, peak_time, impulse, loading_rate = zip(mine, theirs, strict=True)
    return Stance(start, end, peak, peak_time, impulse, loading_rate)


def _facts(forces: GroundForces, start: float, end: float) -> tuple[float, float, float, float]:
    margin = 0.05  # s: ours may begin earlier and end later than the plates'
    near = _inside(forces.times, (start - margin, end + margin))
    times = forces.times[near]
    smooth = low_pass(forces.total, forces.rate, PEAK_CUT_OFF)[near, UP]
    at = int(np.argmax(smooth))
    impulse = float(np.trapz(forces.total[near, UP], times))
    rising = np.gradient(smooth, times)
    return float(smooth[at]), float(times[at]), impulse, float(rising.max())


def loaded_intervals(times: FloatArray, loaded: BoolArray) -> list[tuple[float, float]]:
    """Runs of samples at which something is loaded, first and last instant, s."""
    edges = np.diff(np.concatenate(([0], loaded.astype(np.int8), [0])))
    first, last = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return [(float(times[a]), float(times[b])) for a, b in zip(first, last, strict=True)]


def _inside(times: FloatArray, window: tuple[float, float]) -> BoolArray:
    return np.asarray((times >= window[0] - 1e-9) & (times <= window[1] + 1e-9))
