"""Contact schedule: contacts of body points with the ground, and the ground and flight phases."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import count

from ..arrays import FloatArray

COUNTED = re.compile(r"(ground|flight) \d+")  # a phase's name, as the analysis gives it


class PhaseKind(Enum):
    """Ground phase (supported) or flight phase (ballistic)."""

    GROUND = "ground"
    FLIGHT = "flight"


@dataclass(frozen=True)
class ContactThresholds:
    """Contact-detection thresholds of one kind of point.

    max_height (m above the floor) and max_speed (m/s) must both hold for a point to touch at all.
    landing_height: m above the lowest to which the point then sinks, lift_off_height: m by which
    its sole is above its usual height in this contact; at which its force begins and ends, roughly:
    a sole is pressed when it is a little up. max_slip_speed: m/s along the floor. min_rest: s, for
    which it stays low and slow. min_duration: s; the shortest contact believed.
    """

    max_height: float
    max_speed: float
    landing_height: float
    lift_off_height: float
    max_slip_speed: float
    min_rest: float
    min_duration: float


class PointKind(Enum):
    """Kinds of contact point; thresholds set on recordings with measured ground forces."""

    HEEL = ContactThresholds(
        max_height=0.02,
        max_speed=0.5,
        landing_height=0.015,
        lift_off_height=0.015,
        max_slip_speed=2.0,
        min_rest=0.0,
        min_duration=0.04,
    )
    TOE = ContactThresholds(
        max_height=0.05,
        max_speed=0.5,
        landing_height=0.02,
        lift_off_height=0.024,
        max_slip_speed=2.0,
        min_rest=0.0,
        min_duration=0.04,
    )
    HAND = ContactThresholds(
        max_height=0.035,
        max_speed=0.15,
        landing_height=0.015,
        lift_off_height=0.015,
        max_slip_speed=0.3,
        min_rest=0.15,  # where it turns back in the air a hand is slow for half of that
        min_duration=0.15,
    )
    KNEE = ContactThresholds(
        max_height=0.035,
        max_speed=0.15,
        landing_height=0.015,
        lift_off_height=0.015,
        max_slip_speed=0.3,
        min_rest=0.2,
        min_duration=0.2,
    )

    @property
    def is_of_foot(self) -> bool:
        """Whether it is of what people stand on."""
        return self in (PointKind.HEEL, PointKind.TOE)


@dataclass(frozen=True)
class ContactPoint:
    """A candidate contact point. offset: (3,) m, bone-local. track: (T, 3) m, world, Z up.

    hip: (T, 3) m, world; where the leg that ends in the point begins. pressing: (T, 3) m, world;
    the part of the sole that the load is first and most on, where that is not the point itself.
    depth: m; of the point within its part, and so its height where that rests on the floor.
    """

    kind: PointKind
    bone: str
    offset: FloatArray
    track: FloatArray
    hip: FloatArray | None = None
    pressing: FloatArray | None = None
    depth: float = 0.0

    @property
    def max_height(self) -> float:
        """M above the ground, up to which the point may touch it."""
        return self.depth + self.kind.value.max_height

    def part(self, frames: slice) -> "ContactPoint":
        """The same point during some of the frames."""
        hip, pressing = (
            None if track is None else track[frames] for track in (self.hip, self.pressing)
        )
        return replace(self, track=self.track[frames], hip=hip, pressing=pressing)


@dataclass(frozen=True)
class Contact:
    """Interval during which one point of one bone touches.

    name: the point and its count in time, such as "Left heel 2"; point: "Left heel".
    offset: (3,) m, bone-local, from the bone's head. place: (3,) m, world, Z up.
    start, end: s; the instants at which the force begins and ends. A contact that the clip cuts
    off starts at 0 or ends at the schedule's duration. rise: m above its place at these two; the
    sole gives as much. on: the object of the scene that the recording has it on, None: the floor.
    slack: m by which its point may miss its place; 0 but where no motion holds it exactly.
    """

    name: str
    point: str
    bone: str
    offset: FloatArray
    start: float
    end: float
    place: FloatArray
    rise: tuple[float, float] = (0.0, 0.0)
    on: str | None = None
    slack: float = 0.0

    @property
    def touch(self) -> "Touch":
        """Its point and its time, s."""
        return Touch(self.point, self.start, self.end)

    @property
    def asked_for(self) -> bool:
        """Whether the artist made it; those that were found are numbered."""
        return self.name == self.point


@dataclass(frozen=True)
class KnownContacts:
    """All contacts in frames of a recording that an adaptation wrote, on ground that stays.

    first, last: scene frames. contacts: points, such as "Left heel", each with the scene frames at
    which its force begins and ends.
    """

    first: float
    last: float
    contacts: tuple[tuple[str, float, float], ...]


@dataclass(frozen=True)
class Touch:
    """When a point, such as "Left heel", touches; by any clock."""

    point: str
    start: float
    end: float

    @property
    def limb(self) -> str:
        """Such as "Left foot"; a hand, or a point of the artist's own, is one by itself."""
        return f"{self.point.rpartition(' ')[0]} foot" if self.is_of_foot else self.point

    @property
    def leg(self) -> str:
        """Its limb, but of a knee the foot that the shank ties to it."""
        side, _, part = self.point.rpartition(" ")
        return f"{side} foot" if part == "knee" else self.limb

    @property
    def is_of_foot(self) -> bool:
        """Whether its point is on a sole."""
        return self.point.rpartition(" ")[2] in ("heel", "toe")

    @property
    def is_of_hand(self) -> bool:
        """Whether its point is in a palm."""
        return self.point.rpartition(" ")[2] == "hand"


