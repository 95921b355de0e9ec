"""The equations on a small figure: every Jacobian, and balance between the nodes."""

import numpy as np
import pytest
from hangtime.solver.closeness import Closeness, Prices
from hangtime.solver.fit import motion_target
from hangtime.solver.motion import Motion, unexplained
from hangtime.solver.projection import restore
from hangtime.solver.rows import RowKind
from hangtime.solver.splines import ORDER
from hangtime.solver.status import Status
from hangtime.solver.transcription import Transcription
from hangtime.tests.solver.toys import DURATION, LIFT, places, random_state, standing

STEP = 1e-6


def released() -> Transcription:
    """One force of each foot held at zero."""
    return standing().release(frozenset({(1, 0), (2, 1)}))


def directional(t: Transcription, x: np.ndarray, direction: np.ndarray) -> np.ndarray:
    ahead, behind = (t.residuals(x + s * STEP * direction, places()) for s in (1.0, -1.0))
    return (ahead - behind) / (2.0 * STEP)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("make", [standing, released])
def test_jacobians_are_the_residuals_slopes(make: type, seed: int) -> None:
    t = make()
    x = random_state(seed)
    direction = np.random.default_rng(50 + seed).normal(size=x.shape) * t.active
    rows = t.rows(x, places())
    blocks = t.basis.first_coefficient[rows.span][:, None] + np.arange(ORDER)
    ours = np.einsum("rkn,rkn->r", rows.jacobian, direction[blocks])
    theirs = directional(t, x, direction)
    for kind in set(rows.kind):
        mine = rows.kind == kind
        scale = np.abs(theirs[mine]).max()
        assert scale > 0.01
        assert ours[mine] == pytest.approx(theirs[mine], abs=2e-7 * max(scale, 1.0)), kind


def test_rows_and_residuals_agree() -> None:
    t, x = released(), random_state(9)
    rows = t.rows(x, places())
    assert rows.residual == pytest.approx(t.residuals(x, places()), abs=1e-12)
    assert set(RowKind) == set(rows.kind)  # every kind is covered by these tests


def test_unknowns_that_do_not_exist_have_no_slopes() -> None:
    t = standing()
    rows = t.rows(random_state(1), places())
    blocks = t.basis.first_coefficient[rows.span][:, None] + np.arange(ORDER)
    assert not rows.jacobian[~t.active[blocks]].any()


def test_forces_exist_while_their_contact_lasts_and_end_at_zero() -> None:
    t = standing()
    motion = Motion(t, np.where(t.active, 1.0, 0.0), places())
    right = motion.forces(np.array([0.01, LIFT - 0.01, LIFT - 1e-9, LIFT + 1e-9, 0.25]))[:, 1, 2]
    assert (right[:2] > 0.0).all()
    assert right[2:] == pytest.approx(0.0, abs=1e-3)
    left = motion.forces(np.array([0.0, DURATION]))[:, 0, 2]  # the clip cuts this contact off
    assert (left > 0.0).all()


def solved() -> Motion:
    t = standing()
    x = random_state(3, size=0.02)
    start = Motion(t, x, places())
    metric = Closeness(t, motion_target(start), Prices(shape=1.0, com=0.1)).expand(x)[1]
    outcome = restore(t, metric, x, places(), stage="toy")
    assert outcome.status is Status.SOLVED
    return Motion(outcome.transcription, outcome.x, places())


def test_once_the_rows_hold_balance_holds_at_every_instant() -> None:
    motion = solved()
    times = np.random.default_rng(0).uniform(0.0, DURATION, 500)
    assert np.abs(unexplained(motion, times).force).max() < 2e-5


def test_once_the_rows_hold_the_feet_stay() -> None:
    motion = solved()
    for i, contact in enumerate(motion.transcription.contacts):
        breaks = motion.transcription.basis.breaks
        inside = breaks[(breaks >= contact.pin_start) & (breaks <= contact.pin_end)]
        assert motion.drift(i, inside).max() < 2e-5


def test_pulling_forces_are_found_and_released() -> None:
    t, x = standing(), random_state(2)
    node, point = 2, 0
    x[node + 1, t.layout.force(point).start + 2] = -0.3
    x[4, t.layout.force(point).start + 2] = -0.001
    assert (node, point) in t.pulling(x, 0.01)
    assert (3, point) not in t.pulling(x, 0.01)
    held = t.release(frozenset({(node, point)}))
    assert held.released == {(node, point)}
    assert t.released == frozenset()
