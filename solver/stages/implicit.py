"""The implicit solution (thesis 4.4): small steps from the fit to where every request is met."""

from dataclasses import dataclass, replace

from ..data.problem import MotionProblem
from ..data.recording import PoseTrack
from ..data.requests import Method, ObjectiveKind
from ..data.status import Status
from ..optimisation.sqp import Outcome, Progress, Stopped, restore, worst_violation
from ..transcription.constraint import exchange, missed
from ..transcription.motion import Motion
from .arm_ik import reaching
from .explicit import explicit
from .fit import ADAPT_PROMISE, Fit, Solved, refine
from .setup import Setup, set_up
from .warm_start import stage_count, staged, stance_moves, warm_start

MOST_RETRIES = 3  # with twice as many stages each
MOST_STEPS = 60  # after which there is no further try
MOST_EXCHANGES = 4
PROMISED = 3.0  # times a condition's tolerance: 1 mm, a third of a degree, 0.04 N·m


@dataclass(frozen=True)
class Adaptation(Solved):
    """An adapted motion, the fit it came from, and how the problem was set up.

    stuck: where the steps failed, None where they did not; the motion is then the last on the way
    that obeys physics, `reached` the share of the way that it went. gain: what is left of the
    explicit solution's objective, in shares of the start's; None where there was none.
    """

    fit: Fit
    plan: Setup
    stuck: Outcome | None = None
    reached: float = 1.0
    gain: float | None = None

    @property
    def track(self) -> PoseTrack:
        """The bones' poses, frame by frame."""
        return self.motion.track(self.plan.recording)


def unadapted(fit: Fit) -> Adaptation:
    """A fit as it ended, for reports on one that failed."""
    plan = set_up(fit, MotionProblem())
    return Adaptation(fit.outcomes[-1:], fit.places, fit, plan, fit.outcome, 0.0)


def adapt(fit: Fit, problem: MotionProblem, *, progress: Progress | None = None) -> Adaptation:
    """Adapts a fitted performance to what the problem asks for.

    Raises UnknownPhase, UnknownContact, ContradictoryPins and the requests' own faults. A solve
    that fails is returned with the best motion found and a status that says so; one that
    `progress` ends by raising Stopped, with the motion as it stood.
    """
    plan = set_up(fit, problem)
    try:
        return _adapted(fit, problem, plan, progress)
    except Stopped as stop:
        return _as_it_stands(stop.motion, fit, plan)


def _as_it_stands(motion: Motion, fit: Fit, plan: Setup) -> Adaptation:
    t = motion.transcription
    left = worst_violation(t.rows(motion.x, plan.goal))
    outcome = Outcome(motion.x, t, Status.STOPPED, (), left, plan.goal)
    return Adaptation((outcome,), plan.goal, fit, plan, outcome, reached=0.0)


def _adapted(
    fit: Fit, problem: MotionProblem, plan: Setup, progress: Progress | None
) -> Adaptation:
    outcomes: list[Outcome] = []
    ways: list[_Way] = []
    for harder in range(MOST_RETRIES):
        ways.append(_in_stages(plan, 2**harder, progress))
        outcomes += ways[-1].outcomes
        if ways[-1].arrived or sum(len(o.steps) for o in outcomes) > MOST_STEPS:
            break
    if not ways[-1].arrived:
        return _failed(max(ways, key=lambda way: way.reached), outcomes, fit, plan)
    outcomes += finish(outcomes[-1], plan, progress)
    gain = None
    method, weights = problem.requests.solution.method, dict[ObjectiveKind, float]()
    if method is Method.EXPLICIT:
        weights = dict(problem.requests.solution.objectives)
    if weights or problem.requests.preferred:
        better, gain = explicit(outcomes[-1], plan, weights, progress)
        outcomes += better + (finish(better[-1], plan, progress) if better else [])
    if misses(outcomes[-1]):
        outcomes[-1] = replace(outcomes[-1], status=Status.MISSED)
    stuck = None if outcomes[-1].solved else outcomes[-1]
    return Adaptation(tuple(outcomes), plan.goal, fit, plan, stuck, gain=gain)


