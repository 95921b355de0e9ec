"""What carries the body where no contact does, as far as the recording tells."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import BoolArray
from ..body.anatomy import Part, Side
from ..data.contacts import ContactSchedule, Interval, PointKind
from ..data.faults import OffBalance, Treadmill, UnseenSupport
from ..data.problem import AddedContact
from ..data.recording import Recording
from ..data.requests import PointRequest, When
from ..data.scene import SupportBox
from ..numerics.runs import runs
from ..scene.belt import belt_speed
from ..scene.fall_rate import fitting_rate, is_pulled_down
from ..scene.support import boxes_beneath, feet_stay, steps_on_walls
from ..unseen.held import is_held
from ..unseen.held_hands import Grasp, HandTracks, holds
from ..unseen.support_force import HAND_OVER
from .balance import (
    LASTS,
    SURELY_LASTS,
    lasting,
    low_palms,
    off_balance,
    palms_at_rest,
    pelvis_at_rest,
    smoothing,
    touches_during,
)
from .performance import Performance, contact_points, find_contacts, leans, low_feet

MOST = 2.0 / 3.0  # of the time in the air, in which the body falls at another rate than the scene's
LEANING_SHARE = 0.2  # of a gap, in which hands or knees on the floor may be what carries the body
HELD_SHARE = 0.5  # of a gap, in which hands that hold on may be what carries the body
LOW_SHARE = 0.9  # of a gap, in which a foot or hand on the floor touches all the same
SKIDS = 0.03  # m, to either side, of a foot on the floor; one that stands rolls and turns by less


def unseen_carriers(
    performance: Performance, schedule: ContactSchedule, skids: Sequence[Interval]
) -> Iterator[UnseenSupport | Treadmill]:
    """What is known of each interval in which something unseen carries the body.

    skids: in which feet go from place to place under load.
    """
    if not schedule.unseen:
        return
    points, floor_m = contact_points(performance)
    if speed := belt_speed(performance.times, points):
        yield Treadmill(speed)
        return
    recording = performance.recording
    agreed = agreed_rate(performance, schedule)
    beside = off_balance(performance, schedule, SURELY_LASTS)
    needed = _needs_more(performance, schedule, beside)
    low, slid = (each(performance, schedule.unseen) for each in (_on_floor, skids_in))
    for gap in schedule.unseen:
        first, last = _frame(recording, gap.start), _frame(recording, gap.end)
        if any(skid.start <= gap.start and gap.end <= skid.end for skid in skids):
            yield UnseenSupport(first, last, skidding=True)
            continue
        rate = agreed if _fitting_rate(performance, gap, floor_m) == agreed else None
        boxes: tuple[SupportBox, ...] = ()
        hands: tuple[AddedContact, ...] = ()
        walls: tuple[AddedContact, ...] = ()
        leaning = _leans(performance, gap, floor_m)
        # Who falls at another rate holds on to nothing: `_fitting_rate` has asked by places.
        held = () if leaning or rate is not None else _held(performance, schedule, gap, needed)
        if leaning:
            hands = _hands(performance, schedule, gap, low_palms(performance))
        elif rate is None and (not held or feet_stay(points, _inside(performance, gap))):
            # Who stands on a platform with raised hands may hang as well, and so both are told.
            boxes = boxes_beneath(performance.times, points, gap, floor_m)
            walls = () if boxes or held else _on_walls(performance, gap)
        on_floor = rate is None and not boxes and not held and gap in low
        yield UnseenSupport(
            *(first, last, boxes, hands, rate, recording.rate),
            leaning=leaning,
            skidding=on_floor and gap in slid,
            resting=on_floor and gap not in slid,
            walls=walls,
            holds=held,
        )


def weight_beside(performance: Performance, schedule: ContactSchedule) -> Iterator[OffBalance]:
    """Where the weight is beside what touches for so long that it is no fault of the capture: on
    hands, with their contacts; of who hangs, with what hands hold; where more than feet touches,
    with what does; and else, with when the pelvis rests. Who sits on the floor has hands on it that
    carry little."""
    found = off_balance(performance, schedule, SURELY_LASTS)
    palms = palms_at_rest(performance)
    still, low = pelvis_at_rest(performance)

    def hands(gap: Interval) -> tuple[AddedContact, ...]:
        sits = (still & low)[_inside(performance, gap)].mean() > LEANING_SHARE
        return () if sits else _hands(performance, schedule, gap, palms)

    added = {gap: hands(gap) for gap in found}
    leaning, others = ([gap for gap in found if bool(added[gap]) is on] for on in (True, False))
    if leaning:
        contacts = dict.fromkeys(contact for gap in leaning for contact in added[gap])
        yield OffBalance(_spans(performance, leaning), tuple(contacts))
    needed = _needs_more(performance, schedule, found)
    held = {gap: _held(performance, schedule, gap, needed) for gap in others}
    if hanging := [gap for gap in others if held[gap]]:
        points = dict.fromkeys(point for gap in hanging for point in held[gap])
        touching = _touching(performance, schedule, hanging)
        yield OffBalance(_spans(performance, hanging), touching=touching, holds=tuple(points))
    beyond, rest = _beyond_feet(performance, schedule), [gap for gap in others if not held[gap]]
    more, feet = (
        [part for gap in rest for part in lasting(performance, mask, gap, LASTS)]
        for mask in (beyond, ~beyond)
    )
    if more:
        touching = _touching(performance, schedule, more)
        yield OffBalance(_spans(performance, more), touching=touching)
    if feet:
        rests = [part for gap in feet for part in lasting(performance, still, gap, SURELY_LASTS)]
        yield OffBalance(_spans(performance, feet), resting=_spans(performance, rests))


def _beyond_feet(performance: Performance, schedule: ContactSchedule) -> BoolArray:
    """(T,) whether something else touches than feet, which may do so beside it."""
    points = {c.point for c in schedule.contacts if not c.touch.is_of_foot}
    touches = [touches_during(performance.times, schedule, point) for point in points]
    return np.any(touches, axis=0) if touches else np.zeros(len(performance.times), dtype=np.bool_)


def _touching(
    performance: Performance, schedule: ContactSchedule, intervals: Sequence[Interval]
) -> tuple[str, ...]:
    """The limbs that touch for a good part of some intervals."""
    limbs = {c.point: c.touch.limb for c in schedule.contacts}
    during = np.any([_inside(performance, each) for each in intervals], axis=0)
    lasting = (
        limb
        for point, limb in limbs.items()
        if touches_during(performance.times, schedule, point)[during].mean() > LEANING_SHARE
    )
    return tuple(dict.fromkeys(lasting))


def _held(
    performance: Performance, schedule: ContactSchedule, gap: Interval, needed: BoolArray
) -> tuple[PointRequest, ...]:
    """Points for the hands from which the body hangs in most of a gap, as far as it does not fly;
    none where they hold on for less. needed: (T,) as of `_needs_more`, which a hold may outlast: of
    who stands below a bar with the hands on it, they carry nothing."""
    times, frames = performance.times, performance.recording.frames
    aloft = np.zeros(len(times), dtype=np.bool_)
    for flight in schedule.flights:
        aloft |= (times > flight.start) & (times < flight.end)
    inside, carried = _inside(performance, gap), np.zeros_like(aloft)
    found = []
    for side in (Side.LEFT, Side.RIGHT):
        body, tracks = performance.character.body(Part.HAND, side), _hand(performance, side)
        if body is None or tracks is None:
            continue
        for hold in holds(times, tracks, smoothing(performance)):
            for first, last in _parts(hold, needed | aloft):
                on = np.arange(first, last + 1)[~aloft[first : last + 1]]
                within = on[inside[on]]
                if len(within) == 0 or times[within[-1]] - times[within[0]] < LASTS:
                    continue
                carried[on] = True
                grasp = float(frames[on[0]]), float(frames[on[-1]])
                found.append(
                    PointRequest(
                        # By when, for a hand may hold on twice, and a recipe wants names apart.
                        f"{side.value.capitalize()} hand holds on from {grasp[0]:g}",
                        performance.character.bodies[body].bone,
                        When(frames=grasp),
                        offset=(0.0, 0.0, 0.0) if hold.by_joint else None,
                        environment=True,
                        grip=True,
                    )
                )
    return tuple(found) if carried[inside].mean() >= HELD_SHARE else ()


def _parts(hold: Grasp, where: BoolArray) -> list[tuple[int, int]]:
    """First and last frame (index) of the parts of a hold in which something (T,) is true."""
    within = runs(where[hold.first : hold.last + 1])
    return [(hold.first + first, hold.first + last) for first, last in within]


def _needs_more(
    performance: Performance, schedule: ContactSchedule, beside: Sequence[Interval]
) -> BoolArray:
    """(T,) when something else carries the body than what touches, or shares the load with it
    before and after. beside: in which the weight is beside what touches."""
    needed = np.zeros(len(performance.times), dtype=np.bool_)
    for each in (*schedule.unseen, *beside):
        around = Interval(each.start - HAND_OVER, each.end + HAND_OVER)
        needed |= _inside(performance, around)
    return needed


def _hand(performance: Performance, side: Side) -> HandTracks | None:
    """None where the figure has no such hand."""
    character, centres = performance.character, performance.centres
    hand, head = character.body(Part.HAND, side), character.body(Part.HEAD)
    if hand is None or head is None:
        return None
    middle = performance.rotations[:, hand] @ (0.5 * character.bodies[hand].tip)
    joint = centres[:, hand]
    return HandTracks(joint, joint + middle, centres[:, head], centres[:, 0])


def _spans(
    performance: Performance, intervals: Iterable[Interval]
) -> tuple[tuple[float, float], ...]:
    """Scene frames."""
    recording = performance.recording
    return tuple((_frame(recording, each.start), _frame(recording, each.end)) for each in intervals)


def _on_walls(performance: Performance, gap: Interval) -> tuple[AddedContact, ...]:
    """The contacts of feet that rest on something steep during a gap."""
    recording, points = performance.recording, contact_points(performance)[0]
    return tuple(
        AddedContact(name, _frame(recording, step.start), _frame(recording, step.end))
        for name, step in steps_on_walls(performance.times, points, gap)
    )


def _hands(
    performance: Performance,
    schedule: ContactSchedule,
    gap: Interval,
    down: Mapping[str, BoolArray],
) -> tuple[AddedContact, ...]:
    """The contacts of hands that would carry the body through a gap beside those that are known.
    None where they do not last. down: (T,) by hand, when it is on the floor."""
    times, frames = performance.times, performance.recording.frames
    inside = _inside(performance, gap)
    carried, found = np.zeros_like(inside), list[AddedContact]()
    for name, low in down.items():
        for first, last in runs(low & ~touches_during(times, schedule, name)):
            run = slice(first, last + 1)
            lasts = times[last] - times[first] >= PointKind.HAND.value.min_duration
            if lasts and inside[run].any():
                carried[run] = True
                found.append(AddedContact(name, float(frames[first]), float(frames[last])))
    return tuple(found) if carried[inside].mean() >= LOW_SHARE else ()


def agreed_rate(performance: Performance, schedule: ContactSchedule) -> float | None:
    """The frame rate at which the body falls most of the time in which nothing touches; None where
    there is none: a clock that is wrong is so in every flight. At a true rate feet only push."""
    seconds: defaultdict[float | None, float] = defaultdict(float)
    for gap in schedule.unseen:
        seconds[_fitting_rate(performance, gap, schedule.floor_m)] += gap.end - gap.start
    aloft = sum(seconds.values()) + sum(flight.end - flight.start for flight in schedule.flights)
    agreed = next((rate for rate, spent in seconds.items() if spent > MOST * aloft), None)
    if agreed is None or _is_pulled_down(_played_at(performance, agreed)):
        return None
    return agreed


def _played_at(performance: Performance, rate: float) -> Performance:
    """The same frames at another rate, Hz, with which nothing is known of their contacts."""
    slower = performance.recording.rate / rate
    recording = replace(performance.recording, times=slower * performance.times, known=())
    longer = performance.longer and _played_at(performance.longer, rate)
    return replace(performance, recording=recording, longer=longer)


def _is_pulled_down(performance: Performance) -> bool:
    """Whether contacts, as they are found, would have to pull the body down."""
    times, carried = performance.times, np.zeros(len(performance.times), bool)
    for contact in find_contacts(performance).contacts:
        carried |= (times >= contact.start) & (times <= contact.end)
    return is_pulled_down(times, performance.com[:, 2], carried)


def _fitting_rate(performance: Performance, gap: Interval, floor_m: float) -> float | None:
    """The frame rate at which the body falls in a gap; None where that does not explain it."""
    if _leans(performance, gap, floor_m):
        return None
    inside = _inside(performance, gap)
    heights = performance.com[inside, 2]
    rate = fitting_rate(performance.times[inside], heights, performance.recording.rate)
    return None if rate is None or is_held_in(performance, inside) else rate


def is_held_in(performance: Performance, within: BoolArray | slice) -> bool:
    """Whether in some frames of a recording, one after the other, something holds the body by the
    places of its joints and tips."""
    tips = np.stack([body.tip for body in performance.character.bodies])
    centres = performance.centres[within]
    ends = centres + np.einsum("tbij,bj->tbi", performance.rotations[within], tips)
    parts = np.concatenate([centres, ends], axis=1)
    return is_held(parts, performance.com[within], performance.character.height)


def _leans(performance: Performance, gap: Interval, floor_m: float) -> bool:
    """Whether another part of the body than a foot is on the floor in a good part of a gap, and may
    carry it: a hand that sweeps past the floor for a frame carries nothing."""
    leaning = leans(performance, floor_m)[_inside(performance, gap)]
    return bool(leaning.size and leaning.mean() > LEANING_SHARE)


def skids_in(performance: Performance, gaps: Sequence[Interval]) -> tuple[Interval, ...]:
    """The gaps between contacts in which feet are on the floor and slide, rather than something
    else carrying the body."""
    points, floor_m = contact_points(performance)

    def slides(gap: Interval) -> bool:
        inside, ways = _inside(performance, gap), [0.0]
        for point in points.values():
            if point.kind.is_of_foot:
                low = point.track[:, 2] - floor_m < point.max_height
                places = point.track[inside & low, :2]
                ways += np.ptp(places, axis=0).tolist() if len(places) else []
        return max(ways) > SKIDS

    return tuple(filter(slides, _on_floor(performance, gaps)))


def _on_floor(performance: Performance, gaps: Sequence[Interval]) -> tuple[Interval, ...]:
    """The gaps between contacts in which feet are on the floor, and no other part of the body: a
    foot that swings past the floor is as low for a moment."""
    if not gaps:
        return ()
    points, floor_m = contact_points(performance)
    low = low_feet(points, floor_m)

    def on_floor(gap: Interval) -> bool:
        during = low[_inside(performance, gap)]
        touching = bool(during.size and during.mean() >= LOW_SHARE)
        return touching and not _leans(performance, gap, floor_m)

    return tuple(filter(on_floor, gaps))


def _inside(performance: Performance, gap: Interval) -> BoolArray:
    return (performance.times >= gap.start) & (performance.times <= gap.end)


def _frame(recording: Recording, time: float) -> float:
    """Nearest scene frame of an instant, s."""
    return float(round(recording.frames[0] + time * recording.rate))
