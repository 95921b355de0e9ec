"""The implicit solution (thesis 4.4): minimum-norm steps from the fit to where every request holds.

Far edits are made by continuation, in more steps where fewer fail; what arrives is then closed
between the nodes.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..data.faults import NotInLoop, PeakTooLow, SeamStanceMoved
from ..data.problem import MotionProblem
from ..data.recording import PoseTrack
from ..data.row_kinds import RowKind
from ..data.solver_options import Dynamics, Method, ObjectiveKind
from ..data.status import Durations, Status
from ..fitting.fit import ADAPT_TOLERANCE, Fit, SolvedMotion
from ..fitting.knot_refinement import refine
from ..human.limb_speed import JointSpeed, fastest_joint, too_fast
from ..optimisation.guards import Guard, guarded, in_the_way
from ..optimisation.restoration import MAX_STEPS, restore
from ..optimisation.sqp import Outcome, Progress, Stopped
from ..transcription.constraint import DenseViolation, dense_violation, exchange
from ..transcription.contact_pins import tied_places
from ..transcription.motion import Motion
from ..transcription.transcription import Transcription
from .continuation import continuation
from .explicit import explicit
from .requested import check_forces, check_places
from .setup import Setup, set_up
from .warm_start import Standing

MAX_ATTEMPTS = 3  # each with twice as many continuation steps
MAX_TIMED_ATTEMPTS = 2  # with found durations, which begin at their places: no step is smaller
MAX_ARRIVALS = 2  # where guards were given up, which in smaller steps need not be
HOPELESS = 500.0  # tolerances beyond guards, as of ten limbs 50 mm deep: smaller steps find no room
MAX_SQP_ITERATIONS = 60  # after which there is no further attempt
MAX_EXCHANGES = 4
MAX_GUARD_ROUNDS = 8  # the same where there are guards: one limb makes way for the next
MAX_GUARD_STEPS = 10  # after which what is in the way is given up
CALMER = 1.5  # times slower, than the joint that was too fast: what is as near is left as it is
MOST_FURTHER = 0.1  # rad, by which rows may take another joint further beyond its range
SAME_PLACE = 1e-4  # m
# What no body can do: more in each other than a forearm is thick, and no joint bends so far beyond.
NO_BODY = {RowKind.SOLID: 0.1, RowKind.RANGE: 0.25 * np.pi}  # m, rad
NO_SHORTCOMINGS = 0.0, False, 0.0
MAX_DENSE_VIOLATION = 3.0  # times a constraint's tolerance: 1 mm, a third of a degree, 0.04 N·m


@dataclass(frozen=True)
class Adaptation(SolvedMotion):
    """An adapted motion, the fit it came from, and the problem's set-up.

    stuck: where the steps failed, None where they did not; the motion is then the last on the way
    that obeys physics, `reached` the share of the way that it went. gain: the explicit solution's
    objective in shares of that at its start; None where there was none. stood: where the contacts
    stand of a motion short of its target, None where they are at it. calmed: the joint that was too
    fast without torques weighed, where that is why they are; else None.
    """

    fit: Fit
    setup: Setup
    stuck: Outcome | None = None
    reached: float = 1.0
    gain: float | None = None
    stood: Standing | None = None
    calmed: JointSpeed | None = None

    @property
    def track(self) -> PoseTrack:
        """Bone poses, frame by frame."""
        return self.motion.track(self.setup.recording)


def unadapted(fit: Fit) -> Adaptation:
    """A fit as it ended, for reports on one that failed."""
    setup = set_up(fit, MotionProblem())
    return Adaptation(fit.outcomes[-1:], fit.places, fit, setup, fit.outcome, 0.0)


def adapt(fit: Fit, problem: MotionProblem, *, progress: Progress | None = None) -> Adaptation:
    """Adapts a fitted performance to a problem (thesis 4.3, 4.4).

    Raises UnknownPhase, UnknownContact, ContradictoryPins, OutOfReach, PoseHeld, PeakTooLow and the
    requests' own faults.
    What is not met with the durations that go with the pins, or only where guards are given up, is
    tried with the recorded ones, and the better of both returned; a loop keeps these, for it lasts
    whole frames. Raises SeamStanceMoved, NotInLoop of a loop. A solve that fails is returned with
    the best motion found and a status that says so; one that `progress` ends by raising Stopped,
    with the motion as it stood. Where a joint goes faster than any person's it is solved again with
    torques weighed, and that motion returned if it is much calmer.
    """
    setup = _possible(fit, problem)
    _require_closed(setup)
    try:
        found = _solve(fit, problem, setup, progress)
        lacking = _shortcomings(found)
        if setup.durations is Durations.FOUND and lacking != NO_SHORTCOMINGS:
            setup = _with_recorded_durations(fit, problem)
            again = _solve(fit, problem, setup, progress)
            better, worse = (again, found) if _shortcomings(again) < lacking else (found, again)
            found = _after(worse, better)
    except Stopped as stop:
        return _stopped(stop.motion, fit, setup)
    return _calmed(found, fit, problem, progress)


def _after(worse: Adaptation, better: Adaptation) -> Adaptation:
    """The better of two, with the steps of both."""
    return replace(better, outcomes=(*worse.outcomes, *better.outcomes))


def _calmed(
    found: Adaptation, fit: Fit, problem: MotionProblem, progress: Progress | None
) -> Adaptation:
    """The same, or where a joint is too fast what weighed torques make of it, if that is much
    calmer: by metres alone guards and rows that bend can swing a light arm up from step to step. A
    limb whose torques the artist limits swings as it will."""
    solution = problem.requests.solution
    plain = solution.method is Method.IMPLICIT and solution.dynamics is not Dynamics.REDUCED
    if not (plain and solution.human and found.solved) or problem.requests.torques:
        return found
    fast = too_fast(found.motion, fit.motion)
    if fast is None:
        return found
    try:
        again = adapt(fit, problem.weighing_torques(), progress=progress)
    except np.linalg.LinAlgError:  # what was found stands, and its report tells the speed
        return found
    calmer = CALMER * fastest_joint(again.motion).speed < fast.speed
    calmer = calmer and _shortcomings(again) <= _shortcomings(found)
    return replace(_after(found, again), calmed=fast) if calmer else _after(again, found)


def _possible(fit: Fit, problem: MotionProblem) -> Setup:
    """The set-up, where it is not seen to be impossible; with the recorded durations where forces
    are capped too low for those that go with the pins."""
    setup = set_up(fit, problem)
    check_places(fit, problem, setup.context, setup.start, setup.fitted, setup.target)
    try:
        check_forces(problem, setup.context, setup.start, setup.target)
    except PeakTooLow:
        if setup.durations is not Durations.FOUND:
            raise
        setup = _with_recorded_durations(fit, problem)
        check_forces(problem, setup.context, setup.start, setup.target)
    return setup


def _with_recorded_durations(fit: Fit, problem: MotionProblem) -> Setup:
    """The set-up, where it could not be met with durations that go with the pins."""
    return replace(set_up(fit, problem.keeping_times()), durations=Durations.NOT_MET)


def _shortcomings(found: Adaptation) -> tuple[float, bool, float]:
    """What a motion is judged by, the worst first: the share of the way that is missing, whether it
    misses a constraint between the nodes or is beyond any body, and how far it goes beyond its
    guards."""
    missed = found.outcome.status in (Status.MISSED, Status.NO_BODY)
    beyond = _beyond(_violations(found.outcome, found.setup, found.setup.guards))
    return 1.0 - found.reached, missed, beyond


def _require_closed(setup: Setup) -> None:
    """What is asked of a loop leaves it one. Raises SeamStanceMoved, NotInLoop."""
    t, places = setup.start.transcription, setup.target_places
    if not t.periodic:
        return
    if setup.target.moves:
        raise NotInLoop("ground that moves")
    torn = np.linalg.norm(tied_places(places, t.contacts, setup.start.duration) - places, axis=1)
    if torn.max(initial=0.0) > SAME_PLACE:
        raise SeamStanceMoved(t.contacts[int(torn.argmax())].contact.name)


def _stopped(motion: Motion, fit: Fit, setup: Setup) -> Adaptation:
    feasible = setup.feasible_set(motion.transcription)
    outcome = feasible.outcome(motion.x, Status.STOPPED, [], feasible.violation(motion.x))
    places, stood = setup.target_places, Standing.of(motion)
    return Adaptation((outcome,), places, fit, setup, outcome, reached=0.0, stood=stood)


def _solve(fit: Fit, problem: MotionProblem, setup: Setup, progress: Progress | None) -> Adaptation:
    attempts: list[ContinuationAttempt] = []
    timed = setup.durations is Durations.FOUND
    for harder in range(MAX_TIMED_ATTEMPTS if timed else MAX_ATTEMPTS):
        giving_up = harder > 0  # what smaller steps keep needs no giving up
        attempts.append(_attempt(setup, 2**harder, progress, giving_up=giving_up))
        arrived = [attempt for attempt in attempts if attempt.arrived]
        enough = len(arrived) == MAX_ARRIVALS or any(
            (each.over == 0.0 and not each.missed) or each.over > HOPELESS for each in arrived
        )
        iterations = sum(len(outcome.steps) for each in attempts for outcome in each.outcomes)
        if enough or iterations > MAX_SQP_ITERATIONS:
            break
    best = min(arrived, key=lambda each: (each.missed, each.over), default=None)
    outcomes = [o for each in attempts if each is not best for o in each.outcomes]
    if best is None:
        return _best_feasible(max(attempts, key=lambda each: each.reached), outcomes, fit, setup)
    outcomes += best.outcomes
    gain = None
    method, weights = problem.requests.solution.method, dict[ObjectiveKind, float]()
    if method is Method.EXPLICIT:
        weights = dict(problem.requests.solution.objectives)
    if weights or problem.requests.preferred:
        better, gain = explicit(outcomes[-1], setup, weights, progress)
        outcomes += better + (close_between_nodes(better[-1], setup, progress) if better else [])
    if misses_a_constraint(outcomes[-1]) or _goes_beyond_hard(outcomes[-1], setup):
        outcomes[-1] = replace(outcomes[-1], status=Status.MISSED)
    elif any(
        each.amount > NO_BODY[each.kind] for each in _violations(outcomes[-1], setup, setup.guards)
    ):
        outcomes[-1] = replace(outcomes[-1], status=Status.NO_BODY)
    stuck = None if outcomes[-1].solved else outcomes[-1]
    return Adaptation(tuple(outcomes), setup.target_places, fit, setup, stuck, gain=gain)


def misses_a_constraint(outcome: Outcome) -> bool:
    """Whether the dense violation of a constraint exceeds MAX_DENSE_VIOLATION."""
    t = outcome.transcription
    found = (dense_violation(c, t.character, t.basis, t.layout, outcome.x) for c in t.constraints)
    return any(each.amount > MAX_DENSE_VIOLATION * each.kind.tolerance for each in found)


def _goes_beyond_hard(outcome: Outcome, setup: Setup) -> bool:
    """Whether a motion does by MAX_DENSE_VIOLATION what a hard guard must keep it from."""
    hard = [guard for guard in setup.guards if guard.hard]
    return _beyond(_violations(outcome, setup, hard)) > 0.0


def _violations(outcome: Outcome, setup: Setup, guards: Sequence[Guard]) -> list[DenseViolation]:
    """What a motion does that guards are for."""
    motion = setup.feasible_set(outcome.transcription).motion(outcome.x)
    return [each for guard in guards for each in guard.violations(motion)]


def _beyond(found: list[DenseViolation]) -> float:
    """By how many tolerances, summed, violations are beyond MAX_DENSE_VIOLATION."""
    over = np.array([each.amount / each.kind.tolerance for each in found])
    return float(over[over > MAX_DENSE_VIOLATION].sum())


# ---------------------------------------------------------------- continuation


@dataclass(frozen=True)
class ContinuationAttempt:
    """Outcomes of one continuation attempt, and the number of steps that it was to have.

    closed: outcomes after the last step, that hold between the nodes too. over: by how many
    tolerances the last goes beyond its guards, which are given up where they hold it back. missed:
    whether it misses a constraint between the nodes.
    """

    steps_taken: tuple[Outcome, ...]
    steps: int
    closed: tuple[Outcome, ...] = ()
    over: float = 0.0
    missed: bool = False

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        return (*self.steps_taken, *self.closed)

    @property
    def reached(self) -> float:
        """The share of the steps that were solved."""
        return sum(outcome.solved for outcome in self.steps_taken) / self.steps

    @property
    def arrived(self) -> bool:
        return len(self.steps_taken) == self.steps and self.steps_taken[-1].solved


def _attempt(
    setup: Setup, times: int, progress: Progress | None, *, giving_up: bool
) -> ContinuationAttempt:
    """A continuation, and where it arrives, what closes it between the nodes."""
    taken, steps = continuation(setup, times, progress, giving_up=giving_up)
    attempt = ContinuationAttempt(tuple(taken), steps)
    if not attempt.arrived:
        return attempt
    closed = close_between_nodes(attempt.outcomes[-1], setup, progress)
    attempt = replace(attempt, closed=tuple(closed))
    last = attempt.outcomes[-1]
    over = _beyond(_violations(last, setup, setup.guards))
    return replace(attempt, over=over, missed=misses_a_constraint(last))


def _best_feasible(
    attempt: ContinuationAttempt, outcomes: list[Outcome], fit: Fit, setup: Setup
) -> Adaptation:
    """The last motion on the way that obeys physics, marked as short of the target."""
    stuck, solved = attempt.outcomes[-1], [o for o in attempt.outcomes if o.solved]
    best = solved[-1] if solved else stuck
    feasible = setup.feasible_set(setup.start.transcription)
    outcomes.append(feasible.outcome(best.x, stuck.status, [], feasible.violation(best.x)))
    places = setup.target_places
    stood = Standing.of(Motion(best.transcription, best.x, best.places))
    return Adaptation(tuple(outcomes), places, fit, setup, stuck, attempt.reached, stood=stood)


def close_between_nodes(outcome: Outcome, setup: Setup, progress: Progress | None) -> list[Outcome]:
    """Refines knots and exchanges instants until rows and bounds hold between them too.

    The guards' rows join likewise. Those that cannot be met are given up, and reported.
    """
    outcomes: list[Outcome] = []
    given_up: set[str] = set()
    hard = {name for guard in setup.guards if guard.hard for name in guard.names}
    refined: Outcome | None = None
    for _ in range(MAX_GUARD_ROUNDS if setup.guards else MAX_EXCHANGES):
        if outcome is not refined:
            outcomes += refine(
                outcome, setup.metric_of, ADAPT_TOLERANCE, basis=setup.basis, progress=progress
            )
            outcome = refined = outcomes[-1] if outcomes else outcome
        old, new = outcome.transcription, _exchanged(outcome, setup, given_up)
        if new is old:
            break
        feasible = setup.feasible_set(new)
        same = old.basis is setup.start.transcription.basis
        metric = setup.metric if same else setup.metric_of(feasible.motion(outcome.x))
        steps = MAX_STEPS if new.guards is old.guards else MAX_GUARD_STEPS
        tried = restore(
            feasible, metric, outcome.x, stage="bounds", max_steps=steps, progress=progress
        )
        if tried.solved and not _takes_further(tried, outcome, setup):
            outcomes.append(outcome := tried)
        elif new.guards is old.guards:
            break  # what was solved for stands; what it misses in between is reported
        else:
            stuck = outcome.x if tried.solved else tried.x  # where all rows hold none pulls
            conflicting = in_the_way(feasible, metric, stuck) - hard
            if not conflicting - given_up:
                break  # the artist's hard ranges are missed, and reported
            given_up |= conflicting
    else:
        outcomes += refine(
            outcome, setup.metric_of, ADAPT_TOLERANCE, basis=setup.basis, progress=progress
        )
    return outcomes


def _takes_further(tried: Outcome, outcome: Outcome, setup: Setup) -> bool:
    """Whether rows led to a motion with a joint further beyond its range than before: no cure."""
    if setup.human is None:
        return False
    was, now = (
        max((each.amount for each in setup.human.violations(motion)), default=0.0)
        for motion in (setup.feasible_set(o.transcription).motion(o.x) for o in (outcome, tried))
    )
    return now > was + MOST_FURTHER


def _exchanged(outcome: Outcome, setup: Setup, given_up: set[str]) -> Transcription:
    """The outcome's transcription with instants where bounds are violated between the nodes, or
    guards are but for those given up; itself where neither is so."""
    t = outcome.transcription
    added = tuple(exchange(c, t.character, t.basis, t.layout, outcome.x) for c in t.constraints)
    safe = guarded(setup.feasible_set(t).motion(outcome.x), setup.guards, given_up)
    same = all(new is old for new, old in zip(added, t.constraints, strict=True))
    return safe if same else replace(safe, constraints=added)
