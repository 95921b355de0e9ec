"""What the report tells of what carries the body unseen, and of contacts that were let go."""

from collections.abc import Iterator

import numpy as np

from ..data.constants import STANDARD_GRAVITY, UP
from ..data.contacts import Interval
from ..data.faults import FitNeedsSupport
from ..data.problem import MotionProblem, Unseen
from ..data.reports.constraints import (
    AcceptedReport,
    CarriedFlightReport,
    FitNeeds,
    LetGoReport,
    UnseenSupportReport,
)
from ..fitting.fit import Fit
from ..transcription.motion import Motion, pinned_instants
from ..unseen.free_fall import clear_falls
from .flight_summary import scene_frame

SAMPLE_RATE = 500.0  # Hz
CARRIES = 0.05  # body weights; less is within the error of forces that are told from recordings
LEAST_FRAMES = 4  # that tell an acceleration
APART = 0.1  # s; what is nearer is one interval


def unseen_support(fit: Fit, motion: Motion) -> Iterator[UnseenSupportReport]:
    """The intervals of a motion in which something unseen carries the body."""
    t = motion.transcription
    if t.support is None:
        return
    times = np.linspace(0.0, motion.duration, max(2, round(motion.duration * SAMPLE_RATE)))
    weight = t.character.mass * STANDARD_GRAVITY
    each = motion.forces(times)[:, -t.n_support :] / weight
    arms = motion.pose(times).points(t.points[-t.n_support :])
    moment = np.cross(arms - arms.mean(axis=1, keepdims=True), each).sum(axis=1)
    sizes, moments = (np.linalg.norm(v, axis=1) for v in (each.sum(axis=1), moment))
    busy = np.flatnonzero(np.linalg.norm(each, axis=2).sum(axis=1) > CARRIES)
    breaks = np.flatnonzero(np.diff(times[busy]) > APART) + 1
    for part in np.split(busy, breaks) if len(busy) else ():
        peak = part[sizes[part].argmax()]
        yield UnseenSupportReport(
            first_frame=scene_frame(fit, float(times[part[0]])),
            last_frame=scene_frame(fit, float(times[part[-1]])),
            force_bw=float(sizes[peak]),
            peak_frame=scene_frame(fit, float(times[peak])),
            moment_bw_m=float(moments[part].max()),
        )


def refuse_unseen(problem: MotionProblem, fit: Fit) -> None:
    """Raises FitNeedsSupport where something unseen carries the body in a fit, and the problem
    refuses that: what the analysis told by itself it refused before."""
    if problem.unseen is not Unseen.REFUSE:
        return
    carried = tuple(unseen_support(fit, fit.motion))
    if carried:
        spans = ((round(each.first_frame), round(each.last_frame)) for each in carried)
        raise FitNeedsSupport(tuple(spans))


def let_go(fit: Fit) -> Iterator[LetGoReport]:
    """The contacts that a fit does not hold."""
    for each in fit.let_go:
        start, end = (scene_frame(fit, t) for t in (each.contact.start, each.contact.end))
        yield LetGoReport(each.contact.name, start, end, 1000.0 * each.off)


def fit_needs(fit: Fit, motion: Motion | None = None) -> FitNeeds:
    """What a fit needs beside what the recording shows; of an adaptation of it where its motion is
    given."""
    motion = motion or fit.motion
    carried = tuple(unseen_support(fit, motion))
    needs = tuple(let_go(fit)), tuple(accepted(motion)), tuple(carried_flights(fit))
    return FitNeeds(carried, *needs)


def carried_flights(fit: Fit) -> Iterator[CarriedFlightReport]:
    """The flights that were found, in which a fit has something unseen carry the body, and which
    are no clear falls; of one of so few frames that they tell no fall nothing is told."""
    times, com = fit.performance.times, fit.performance.com
    for each in fit.carried:
        during = (times >= each.start) & (times <= each.end)
        flight = Interval(each.start, each.end)
        if np.count_nonzero(during) < LEAST_FRAMES or clear_falls(times, com, [flight]):
            continue
        t, places = times[during] - each.start, com[during]
        without_fall = places + 0.5 * STANDARD_GRAVITY * np.outer(t**2, UP)
        slope, start = np.polyfit(t, without_fall, 1)
        off = without_fall - np.outer(t, slope) - start
        yield CarriedFlightReport(
            phase=each.name,
            first_frame=scene_frame(fit, each.start),
            last_frame=scene_frame(fit, each.end),
            acceleration=float(-2.0 * np.polyfit(t, places[:, 2], 2)[0]),
            off_mm=1000.0 * float(np.linalg.norm(off, axis=1).max()),
        )


def accepted(motion: Motion) -> Iterator[AcceptedReport]:
    """The contacts of a motion that miss their places by what is good enough."""
    for i, each in enumerate(motion.transcription.contacts):
        if each.contact.slack > 0.0:
            off = motion.drift(i, pinned_instants(each, SAMPLE_RATE))
            millimetres = 1000.0 * float(off.max()), 1000.0 * each.contact.slack
            yield AcceptedReport(each.contact.name, *millimetres)
