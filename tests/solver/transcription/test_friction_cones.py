"""Forces push within friction cones: round and pyramid, on floors and slopes, but for grips."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.status import Status
from hangtime.solver.numerics.rotations import unit
from hangtime.solver.numerics.splines import ORDER
from hangtime.solver.transcription.contact_pins import PointContact
from hangtime.solver.transcription.friction_cones import FrictionCones
from hangtime.solver.transcription.motion import Motion
from hangtime.tests.helpers.toy_problems import (
    DURATION,
    STEP,
    contacts,
    places,
    random_state,
    restored,
    standing,
    stood,
)
from hypothesis import given
from hypothesis import strategies as st

FLOOR = np.array([0.0, 0.0, 1.0])
NORMALS = {"floor": FLOOR, "nearly floor": [0.03, 0.01, 1.0], "slope": [0.3, -0.4, 1.0]}


def cones(changed: Sequence[PointContact]) -> FrictionCones:
    return FrictionCones(standing().basis, standing().layout, changed)


def left(**changes: object) -> PointContact:
    return replace(contacts()[0], **changes)


def excess(force: np.ndarray, contact: PointContact) -> tuple[float, float]:
    """Least push and greatest friction row when the left foot's force is everywhere `force`."""
    x = random_state(0)
    x[:, standing().layout.force(0)] = force
    push, friction = cones([contact]).rows(x)
    return float(push.value.min()), float(friction.value.max())


@pytest.mark.parametrize("pyramid", [False, True])
@pytest.mark.parametrize("name", NORMALS)
def test_slopes(name: str, *, pyramid: bool) -> None:
    normal = unit(np.array(NORMALS[name], dtype=float))
    made = cones([left(normal=normal, pyramid=pyramid, friction=0.7), contacts()[1]])
    x, t = random_state(1), standing()
    direction = np.random.default_rng(2).normal(size=x.shape)
    ours, values = [], []
    for rows in made.rows(x):
        blocks = t.basis.first_coefficient[rows.span][:, None] + np.arange(ORDER)
        ours.append(np.einsum("rkn,rkn->r", rows.jacobian, direction[blocks]))
        values.append(rows.value)
    ahead, behind = (made.values(x + s * STEP * direction) for s in (1.0, -1.0))
    numeric = (ahead - behind) / (2.0 * STEP)
    assert np.concatenate(values) == pytest.approx(made.values(x), abs=1e-14)
    assert np.abs(numeric).max() > 0.1
    assert np.concatenate(ours) == pytest.approx(numeric, abs=1e-6)


@pytest.mark.parametrize("name", NORMALS)
def test_a_force_is_split_into_its_parts(name: str) -> None:
    """Along two tangents and the normal, none of it lost."""
    normal = unit(np.array(NORMALS[name], dtype=float))
    x = random_state(3)
    found = cones([left(normal=normal)]).forces(x)
    nodes = standing().active[:, standing().layout.force(0).start]
    world = x[nodes][:, standing().layout.force(0)]
    assert len(found) == len(world)
    assert found[:, 2] == pytest.approx(world @ normal)
    assert np.linalg.norm(found, axis=1) == pytest.approx(np.linalg.norm(world, axis=1))


@pytest.mark.parametrize("pyramid", [False, True])
def test_what_cones_allow(*, pyramid: bool) -> None:
    foot = left(friction=0.5, pyramid=pyramid)
    assert excess(np.array([0.0, 0.0, 1.0]), foot) == pytest.approx((1.0, -0.5))
    assert excess(np.array([0.5, 0.0, 1.0]), foot) == pytest.approx((1.0, 0.0))
    assert excess(np.array([0.0, -0.7, 1.0]), foot) == pytest.approx((1.0, 0.2))
    assert excess(np.array([0.0, 0.0, -0.3]), foot)[0] == pytest.approx(-0.3)


def test_the_pyramid_cuts_the_cone_s_corners() -> None:
    force = np.array([0.3, 0.3, 1.0])
    assert excess(force, left(friction=0.5))[1] < 0.0
    assert excess(force, left(friction=0.5, pyramid=True))[1] == pytest.approx(0.1)


@given(st.tuples(*[st.floats(-1.0, 1.0)] * 3), st.floats(0.05, 1.5))
def test_the_pyramid_is_inside_the_cone(force: tuple[float, float, float], mu: float) -> None:
    round_one, flat = (
        excess(np.array(force), left(friction=mu, pyramid=p))[1] for p in (False, True)
    )
    assert round_one <= flat + 1e-12


def test_every_force_of_a_contact_is_bounded_and_no_other() -> None:
    push, friction = cones(contacts()).rows(random_state(4))
    active = standing().active[:, standing().layout.forces].any(axis=0).sum()
    assert active == 6
    count = int(standing().active[:, standing().layout.forces].sum()) // 3
    assert len(push.value) >= count  # the last node of a lifted foot is zero: an empty row
    assert len(push.value) == len(friction.value)
    assert set(push.kind) == {RowKind.PUSH}
    assert (push.time[push.owner == 1] <= contacts()[1].contact.end).all()
    assert push.time.min() == 0.0
    assert push.time.max() == pytest.approx(DURATION)


def test_grips_may_pull() -> None:
    push, friction = cones([left(friction=None)]).rows(random_state(5))
    assert len(push.value) == len(friction.value) == 0
    push, _ = cones([left(friction=None), contacts()[1]]).rows(random_state(5))
    assert set(push.owner) == {1}


@pytest.mark.parametrize("pyramid", [False, True])
def test_little_friction_is_kept_between_the_nodes_too(*, pyramid: bool) -> None:
    """The standing figure on a floor on which its first guess slips."""
    slippery = tuple(replace(c, friction=0.3, pyramid=pyramid) for c in contacts())
    t = replace(standing(), contacts=slippery)
    assert t.cones.rows(stood().x)[1].violation().max() > 10.0 * RowKind.FRICTION.tolerance
    outcome = restored(t, stood())
    assert outcome.status is Status.SOLVED
    times = np.linspace(0.0, DURATION, 400)
    forces = Motion(t, outcome.x, places()).forces(times) / (t.character.mass * 9.81)
    sideways = np.linalg.norm(forces[..., :2], axis=-1)
    slack = RowKind.FRICTION.tolerance + 1e-9
    assert (sideways <= 0.3 * forces[..., 2] + slack).all()
    assert forces[..., 2].min() >= -RowKind.PUSH.tolerance - 1e-9
