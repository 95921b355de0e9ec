"""Human ranges: zeros, senses and ends of every joint, on a person's figure in a T-pose."""

from functools import cache

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.character import Character
from hangtime.solver.human.ranges import JointRange, joint_ranges, rest_figure
from hangtime.solver.numerics.rotations import rotation_matrix, shortest_rotation, unit
from hangtime.solver.transcription.joint_measures import BendAngle, ConeAngle
from hangtime.tests.helpers.fitted_hop import fitted_hop

UP = np.array([0.0, 0.0, 1.0])


def character() -> Character:
    return fitted_hop().motion.transcription.character


@cache
def ranges() -> dict[str, JointRange]:
    motion = fitted_hop().motion
    found = joint_ranges(character(), motion.angles(np.linspace(0.0, motion.duration, 100)))
    assert len({each.name for each in found}) == len(found)
    return {each.name: each for each in found}


def left() -> FloatArray:
    return rest_figure(character()).left


def forward() -> FloatArray:
    return rest_figure(character()).forward


def hinge(name: str) -> FloatArray:
    """The axis that a joint bends about, (3,); of other joints none."""
    measure = ranges()[name].measure
    return np.cross(measure.straight, measure.flexion) if isinstance(measure, BendAngle) else UP


def excess(name: str, axis: FloatArray, degrees: float) -> float:
    """Degrees that a joint is beyond its range, turned about an axis (parent's frame) from rest."""
    return float(np.degrees(ranges()[name].beyond(turned(axis, degrees))[0]))


def turned(axis: FloatArray, degrees: float) -> FloatArray:
    return rotation_matrix(np.radians(degrees) * axis)[None]


def test_every_joint_has_a_range() -> None:
    ranged = {each.body for each in ranges().values()}
    jointed = {i for i, joint in enumerate(character().joints) if joint.parent >= 0}
    assert jointed == ranged


def test_the_rest_pose_is_in_every_range() -> None:
    for each in ranges().values():
        ends = each.name.lower().endswith(("elbow bends", "knee bends"))  # straight at rest
        assert each.beyond(np.eye(3)[None])[0] < (1e-6 if ends else 0.0), each.name


def test_a_knee_does_not_bend_backwards() -> None:
    assert excess("Left knee bends", hinge("Left knee bends"), -5.0) == pytest.approx(5.0, abs=0.1)


# axis, degrees to its end: about the left axis a positive turn takes up forwards
ENDS = [
    ("Left knee bends", "own", 135.0),
    ("Left hip turns", "up", 45.0),
    ("Right hip turns", "up", -45.0),
    ("Left collarbone moves", "forward", 45.0),
    ("Left collarbone moves", "forward", -10.0),
    ("Right collarbone moves", "forward", -45.0),
    ("Right collarbone moves", "forward", 10.0),
    ("Neck 3 turns", "up", 20.0),
    ("Neck 3 bends", "left", 15.0),
    ("Left shoulder turns", "left", -90.0),
    ("Left shoulder turns", "left", 70.0),
    ("Right shoulder turns", "left", -90.0),
    ("Right shoulder turns", "left", 70.0),
]


@pytest.mark.parametrize(("name", "axis", "end"), ENDS)
def test_ranges_end_where_the_tables_say(name: str, axis: str, end: float) -> None:
    about = {"left": left(), "up": UP, "forward": forward(), "own": hinge(name)}[axis]
    beyond = end + np.sign(end) * 5.0
    assert excess(name, about, end) == pytest.approx(0.0, abs=2.5)
    assert excess(name, about, beyond) == pytest.approx(5.0, abs=3.0)
    assert excess(name, about, 0.5 * end) < 0.0


def test_a_range_holds_what_a_recording_does() -> None:
    neck = ranges()["Neck 3 bends"]
    folded = turned(left(), 40.0)
    wider = neck.holding(folded)
    assert wider.beyond(folded)[0] == pytest.approx(0.0, abs=1e-9)
    assert neck.holding(turned(left(), 5.0)).upper == neck.upper


def flexed(degrees: float) -> FloatArray:
    """The left hip with the thigh hanging straight down, then turned forwards; child to parent."""
    thigh = character().bodies[ranges()["Left hip bends"].body]
    return turned(left(), -degrees) @ shortest_rotation(unit(thigh.tip), -UP)


@pytest.mark.parametrize("degrees", [121.0, 130.0, 150.0, 165.0])
def test_a_folded_hip_is_beyond_its_range_by_degrees_of_flexion(degrees: float) -> None:
    beyond = np.degrees(ranges()["Left hip bends"].beyond(flexed(degrees)))
    assert beyond == pytest.approx(degrees - 120.0, abs=1.0)


@pytest.mark.parametrize("wider", [10.0, 40.0])
def test_a_wider_cone_is_so_much_wider_all_around(wider: float) -> None:
    cones = [each for each in ranges().values() if isinstance(each.measure, ConeAngle)]
    turns = rotation_matrix(np.random.default_rng(1).normal(0.0, 1.0, (200, 3)))
    for each in cones:
        other = each.widened(np.radians(wider))
        assert other.beyond(turns) == pytest.approx(each.beyond(turns) - np.radians(wider))
        outside = other.measure.of(turns) > other.upper  # as the solver sees it
        assert (outside == (other.beyond(turns) > 0.0)).all(), each.name


def test_a_pike_that_was_recorded_allows_no_wider_straddle() -> None:
    hip = ranges()["Left hip bends"]
    straddle = turned(forward(), -80.0) @ flexed(0.0)
    allowed = hip.holding(flexed(150.0))
    assert allowed.beyond(flexed(150.0)) == pytest.approx(0.0, abs=1e-9)
    assert hip.beyond(straddle) - allowed.beyond(straddle) == pytest.approx(
        np.radians(30.0), abs=np.radians(1.0)
    )
