"""The summed contact force against the plates': errors, shape, peaks and impulse."""

import itertools
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.requests import Vector
from ...solver.numerics.runs import runs
from ..filters import CUT_OFFS, differentiated, low_pass, resampled
from .trials import FEET, GroundForces, Trial

PEAK_CUT_OFF = 15.0  # Hz, for peaks and loading rates, which are told of both sides alike
STEP = 0.002  # s
SHORTEST_FLIGHT = 0.01  # s; between two stances
FORWARD, LEFT, UP = 0, 1, 2


@dataclass(frozen=True)
class RmsError:
    """Rms error of the summed force, body weights, each (3,): forward, left, up.

    stance: the same where the plates carry. stored: of plain differentiation, by the trial's file.
    """

    cut_off: float
    ours: Vector
    baseline: Vector
    stored: Vector | None
    ours_stance: Vector
    baseline_stance: Vector


def rms_errors(trial: Trial, ours: GroundForces) -> list[RmsError]:
    """Both sides low-passed alike, at the instants of the trial's centre of mass."""
    at = trial.com_times
    inside = _inside(at, trial.compared)
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
                trial.stored_baseline(cut_off),
                _rms(wrong[stance]),
                _rms(wrong_plain[stance]),
            )
        )
    return found


def foot_errors(trial: Trial, ours: GroundForces, cut_off: float = 15.0) -> tuple[Vector, ...]:
    """Rms error of the left and the right foot's force, body weights: forward, left, up."""
    at = trial.com_times[_inside(trial.com_times, trial.compared)]
    mine, theirs = (
        resampled(f.times, low_pass(f.feet, f.rate, cut_off), at) for f in (ours, trial.plates)
    )
    return tuple(_rms((mine - theirs)[:, side]) for side in range(len(FEET)))


def filtered(forces: GroundForces, cut_off: float, at: FloatArray) -> FloatArray:
    """(U, 3) summed force, low-passed, at instants (U,) s."""
    return resampled(forces.times, low_pass(forces.total, forces.rate, cut_off), at)


def _rms(errors: FloatArray) -> Vector:
    forward, left, up = np.sqrt((errors**2).mean(axis=0)).tolist()
    return forward, left, up


def total_variation(forces: GroundForces, window: tuple[float, float]) -> float:
    """Total variation of the vertical force within a window, body weights, as it was sampled."""
    return float(np.abs(np.diff(forces.total[_inside(forces.times, window), UP])).sum())


@dataclass(frozen=True)
class Step:
    """Largest change of the vertical force within 2 ms, body weights, and its instant, s.

    jump: the same beyond what the slopes of the 2 ms before and after it explain: of a force that
    only rises steeply there is none, of one that jumps it is the jump.
    """

    change: float
    change_at: float
    jump: float
    jump_at: float


def largest_step(forces: GroundForces, window: tuple[float, float], explained: list[float]) -> Step:
    """The largest step in a window that no instant in `explained`, s, lies in.

    explained: when the whole body lands or leaves; there the sum may jump.
    """
    n = max(1, round(STEP * forces.rate))
    times, vertical = forces.times, forces.total[:, UP]
    changes = vertical[n:] - vertical[:-n]
    beside = 0.5 * (changes[: -2 * n] + changes[2 * n :])
    jumps = np.abs(changes[n:-n] - beside)
    found = []
    for sizes, reach, first in ((np.abs(changes), 0, times[:-n]), (jumps, n, times[n : -2 * n])):
        before, after = (reach + 0.5) / forces.rate, (reach + n + 0.5) / forces.rate
        counted = (first - before >= window[0]) & (first + after <= window[1])
        for instant in explained:
            counted &= (first + after < instant) | (first - before > instant)
        at = int(np.argmax(np.where(counted, sizes, -1.0)))
        found += [float(sizes[at]) if counted[at] else 0.0, float(first[at])]
    return Step(*found)


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
    """The stances before and after which the plates saw a flight, within the valid seconds."""
    flights = itertools.pairwise(measured_flights(trial))
    return [_stance(trial.plates, ours, before, after) for before, after in flights]


def measured_flights(trial: Trial) -> list[tuple[float, float]]:
    """First and last instant, s, at which neither plate carried, within the valid seconds."""
    times, free = trial.plates.times, trial.plates.total[:, UP] <= 0.0
    inside = _inside(times, trial.valid)
    found = loaded_intervals(times[inside], free[inside])
    return [(start, end) for start, end in found if end - start >= SHORTEST_FLIGHT]


def _stance(
    plates: GroundForces,
    ours: GroundForces,
    before: tuple[float, float],
    after: tuple[float, float],
) -> Stance:
    """From the middle of one flight to the middle of the next: ours may last longer."""
    window = (0.5 * sum(before), 0.5 * sum(after))
    peak, peak_time, impulse, loading_rate = zip(
        _facts(ours, window), _facts(plates, window), strict=True
    )
    return Stance(before[1], after[0], peak, peak_time, impulse, loading_rate)


def _facts(forces: GroundForces, window: tuple[float, float]) -> tuple[float, float, float, float]:
    inside = _inside(forces.times, window)
    times = forces.times[inside]
    smooth = low_pass(forces.total, forces.rate, PEAK_CUT_OFF)[inside, UP]
    at = int(np.argmax(smooth))
    impulse = float(np.trapz(forces.total[inside, UP], times))
    return float(smooth[at]), float(times[at]), impulse, float(np.gradient(smooth, times).max())


def loaded_intervals(times: FloatArray, loaded: BoolArray) -> list[tuple[float, float]]:
    """Runs of samples at which something is loaded, first and last instant, s."""
    return [(float(times[a]), float(times[b])) for a, b in runs(loaded)]


def _inside(times: FloatArray, window: tuple[float, float]) -> BoolArray:
    return np.asarray((times >= window[0] - 1e-9) & (times <= window[1] + 1e-9))
