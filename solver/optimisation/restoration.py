"""Restoration to the feasible set: minimum-norm steps until all rows hold (thesis 4.4)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..data.status import Status
from ..numerics.block_banded import BlockBanded
from ..transcription.rows import Rows
from .kkt_step import LinearisedProblem, Remains
from .local_steps import local_step, parts_around
from .sqp import NEARLY_FEASIBLE, FeasibleSet, Outcome, Progress, Step, worst_violation

MAX_CHORD_RATIO = 0.03  # of the violation that a step leaves, for the next to keep its Jacobian
MAX_CHORD_REST = 0.5  # tolerances, which the last of chord steps must be expected to leave
MAX_CHORD_STEPS = 3  # in which what is left must be expected to end: a new factor costs as much
MAX_CHORD_GUARDED = 10.0  # tolerances (1 cm, 1 degree) by which guards join, for a chord step
MAX_STEPS = 30  # of a restoration
MIN_RESTORATION_LENGTH = 0.005
STALL_WINDOW = 6  # steps in which the violation has to halve
MAX_CREEPING = 3  # steps in a row that are shorter than a tenth: such solves arrive nowhere
LOCAL_GAIN = 0.5  # of the violation, which a step in parts may leave: they are not to creep
RECOVERED = 0.9  # of the violation before a watched step, which the one after it must reach
# Times the tolerances: from further off guards join where a step leads; once more this near, for
# what joins where all the rest holds costs steps of its own.
GUARDS_JOIN = 10.0

Wider = Callable[[FeasibleSet, FloatArray], FeasibleSet]
"""A set with the guard rows that unknowns (K, n_block) call for as well, or the very same."""


def restore(
    feasible: FeasibleSet,
    metric: BlockBanded,
    x: FloatArray,
    *,
    stage: str,
    max_steps: int = MAX_STEPS,
    max_turn: float = np.inf,
    progress: Progress | None = None,
    wider: Wider | None = None,
    last: Remains | None = None,
) -> Outcome:
    """Feasibility restoration: minimum-norm steps until all rows hold (thesis 4.4).

    metric: W, fixed. x: (K, n_block). A line search on the summed squared violation guards the
    steps (thesis eq. 4.6). Near the end a whole step is taken though it raises that, for Newton's
    own steps end where shortened ones creep; if the one after it does not make up for it, both are
    taken back (the watchdog technique of Chamberlain, Powell, Lemarechal and Pedersen 1982). While
    steps gain an order of magnitude, the next one uses the same Jacobian and factor, which costs a
    third of a new one (chord steps). Where few spans are violated the next step is of what is about
    them (local_steps.py). max_turn: rad, of a joint in one step. wider: asked where a step of the
    whole with a new Jacobian would lead, where the rows nearly hold, and where they hold, for a set
    with more guard rows to go on in. Those that join ahead of a step cost it no new factor, and
    what they ask for is in one step with all else. last: what a step before it leaves, with the
    same rows.
    """
    iterate = _ChordIterate(feasible, metric, x, max_turn, wider, last)
    join, asked = [1.0, GUARDS_JOIN], None  # asked: x, where nothing new can join
    steps: list[Step] = []
    status = Status.TOO_MANY_STEPS
    while True:
        if iterate.x is not asked and iterate.violation <= join[-1]:
            asked, join = iterate.x, join[:1]
            iterate.widen(iterate.x)
        if iterate.violation <= 1.0:
            status = Status.SOLVED
            break
        if len(steps) >= max_steps:
            break
        step = iterate.advance(stage)
        if step is None:
            continue
        steps.append(step)
        if progress is not None:
            progress(step, iterate.feasible.motion(iterate.kept))
        if iterate.violation > 1.0 and (step.length == 0.0 or _stagnant(steps)):
            status = Status.STALLED
            break
    if status is not Status.SOLVED:
        iterate.take_back()
    return iterate.feasible.outcome(iterate.x, status, steps, iterate.violation)


class _ChordIterate:
    """Unknowns x on their way to the feasible set; keeps Jacobian and factor while they serve."""

    def __init__(
        self,
        feasible: FeasibleSet,
        metric: BlockBanded,
        x: FloatArray,
        max_turn: float,
        wider: Wider | None,
        last: Remains | None,
    ) -> None:
        self.feasible, self._metric, self._max_turn = feasible, metric, max_turn
        self._wider, self._remains = wider, last
        rows = feasible.rows(x)
        self.x, self.violation = x, worst_violation(rows)
        self._value = rows.value
        self._rows: Rows | None = rows  # with their Jacobian, until the first step
        self._linearised: LinearisedProblem | None = None
        self._before = np.inf  # violation before the last step
        self._stale = self._chord = self._renewing = False
        self._watched: _Watched | None = None
        self._watching = True
        self._whole = False  # whether steps in parts are no more taken
        self._guards = int(rows.guards.sum())  # which are the last

    def advance(self, stage: str) -> Step | None:
        """Takes a step; None where a chord step was shortened, so that a new Jacobian is due, or
        where steps were taken back."""
        if (parts := self._violated_parts()) and (step := self._advance_in(parts, stage)):
            return step
        slow = self._linearised is None or not self._gains()
        fresh = slow or self._stale or (self._renewing and not self._nearly_there())
        linearised = self._linearise() if fresh or self._linearised is None else self._linearised
        d, longest = self._step(linearised)
        ahead = fresh and longest == 1.0 and self._watched is None and np.isfinite(d).all()
        if ahead and self.violation > GUARDS_JOIN and self.widen(self.x + d):
            assert self._linearised is not None
            linearised = self._linearised
            d, longest = self._step(linearised)
        before, worst = self.violation, linearised.worst_owner(self._value)
        watched = fresh and longest == 1.0 and self._watching and self._watched is None
        start = _Watched(self.x, self._value, before, self._before)
        trial = _shorten(
            self.feasible,
            linearised,
            self.x,
            d,
            self._value,
            longest=longest,
            watched=watched,
        )
        self.x, self._value = trial.x, trial.value
        self._renewing = slow and trial.length == longest
        self.violation = linearised.violation(trial.value)
        if self._watched is not None:
            if not self.violation < RECOVERED * self._watched.violation:
                self.take_back()
                return None
            self._watched = None
        elif trial.raises:
            self._watched = start
        self._stale = trial.length < 1.0 and not fresh
        if self._stale:
            return None
        self._before, self._chord = before, not fresh
        return Step(stage, before, trial.length, worst)

    def _violated_parts(self) -> list[slice]:
        """Where few of many spans are violated, what is about them; else none."""
        t, linearised = self.feasible.transcription, self._linearised
        if linearised is None or self._whole or self._watched is not None or t.seam is not None:
            return []
        violated = linearised.violations(self._value) > 1.0
        return parts_around(np.unique(linearised.rows.span[violated]), t.basis.breaks)

    def _advance_in(self, parts: list[slice], stage: str) -> Step | None:
        """Takes a step in each of these parts; None where that would turn a joint too far, and
        none any more where it gains little."""
        feasible, linearised = self.feasible, self._linearised
        assert linearised is not None
        t, places, basis = feasible.transcription, feasible.places, feasible.basis
        d = np.zeros_like(self.x)
        for part in parts:
            d += local_step(t, places, self._metric, self.x, part, basis)
        if self._longest(d) < 1.0:
            return None
        value = feasible.values(self.x + d)
        before, worst = self.violation, linearised.worst_owner(self._value)
        violation = linearised.violation(value)
        if not violation <= max(1.0, LOCAL_GAIN * before):
            self._whole = True
            return None
        self.x, self._value, self.violation = self.x + d, value, violation
        self._before, self._chord, self._stale = before, False, True
        return Step(stage, before, 1.0, worst)

    def _step(self, linearised: LinearisedProblem) -> tuple[FloatArray, float]:
        """The step (K, n_block), and how much of it turns no joint too far."""
        d = linearised.step(self._value, limp_to_middle=True).d
        return d, self._longest(d)

    def _longest(self, d: FloatArray) -> float:
        """How much of a step d (K, n_block) turns no joint too far."""
        turn = float(np.abs(d[:, self.feasible.transcription.layout.angles]).max())
        return self._max_turn / turn if turn > self._max_turn else 1.0

    @property
    def kept(self) -> FloatArray:
        """(K, n_block) unknowns that stay if no step follows."""
        return self.x if self._watched is None else self._watched.x

    def take_back(self) -> None:
        """Goes back to before a watched step, if the last was one; no more are watched."""
        if self._watched is None:
            return
        back, self._watched, self._watching = self._watched, None, False
        self.x, self._value, self.violation = back.x, back.value, back.violation
        self._before, self._stale = back.before, True

    def _gains(self) -> bool:
        """Whether the last step gained so much that the next may keep its Jacobian: for many more,
        or, as a chord step gains what the one before it did, for the few that end it."""
        share = self.violation / self._before
        if self._chord and self.violation * share**MAX_CHORD_STEPS < MAX_CHORD_REST:
            return True
        return self.violation <= MAX_CHORD_RATIO * self._before

    def _nearly_there(self) -> bool:
        """Whether a chord step will end it: of what is left, its Jacobian leaves twice the share
        that its own step, Newton's, left."""
        return 2.0 * self.violation**2 < MAX_CHORD_REST * self._before

    def widen(self, x: FloatArray) -> bool:
        """Goes on with the guard rows that x (K, n_block) calls for, if there are new ones, and
        with a new Jacobian where one that joins asks for a long way: the steps before tell how well
        the old one serves near by."""
        feasible = self.feasible if self._wider is None else self._wider(self.feasible, x)
        if feasible is self.feasible:
            return False
        t, self.feasible = feasible.transcription, feasible
        guards = t.guard_rows(self.x)
        if self._linearised is not None:
            self._linearised = self._linearised.widened(t, guards)
        kept = np.arange(len(self._value)) < len(self._value) - self._guards
        self._value = np.concatenate([self._value[kept], guards.value])
        joined = worst_violation(guards)
        self._guards = len(guards.value)
        self._stale = self._stale or joined > MAX_CHORD_GUARDED
        self._rows = self._watched = self._remains = None  # these rows are others
        self.violation, self._before = max(self.violation, joined), np.inf
        return True

    def _linearise(self) -> LinearisedProblem:
        rows, self._rows = self._rows or self.feasible.rows(self.x), None
        last, self._remains = self._remains, None
        if self._linearised is not None:
            last = self._linearised.remains
        self._linearised = None  # as large as all else together: not two at a time
        self._linearised = self.feasible.linearise(rows, self._metric, last)
        return self._linearised


