"""The equations on a small figure: every Jacobian, and balance between the nodes."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.solver.data.requests import (
    ALWAYS,
    AngleLimit,
    ConeLimit,
    ForceRequest,
    OrientationRequest,
    PointRequest,
    PoseRequest,
    Requests,
    TorqueLimit,
    TwistLimit,
)
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.status import Status
from hangtime.solver.human.human_guard import RangeLeft, recorded_ranges
from hangtime.solver.numerics.rotations import unit
from hangtime.solver.numerics.splines import ORDER
from hangtime.solver.solid.penetrations import Penetrations
from hangtime.solver.solid.solid_world import SolidDistance, solid_world
from hangtime.solver.transcription.contact_pins import PlaceTrajectory, PointContact
from hangtime.solver.transcription.guard_rows import GuardRows
from hangtime.solver.transcription.motion import Motion, dynamics_residual
from hangtime.solver.transcription.transcription import Transcription
from hangtime.tests.helpers.toy_problems import (
    DURATION,
    LIFT,
    STEP,
    asked,
    contacts,
    places,
    random_state,
    restored,
    standing,
    stood,
)

SPEED = np.array([0.2, -0.1, 0.1])  # m/s, of what carries the left foot


def with_contacts(*changed: PointContact) -> Transcription:
    return replace(standing(), contacts=changed)


@cache
def tilted() -> Transcription:
    """A foot that slides on a slope, within a pyramid; the other on a round cone."""
    left, right = contacts()
    normal = unit(np.array([0.2, -0.1, 1.0]))
    held = np.stack([normal, unit(np.array([1.0, 0.0, -0.2]))])
    return with_contacts(replace(left, held=held, normal=normal, pyramid=True, friction=0.6), right)


@cache
def carried() -> Transcription:
    """A foot on a lift, which it grips."""
    left, right = contacts()
    times = np.linspace(0.0, DURATION, 13)
    track = PlaceTrajectory(times, times[:, None] * SPEED)
    return with_contacts(replace(left, track=track, friction=None), right)


@cache
def discretised() -> Transcription:
    """One constraint of every kind."""
    return asked(
        Requests(
            points=(PointRequest("place", "trunk", ALWAYS, offset=(0.0, 0.1, 0.2)),),
            angles=(AngleLimit("bend", "left shank", 0.1, 0.2),),
            cones=(ConeLimit("cone", "left thigh", 0.1, stretch=(1.5, 0.7)),),
            twists=(TwistLimit("twist", "right thigh", -0.1, 0.1),),
            torques=(TorqueLimit("torque", ("left shank", "right thigh"), bound=5.0),),
            poses=(PoseRequest("pose", ALWAYS, bones=("right shank",)),),
            orientations=(OrientationRequest("turn", "trunk", ALWAYS, turn=0.3, tilt=0.2),),
            forces=(ForceRequest("peak", peak=1.5),),
        )
    )


@cache
def solid() -> Transcription:
    """Legs and floor, every pair at an instant of its own."""
    world = solid_world(stood(), stood(), (np.zeros_like, np.zeros_like), np.array)
    items = np.arange(len(world.names))
    times, none = np.linspace(0.0, DURATION, len(items)), np.zeros(len(items))
    every = Penetrations(world.names, items, times, none, none, np.zeros((len(items), 3)))
    function = SolidDistance(world.surfaces, every)
    return replace(standing(), guards=(GuardRows(world.names, items, times, none, function),))


@cache
def human() -> Transcription:
    """Both ends of every joint's range, each at an instant of its own."""
    ranges = recorded_ranges(stood())
    count = 2 * len(ranges)
    items, times = np.arange(count) // 2, np.linspace(0.0, DURATION, count)
    ends = tuple(replace(each, lower=-1.0, upper=1.0) for each in ranges)
    function = RangeLeft(ends, items, np.arange(count) % 2 == 0)
    names = tuple(each.name for each in ranges)
    return replace(standing(), guards=(GuardRows(names, items, times, np.zeros(count), function),))


def directional(t: Transcription, x: np.ndarray, direction: np.ndarray) -> np.ndarray:
    ahead, behind = (t.values(x + s * STEP * direction, places()) for s in (1.0, -1.0))
    return (ahead - behind) / (2.0 * STEP)


MAKERS = (standing, tilted, carried, discretised, solid, human)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("make", MAKERS)
def test_jacobians_are_the_values_slopes(make: Callable[[], Transcription], seed: int) -> None:
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
        assert ours[mine] == pytest.approx(theirs[mine], abs=5e-7 * max(scale, 1.0)), kind


@pytest.mark.parametrize("make", MAKERS)
def test_rows_and_values_agree(make: Callable[[], Transcription]) -> None:
    t, x = make(), random_state(9)
    rows = t.rows(x, places())
    assert rows.value == pytest.approx(t.values(x, places()), abs=1e-12)
    assert rows.span.max() < t.basis.n_spans
    assert rows.owner.max() < len(t.owners)


def test_these_tests_cover_every_kind_of_row() -> None:
    kinds = {kind for make in MAKERS for kind in make().rows(random_state(9), places()).kind}
    assert kinds == set(RowKind)


def test_unknowns_that_do_not_exist_have_no_slopes() -> None:
    t = discretised()
    rows = t.rows(random_state(1), places())
    blocks = t.basis.first_coefficient[rows.span][:, None] + np.arange(ORDER)
    assert not rows.jacobian[~t.active[blocks]].any()


