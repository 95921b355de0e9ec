"""Interactive drag: a few warm-started SQP steps for each new place of a dragged pin.

Moving a pin changes the rows' values, not their Jacobian, so most steps go on with the last factor
(chord steps); a new one is made where they no longer come near. Each update steps from the last one
by the smallest change: measured against steps towards the motion nearest to the fit, that is as
near to what the solve will find and does not jitter. Far moves are made by continuation, one step
an update; moving ground comes up to its speed likewise. The solve proper, once the pin is let go,
starts from the fit again. While a pin moves phases last as long as they did; once it rests they
take the durations that go with its place. What is solid is looked for in the motion before each
update, and kept out by the update.
"""

from dataclasses import replace

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.problem import MotionProblem
from ..data.report import DragSummary
from ..data.status import DragStatus
from ..data.traces import Traces
from ..optimisation.kkt_step import LinearisedProblem
from ..optimisation.sqp import restore
from ..transcription.motion import Motion
from .fit import Fit
from .implicit import Adaptation
from .platforms import find_standing
from .setup import Setup, set_up
from .warm_start import Standing, continuation_steps, partial_places, stance_moves, warm_start

CHORD_STEPS = 2  # an update, on the same factor
MAX_DRAG_CHORD_RATIO = 0.3  # of the violation, left by a chord step; beyond it the factor is stale
DIVERGED_VIOLATION = 1e5  # times the tolerances (1 m)
RESTING_UPDATES = 6  # at one place, after which a pin is no longer on its way
RETIMING_STEPS = 8  # at most, to a motion with other durations
FAR_SOLID = 0.02  # m beyond its bound, where a solid needs no row any more
MAX_BLOCKED_UPDATES = 4  # in which a solid does not come out, after which it is let be
SAME_DURATION = 1e-3  # s, by which nobody sees that a phase lasts longer
HELD_VIOLATION = 100.0  # times the tolerances (1 mm): a motion that serves to go back to


