"""Continuation: a far edit's pins and bounds move in several steps (Allgower & Georg 1990).

Guards join within each step, ahead of what would break them; what they hold back goes on without
them, if it must.
"""

from collections.abc import Sequence
from functools import partial

from ..arrays import FloatArray
from ..data.row_kinds import RowKind
from ..fitting.fit import MAX_TURN
from ..inverse_kinematics.arm_ik import reach_grips
from ..optimisation.guards import Guard, with_guards
from ..optimisation.restoration import restore
from ..optimisation.sqp import FeasibleSet, Outcome, Progress
from ..transcription.motion import Motion
from .setup import Setup
from .warm_start import continuation_steps, partial_places, stance_moves, warm_start


def continuation(
    setup: Setup, times: int, progress: Progress | None, *, giving_up: bool
) -> tuple[list[Outcome], int]:
    """Solves in as many steps as the pins' moves ask for, times `times`; bounds ease in. The
    outcomes of those that were taken, the last of which may have failed, and how many there were
    to be.

    giving_up: whether a step goes on without the guards that hold it back.
    """
    on_the_way = _on_the_way(setup)
    motion, schedule = setup.start, setup.schedule
    before = last = setup.fitted.with_places(motion.places)
    whole = stance_moves(schedule, before, setup.target, setup.turns, setup.seats)
    steps = times * continuation_steps(whole)
    outcomes: list[Outcome] = []
    for step in range(1, steps + 1):
        standing, places = setup.target, setup.target_places
        transcription = setup.start.transcription
        if step < steps:
            places = partial_places(schedule, before.places, places, whole, step / steps)
            standing = setup.target.slowed(step / steps, before).with_places(places)
        if step < steps and standing.moves:
            transcription = transcription.riding(standing.rides)
        start = warm_start(motion, stance_moves(schedule, last, standing, seats=setup.seats))
        if transcription.seam is not None:
            start = transcription.seam.closed(start, setup.metric)
        if step == 1:  # where nothing is gripped this changes nothing
            ranges = () if setup.human is None else setup.human.ranges
            start = reach_grips(Motion(transcription, start, places), setup.target_places, ranges).x
        if step < steps:
            transcription = transcription.relaxed(start, 1.0 / (steps - step + 1))
        feasible = setup.feasible_set(transcription, places)
        guards = setup.guards if step == steps else on_the_way
        ways = _ways_to_guard(guards) if giving_up else [guards]
        outcome = _restored(feasible, start, setup, progress, ways)
        outcomes.append(outcome)
        motion = setup.feasible_set(outcome.transcription, places).motion(outcome.x)
        last = standing
        if not outcome.solved:
            break
    return outcomes, steps


def _on_the_way(setup: Setup) -> tuple[Guard, ...]:
    """Guards of the steps before the last: floor and scene are not yet where they shall be, but a
    joint that once is far beyond its range, or an arm that is through the trunk, finds a long way
    back."""
    guards: list[Guard] = [] if setup.human is None else [setup.human]
    if setup.solid is not None:
        guards.append(setup.solid.limbs_alone())
    return tuple(guards)


def _restored(
    feasible: FeasibleSet,
    start: FloatArray,
    setup: Setup,
    progress: Progress | None,
    ways: Sequence[tuple[Guard, ...]],
) -> Outcome:
    """A continuation step; the guards join within it, in the first of `ways` that helps."""
    attempt = partial(
        restore,
        feasible,
        setup.metric,
        start,
        stage="adapt",
        max_turn=MAX_TURN,
        progress=progress,
    )
    outcome = attempt(wider=partial(with_guards, ways[0]))
    for fewer in ways[1:]:
        # Where those that are left out have not joined it would go as before.
        if not outcome.solved and not _joined(outcome) <= {guard.kind for guard in fewer}:
            outcome = attempt(wider=partial(with_guards, fewer))
    return outcome


def _joined(outcome: Outcome) -> set[RowKind]:
    """Kinds of the guards that joined."""
    return {guard.kind for guard in outcome.transcription.guards}


def _ways_to_guard(guards: tuple[Guard, ...]) -> list[tuple[Guard, ...]]:
    """By which guards a step is tried in turn: all, some, and none but hard ones.

    Where not all can be kept, floor and limbs go before ranges, unless these are hard.
    """
    hard = tuple(guard for guard in guards if guard.hard)
    solids = tuple(guard for guard in guards if guard.kind is RowKind.SOLID)
    ways = [guards]
    for fewer in (hard,) if hard else (solids, ()):
        if len(fewer) < len(ways[-1]):
            ways.append(fewer)
    return ways
