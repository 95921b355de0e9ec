"""Ground that moves: rides begin at rest in their place, and their rates are derivatives."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.scene import SceneObject, SceneRole, SteadyMotion
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.scene.object_motion import ObjectMotion
from hangtime.solver.transcription.contact_pins import PointContact
from hangtime.solver.transcription.friction_cones import FrictionCones
from hangtime.solver.transcription.motion import Motion
from hangtime.solver.transcription.ride import Ride
from hangtime.solver.transcription.transcription import Transcription
from hangtime.tests.helpers.moving import ground, keyed
from hangtime.tests.helpers.toy_problems import (
    CROUCH,
    DURATION,
    contacts,
    places,
    random_state,
    standing,
)

STEP = 1e-6
AT = np.array([0.05, 0.13, 0.21, 0.28])
PLACE = np.array([0.4, -0.3, 0.1])
GROUNDS = {
    "train": ground(SteadyMotion(velocity=(3.0, 1.0, 0.0))),
    "disc": ground(SteadyMotion(spin=2.0, pivot=(0.5, 0.5, 0.0))),
    "belt": ground(SteadyMotion(belt=(0.0, -2.0, 0.0))),
    "swing": keyed(
        lambda t: (np.array([t, 0.1 * t, t**2]), axis_rotation(0, 0.4 * np.sin(3.0 * t)))
    ),
    "everything": replace(
        keyed(lambda t: (np.array([t, 0.1 * t, t**2]), axis_rotation(0, 0.4 * np.sin(3.0 * t)))),
        steady=SteadyMotion((1.0, 0.0, 0.2), 1.5, (0.3, 0.0, 0.0), (0.0, 1.0, 0.5)),
    ),
}


def ride(name: str, since: float = 0.1) -> Ride:
    return Ride(ObjectMotion(GROUNDS[name], 1.0, 100.0), since)


@pytest.mark.parametrize("name", GROUNDS)
@pytest.mark.parametrize("share", [1.0, 0.4])
def test_rates_are_derivatives(name: str, share: float) -> None:
    each = ride(name).slowed(share)
    ahead, behind = (each.poses(AT + side * STEP) for side in (1.0, -1.0))
    rates = each.rates(AT)
    np.testing.assert_allclose(rates.turn, (ahead.turn - behind.turn) / (2 * STEP), atol=1e-6)
    np.testing.assert_allclose(rates.shift, (ahead.shift - behind.shift) / (2 * STEP), atol=1e-6)


@pytest.mark.parametrize("name", GROUNDS)
def test_a_ride_begins_where_it_stands(name: str) -> None:
    np.testing.assert_allclose(ride(name).poses(np.array([0.1])).of(PLACE), [PLACE], atol=1e-12)


def test_a_disc_turns_places_about_its_pivot() -> None:
    pivot = np.array([0.5, 0.5, 0.0])
    (at,) = ride("disc", 0.0).poses(np.array([0.2])).of(PLACE)
    np.testing.assert_allclose(at - pivot, axis_rotation(2, 0.4) @ (PLACE - pivot))


def test_a_belt_moves_in_the_objects_axes_which_stay() -> None:
    turned = replace(GROUNDS["belt"], rotations=axis_rotation(2, np.pi / 2)[None])
    poses = Ride(ObjectMotion(turned, 1.0, 100.0), 0.0).poses(np.array([0.5]))
    np.testing.assert_allclose(poses.of(PLACE)[0] - PLACE, [1.0, 0.0, 0.0], atol=1e-12)


def test_the_ground_under_a_place_has_its_own_velocity() -> None:
    velocity = ride("disc").velocity(PLACE, 0.25)
    np.testing.assert_allclose(velocity, 2.0 * np.cross([0.0, 0.0, 1.0], PLACE - [0.5, 0.5, 0.0]))


def test_a_retimed_contact_rides_from_its_new_landing_by_the_same_clock() -> None:
    later = replace(contacts()[0], ride=ride("swing", 0.0)).retimed(lambda t: t + 0.1)
    assert later.ride is not None
    assert later.ride.since == pytest.approx(0.1)
    assert later.ride.ground == ride("swing").ground


# -- in the equations -----------------------------------------------------------------------


def riding(name: str) -> Transcription:
    one, other = contacts()
    return replace(standing(), contacts=(replace(one, ride=ride(name, 0.0)), other))


@pytest.mark.parametrize("name", GROUNDS)
def test_jacobians_on_moving_ground_are_derivatives(name: str) -> None:
    t, x = riding(name), random_state(4)
    direction = np.random.default_rng(1).normal(size=x.shape) * t.active
    rows = t.rows(x, places())
    ahead, behind = (t.values(x + side * STEP * direction, places()) for side in (1.0, -1.0))
    blocks = t.basis.first_coefficient[rows.span][:, None] + np.arange(4)
    ours = np.einsum("rkn,rkn->r", rows.jacobian, direction[blocks])
    np.testing.assert_allclose(ours, (ahead - behind) / (2 * STEP), atol=1e-5)
    np.testing.assert_allclose(rows.value, t.values(x, places()))


def test_a_pinned_point_is_held_where_the_ground_takes_it() -> None:
    contact = replace(contacts()[0], ride=ride("train", 0.0))
    there = PLACE + 0.2 * np.array([3.0, 1.0, 0.0])
    error = contact.pin_error(there[None], PLACE, np.array([0.2]))
    np.testing.assert_allclose(error, 0.0, atol=1e-12)


def test_friction_cones_tilt_with_the_ground() -> None:
    def cones(contact: PointContact) -> FrictionCones:
        t = standing()
        return FrictionCones(t.basis, t.layout, [contact])

    still, x = contacts()[0], random_state(2)
    tilted = replace(still, ride=ride("swing", 0.0))
    was, now = cones(still).forces(x), cones(tilted).forces(x)
    np.testing.assert_allclose(np.linalg.norm(now, axis=1), np.linalg.norm(was, axis=1))
    np.testing.assert_allclose(now[0], was[0], atol=1e-12)  # where the ride begins
    tilt = 0.4 * np.sin(3.0 * 0.3)  # where it ends
    assert now[-1, 2] == pytest.approx(axis_rotation(0, tilt)[:, 2] @ world(x)[-1])


def world(x: np.ndarray) -> np.ndarray:
    """(U, 3) the left foot's force at the force nodes, world axes."""
    t = standing()
    nodes = np.unique(t.basis.force_nodes(np.arange(t.basis.n_spans)))
    return x[t.layout.force_block(nodes)][:, t.layout.force(0)]