def test_rows_are_owned_by_those_that_asked_for_them() -> None:
    t = discretised()
    rows = t.rows(random_state(1), places())
    asked_by = {name: set(rows.kind[rows.owner == i]) for i, name in enumerate(t.owners)}
    assert asked_by["left shank 1"] == {
        RowKind.PIN,
        RowKind.PIN_SPEED,
        RowKind.PUSH,
        RowKind.FRICTION,
    }
    assert asked_by["torque"] == {RowKind.TORQUE}
    assert asked_by["peak"] == {RowKind.PEAK}
    assert set(rows.kind[rows.owner == -1]) == {RowKind.BALANCE, RowKind.MOMENT}


def test_forces_exist_while_their_contact_lasts_and_end_at_zero() -> None:
    t = standing()
    motion = Motion(t, np.where(t.active, 1.0, 0.0), places())
    right = motion.forces(np.array([0.01, LIFT - 0.01, LIFT - 1e-9, LIFT + 1e-9, 0.25]))[:, 1, 2]
    assert (right[:2] > 0.0).all()
    assert right[2:] == pytest.approx(0.0, abs=1e-3)
    left = motion.forces(np.array([0.0, DURATION]))[:, 0, 2]  # the clip cuts this contact off
    assert (left > 0.0).all()


def test_once_the_rows_hold_balance_holds_at_every_instant() -> None:
    times = np.random.default_rng(0).uniform(0.0, DURATION, 500)
    assert np.abs(dynamics_residual(stood(), times).force).max() < 2e-5


def test_once_the_rows_hold_the_feet_stay() -> None:
    motion = stood()
    for i, contact in enumerate(motion.transcription.contacts):
        breaks = motion.transcription.basis.breaks
        inside = breaks[(breaks >= contact.contact.start) & (breaks <= contact.contact.end)]
        assert motion.drift(i, inside).max() < 2e-5


def left_foot(motion: Motion, times: np.ndarray) -> np.ndarray:
    return motion.contact_points(times)[:, 0]


def test_a_moving_place_carries_the_foot() -> None:
    outcome = restored(carried(), stood())
    assert outcome.status is Status.SOLVED
    times = carried().basis.breaks
    went = left_foot(Motion(carried(), outcome.x, places()), times) - places()[0]
    assert went == pytest.approx(times[:, None] * SPEED, abs=2e-5)


def test_a_foot_that_may_slide_is_held_in_its_directions_only() -> None:
    left, right = contacts()
    t = with_contacts(replace(left, held=np.array([[0.0, 0.0, 1.0]])), right)
    pushed = stood().x.copy()
    pushed[:, t.layout.com] += np.linspace([0.0, 0.0, 0.0], [0.0, 0.06, 0.0], len(pushed))
    outcome = restored(t, Motion(t, pushed, places()))
    assert outcome.status is Status.SOLVED
    went = left_foot(Motion(t, outcome.x, places()), t.basis.breaks) - places()[0]
    assert np.abs(went[:, 2]).max() < 2e-5
    assert np.abs(went[:, :2]).max() > 0.01


def test_a_steady_track_has_its_speed_at_its_ends_too() -> None:
    times = np.linspace(0.1, 0.4, 5)
    track = PlaceTrajectory(times, (times - 0.1)[:, None] * SPEED)
    found = track.velocity(np.array([0.1, 0.25, 0.4]))
    assert found == pytest.approx(np.tile(SPEED, (3, 1)))


def test_a_track_keeps_the_scene_s_clock_as_its_contact_is_retimed() -> None:
    contact, times = carried().contacts[0], np.array([0.15, 0.2])
    later = contact.retimed(lambda old: old + 0.1)
    assert later.contact.start == pytest.approx(contact.contact.start + 0.1)
    assert later.holds(times).shift == pytest.approx(contact.holds(times).shift)


def test_what_a_track_carries_rests_before_and_after_it() -> None:
    track = PlaceTrajectory(np.array([0.1, 0.4]), np.array([[0.0, 0.0, 0.0], SPEED]))
    assert track.velocity(np.array([0.0, 0.5])) == pytest.approx(np.zeros((2, 3)))


def test_relaxed_bounds_move_their_share_towards_what_was_asked() -> None:
    t, x = discretised(), random_state(5)
    relaxed = t.relaxed(x, 0.25)
    whole, part = (each.rows(x, places()).violation() for each in (t, relaxed))
    mine = t.rows(x, places()).owner >= len(t.contacts)
    assert np.abs(whole[mine]).max() > 0.1
    assert part[mine] == pytest.approx(0.25 * whole[mine], abs=1e-12)
    assert part[~mine] == pytest.approx(whole[~mine])


def test_a_flight_alone_has_equations() -> None:
    t = replace(standing(), points=(), contacts=())
    x = 0.1 * np.random.default_rng(0).normal(size=t.active.shape)
    none = np.zeros((0, 3))
    rows = t.rows(x, none)
    assert set(rows.kind) == {RowKind.BALANCE, RowKind.MOMENT}
    assert rows.value == pytest.approx(t.values(x, none))


def test_values_where_contacts_are_elsewhere_need_no_figure() -> None:
    t, x, before = standing(), random_state(3), places()
    after = before + np.linspace(0.1, -0.2, before.size).reshape(before.shape)
    expected = t.values(x, after)
    assert np.abs(expected - t.values(x, before)).max() > 0.1
    np.testing.assert_allclose(t.moved(t.values(x, before), before, after), expected, atol=1e-12)
