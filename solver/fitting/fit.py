"""The fit: the physically valid motion nearest to the recording (thesis 4.2).

It is computed once per recording and starts every adaptation.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from ..analysis.performance import Performance
from ..arrays import FloatArray
from ..data.contacts import Contact, ContactSchedule, Phase
from ..data.reports.certificate import CertificateItem
from ..data.requests import BodyChange
from ..data.status import Status
from ..human.human_guard import HumanGuard, recorded_ranges
from ..human.range_price import range_price
from ..numerics.block_banded import BlockBanded
from ..objectives.joint_price import JointPrice
from ..objectives.least_squares import torque_metric
from ..objectives.motion_metric import motion_metric
from ..objectives.tracking_cost import CostWeights, TrackingCost
from ..optimisation.guards import with_guards
from ..optimisation.kkt_step import LinearisedProblem, Remains
from ..optimisation.projection import project
from ..optimisation.restoration import restore
from ..optimisation.sqp import FeasibleSet, Outcome, Progress
from ..solid.penetrations import Penetrations
from ..solid.shape_changes import AS_IS, ShapeChanges
from ..solid.solid_world import floor_heights, own_overlaps
from ..transcription.contact_pins import tied_places
from ..transcription.motion import (
    DenseTolerance,
    Motion,
    pinned_instants,
    spans_to_refine,
)
from ..transcription.ride import Ride
from ..transcription.torque_constraint import joint_torques
from ..transcription.transcription import Transcription
from .knot_refinement import MetricOf, on_finer_basis, refine
from .transcribe import initial_guess, recorded_target, transcribe

# One g of the centre of mass's acceleration weighs like a decimetre: recordings are off by a tenth
# of g and by a centimetre. One g of a limb's acceleration weighs like 1.6 cm, and a body weight of
# force across the recorded direction like 3 cm.
# Set beside force plates (docs/validation.md). By metres alone a step turns the bones of a neck
# against each other by degrees for half a millimetre of a pin, and bends the rows so much that it
# leads nowhere; damped a little it does. Chosen on the five clips of `dev.py figures`.
FIT_COST_WEIGHTS = CostWeights(
    position=1.0,
    acceleration_time=0.04,
    com_acceleration=1e-2,
    force=1e-5,
    force_rate_time=0.15,
    friction=1e-3,
    support=1e-3,
    goes_on=True,
    damping=0.02,
)
# An adaptation keeps the shape; where the centre of mass goes is for physics to say. Forces
# weigh too: what a person does to jump further is push longer, not only harder.
# What carries unseen is for the recording to say.
# What is before the range stays as it was, so who begins elsewhere lurches there: over an obstacle
# in Mars' gravity it began 38 cm behind; with 1, 10 and 100 here that is 12, 3.4 and 1.5 cm. What
# follows goes along with the landing, so the end is free. A seat stays where it is:
# to move a foot the whole body slid off it (by 13 cm of 14; with 10 and 100 here 1.6 and 0.2).
ADAPT_COST_WEIGHTS = CostWeights(
    shape=1.0, com=0.02, acceleration_time=0.1, force=3e-3, support=1.0, came_from=10.0, rest=100.0
)
# Durations are found by poses (durations.py): as in an adaptation, but forces and the centre of
# mass only settle what no pose shows. The weight of accelerations was chosen on two broad jumps,
# where a third tells how much longer the performer flies; the hops of docs/pairs.md had no say.
POSE_COST_WEIGHTS = CostWeights(shape=1.0, com=1e-4, acceleration_time=0.05, force=1e-5)
MAX_PLACE_UPDATES = 4
MAX_PROJECTION_STEPS = 3  # undamped, from afar
MAX_TURN = 0.5 * np.pi  # of a joint in a step near a motion; beyond, linear rows point backwards
MAX_GUARDED = 0.01  # m, rms; the ranges of joints may not take a fit further off than that
MAX_IMPROVEMENTS = 2  # such steps on the refined knots, near by; most end after two anyway
# The fit is made finer than an adaptation needs, so that most adaptations need no more knots.
FIT_TOLERANCE = DenseTolerance(flight=4e-4, ground=1.5e-3, drift=1e-4)
ADAPT_TOLERANCE = DenseTolerance(flight=1e-3, ground=4e-3, drift=4e-4)


@dataclass(frozen=True)
class SolvedMotion:
    """A solved motion: the outcomes of its stages in order, and each contact's place."""

    outcomes: tuple[Outcome, ...]
    places: FloatArray  # (n_contacts, 3) m

    @property
    def outcome(self) -> Outcome:
        return self.outcomes[-1]

    @cached_property
    def motion(self) -> Motion:
        return Motion(self.outcome.transcription, self.outcome.x, self.places)

    @property
    def solved(self) -> bool:
        return self.outcome.status is Status.SOLVED