@pytest.mark.parametrize(("friction", "slips"), [(0.31, False), (0.30, True)])
def test_a_cart_that_speeds_up_at_3_takes_friction_of_3_over_g(
    friction: float, slips: bool
) -> None:
    """By hand: the figure goes stiffly along, so the ground pushes with 3 / 9.81 of its weight."""
    speeding = keyed(lambda t: (np.array([1.5 * t**2, 0.0, 0.0]), np.eye(3)))
    on_cart = Ride(ObjectMotion(speeding, 1.0, 100.0), 0.0)
    stand = standing()
    each = [replace(c, ride=on_cart, friction=friction) for c in contacts()]
    t, x = replace(stand, contacts=tuple(each)), np.zeros(stand.active.shape)
    times = np.linspace(0.0, DURATION, 100)
    along = np.stack([1.5 * times**2, 0.0 * times, 1.0 + 0.0 * times], axis=1)
    x[:, t.layout.com], x[:, t.layout.angles] = t.basis.project(times, along, 0.0), CROUCH
    x[:, t.layout.force(0)] = [3.0 / STANDARD_GRAVITY, 0.0, 1.0]
    x[~t.active] = 0.0
    places = Motion(t, x, np.zeros((2, 3))).contact_points(np.zeros(1))[0]
    rows = t.rows(x, places)
    left = {kind: np.abs(rows.violation()[rows.kind == kind]).max() for kind in set(rows.kind)}
    for kind in (RowKind.PIN, RowKind.PIN_SPEED, RowKind.BALANCE):
        assert left[kind] < 1e-9, kind
    expected = 3.0 / STANDARD_GRAVITY - friction if slips else 0.0
    assert left[RowKind.FRICTION] == pytest.approx(expected, abs=1e-9)


def test_an_object_without_keys_or_rates_stands() -> None:
    assert not replace(GROUNDS["train"], steady=None).moves
    assert GROUNDS["train"].moves
    assert GROUNDS["swing"].moves
    assert GROUNDS["train"].role is SceneRole.GROUND
    assert isinstance(GROUNDS["train"], SceneObject)
