"""Constraint violations of an adaptation, by the names that the artist knows."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..analysis.pins.pinned_places import chosen_contacts, phase_of
from ..data.constants import STANDARD_GRAVITY
from ..data.problem import MotionProblem
from ..data.row_kinds import RowKind, Violation
from ..data.status import Status
from ..fitting.fit import Fit
from ..optimisation.guards import Guard, in_the_way
from ..stages.implicit import Adaptation
from ..transcription.constraint import DenseViolation, dense_violation
from ..transcription.motion import Motion
from .flight_summary import scene_frame

MOST_LISTED = 3  # constraints that a failure names


def pins_of_contacts(fit: Fit, problem: MotionProblem) -> dict[str, str]:
    """The artist's name of the pin that moves each contact, by the contact's name.

    Raises UnknownPhase, UnknownContact.
    """
    names: dict[str, str] = {}
    for pin in problem.pins:
        for i in chosen_contacts(pin, phase_of(pin, fit.schedule), fit.schedule):
            names[fit.schedule.contacts[i].name] = pin.name
    return names


def condition_violations(adaptation: Adaptation) -> list[DenseViolation]:
    """Worst violation of each of the artist's constraints, between the nodes too, and of what the
    motion was, or had to be, guarded from."""
    asked = _of_constraints(adaptation.motion)
    return asked + [each for guard in adaptation.setup.guards for each in _of(guard, adaptation)]


def _angles_in_space(adaptation: Adaptation) -> list[DenseViolation]:
    """Violations whose rows' values are no angles in space: of cones, and of joints' ranges."""
    motion, human = adaptation.motion, adaptation.setup.human
    cones = [each for each in _of_constraints(motion) if each.kind is RowKind.CONE]
    return cones + ([] if human is None else human.violations(motion))


def _of_constraints(motion: Motion) -> list[DenseViolation]:
    t = motion.transcription
    return [dense_violation(c, t.character, t.basis, t.layout, motion.x) for c in t.constraints]


def _of(guard: Guard, adaptation: Adaptation) -> list[DenseViolation]:
    of_guards = adaptation.outcome.status in (Status.SOLVED, Status.NO_BODY)
    if not of_guards and not guard.hard:  # of another failure what it failed for is told
        return []
    found, rows = (
        guard.violations(adaptation.motion),
        adaptation.motion.transcription.guard(guard.kind),
    )
    violated = {each.name for each in found}
    kept: dict[str, float] = {}
    if rows is not None:
        for item, time in zip(rows.items, rows.times, strict=True):
            kept.setdefault(rows.names[item], float(time))
    return found + [
        DenseViolation(name, guard.kind, 0.0, time)
        for name, time in kept.items()
        if name not in violated
    ]


def worst_constraints(
    adaptation: Adaptation,
    problem: MotionProblem,
    conditions: Sequence[DenseViolation] | None = None,
    *,
    least: float = 1.0,
) -> list[Violation]:
    """The violation of every contact, condition and phase's equations, worst first.

    Of a solve that failed: those that conflict where it got stuck, then what the best motion found
    misses. conditions: of the adaptation, where they are known. least: how often its tolerance a
    violation must reach to be listed.
    """
    stuck, motion = adaptation.stuck, adaptation.motion
    if stuck is not None and stuck is not adaptation.outcome:
        failed = replace(adaptation, outcomes=(stuck,), stuck=None)
        here = replace(adaptation, stuck=None)
        conflicts = worst_constraints(failed, problem, least=least)
        short = worst_constraints(here, problem, conditions, least=least)
        return conflicts + [each for each in short if each.name not in {c.name for c in conflicts}]
    t = motion.transcription
    rows = t.rows(motion.x, adaptation.outcome.places)
    pins = pins_of_contacts(adaptation.fit, problem)
    phases = adaptation.setup.schedule.phases
    owners = [
        name if pins.get(name, name) == name else f"{pins[name]}: {name}" for name in t.owners
    ]
    ends = [phase.end for phase in phases[:-1]]
    names = [*owners, *(phase.name for phase in phases)]
    named = np.where(rows.owner >= 0, rows.owner, len(owners) + np.searchsorted(ends, rows.time))
    found: dict[tuple[str, RowKind], tuple[float, float]] = {}  # and when, s
    none = 0.0, 0.0
    left = np.abs(rows.violation())
    for kind in RowKind:
        mine = rows.kind == kind
        for i in np.unique(named[mine]):
            these = np.flatnonzero(mine & (named == i))
            worst = these[left[these].argmax()]
            missed = float(left[worst]), float(rows.time[worst])
            found[names[i], kind] = max(found.get((names[i], kind), none), missed)
    for each in condition_violations(adaptation) if conditions is None else conditions:
        before = found.get((each.name, each.kind), none)
        found[each.name, each.kind] = max(before, (each.amount, each.time))
    for each in _angles_in_space(adaptation):
        if (each.name, each.kind) in found:
            found[each.name, each.kind] = each.amount, each.time
    ranked = sorted(
        ((v / kind.tolerance, time, name, kind) for (name, kind), (v, time) in found.items()),
        key=lambda each: each[0],
        reverse=True,
    )
    weight = t.character.mass * STANDARD_GRAVITY
    return [
        Violation(
            name,
            kind,
            kind.reported(share * kind.tolerance, weight),
            scene_frame(adaptation.fit, time),
        )
        for share, time, name, kind in ranked
        if share >= least
    ]


def most_telling(adaptation: Adaptation, problem: MotionProblem) -> tuple[Violation, ...]:
    """The few worst constraints of a failed solve, the worst that the artist asked for among them.

    What gives way first may be a foot that nobody moved; what it gave way to has to be named too,
    and the hard ranges that stand against it.
    """
    ranked = worst_constraints(adaptation, problem)
    asked = {pin.name for pin in problem.pins} | set(problem.requests.names)
    own = [each for each in ranked if each.name in asked or each.name.partition(": ")[0] in asked]
    first = ranked[:MOST_LISTED]
    if own and not any(each in first for each in own):
        first = [*first[: MOST_LISTED - 1], own[0]]
    named = {each.name for each in first}
    return (*first, *(each for each in _at_hard_ends(adaptation) if each.name not in named))


def _at_hard_ends(adaptation: Adaptation) -> list[Violation]:
    """The hard guards' items that pull the hardest where a solve got stuck: they hold, by 0."""
    stuck, setup = adaptation.stuck, adaptation.setup
    hard = {name: guard.kind for guard in setup.guards if guard.hard for name in guard.names}
    if not hard or stuck is None or not stuck.transcription.guards:
        return []
    feasible = setup.feasible_set(stuck.transcription, stuck.places)
    pulling = in_the_way(feasible, setup.metric_of(feasible.motion(stuck.x)), stuck.x)
    return [Violation(name, hard[name], 0.0) for name in sorted(pulling & hard.keys())]