@dataclass(frozen=True)
class LinearisedPoses:
    """A motion's rows, linearised by how far poses are apart. price: of turning joints, or None."""

    motion: Motion
    price: JointPrice | None

    @cached_property
    def metric(self) -> BlockBanded:
        """W of the distance in metres, without the price."""
        return motion_metric(self.motion, POSE_COST_WEIGHTS)

    @property
    def unpriced(self) -> LinearisedProblem:
        """With that metric."""
        return self._by_metres.renewed()

    @property
    def priced(self) -> LinearisedProblem:
        """With a metric that counts what a change takes of the joints' ranges, where known."""
        return (self._by_metres if self.price is None else self._by_ranges).renewed()

    @cached_property
    def _by_metres(self) -> LinearisedProblem:
        return self._linearised(self.metric)

    @cached_property
    def _by_ranges(self) -> LinearisedProblem:
        return self._linearised(motion_metric(self.motion, POSE_COST_WEIGHTS, self.price))

    def _linearised(self, metric: BlockBanded) -> LinearisedProblem:
        feasible = FeasibleSet(self.motion.transcription, self.motion.places)
        return feasible.linearise(feasible.rows(self.motion.x), metric)


@dataclass(frozen=True)
class LetGo:
    """A contact that a fit could not hold. off: m, by how much its point missed its place."""

    contact: Contact
    off: float


@dataclass(frozen=True)
class Fit(SolvedMotion):
    """A fitted performance. let_go: contacts that were found, but that it does not hold. carried:
    flights that were found, in which something unseen carries it."""

    performance: Performance
    schedule: ContactSchedule
    let_go: tuple[LetGo, ...] = ()
    carried: tuple[Phase, ...] = ()

    @cached_property
    def price(self) -> JointPrice:
        """What turning a person's joints costs in its adaptations."""
        return range_price(self.motion)

    @cached_property
    def metric(self) -> BlockBanded:
        """Metric W of the minimum-norm steps of its adaptations, of a person."""
        return motion_metric(self.motion, ADAPT_COST_WEIGHTS, self.price)

    @cached_property
    def poses(self) -> LinearisedPoses:
        """Its rows, as durations of its adaptations are sought with."""
        return LinearisedPoses(self.motion, self.price)

    @cached_property
    def overlaps(self) -> Penetrations:
        """What it has through each other as the shapes are; see `overlaps_of`."""
        return self.overlaps_of(AS_IS)

    def overlaps_of(self, changes: ShapeChanges) -> Penetrations:
        """What it has of its body and its floor through each other; its adaptations may, too."""
        return own_overlaps(self.motion, floor_heights(self.schedule, self.places), changes)

    @cached_property
    def other_bodies(self) -> dict[BodyChange, Motion]:
        """Cache of the fit with other bodies (setup.py): their functions take long to build."""
        return {}

    @cached_property
    def certified(self) -> dict[CertificateItem, float]:
        """Cache of the values of its certificate (results/certificate.py), as edits are beside."""
        return {}

    @cached_property
    def torque_metric(self) -> BlockBanded:
        """Metric of changes of the fit's torques; see objectives.torque_metric."""
        return torque_metric(self.motion, joint_torques(self.motion.transcription))


def fit(
    performance: Performance,
    schedule: ContactSchedule,
    *,
    periodic: bool = False,
    rides: Sequence[Ride | None] = (),
    progress: Progress | None = None,
) -> Fit:
    """The physically valid motion nearest to the recording, with its contacts (thesis 4.2).

    periodic: whether it shall repeat, its end meeting its start. rides: of the schedule's contacts,
    where some of them were recorded on ground that moves. A fit that fails is returned as
    it ended, with a status that says so.
    """
    recorded = recorded_motion(performance, schedule, periodic=periodic, rides=rides)
    human = HumanGuard(recorded_ranges(recorded), recorded)
    price = range_price(recorded)
    metric_of = partial(motion_metric, weights=FIT_COST_WEIGHTS, price=price)
    outcomes = _valid_nearby(recorded, performance, schedule, price, progress)
    last = outcomes[-1]
    if last.solved:
        coarse = Motion(last.transcription, last.x, last.places)
        finer = on_finer_basis(coarse, spans_to_refine(coarse, FIT_TOLERANCE))
        cost_of = partial(_distance, finer.transcription, performance, schedule, price)
        outcomes += _improved(finer, cost_of, metric_of, performance, human, progress)
    places = last.places
    settled = tuple(
        replace(contact, place=place)
        for contact, place in zip(schedule.contacts, places, strict=True)
    )
    outcomes[-1] = outcomes[-1].unguarded()
    return Fit(tuple(outcomes), places, performance, replace(schedule, contacts=settled))


