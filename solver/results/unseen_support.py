"""What the report tells of what carries the body unseen, and of contacts that were let go."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ..analysis.balance import LOADED, SURELY_LASTS, outside
from ..arrays import BoolArray, FloatArray
from ..data.constants import STANDARD_GRAVITY, UP
from ..data.contacts import ContactSchedule, Interval
from ..data.faults import CarriedBy, FitNeedsSupport, OffBalance, UnseenSupport
from ..data.problem import MotionProblem, Unseen
from ..data.recording import Recording
from ..data.reports.constraints import (
    CARRIES,
    AcceptedReport,
    CarriedFlightReport,
    FitNeeds,
    LetGoReport,
    UnseenSupportReport,
)
from ..data.reports.report import Report
from ..fitting.fit import Fit
from ..numerics.runs import runs
from ..transcription.motion import Motion, pinned_instants
from ..transcription.transcription import Transcription
from ..unseen.free_fall import clear_falls
from .flight_summary import scene_frame

SAMPLE_RATE = 500.0  # Hz
LEAST_FRAMES = 4  # that tell an acceleration
MOST = 0.5  # of an interval, in which hands, or an artist's points, touch that carry in it
APART = 0.1  # s; what is nearer is one interval

Span = tuple[float, float]  # first and last frame


def unseen_support(fit: Fit, motion: Motion) -> Iterator[UnseenSupportReport]:
    """The intervals of a motion in which something unseen carries the body, and those beside them
    in which it does no more than turn it."""
    t = motion.transcription
    if t.support is None:
        return
    times = np.linspace(0.0, motion.duration, max(2, round(motion.duration * SAMPLE_RATE)))
    weight = t.character.mass * STANDARD_GRAVITY
    each = motion.forces(times)[:, -t.n_support :] / weight
    arms = motion.pose(times).points(t.points[-t.n_support :])
    moment = np.cross(arms - arms.mean(axis=1, keepdims=True), each).sum(axis=1)
    sizes, moments = (np.linalg.norm(v, axis=1) for v in (each.sum(axis=1), moment))
    acts = np.linalg.norm(each, axis=2).sum(axis=1) > CARRIES
    on_hands = _on_hands(t, times)
    beside = weight_beside(motion, times) if on_hands.any() else np.zeros_like(times)
    for first, last in support_intervals(times, sizes > CARRIES, acts):
        part = slice(first, last + 1)
        peak = first + int(sizes[part].argmax())
        yield UnseenSupportReport(
            first_frame=scene_frame(fit, float(times[first])),
            last_frame=scene_frame(fit, float(times[last])),
            force_bw=float(sizes[peak]),
            peak_frame=scene_frame(fit, float(times[peak])),
            moment_bw_m=float(moments[part].max()),
            mean_bw=float(sizes[part].mean()),
            beside_hands_m=_mean_on_hands(beside[part], on_hands[part]),
        )


def _mean_on_hands(beside: FloatArray, on_hands: BoolArray) -> float:
    """M, of instants (T,) in which a hand touches; 0 where these are few."""
    return float(beside[on_hands].mean()) if on_hands.mean() > MOST else 0.0


def _on_hands(t: Transcription, times: FloatArray) -> BoolArray:
    """(T,) whether a hand touches."""
    hands = [c.contact for c in t.contacts if c.contact.touch.is_of_hand]
    return _during(times, [(hand.start, hand.end) for hand in hands])


def weight_beside(motion: Motion, times: FloatArray) -> FloatArray:
    """(T,) m, by how much one force that does what all do, the unseen among them, would meet the
    ground beside what touches; 0 where nothing touches, or what carries is small."""
    t = motion.transcription
    touching = np.array([_during(times, [(c.contact.start, c.contact.end)]) for c in t.contacts])
    points, forces = motion.contact_points(times), motion.forces(times)
    tracks = np.swapaxes(points[:, [c.point for c in t.contacts]], 0, 1)
    ground = np.where(touching, tracks[..., 2], 0.0).sum(axis=0)
    high = points[..., 2] - (ground / np.maximum(touching.sum(axis=0), 1))[:, None]
    upwards = forces[..., 2].sum(axis=1)
    loaded = upwards > LOADED * t.character.mass * STANDARD_GRAVITY
    arms = points[..., :2] * forces[..., 2:] - high[..., None] * forces[..., :2]
    meets = arms.sum(axis=1) / np.where(loaded, upwards, np.inf)[:, None]
    return np.where(loaded, outside(meets, tracks[..., :2], touching), 0.0)


def support_intervals(
    times: FloatArray, carries: BoolArray, acts: BoolArray
) -> list[tuple[int, int]]:
    """First and last index of each interval in which something (T,) carries, and of those between
    them in which it acts all the same, in order. What is nearer than APART is one, and so long a
    one between is at least: a force that rises or fades acts before it carries."""
    carried = _joined(times, carries)
    lasting = [
        (first + a, first + b)
        for first, last in runs(_between(carried, len(times)))
        for a, b in _joined(times[first : last + 1], acts[first : last + 1])
        if times[first + b] - times[first + a] > APART
    ]
    return sorted([*carried, *lasting])


def _between(parts: Sequence[tuple[int, int]], count: int) -> BoolArray:
    """(count,) whether an index is in none of the parts (first, last)."""
    between = np.ones(count, dtype=bool)
    for first, last in parts:
        between[first : last + 1] = False
    return between


def _joined(times: FloatArray, mask: BoolArray) -> list[tuple[int, int]]:
    """The runs of a mask (T,), those in one that are nearer than APART."""
    joined: list[tuple[int, int]] = []
    for first, last in runs(mask):
        near = bool(joined) and times[first] - times[joined[-1][1]] <= APART
        joined.append((joined.pop()[0] if near else first, last))
    return joined


def hints_left(
    told: Sequence[CarriedBy], result: Report, schedule: ContactSchedule, recording: Recording
) -> list[CarriedBy]:
    """What an analysis told of a recording, of weight beside what touches no more than where a
    result still has something unseen carry it, and no point of the artist's, and nothing of hands
    that hold on where such points do.

    schedule: the result's. Frames stay the recording's, by which points and contacts are asked for.
    """
    frames, rate = recording.frames, recording.rate
    carried = [(u.first_frame, u.last_frame) for u in result.unseen_support if u.force_bw > CARRIES]
    points = [
        (frames[0] + rate * c.start, frames[0] + rate * c.end)
        for c in schedule.contacts
        if c.asked_for
    ]
    asked = _during(frames, _as_recorded(points, result))
    left = _during(frames, _as_recorded(carried, result)) & ~asked

    def cut(spans: Sequence[Span]) -> tuple[Span, ...]:
        some = runs(_during(frames, spans) & left)
        lasting = ((frames[a], frames[b]) for a, b in some if b - a >= SURELY_LASTS * rate)
        return tuple((float(first), float(last)) for first, last in lasting)

    def kept(hint: OffBalance) -> OffBalance:
        spans = cut(hint.spans)
        hands = tuple(h for h in hint.hands if _overlap((h.start_frame, h.end_frame), spans))
        holds = tuple(h for h in hint.holds if _overlap(h.when.frames, spans))
        return replace(hint, spans=spans, resting=cut(hint.resting), hands=hands, holds=holds)

    def is_left(hint: CarriedBy) -> bool:
        if isinstance(hint, UnseenSupport) and hint.holds:
            return bool(asked[_during(frames, [(hint.first, hint.last)])].mean() <= MOST)
        return not isinstance(hint, OffBalance) or bool(hint.spans)

    return [*filter(is_left, (kept(e) if isinstance(e, OffBalance) else e for e in told))]


def _overlap(frames: Span | None, spans: Sequence[Span]) -> bool:
    """Whether frames, from first to last, None for all, share any with one of some spans."""
    return frames is None or any(frames[0] < span[1] and frames[1] > span[0] for span in spans)


def _as_recorded(spans: Sequence[Span], result: Report) -> list[Span]:
    """A result's frames in the recording's."""
    corners = result.times.adapted_frame, result.times.recorded_frame
    return [(float(first), float(last)) for first, last in (np.interp(s, *corners) for s in spans)]


def _during(frames: FloatArray, spans: Sequence[Span]) -> BoolArray:
    """(T,) which frames, or instants, are in one of some spans."""
    inside = np.zeros(len(frames), dtype=np.bool_)
    for first, last in spans:
        inside |= (frames >= first) & (frames <= last)
    return inside


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
