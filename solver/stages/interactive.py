"""Interactive drag: a warm-started SQP step or two for each new place of a dragged pin.

That is the real-time iteration of Diehl et al. (2002): where the pin moves on, the next problem is
solved a little, not the last one wholly. Moving a pin changes the rows' values, not their Jacobian,
so most steps go on with the last factor (chord steps), from the values that the last update ended
with and their first-order change: what an update evaluates is only what it shows. Where the pin
went so far that the step leaves more than a millimetre, a second one follows on the same factor,
which costs a fifth of a new one; and as the pin has not moved between the two, what the second
leaves tells whether a new one is needed. Each update steps from the last by the smallest change:
measured against steps towards the motion nearest to the fit, that is as near to what the solve will
find and does not jitter. Far moves are made by continuation, one step an update; moving ground
comes up to its speed likewise. The solve proper, once the pin is let go, starts from the fit again.
While a pin moves phases last as long as they did; once it rests they take the durations that go
with its place. What is in something, and joints beyond their ranges, are looked for every fourth
update, or after some centimetres, and mended by the updates that follow.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.contacts import Interval
from ..data.problem import MotionProblem
from ..data.reports.report import DragSummary
from ..data.status import DragStatus
from ..data.traces import Traces
from ..fitting.fit import Fit
from ..optimisation.guards import Guard, guarded
from ..optimisation.kkt_step import LinearisedProblem
from ..optimisation.restoration import restore
from ..optimisation.sqp import FeasibleSet
from ..transcription.guard_rows import GuardRows
from ..transcription.motion import Motion
from .implicit import Adaptation
from .platforms import find_standing
from .setup import Setup, set_up
from .warm_start import (
    Standing,
    continuation_steps,
    partial_places,
    seats,
    stance_moves,
    warm_start,
)

SWEEPS = 2  # a step; the next update goes on with what they leave
MOST_STEPS = 2  # an update; the second where the first leaves more than HELD_VIOLATION
MAX_DRAG_CHORD_RATIO = 0.5  # of the violation, left by a step at rest; beyond: a stale factor
MOST_ALIKE = 1.5  # times the last step's way, that a step is compared with it
DIVERGED_VIOLATION = 2.5e4  # times the tolerances (1 m)
LOOKING = 4  # updates from one look for guards to the next while a pin is on its way
LOOKING_WAY = 0.04  # m, that a contact goes meanwhile at most
RESTING_UPDATES = 12  # at one place, after which a pin is no longer on its way
RETIMING_STEPS = 8  # at most, to a motion with other durations
FAR = 20.0  # tolerances within its bound (2 cm, 2 degrees), where a guard needs no row any more
ASTRAY = 50.0  # tolerances beyond it (5 cm, 5 degrees), from where no linear step leads out
MAX_BLOCKED_UPDATES = 8  # in which a solid does not come out, after which it is let be
SAME_DURATION = 1e-3  # s, by which nobody sees that a phase lasts longer
HELD_VIOLATION = 25.0  # times the tolerances (1 mm): a motion that serves to go back to


class Follower:
    """Warm-started tracking of a changing problem, from a fit or an adaptation of the same problem.

    violation: of `motion`, the worst over its tolerance.
    """

    def __init__(self, fit: Fit, problem: MotionProblem, last: Adaptation | None = None) -> None:
        self._fit, self._problem = fit, problem
        self._timed: MotionProblem | None = problem  # whose durations these are
        if last is None:  # with the recording's durations, which no search is needed for
            self.setup, self._timed = set_up(fit, problem.keeping_times()), None
            self.motion, self._metric = self.setup.start, self.setup.metric
            self._standing = self.setup.fitted.with_places(self.motion.places)
        else:
            self.setup = last.setup
            self.motion = Motion(last.outcome.transcription, last.outcome.x, last.places)
            self._metric = self.setup.metric_of(self.motion)
            self._standing = Standing.of(self.motion)
        self._seats = self.setup.seats  # of the metric
        self._rested = 0  # updates at one place
        self._linearised: LinearisedProblem | None = None
        self._value: FloatArray | None = None  # of the rows, at the motion; None: not known
        self._secant = Secant.none()
        self._held = self.motion, self._standing
        self._given_up: set[str] = set()  # solids and ranges that are let be
        self._unlooked = 0  # updates since the last look for guards
        self._looked_at = self.motion.places  # then
        self._off = np.zeros(0)  # of the guard rows, over their tolerances
        self._blocked = 0  # updates in which one of them is furthest from where it should be
        self.violation = np.inf

    def follow(self, problem: MotionProblem) -> DragStatus:
        """Steps towards a problem as it is now; a motion that diverges goes back to where it held.

        Raises as set_up does, leaving the motion as it was.
        """
        self._rested = self._rested + 1 if problem == self._problem else 0
        if replace(problem, pins=()) != replace(self._problem, pins=()):
            self._set_up(problem)
        elif self._rested >= RESTING_UPDATES and self._timed != problem:
            self._retime(problem)
        self._problem = problem
        target, schedule, was = self._target(problem), self.setup.schedule, self._standing
        self._seat(seats(schedule, self.setup.fitted, target))
        whole = stance_moves(schedule, was, target, seats=self._seats)
        steps = continuation_steps(whole)
        if steps > 1:
            places = partial_places(schedule, was.places, target.places, whole, 1.0 / steps)
            share = was.share + (1.0 - was.share) / steps
            target = target.slowed(share, self.setup.fitted).with_places(places)
        x = warm_start(self.motion, stance_moves(schedule, was, target, seats=self._seats))
        self._guard()
        if not self._step(x, target):
            (self.motion, self._standing), self._linearised = self._held, None
            self._let_be()
            return DragStatus.DIVERGED
        self._watch_guards()
        if self.violation < HELD_VIOLATION:
            self._held = self.motion, self._standing
        there = steps == 1 and self.violation <= 1.0 and self._timed == problem
        there &= self._unlooked <= 1  # nor is it in anything
        return DragStatus.CONVERGED if there else DragStatus.CONVERGING

    def _target(self, problem: MotionProblem) -> Standing:
        return find_standing(self._fit, problem, self.setup.context)[0]

    def _set_up(self, problem: MotionProblem) -> None:
        """Sets up for other requests, from the same unknowns where basis and layout allow."""
        setup = set_up(self._fit, problem)
        old, new = self.motion.transcription, setup.start.transcription
        start, standing = setup.start, setup.fitted.with_places(setup.start.places)
        if new.basis is old.basis and new.layout == old.layout:
            start, standing = Motion(new, self.motion.x, self.motion.places), self._standing
        self._begin(setup, start, standing, problem)

    def _retime(self, problem: MotionProblem) -> None:
        """Begins anew where other durations go with the pins, or where they had changed.

        Where that does not come near a motion, or limbs end deep in something, the present one
        stays.
        """
        setup = set_up(self._fit, problem)
        self._timed = problem
        if np.allclose(setup.start.duration, self.motion.duration, atol=SAME_DURATION):
            return
        start, target = setup.start, setup.target
        feasible = setup.feasible_set(start.transcription, target.places)
        still = setup.fitted.with_places(start.places)
        x = warm_start(start, stance_moves(setup.schedule, still, target, seats=setup.seats))
        found = restore(feasible, setup.metric, x, stage="drag", max_steps=RETIMING_STEPS)
        motion = feasible.motion(found.x)
        if found.violation < HELD_VIOLATION and not _astray(motion, setup.sparse_guards):
            self._begin(setup, motion, target, problem)

    def _begin(
        self, setup: Setup, start: Motion, standing: Standing, problem: MotionProblem
    ) -> None:
        self.setup, self.motion, self._metric = setup, start, setup.metric
        self._standing, self._linearised, self._timed = standing, None, problem
        self._held, self._looked_at = (start, standing), start.places
        self._seats = setup.seats

    def _seat(self, found: tuple[Interval, ...]) -> None:
        """Measures by whether the body stays on a seat with pins as they are now."""
        if found != self._seats:
            self._seats, self._metric = found, self.setup.metric_of(self.motion, found)
            self._linearised = None

    def _guard(self) -> None:
        """Rows for what is in each other, or beyond its range, now; without those that are far
        from it by now. To look takes longer than a step, so while a pin moves most updates go
        without."""
        x = self.motion.x
        self._unlooked += 1
        there = self._rested > 0 and self.violation <= 1.0
        far = np.abs(self.motion.places - self._looked_at).max(initial=0.0) > LOOKING_WAY
        if self.violation > HELD_VIOLATION or not (there or far or self._unlooked >= LOOKING):
            return
        self._unlooked, self._looked_at = 0, self.motion.places
        t = guarded(self.motion, self.setup.sparse_guards, self._given_up)
        if t is self.motion.transcription:
            return
        rows = t.guard_rows(x)
        near = rows.value - rows.lower < FAR * rows.tolerance
        each = zip(t.guards, _by_guard(t.guards, near), strict=True)
        t = t.guarded(tuple(guard.some(which) for guard, which in each if which.any()))
        if self._linearised is not None:
            kept, rows = ~self._linearised.rows.guards, rows.some(near)
            self._linearised = self._linearised.widened(t, rows)
            self._secant = self._secant.widened(kept, len(rows.value))
            if self._value is not None:
                self._value = np.concatenate([self._value[kept], rows.value])
        self.motion = replace(self.motion, transcription=t)

    def _watch_guards(self) -> None:
        """Lets those be that what is asked for has kept from their place for some updates."""
        off = self._off > 1.0
        self._blocked = self._blocked + 1 if self.violation > 1.0 and off.any() else 0
        if self._blocked > MAX_BLOCKED_UPDATES:
            self._let_be(off)
            self._blocked = 0

    def _let_be(self, which: BoolArray | None = None) -> None:
        """Gives up guards, by flags of all their rows (U,); None all that have rows."""
        guards = self.motion.transcription.guards
        if which is None:
            which = np.ones(sum(len(guard.items) for guard in guards), dtype=bool)
        for guard, mine in zip(guards, _by_guard(guards, which), strict=True):
            self._given_up |= {guard.names[item] for item in set(guard.items[mine].tolist())}

    def _step(self, x: FloatArray, standing: Standing) -> bool:
        """A step or two from unknowns x; False, with the motion as it was, where they diverge."""
        feasible, way = self._feasible(standing), standing.places - self.motion.places
        try:
            linearised, value = self._at(x, feasible)
        except np.linalg.LinAlgError:  # too far from any motion
            return False
        enough = 1.0 if self._rested >= RESTING_UPDATES else HELD_VIOLATION
        stale = False
        for _ in range(MOST_STEPS):
            before = linearised.violation(value)
            step = linearised.step(
                value + self._secant.along(way), sweeps=SWEEPS, limp_to_middle=True
            )
            expected, x = value + step.change, x + step.d
            value = feasible.values(x)
            after = linearised.violation(value)
            if not after < DIVERGED_VIOLATION:
                return False
            if way.any():
                self._secant, way = Secant(way, value - expected), np.zeros(way.shape)
            elif before > enough:  # nothing has moved since: what is left is the factor's
                stale = after > max(1.0, MAX_DRAG_CHORD_RATIO * before)
            if after <= HELD_VIOLATION:
                break
        self._linearised = None if stale else linearised
        self._off = linearised.violations(value)[linearised.rows.guards]
        self.violation, self._value = after, value
        self.motion, self._standing = feasible.motion(x), standing
        return True

    def _at(self, x: FloatArray, feasible: FeasibleSet) -> tuple[LinearisedProblem, FloatArray]:
        """The linearised problem, a new one where the last does not serve, and the rows' values at
        unknowns x: to first order where they are known at the motion. Raises LinAlgError."""
        linearised, t = self._linearised, feasible.transcription
        if linearised is None:
            rows = feasible.rows(x)
            self._secant = Secant.none()
            return feasible.linearise(rows, self._metric), rows.value
        if self._value is None or t is not self.motion.transcription:
            return linearised, feasible.values(x)
        value = t.moved(self._value, self.motion.places, feasible.places)
        return linearised, value + linearised.times(x - self.motion.x)

    def _feasible(self, standing: Standing) -> FeasibleSet:
        t = self.motion.transcription
        if Standing.of(self.motion).rides != standing.rides:
            t = t.riding(standing.rides)
        return self.setup.feasible_set(t, standing.places)


@dataclass(frozen=True)
class Secant:
    """How the last step's rows ended beside their linear prediction: left (R,), where the places
    went by `way` (n_contacts, 3) m. Most of it is how far the Jacobian is from today's along that
    way, and the next step goes on the same way (Broyden's secant condition)."""

    way: FloatArray
    left: FloatArray | float

    @staticmethod
    def none() -> "Secant":
        return Secant(np.zeros((1, 3)), 0.0)

    def along(self, way: FloatArray) -> FloatArray | float:
        """What a step is likely to leave with places that go `way` (n_contacts, 3) m: as much as
        the last, as far as it goes along with it."""
        far = float((self.way**2).sum())
        share = float((self.way * way).sum()) / far if far > 0.0 else 0.0
        return float(np.clip(share, -MOST_ALIKE, MOST_ALIKE)) * self.left

    def widened(self, kept: BoolArray, more: int) -> "Secant":
        """For the rows that are kept, by flags (R,), and others after them."""
        if isinstance(self.left, float):
            return self
        return Secant(self.way, np.concatenate([self.left[kept], np.zeros(more)]))


def _astray(motion: Motion, guards: Sequence[Guard]) -> bool:
    """Whether something is deeper in something, or a joint further off, than an update mends."""
    t = guarded(motion, guards, set())
    if not t.guards:
        return False
    rows = t.guard_rows(motion.x)
    return bool((np.abs(rows.violation()) > ASTRAY * rows.tolerance).any())


def _by_guard(guards: Sequence[GuardRows], flags: BoolArray) -> list[BoolArray]:
    """Flags of the rows of all guards, (U,), guard by guard."""
    ends = np.cumsum([len(guard.items) for guard in guards])
    return [flags[end - len(guard.items) : end] for guard, end in zip(guards, ends, strict=True)]


def pelvis_range(fit: Fit) -> tuple[float, float]:
    """The lowest and the highest place of a fit's pelvis, m."""
    height = fit.motion.joint_centres(fit.performance.times)[:, 0, 2]
    return float(height.min()), float(height.max())


def change(
    fit: Fit, was: tuple[float, float], setup: Setup, motion: Motion, seen: Traces
) -> DragSummary:
    """Change of a motion, as sampled (seen), against the fit. was: the fit's pelvis_range."""
    known = {c.name: place for c, place in zip(fit.schedule.contacts, fit.places, strict=True)}
    moves = [
        float(np.linalg.norm(place - known[c.name]))
        for c, place in zip(setup.schedule.contacts, motion.places, strict=True)
        if c.name in known
    ]
    now = seen.heads[:, 0, 2]
    forces = np.linalg.norm(seen.forces.sum(axis=1), axis=1)
    return DragSummary(
        moved_cm=100.0 * max(moves, default=0.0),
        deeper_cm=100.0 * (was[0] - float(now.min())),
        higher_cm=100.0 * (float(now.max()) - was[1]),
        peak_bw=float(forces.max(initial=0.0)) / seen.weight,
    )