class Follower:
    """Warm-started tracking of a changing problem, from a fit or an adaptation of the same problem.

    violation: of `motion`, the worst over its tolerance.
    """

    def __init__(self, fit: Fit, problem: MotionProblem, last: Adaptation | None = None) -> None:
        self._fit, self._problem = fit, problem
        if last is None:
            self.setup = set_up(fit, problem)
            self.motion, self._metric = self.setup.start, self.setup.metric
            self._standing = Standing.still(self.motion.places)
        else:
            self.setup = last.setup
            self.motion = Motion(last.outcome.transcription, last.outcome.x, last.places)
            self._metric = self.setup.metric_of(self.motion)
            self._standing = Standing.of(self.motion)
        self._timed, self._rested = problem, 0  # whose durations these are; updates at one place
        self._linearised: LinearisedProblem | None = None
        self._held = self.motion, self._standing
        self._given_up: set[str] = set()  # solids that are let be
        self._blocked = 0  # updates in which a solid is furthest from where it should be
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
        whole = stance_moves(schedule, was, target)
        steps = continuation_steps(whole)
        if steps > 1:
            places = partial_places(schedule, was.places, target.places, whole, 1.0 / steps)
            target = target.slowed(was.share + (1.0 - was.share) / steps).with_places(places)
        x = warm_start(self.motion, stance_moves(schedule, was, target))
        self._keep_out()
        if not self._step(x, target):
            (self.motion, self._standing), self._linearised = self._held, None
            self._let_be(np.array(True))
            return DragStatus.DIVERGED
        self._watch_solids()
        if self.violation < HELD_VIOLATION:
            self._held = self.motion, self._standing
        there = steps == 1 and self.violation <= 1.0 and self._timed == problem
        return DragStatus.CONVERGED if there else DragStatus.CONVERGING

    def _target(self, problem: MotionProblem) -> Standing:
        return find_standing(self._fit, problem, self.setup.context)[0]

    def _set_up(self, problem: MotionProblem) -> None:
        """Sets up for other requests, from the same unknowns where basis and layout allow."""
        setup = set_up(self._fit, problem)
        old, new = self.motion.transcription, setup.start.transcription
        start, standing = setup.start, Standing.still(setup.start.places)
        if new.basis is old.basis and new.layout == old.layout:
            start, standing = Motion(new, self.motion.x, self.motion.places), self._standing
        self._begin(setup, start, standing, problem)

    def _retime(self, problem: MotionProblem) -> None:
        """Begins anew where other durations go with the pins, or where they had changed.

        Where that does not come near a motion the present one stays.
        """
        setup = set_up(self._fit, problem)
        self._timed = problem
        if np.allclose(setup.start.duration, self.motion.duration, atol=SAME_DURATION):
            return
        start, target = setup.start, setup.target
        feasible = setup.feasible_set(start.transcription, target.places)
        still = Standing.still(start.places)
        x = warm_start(start, stance_moves(setup.schedule, still, target))
        found = restore(feasible, setup.metric, x, stage="drag", max_steps=RETIMING_STEPS)
        if found.violation < HELD_VIOLATION:
            self._begin(setup, feasible.motion(found.x), target, problem)

    def _begin(
        self, setup: Setup, start: Motion, standing: Standing, problem: MotionProblem
    ) -> None:
        self.setup, self.motion, self._metric = setup, start, setup.metric
        self._standing, self._linearised, self._timed = standing, None, problem
        self._held = start, standing

    def _keep_out(self) -> None:
        """Rows for what is in each other now, without those that are far from it by now."""
        world, t, x = self.setup.solid, self.motion.transcription, self.motion.x
        if world is None or self.violation > HELD_VIOLATION:
            return
        solid = world.rows(self.motion, self._given_up)
        if solid is None:
            return
        rows = t.guarded((solid,)).guard_rows(x)
        near = rows.value - rows.lower < FAR_SOLID
        left = world.only(solid, near)
        t = t.guarded(() if left is None else (left,))
        if self._linearised is not None:
            self._linearised = self._linearised.widened(t, rows.some(near))
        self.motion = replace(self.motion, transcription=t)

    def _watch_solids(self) -> None:
        """Lets those be that what is asked for has kept from their place for some updates."""
        t = self.motion.transcription
        if not t.guards:
            return
        rows = t.guard_rows(self.motion.x)
        off = np.abs(rows.violation()) / rows.tolerance
        self._blocked = self._blocked + 1 if self.violation > 1.0 and off.max() > 1.0 else 0
        if self._blocked > MAX_BLOCKED_UPDATES:
            self._let_be(off > 1.0)
            self._blocked = 0

    def _let_be(self, which: BoolArray) -> None:
        """Gives up solids, by flags of their rows (U,)."""
        for guard in self.motion.transcription.guards:
            items = np.unique(guard.items[np.broadcast_to(which, guard.items.shape)])
            self._given_up |= {guard.names[item] for item in items.tolist()}

    def _step(self, x: FloatArray, standing: Standing) -> bool:
        """A few chord steps from unknowns x; False, having changed nothing, where they diverge."""
        t = self.motion.transcription
        if Standing.of(self.motion).rides != standing.rides:
            t = t.riding(standing.rides)
        feasible = self.setup.feasible_set(t, standing.places)
        value = feasible.values(x)
        try:
            linearised = self._linearised or feasible.linearise(feasible.rows(x), self._metric)
        except np.linalg.LinAlgError:  # too far from any motion
            return False
        for _ in range(CHORD_STEPS):
            before = linearised.violation(value)
            x = x + linearised.step(value)[0]
            value = feasible.values(x)
            after = linearised.violation(value)
            stale = after > MAX_DRAG_CHORD_RATIO * before
            if after <= 1.0 or stale:
                break
        if not after < DIVERGED_VIOLATION:
            return False
        self.violation = after
        self._linearised = None if stale and after > 1.0 else linearised
        self.motion, self._standing = feasible.motion(x), standing
        return True


def change(fit: Fit, setup: Setup, motion: Motion, seen: Traces) -> DragSummary:
    """Change of a motion, as sampled (seen), against the fit."""
    known = {c.name: place for c, place in zip(fit.schedule.contacts, fit.places, strict=True)}
    moves = [
        float(np.linalg.norm(place - known[c.name]))
        for c, place in zip(setup.schedule.contacts, motion.places, strict=True)
        if c.name in known
    ]
    was = fit.motion.joint_centres(fit.performance.times)[:, 0, 2]
    now = seen.heads[:, 0, 2]
    forces = np.linalg.norm(seen.forces.sum(axis=1), axis=1)
    return DragSummary(
        moved_cm=100.0 * max(moves, default=0.0),
        deeper_cm=100.0 * float(was.min() - now.min()),
        higher_cm=100.0 * float(now.max() - was.max()),
        peak_bw=float(forces.max(initial=0.0)) / seen.weight,
    )
