"""A motion that follows a pin while it is dragged: a few warm-started steps for each new place.

Moving a pin changes the rows' values, not their Jacobian, so most steps go on with the last factor
(chord steps); a new one is made where they no longer come near. Each update steps from the last one
by the smallest change: measured against steps towards the motion nearest to the fit, that is as
near to what the solve will find and does not jitter. Far moves are made in stages, one an update.
The solve proper, once the pin is let go, starts from the fit again.
"""

from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..data.problem import MotionProblem
from ..data.report import DragSummary
from ..data.status import DragStatus
from ..data.traces import Traces
from ..optimisation.kkt_step import Linearised
from ..transcription.motion import Motion
from .fit import Fit
from .implicit import Adaptation
from .setup import Setup, goal_places, set_up
from .warm_start import stage_count, staged, stance_moves, warm_start

CHORDS = 2  # steps an update on the same factor
GAIN = 0.3  # of the violation: what a chord step must leave at most, or the factor is stale
LOST = 1e5  # times the tolerances (1 m)
NEAR = 100.0  # times the tolerances (1 mm): where the last factor still serves


class Follower:
    """The motion as it follows; begins at a fit, or at an adaptation of the same problem."""

    def __init__(self, fit: Fit, problem: MotionProblem, last: Adaptation | None = None) -> None:
        self._fit, self._problem = fit, problem
        self._plan = set_up(fit, problem)
        self.motion = self._plan.start
        if last is not None:
            self.motion = Motion(last.outcome.transcription, last.outcome.x, last.places)
            self._plan = last.plan
        self._metric = self._plan.metric if last is None else self._plan.metric_of(self.motion)
        self._line: Linearised | None = None
        self._held = self.motion
        self.violation = np.inf

    @property
    def plan(self) -> Setup:
        return self._plan

    def follow(self, problem: MotionProblem) -> DragStatus:
        """Steps towards what a problem asks for now; a motion that is lost goes back to where it
        last held.

        Raises as arrange does, leaving the motion as it was.
        """
        if replace(problem, pins=()) != replace(self._problem, pins=()):
            self._rearrange(problem)
        self._problem = problem
        goal = goal_places(self._fit, problem, self._plan.schedule)
        was = self.motion.places
        whole = stance_moves(self._plan.schedule, was, goal)
        stages = stage_count(whole)
        if stages > 1:
            goal = staged(self._plan.schedule, was, goal, whole, 1.0 / stages)
        x = warm_start(self.motion, stance_moves(self._plan.schedule, was, goal))
        if not self._settle(x, goal):
            self.motion, self._line = self._held, None
            return DragStatus.DIVERGED
        if self.violation < NEAR:
            self._held = self.motion
        there = stages == 1 and self.violation <= 1.0
        return DragStatus.CONVERGED if there else DragStatus.CONVERGING

    def _rearrange(self, problem: MotionProblem) -> None:
        """Other bounds or places of points: the same unknowns where the structure allows."""
        plan = set_up(self._fit, problem)
        old, new = self.motion.transcription, plan.start.transcription
        start = plan.start
        if new.basis is old.basis and new.layout == old.layout:
            start = Motion(new, self.motion.x, self.motion.places)
        self._plan, self.motion, self._metric = plan, start, plan.metric
        self._line, self._held = None, start

    def _settle(self, x: FloatArray, places: FloatArray) -> bool:
        """A few steps from unknowns x; False, having changed nothing, where they lead astray."""
        t = self.motion.transcription
        value = t.values(x, places)
        try:
            line = self._line or self._linearised(x, places)
        except np.linalg.LinAlgError:  # too far from any motion
            return False
        for _ in range(CHORDS):
            before = line.worst(value)
            x = x + line.step(value)[0]
            value = t.values(x, places)
            after = line.worst(value)
            if after <= 1.0 or after > GAIN * before:
                break
        if not after < LOST:
            return False
        self.violation = after
        self._line = line if after < NEAR else None
        self.motion = Motion(t, x, places)
        return True

    def _linearised(self, x: FloatArray, places: FloatArray) -> Linearised:
        t = self.motion.transcription
        return Linearised(t, t.rows(x, places), self._metric, basis=self._plan.basis)


def change(fit: Fit, plan: Setup, motion: Motion, seen: Traces) -> DragSummary:
    """Change of a motion against the fit. seen: the motion's traces."""
    known = {c.name: place for c, place in zip(fit.schedule.contacts, fit.places, strict=True)}
    moves = [
        float(np.linalg.norm(place - known[c.name]))
        for c, place in zip(plan.schedule.contacts, motion.places, strict=True)
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
