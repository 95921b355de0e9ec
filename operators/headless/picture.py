"""The pictures of a result: the body at instants, with what holds it (thesis 6)."""

from collections.abc import Iterable, Iterator, Sequence, Set
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

import numpy as np

from ...bridge.picture.annotations import Bar, Mark, Sphere, Thing, TimeSpan
from ...bridge.picture.film import draw_film
from ...bridge.picture.layout import RAISED, canvas_axes
from ...bridge.picture.render import draw_sheet
from ...bridge.picture.sheet import Limb, SheetRow, View
from ...solver.analysis.performance import above_ground, contact_points
from ...solver.analysis.pins.pinned_places import facing
from ...solver.arrays import FloatArray
from ...solver.body.anatomy import Part
from ...solver.body.character import Character
from ...solver.data.constants import UP
from ...solver.data.contacts import Phase, PhaseKind
from ...solver.data.problem import MotionProblem, OffsetAxes, Pin
from ...solver.scene.steep import is_steep
from ...solver.scene.support import points_up
from ...solver.stages.implicit import Adaptation
from ...solver.transcription.motion import Motion

FEET = (Part.FOOT, Part.TOE)
BESIDE_HANDS = 0.3  # m, how far a bar reaches beyond the hands that hold it
POST = 0.09  # m, radius of what a hand rests on
TRAVELS = 0.3  # m, less is no direction
SIDEWAYS = 0.1  # m, from where on a change is hardly seen from the side
APART = 1.05  # halves of a pelvis, as long as it is drawn; a joint farther off leaves a gap


def draw(adaptation: Adaptation, rows: Sequence[SheetRow], path: Path) -> None:
    """`both_rows`, the recording above, as a PNG file; where contacts went sideways both once more,
    from above. Raises OutputNotWritable."""
    view = View(heading=heading(adaptation))
    draw_sheet(
        rows, path, replace(view, above=goes_sideways(adaptation, canvas_axes(rows, view.heading)))
    )


def draw_moving(adaptation: Adaptation, rows: Sequence[SheetRow], path: Path) -> None:
    """What `draw` draws as a film: an MPEG-4 file. Raises OutputNotWritable."""
    draw_film(rows, path, View(heading=heading(adaptation)))


def both_rows(
    adaptation: Adaptation,
    problem: MotionProblem,
    recorded: Sequence[Mark] = (),
    adapted: Sequence[Mark] = (),
) -> tuple[SheetRow, SheetRow]:
    """The recording, and the adapted motion with what was asked for as its title.

    recorded, adapted: marks; their arrays are constant, or sampled at the recording's instants and
    at `instants(adaptation.motion)`.
    """
    asked = [*map(caption, problem.pins), *problem.requests.names]
    edit = "; ".join(asked) or "made to obey physics"
    title = f"Adapted: {edit}"
    return recorded_row(adaptation, recorded), adapted_row(adaptation, title, adapted)


def heading(adaptation: Adaptation) -> tuple[float, float]:
    """Direction to the right in the picture: of the recording's travel, so that a diagonal shows as
    one, else of the mean travel of recording and result. Who hardly travels faces that way at the
    start: later he may stand on his hands."""
    performance, motion = adaptation.fit.performance, adaptation.motion
    recorded, adapted = performance.com, motion.com(np.array([0.0, motion.duration]))
    was, now = (com[-1, :2] - com[0, :2] for com in (recorded, adapted))
    ways = [way for way in (was, 0.5 * (was + now)) if np.linalg.norm(way) > TRAVELS]
    x, y = (ways or [facing(performance, 0.0)[:2]])[0].tolist()
    return x, y


def goes_sideways(adaptation: Adaptation, axes: FloatArray) -> bool:
    """Whether contacts went to the side of the picture's axes (3, 3)."""
    moved = adaptation.motion.places - adaptation.setup.fitted.places
    return bool((np.abs(moved @ axes[1]) > SIDEWAYS).any())


def instants(motion: Motion, rate: float = 120.0) -> FloatArray:
    """(T,) s, at which a motion's row, and marks that vary, are sampled."""
    return np.linspace(0.0, motion.duration, max(2, round(motion.duration * rate) + 1))