def _stagnant(steps: list[Step]) -> bool:
    """Whether the last steps creep, or did not even halve the violation."""
    if len(steps) >= MAX_CREEPING and all(step.length < 0.1 for step in steps[-MAX_CREEPING:]):
        return True
    if len(steps) < 2 * STALL_WINDOW:
        return False
    return steps[-1].violation > 0.5 * steps[-1 - STALL_WINDOW].violation


@dataclass(frozen=True)
class _Watched:
    """Where a step that raises the violation began: unknowns, the rows' values, their violation,
    and that before the step that led there."""

    x: FloatArray
    value: FloatArray
    violation: float
    before: float


@dataclass(frozen=True)
class _Trial:
    """Trial point: unknowns, the rows' values, and step length.
    raises: whether it is no better than where it began."""

    x: FloatArray
    value: FloatArray
    length: float
    raises: bool = False


def _shorten(
    feasible: FeasibleSet,
    linearised: LinearisedProblem,
    x: FloatArray,
    d: FloatArray,
    value: FloatArray,
    *,
    longest: float,
    watched: bool,
) -> _Trial:
    """Backtracking line search on the summed squared violation; length 0 if nothing lowers it.

    Near the end, where what is left of different rows has different units, lowering the worst
    violation counts as well. longest: the first length. watched: whether a whole step near the
    end may lower nothing.
    """
    before, worst = linearised.merit(value), linearised.violation(value)
    length = longest
    while length > MIN_RESTORATION_LENGTH:
        trial = x + length * d
        left = feasible.values(trial)
        enough = 1.0 - 0.1 * length
        near = worst < NEARLY_FEASIBLE and linearised.violation(left) < enough * worst
        if near or linearised.merit(left) < enough * before:
            return _Trial(trial, left, length)
        if (
            watched
            and length == longest
            and max(worst, linearised.violation(left)) < NEARLY_FEASIBLE
        ):
            return _Trial(trial, left, length, raises=True)
        length *= 0.5
    return _Trial(x, value, 0.0)
