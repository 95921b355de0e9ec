"""Conditions on the standing figure: each kind of request is first missed, by name, then met."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.body.kinematics import BodyPoint
from hangtime.solver.constraints.constraint_builder import build_constraints
from hangtime.solver.constraints.evaluation_context import touches
from hangtime.solver.constraints.joint_constraints import pose_function
from hangtime.solver.constraints.point_constraints import point_axes
from hangtime.solver.data.faults import (
    BadTiming,
    NoSuchPoseFrame,
    RootHasNoJoint,
    StillBone,
    UnknownPhaseIn,
)
from hangtime.solver.data.requests import (
    ALWAYS,
    AngleLimit,
    ConeLimit,
    ForceRequest,
    Moment,
    OrientationRequest,
    Path,
    PointAxes,
    PointRequest,
    PoseRequest,
    Reference,
    Requests,
    TorqueLimit,
    TwistLimit,
    When,
)
from hangtime.solver.data.status import Status
from hangtime.solver.numerics.rotations import unit
from hangtime.solver.transcription.constraint import dense_violation, exchange
from hangtime.solver.transcription.motion import Motion
from hangtime.tests.helpers.toy_problems import (
    DURATION,
    RATE,
    asked,
    contacts,
    context,
    held_between,
    places,
    restored,
    standing,
    stood,
)

MIDDLE = When(moment=Moment.MIDDLE)
LATE = When(frames=(1.0 + 0.2 * RATE, 1.0 + 0.25 * RATE))
FREE = (None, None)
TOP = (0.0, 0.05, 0.5)


def where(bone: str, offset: tuple[float, float, float], time: float) -> np.ndarray:
    """A point of a bone in the standing motion, world."""
    body = [b.bone for b in standing().character.bodies].index(bone)
    times = np.array([time])
    at = stood().pose(times).points([BodyPoint(body, np.array(offset))])[0, 0]
    return at + stood().com(times)[0]


def along_path() -> Path:
    start = where("trunk", TOP, 0.0)
    places = start + np.outer([0.0, 1.0, 2.0], [0.0, 0.015, -0.01])
    frames = tuple(1.0 + RATE * t for t in (0.0, 0.5 * DURATION, DURATION))
    return Path(frames, tuple(map(tuple, places.tolist())))


ASKED = {
    "point": Requests(
        points=(PointRequest("point", "trunk", MIDDLE, TOP, relative=(0, 0.03, -0.03)),)
    ),
    "point at a place": Requests(points=(PointRequest("point", "right shank", LATE),)),
    "point in bounds": Requests(
        points=(PointRequest("point", "right shank", LATE, bounds=(FREE, FREE, (0.42, None))),)
    ),
    "point above a slope": Requests(
        points=(
            PointRequest(
                "point",
                "right shank",
                LATE,
                place=(0.0, 0.0, 0.35),
                axes=PointAxes.SURFACE,
                normal=(0.0, 0.5, 1.0),
                bounds=(FREE, FREE, (0.05, None)),
            ),
        )
    ),
    "point on a path": Requests(
        points=(PointRequest("point", "trunk", LATE, TOP, path=along_path()),)
    ),
    "angle": Requests(angles=(AngleLimit("angle", "left shank", 0.3, 0.5),)),
    "fixed angle": Requests(angles=(AngleLimit("angle", "right shank", 0.4, 0.4, LATE),)),
    "cone": Requests(
        cones=(ConeLimit("cone", "right thigh", 0.1, (0.3, 0.0, -1.0), (1.2, 0.8), LATE),)
    ),
    "twist": Requests(twists=(TwistLimit("twist", "right thigh", 0.15, 0.3, LATE),)),
    "torque": Requests(torques=(TorqueLimit("torque", ("left shank",), bound=20.0),)),
    "share of a torque": Requests(torques=(TorqueLimit("torque", ("left shank",), share=0.5),)),
    "limp": Requests(torques=(TorqueLimit("torque", ("right shank",), bound=0.0, when=LATE),)),
    "pose": Requests(poses=(PoseRequest("pose", LATE, ("right shank",), frame=1.0),)),
    "rest": Requests(
        poses=(PoseRequest("pose", LATE, ("right thigh",), Reference.REST, slack=0.001),)
    ),
    "orientation": Requests(orientations=(OrientationRequest("turn", "trunk", MIDDLE, turn=0.2),)),
    "tilt": Requests(
        orientations=(OrientationRequest("turn", "trunk", MIDDLE, tilt=0.2, slack=0.01),)
    ),
    "peak": Requests(forces=(ForceRequest("peak", peak=0.95),)),
    "peak of one foot": Requests(
        forces=(ForceRequest("peak", peak=0.4, touching=("right shank",)),)
    ),
}
MET_ALREADY = {"point at a place"}  # what the fit does anyway


@pytest.mark.parametrize("name", ASKED)
def test_what_is_asked_is_missed_by_name_and_then_met(name: str) -> None:
    t = asked(ASKED[name])
    (constraint,) = t.constraints
    before = dense_violation(constraint, t.character, t.basis, t.layout, stood().x)
    assert before.name == constraint.name == t.owners[-1]
    assert before.kind is constraint.function.kind
    assert constraint.start - 1e-9 <= before.time <= constraint.end + 1e-9
    if name not in MET_ALREADY:
        assert before.amount > 5.0 * before.kind.tolerance
    t, outcome = held_between(t, stood())
    assert outcome.status is Status.SOLVED
    rows = t.rows(outcome.x, places())
    assert np.abs(rows.violation() / rows.tolerance).max() <= 1.0
    after = dense_violation(constraint, t.character, t.basis, t.layout, outcome.x)
    assert after.amount < 0.2 * before.amount + before.kind.tolerance


@pytest.mark.parametrize("name", ["angle", "cone", "torque", "point on a path"])
def test_exchange_adds_rows_until_bounds_hold_between_them(name: str) -> None:
    """From one row a span only, which leaves something to be found in between."""
    t = asked(ASKED[name])
    sparse = tuple(replace(c, per_span=1) for c in t.constraints)
    t, x, rounds = replace(t, constraints=sparse), stood().x, 0
    while rounds < 6:
        outcome = restored(t, Motion(t, x, places()))
        assert outcome.status is Status.SOLVED
        x = outcome.x
        added = tuple(exchange(c, t.character, t.basis, t.layout, x) for c in t.constraints)
        if added == t.constraints:
            break
        t, rounds = replace(t, constraints=added), rounds + 1
    (constraint,) = t.constraints
    after = dense_violation(constraint, t.character, t.basis, t.layout, x)
    assert after.amount <= after.kind.tolerance


def test_an_end_that_is_a_break_but_for_rounding_is_looked_at() -> None:
    made = asked(Requests(torques=(TorqueLimit("Knee", ("left shank",), bound=5.0),)))
    basis = made.basis
    edge = float(basis.breaks[basis.double][0])
    whole = replace(made.constraints[0], start=0.0, end=edge - 1e-9)
    assert whole.dense(basis).times.max() == edge
    assert basis.breaks[whole.dense(basis).spans[-1] + 1] == edge  # from the left


def test_exchange_leaves_alone_what_holds() -> None:
    t = asked(ASKED["point at a place"])
    (constraint,) = t.constraints
    assert exchange(constraint, t.character, t.basis, t.layout, stood().x) is constraint


def test_requests_that_contradict_each_other_end_soon_unmet_and_finite() -> None:
    """A knee at two angles at once: both are reported by name."""
    t = asked(
        Requests(
            angles=(
                AngleLimit("straight", "right shank", 0.0, 0.05, LATE),
                AngleLimit("bent", "right shank", 0.5, 0.6, LATE),
            )
        )
    )
    outcome = restored(t, stood())
    assert outcome.status is not Status.SOLVED
    assert len(outcome.steps) <= 30
    assert np.isfinite(outcome.x).all()
    off = {
        c.name: dense_violation(c, t.character, t.basis, t.layout, outcome.x).amount
        for c in t.constraints
    }
    assert max(off.values()) > 0.1
    assert sum(off.values()) >= 0.45 - 1e-6


# -- what requests mean ---------------------------------------------------------------------


def trunk_at_middle(name: str) -> np.ndarray:
    t = asked(ASKED[name])
    x = restored(t, stood()).x
    return Motion(t, x, places()).pose(np.array([0.5 * DURATION])).rotations[0, 0]


def test_a_turn_is_counter_clockwise_from_above_against_the_fit() -> None:
    was = stood().pose(np.array([0.5 * DURATION])).rotations[0, 0]
    turned = trunk_at_middle("orientation") @ was.T
    c, s = np.cos(0.2), np.sin(0.2)
    assert turned == pytest.approx(np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]), abs=2e-3)


def test_a_tilt_is_forwards() -> None:
    """Travel goes along x here: what pointed up goes towards x."""
    was = stood().pose(np.array([0.5 * DURATION])).rotations[0, 0]
    turned = trunk_at_middle("tilt") @ was.T
    assert turned @ [0.0, 0.0, 1.0] == pytest.approx([np.sin(0.2), 0.0, np.cos(0.2)], abs=0.02)


def test_bounds_without_a_place_are_above_the_floor() -> None:
    t = asked(ASKED["point in bounds"])
    motion = Motion(t, restored(t, stood()).x, places())
    times = np.linspace(0.2, 0.25, 9)
    middle = BodyPoint(4, 0.5 * t.character.bodies[4].tip)
    assert (motion.pose(times).points([middle])[:, 0] + motion.com(times))[:, 2].min() > 0.4195


def test_a_bound_on_one_axis_has_one_row_an_instant() -> None:
    t = asked(ASKED["point in bounds"])
    (discretised,) = t.discretised
    assert discretised.lower.shape == (len(discretised.instants.times), 1)


def test_a_surface_s_axes_are_along_across_and_out() -> None:
    normal = (0.3, 0.2, 1.0)
    request = PointRequest("p", "trunk", ALWAYS, axes=PointAxes.SURFACE, normal=normal)
    axes = point_axes(request, context(), (0.0, DURATION))
    assert axes.T @ axes == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[:, 2] == pytest.approx(unit(np.array(normal)))
    assert axes[0, 0] > 0.9


def test_a_share_of_a_torque_is_of_the_fit_s_peak() -> None:
    whole = asked(Requests(torques=(TorqueLimit("t", ("left shank",), share=1.0),))).constraints[0]
    t = standing()
    assert dense_violation(whole, t.character, t.basis, t.layout, stood().x).amount < 2e-5
    half = asked(Requests(torques=(TorqueLimit("t", ("left shank",), share=0.5),))).constraints[0]
    assert half.bounds.upper == pytest.approx(0.5 * whole.bounds.upper)


def test_torques_of_one_angle_and_about_a_value() -> None:
    request = TorqueLimit("t", ("left thigh",), bound=10.0, dof=1, value=30.0)
    (constraint,) = asked(Requests(torques=(request,))).constraints
    unit_nm = standing().character.mass * 9.81
    assert constraint.bounds.lower * unit_nm == pytest.approx([20.0])
    assert constraint.bounds.upper * unit_nm == pytest.approx([40.0])


def test_touching_is_by_contact_point_or_bone() -> None:
    contact = replace(contacts()[0].contact, name="Left heel 2", point="Left heel", bone="Foot")
    for name in ("Left heel 2", "Left heel", "Foot"):
        assert touches(("other", name), contact)
    assert touches((), contact)
    assert not touches(("Right heel",), contact)


# -- faults ---------------------------------------------------------------------------------


def built(requests: Requests) -> None:
    build_constraints(requests, context(), standing())


def test_bones_that_no_body_moves_are_named_with_those_there_are() -> None:
    with pytest.raises(StillBone) as caught:
        built(Requests(angles=(AngleLimit("knee", "tail", 0.0, 1.0),)))
    assert (caught.value.request, caught.value.bone) == ("knee", "tail")
    assert "left shank" in caught.value.known


@pytest.mark.parametrize(
    "requests",
    [
        Requests(angles=(AngleLimit("root", "trunk", 0.0, 1.0),)),
        Requests(cones=(ConeLimit("root", "trunk", 0.5),)),
        Requests(twists=(TwistLimit("root", "trunk", 0.0, 1.0),)),
        Requests(torques=(TorqueLimit("root", ("left shank", "trunk"), bound=1.0),)),
        Requests(poses=(PoseRequest("root", ALWAYS, ("trunk",)),)),
    ],
)
def test_the_root_has_no_joint(requests: Requests) -> None:
    with pytest.raises(RootHasNoJoint) as caught:
        built(requests)
    assert (caught.value.request, caught.value.bone) == ("root", "trunk")


def test_times_that_are_not_there_are_named() -> None:
    with pytest.raises(UnknownPhaseIn) as unknown:
        built(Requests(angles=(AngleLimit("knee", "left shank", 0, 1, When(phase="flight 1")),)))
    assert (unknown.value.request, unknown.value.known) == ("knee", ("ground 1",))
    with pytest.raises(BadTiming) as empty:
        built(Requests(angles=(AngleLimit("knee", "left shank", 0, 1, When(frames=(25, 12))),)))
    assert empty.value.request == "knee"


@pytest.mark.parametrize("frame", [-3.0, 9999.0])
def test_a_pose_of_a_frame_that_is_not_adapted_is_told_with_those_that_are(frame: float) -> None:
    with pytest.raises(NoSuchPoseFrame) as told:
        built(Requests(poses=(PoseRequest("pose", LATE, ("right shank",), frame=frame),)))
    assert (told.value.request, told.value.frame) == ("pose", frame)
    assert told.value.first < told.value.last < 9999.0


def test_a_pose_leaves_out_what_is_apart() -> None:
    body = context()
    knee = body.character.joints[body.body("pose", "right shank")]
    whole = pose_function(PoseRequest("pose", LATE), body).which
    left = pose_function(PoseRequest("pose", LATE, apart=("right shank", "tail")), body).which
    assert set(whole).difference(left) == set(range(knee.first, knee.dofs.stop))
