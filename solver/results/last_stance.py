"""Move of a motion's last stance, with which the rest of the take goes."""

import numpy as np

from ..data.stance_move import StanceMove
from ..stages.implicit import Adaptation
from ..stages.warm_start import Standing, end_move, stance_moves


def last_stance_move(adaptation: Adaptation) -> StanceMove | None:
    """The least-squares rigid move of the contacts that stand where the last stance ends, from
    which the body may fly on or something unseen carry it; None where no contacts were found.

    From where the fit has them, so that what nobody moves stays to the last bit; to where the
    motion has them, which short of its target is on the way there.
    """
    setup = adaptation.setup
    schedule = setup.schedule
    if adaptation.stood is None:
        after, turns = Standing.of(adaptation.motion), setup.turns
    else:
        after, turns = adaptation.stood, None
    moves = stance_moves(schedule, setup.fitted, after, turns)
    if not moves:
        return None
    last = end_move(schedule, setup.fitted, after, moves[-1])
    phase = next(p for p in schedule.phases if p.start <= last.start < p.end)
    px, py, pz = last.pivots[-1].tolist()
    x, y, z = np.asarray(last.shifts[-1]).tolist()
    return StanceMove(phase.name, (px, py, pz), float(last.turns[-1]), (x, y, z))