def _valid_nearby(
    recorded: Motion,
    performance: Performance,
    schedule: ContactSchedule,
    price: JointPrice,
    progress: Progress | None,
) -> list[Outcome]:
    """A valid motion near the recording, on its knots: its distance counts until the rows nearly
    hold. Where the places contradict each other, those that were reached are tried."""
    transcription, x = recorded.transcription, recorded.x
    cost = _distance(transcription, performance, schedule)
    if transcription.seam is not None:
        x = transcription.seam.closed(x, cost.expand(x)[1])
    feasible = FeasibleSet(transcription, recorded.places)
    remains: Remains | None  # of the step before, for the first of a restoration with its rows
    first, hessian, remains = project(
        feasible, cost, x, stage="fit", max_steps=MAX_PROJECTION_STEPS, progress=progress
    )
    outcomes = [first]
    metric = motion_metric(feasible.motion(first.x), FIT_COST_WEIGHTS, price, into=hessian)
    for _ in range(1 + MAX_PLACE_UPDATES):
        last = restore(
            feasible, metric, outcomes[-1].x, stage="fit", progress=progress, last=remains
        )
        remains = None
        outcomes.append(last)
        if last.solved:
            break
        feasible = replace(feasible, places=reached_places(feasible.motion(last.x)))
    return outcomes


def recorded_motion(
    performance: Performance,
    schedule: ContactSchedule,
    *,
    periodic: bool = False,
    rides: Sequence[Ride | None] = (),
) -> Motion:
    """The recording as splines, on its contacts at their places: where the fit begins."""
    transcription = transcribe(performance, schedule, periodic=periodic)
    if any(ride is not None for ride in rides):
        transcription = transcription.riding(rides)
    x = initial_guess(transcription, performance)
    places = np.array([c.contact.place for c in transcription.contacts]).reshape(-1, 3)
    return Motion(transcription, x, settled_places(transcription, places))


def _distance(
    transcription: Transcription,
    performance: Performance,
    schedule: ContactSchedule,
    price: JointPrice | None = None,
) -> TrackingCost:
    """The distance to the recording on a transcription."""
    target = recorded_target(transcription, performance, schedule)
    return TrackingCost(transcription, target, FIT_COST_WEIGHTS, price)


def _improved(
    finer: Motion,
    cost_of: Callable[[], TrackingCost],
    metric_of: MetricOf,
    performance: Performance,
    human: HumanGuard,
    progress: Progress | None,
) -> list[Outcome]:
    """Nearer to the recording on the refined knots, where all rows hold between the nodes too.

    In the ranges of joints, where such a motion is found near by, else without; and where steps
    towards the recording lead nowhere, the shortest way to where all rows hold.
    """
    plain = FeasibleSet(finer.transcription, finer.places)
    limit = _off(finer, performance) + MAX_GUARDED
    for guards in ((human,), ()):
        wider = partial(with_guards, guards)
        feasible = wider(plain, finer.x)
        nearer, metric, remains = project(
            feasible,
            cost_of(),
            finer.x,
            stage="fit",
            max_steps=MAX_IMPROVEMENTS,
            progress=progress,
        )
        restored = restore(
            feasible,
            metric,
            nearer.x,
            stage="fit",
            max_turn=MAX_TURN,
            progress=progress,
            wider=wider,
            last=remains,
        )
        near = _off(feasible.motion(restored.x), performance) < limit
        if restored.solved and (near or not restored.transcription.guards):
            return [nearer, restored, *refine(restored, metric_of, ADAPT_TOLERANCE, progress)]
    restored = restore(plain, metric_of(finer), finer.x, stage="fit", progress=progress)
    return [restored, *refine(restored, metric_of, FIT_TOLERANCE, progress)]


def _off(motion: Motion, performance: Performance) -> float:
    """Distance of the joint centres from a recording, m, rms."""
    apart = motion.joint_centres(performance.times) - performance.centres
    return float(np.sqrt((apart**2).sum(axis=2).mean()))


def reached_places(motion: Motion) -> FloatArray:
    """(n_contacts, 3) m, mean place of each pinned point, without what its sole gives.

    Places read off a recording contradict each other by millimetres where heel and toe of one foot
    are both down; where the steps brought them they agree better.
    """
    places = motion.places.copy()
    for i, contact in enumerate(motion.transcription.contacts):
        instants = pinned_instants(contact, 120.0)
        reached = motion.contact_points(instants)[:, contact.point]
        places[i] = contact.holds(instants).back(reached).mean(axis=0)
    return settled_places(motion.transcription, places)


def settled_places(transcription: Transcription, places: FloatArray) -> FloatArray:
    """Places (n_contacts, 3) m as a motion that repeats needs them; of others as they are."""
    if not transcription.periodic:
        return places
    duration = float(transcription.basis.breaks[-1])
    return tied_places(places, transcription.contacts, duration)