def recorded_row(adaptation: Adaptation, marks: Sequence[Mark] = ()) -> SheetRow:
    """The recording with the contacts found in it."""
    performance, schedule = adaptation.fit.performance, adaptation.fit.schedule
    parts = {body.bone: body.part for body in performance.character.bodies}
    depths = above_ground(schedule.contacts, performance.character, schedule.floor_m).tolist()
    walls = on_walls(adaptation)
    held = [
        ContactHold(parts[c.bone], c.place, (c.start, c.end), False, depth, c.name in walls)
        for c, depth in zip(schedule.contacts, depths, strict=True)
    ]
    feet = [hold for hold in held if hold.stands]
    others = [hold for hold in held if not hold.stands]
    beside = (*(Sphere(hold.place, hold.span) for hold in others), *marks)
    if not any(isinstance(mark, Thing) for mark in marks):
        beside += tuple(posts(others, schedule.floor_m, performance.times, performance.com))
    return SheetRow(
        f"Recording: {performance.recording.name}",
        performance.times,
        tuple(limbs(performance.character, performance.rotations, performance.centres)),
        performance.com,
        np.array([hold.place for hold in feet]).reshape(-1, 3),
        key_times(adaptation.fit.motion, schedule.phases),
        tuple(hold.span for hold in feet),
        beside,
    )


def adapted_row(adaptation: Adaptation, title: str, marks: Sequence[Mark] = ()) -> SheetRow:
    """The adapted motion with its contacts: spheres, and a bar where hands hold on."""
    motion, phases = adaptation.motion, adaptation.setup.schedule.phases
    t, times = motion.transcription, instants(motion)
    posed, com = motion.pose(times), motion.com(times)
    floor = adaptation.setup.schedule.floor_m
    holds = tuple(contact_holds(motion, times, floor, on_walls(adaptation)))
    feet = [hold for hold in holds if hold.stands]
    others = [hold for hold in holds if not hold.stands]
    ground = [*adaptation.fit.places[:, 2], *(hold.place[2] for hold in feet)]
    beside = (*(Sphere(hold.place, hold.span) for hold in others), *bars(others), *marks)
    if not any(isinstance(mark, Thing) for mark in marks):
        beside += tuple(posts(others, min(ground, default=floor), times, com))
    return SheetRow(
        title,
        times,
        tuple(limbs(t.character, posed.rotations, posed.centres + com[:, None])),
        com,
        np.array([hold.place for hold in feet]).reshape(-1, 3),
        key_times(motion, phases),
        tuple(hold.span for hold in feet),
        beside,
        min(ground, default=None),
    )


@dataclass(frozen=True, eq=False)
class ContactHold:
    """Place, m, and interval of a contact of one part of the body.

    place: (3,), or (T, 3) where it moves. grip: whether the part holds on there. depth: m from the
    place down to what a part that does not rests on. wall: whether it is against something steep.
    """

    part: Part
    place: FloatArray
    span: TimeSpan
    grip: bool
    depth: float = 0.0
    wall: bool = False

    @property
    def stands(self) -> bool:
        """Whether a foot stands there on ground that stays."""
        return self.part in FEET and self.place.ndim == 1 and not self.wall


def on_walls(adaptation: Adaptation) -> frozenset[str]:
    """The names of contacts against something steep: by the scene, or by soles as recorded."""
    performance, schedule = adaptation.fit.performance, adaptation.fit.schedule
    contacts = adaptation.motion.transcription.contacts
    found = {c.contact.name for c in contacts if is_steep(c.normal[None])[0]}
    points, times = contact_points(performance)[0], performance.times
    for contact in schedule.contacts:
        if contact.point in points and points[contact.point].kind.is_of_foot:
            middle = 0.5 * (contact.start + contact.end)
            if points_up(points, contact.point)[np.abs(times - middle).argmin()]:
                found.add(contact.name)
    return frozenset(found)


def contact_holds(
    motion: Motion, times: FloatArray, floor: float, walls: Set[str] = frozenset()
) -> Iterator[ContactHold]:
    """Every contact of a motion; where it moves, at the instants (T,). floor: m, as recorded.
    walls: the names of those against something steep."""
    t = motion.transcription
    depths = above_ground([each.contact for each in t.contacts], t.character, floor).tolist()
    for contact, place, depth in zip(t.contacts, motion.places, depths, strict=True):
        body = t.character.bodies[t.points[contact.point].body]
        span = (contact.contact.start, contact.contact.end)
        if contact.track is not None or contact.ride is not None:
            rigid = replace(contact, sole=None)
            place = rigid.holds(np.clip(times, *span)).of(place)
        wall = contact.contact.name in walls
        yield ContactHold(body.part, place, span, contact.friction is None, depth, wall)