@dataclass(frozen=True)
class Interval:
    """A time interval [start, end], s."""

    start: float
    end: float


@dataclass(frozen=True)
class Phase:
    """A ground or flight phase [start, end], s; number counts from 1 in each kind."""

    kind: PhaseKind
    number: int
    start: float
    end: float

    @property
    def name(self) -> str:
        """Such as "flight 1"."""
        return f"{self.kind.value} {self.number}"

    def overlaps(self, other: "Phase") -> bool:
        """Whether both are of one kind and share some time."""
        together = min(self.end, other.end) > max(self.start, other.start)
        return self.kind is other.kind and together


def is_phase_name(name: str) -> bool:
    """Whether a name is read as that of a phase, whatever its capitals and spaces."""
    return COUNTED.fullmatch(" ".join(name.casefold().split())) is not None


def phase_title(name: str) -> str:
    """A phase's name as a line begins with it; a held frame's is the artist's, and stays."""
    return name.capitalize() if COUNTED.fullmatch(name) else name


@dataclass(frozen=True)
class ContactSchedule:
    """All contacts of a clip of `duration` s, by start; floor_m is the floor's height, m, world.

    unseen: intervals without a contact in which the body does not fall, so something that the
    recording does not show carries it (a box, a rail, a drifting floor): they are not flights.
    numbers: of its phases in order, as the schedule that it was made of has them; where its phases
    are others, and without any, each kind is counted on from the first.
    """

    contacts: tuple[Contact, ...]
    duration: float
    floor_m: float
    unseen: tuple[Interval, ...] = ()
    numbers: tuple[tuple[PhaseKind, int], ...] = ()

    @property
    def bones(self) -> tuple[str, ...]:
        """The bones that touch."""
        return tuple(dict.fromkeys(contact.bone for contact in self.contacts))

    @property
    def flights(self) -> tuple[Interval, ...]:
        """Flight intervals: what neither a contact nor unseen support covers, in order."""
        carried = [(c.start, c.end) for c in self.contacts]
        carried += [(u.start, u.end) for u in self.unseen]
        return gaps(carried, self.duration)

    @property
    def phases(self) -> tuple[Phase, ...]:
        """Alternating ground and flight phases that cover [0, duration]."""
        flights = self.flights
        ground = gaps(((f.start, f.end) for f in flights), self.duration)
        spans = [(f, PhaseKind.FLIGHT) for f in flights] + [(g, PhaseKind.GROUND) for g in ground]
        spans.sort(key=lambda each: each[0].start)
        numbers = self._numbers([kind for _, kind in spans])
        return tuple(
            Phase(kind, number, span.start, span.end)
            for (span, kind), number in zip(spans, numbers, strict=True)
        )

    def _numbers(self, kinds: Sequence[PhaseKind]) -> Sequence[int]:
        """Of phases of these kinds, in order."""
        if [kind for kind, _ in self.numbers] == kinds:
            return [number for _, number in self.numbers]
        first = dict(reversed(self.numbers))
        counts = {kind: count(first.get(kind, 1)) for kind in PhaseKind}
        return [next(counts[kind]) for kind in kinds]

    def named_as(self, other: "ContactSchedule") -> "ContactSchedule":
        """The schedule, each of its phases with the name of the first one of another schedule, on
        the same time, that it has a part in; counted on where two would have the same."""
        phases, known = self.phases, other.phases
        shared = [next((k for k in known if k.overlaps(phase)), phase) for phase in phases]
        distinct = len({phase.name for phase in shared}) == len(phases)
        if distinct:
            return replace(self, numbers=numbers_of(shared))
        first = dict(reversed(numbers_of(known)))
        return replace(self, numbers=tuple(first.items()))

    @property
    def stances(self) -> tuple[Phase, ...]:
        """The phases on the ground in which something touches."""
        ground = (phase for phase in self.phases if phase.kind is PhaseKind.GROUND)
        return tuple(phase for phase in ground if self.of_phase(phase))

    @property
    def boundaries(self) -> tuple[float, ...]:
        """Phase boundaries, s, ascending: the clip's ends and every start and end of a contact."""
        ends = {0.0, self.duration}
        ends |= {t for c in self.contacts for t in (c.start, c.end)}
        ends |= {t for u in self.unseen for t in (u.start, u.end)}
        return tuple(sorted(ends))

    @property
    def jumps(self) -> tuple[float, ...]:
        """Instants, s, ascending, at which accelerations may jump: the body lands or leaves as a
        whole, or the clip begins or ends."""
        ends = {0.0, self.duration}
        ends |= {t for flight in self.flights for t in (flight.start, flight.end)}
        return tuple(sorted(ends))

    def part(self, start: float, end: float) -> "ContactSchedule":
        """The schedule from `start` to `end`, s, both within ground phases; names stay."""

        def inside(start_s: float, end_s: float) -> tuple[float, float]:
            return max(start_s - start, 0.0), min(end_s - start, end - start)

        contacts = []
        for contact in self.contacts:
            first, last = inside(contact.start, contact.end)
            if last <= first:
                continue
            rise = (
                0.0 if contact.start <= start else contact.rise[0],
                0.0 if contact.end >= end else contact.rise[1],
            )
            contacts.append(replace(contact, start=first, end=last, rise=rise))
        unseen = (Interval(*inside(u.start, u.end)) for u in self.unseen)
        return replace(
            self,
            contacts=tuple(sorted(contacts, key=lambda c: (c.start, c.point))),
            duration=end - start,
            unseen=tuple(u for u in unseen if u.end > u.start),
            numbers=numbers_of(p for p in self.phases if p.start < end and p.end > start),
        )

    def of_phase(self, phase: Phase) -> tuple[Contact, ...]:
        """The contacts that carry during part of `phase`."""
        return tuple(c for c in self.contacts if c.start < phase.end and c.end > phase.start)

    def stance(self, contact: Contact) -> Phase:
        """The ground phase in which a contact begins."""
        ground = (phase for phase in self.phases if phase.kind is PhaseKind.GROUND)
        return next(p for p in ground if contact.start < p.end and contact.end > p.start)


def numbers_of(phases: Iterable[Phase]) -> tuple[tuple[PhaseKind, int], ...]:
    """Kind and number of each phase."""
    return tuple((phase.kind, phase.number) for phase in phases)


def gaps(covered: Iterable[tuple[float, float]], duration: float) -> tuple[Interval, ...]:
    """Complement of the intervals (start, end), s, in [0, duration], in order."""
    free = []
    reached = 0.0
    for start, end in sorted(covered):
        if start > reached:
            free.append(Interval(reached, start))
        reached = max(reached, end)
    if reached < duration:
        free.append(Interval(reached, duration))
    return tuple(free)