def misses(outcome: Outcome) -> bool:
    """Whether a condition is missed by more than is promised, between the rows too."""
    t = outcome.transcription
    found = (missed(c, t.character, t.basis, t.layout, outcome.x) for c in t.conditions)
    return any(each.amount > PROMISED * each.kind.tolerance for each in found)


@dataclass(frozen=True)
class _Way:
    """How far the stages led: their outcomes, and how many there were to be."""

    outcomes: tuple[Outcome, ...]
    stages: int

    @property
    def reached(self) -> float:
        """The share of the stages that were solved."""
        return sum(outcome.solved for outcome in self.outcomes) / self.stages

    @property
    def arrived(self) -> bool:
        return len(self.outcomes) == self.stages and self.outcomes[-1].solved


def _failed(way: _Way, outcomes: list[Outcome], fit: Fit, plan: Setup) -> Adaptation:
    """The last motion on the way that obeys physics, marked as short of the goal."""
    stuck, solved = way.outcomes[-1], [o for o in way.outcomes if o.solved]
    best = solved[-1] if solved else stuck
    t = plan.start.transcription
    left = worst_violation(t.rows(best.x, plan.goal))
    outcomes.append(Outcome(best.x, t, stuck.status, (), left, plan.goal))
    return Adaptation(tuple(outcomes), plan.goal, fit, plan, stuck, way.reached)


def _in_stages(plan: Setup, times: int, progress: Progress | None) -> _Way:
    """Solves in as many stages as the pins' moves ask for, times `times`; bounds ease in."""
    motion, schedule = plan.start, plan.schedule
    before = motion.places
    whole = stance_moves(schedule, before, plan.goal, plan.turns)
    stages = times * stage_count(whole)
    outcomes: list[Outcome] = []
    for stage in range(1, stages + 1):
        places = plan.goal
        transcription = plan.start.transcription
        if stage < stages:
            places = staged(schedule, before, plan.goal, whole, stage / stages)
        start = warm_start(motion, stance_moves(schedule, motion.places, places))
        if stage == 1:  # where nothing is gripped this changes nothing
            start = reaching(Motion(transcription, start, places), plan.goal).x
        if stage < stages:
            transcription = transcription.eased(start, 1.0 / (stages - stage + 1))
        outcome = restore(
            transcription,
            plan.metric,
            start,
            places,
            stage="adapt",
            basis=plan.basis,
            progress=progress,
        )
        outcomes.append(outcome)
        motion = Motion(outcome.transcription, outcome.x, places)
        if not outcome.solved:
            break
    return _Way(tuple(outcomes), stages)


def finish(outcome: Outcome, plan: Setup, progress: Progress | None) -> list[Outcome]:
    """Refines knots and instants until equations and bounds hold between them as promised."""
    outcomes: list[Outcome] = []
    for _ in range(MOST_EXCHANGES):
        outcomes += refine(
            outcome, plan.goal, plan.metric_of, ADAPT_PROMISE, basis=plan.basis, progress=progress
        )
        outcome = outcomes[-1] if outcomes else outcome
        t = outcome.transcription
        added = tuple(exchange(c, t.character, t.basis, t.layout, outcome.x) for c in t.conditions)
        if all(new is old for new, old in zip(added, t.conditions, strict=True)):
            break
        motion = Motion(replace(t, conditions=added), outcome.x, plan.goal)
        same = t.basis is plan.start.transcription.basis
        outcome = restore(
            motion.transcription,
            plan.metric if same else plan.metric_of(motion),
            motion.x,
            plan.goal,
            stage="bounds",
            basis=plan.basis,
            progress=progress,
        )
        if not outcome.solved:
            break  # what was solved for stands; what it misses in between is reported
        outcomes.append(outcome)
    return outcomes