def posts(
    holds: Iterable[ContactHold], floor: float, times: FloatArray, com: FloatArray
) -> Iterator[Bar]:
    """A post from the floor, m, to each hand or knee that rests above it, so that it does not hang
    in the air; whoever hangs rests on nothing. com: (T, 3) m, at `times` (T,) s."""
    for hold in holds:
        top = hold.place - hold.depth * UP
        body = np.interp(np.mean(hold.span), times, com[:, 2])
        rests = not hold.grip and not hold.wall
        if rests and floor + RAISED < top[..., 2].min() and top[..., 2].max() < body:
            yield Bar(top * [1.0, 1.0, 0.0] + floor * UP, top, POST, hold.span)


def bars(holds: Sequence[ContactHold]) -> Iterator[Bar]:
    """A level bar through each two hands that hold on at the same time."""
    hands = [hold for hold in holds if hold.part is Part.HAND and hold.grip]
    for one, other in combinations(hands, 2):
        span = max(one.span[0], other.span[0]), min(one.span[1], other.span[1])
        along = (other.place - one.place) * [1.0, 1.0, 0.0]
        length = np.linalg.norm(along, axis=-1, keepdims=True)
        if span[0] < span[1] and length.min() > 1e-3:
            reach = (0.5 + BESIDE_HANDS / length) * along
            middle = 0.5 * (one.place + other.place)
            yield Bar(middle - reach, middle + reach, span=span)


def limbs(character: Character, rotations: FloatArray, centres: FloatArray) -> Iterable[Limb]:
    """Every body's box at (T, B) rotations and joint centres, m, world; the pelvis reaches to the
    spine's joint, which on some figures is a hand's breadth above it."""
    for i, body in enumerate(character.bodies):
        along, half = body.box_rotation[:, 2], 0.5 * body.box_size[2]
        ends = np.array([-half, half])
        for joint, other in zip(character.joints, character.bodies, strict=True):
            if joint.parent == i and body.part is Part.PELVIS and other.part is Part.SPINE:
                there = float(along @ (joint.offset - body.box_centre))
                if abs(there) > APART * half:
                    ends = np.array([min(-half, there), max(half, there)])
        size = np.append(body.box_size[:2], ends[1] - ends[0])
        turn = rotations[:, i]
        middle = centres[:, i] + turn @ (body.box_centre + ends.mean() * along)
        yield Limb(body.name, size, middle, turn @ body.box_rotation)


def key_times(motion: Motion, phases: Iterable[Phase]) -> tuple[float, ...]:
    """Take-off and landing of every flight, then its apex, s."""
    edges: list[float] = []
    apexes: list[float] = []
    for phase in phases:
        if phase.kind is PhaseKind.FLIGHT:
            during = np.linspace(phase.start, phase.end, 100)
            edges += [phase.start, phase.end]
            apexes.append(float(during[motion.com(during)[:, 2].argmax()]))
    return (*edges, *apexes)


def caption(pin: Pin) -> str:
    """Such as "Landing: 0.3 m forward, 0.2 m up, turned by 90°"."""
    words = []
    if pin.place is not None:
        words.append(f"to ({', '.join(f'{x:g}' for x in pin.place)}) m")
    if pin.axes is OffsetAxes.WORLD and any(pin.offset):
        words.append(f"by ({', '.join(f'{x:g}' for x in pin.offset)}) m")
    elif pin.axes is OffsetAxes.TRAVEL:
        ways = (("forward", "back"), ("left", "right"), ("up", "down"))
        for amount, (ahead, behind) in zip(pin.offset, ways, strict=True):
            if amount:
                words.append(f"{abs(amount):g} m {ahead if amount > 0.0 else behind}")
    if pin.turn:
        words.append(f"turned by {np.degrees(pin.turn):.4g}°")
    return f"{pin.name}: {', '.join(words) or 'held'}"
