"""The gallery's recipes, checks and verdicts, without solving anything big."""

import math

import numpy as np
import pytest
from hangtime.bridge.picture.annotations import Box, Cone, LimitArc, Tint
from hangtime.devtools.gallery import jobs, limits, main, scene_table, table
from hangtime.devtools.gallery.checks import BendCheck, Check, ConeCheck, PointCheck
from hangtime.operators.headless.annotate import marks_of
from hangtime.operators.headless.picture import instants
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Bone, Recording
from hangtime.solver.data.requests import (
    AddedMass,
    AngleLimit,
    BodyChange,
    ConeLimit,
    Requests,
    TorqueLimit,
    When,
)
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.stages.implicit import adapt
from hangtime.tests.helpers.fitted_hop import fitted_hop

ALONG = np.array([0.0, 0.0, -1.0])
FREE = (-math.inf, math.inf)


def two_bones(bend: float) -> Recording:
    """A limb that hangs and whose lower bone is turned about x by `bend`, rad, in two frames."""
    bones = (
        Bone("upper", -1, np.array([0.0, 0.0, 2.0]), np.array([0.0, 0.0, 1.0]), np.eye(3)),
        Bone("lower", 0, np.array([0.0, 0.0, 1.0]), np.zeros(3), np.eye(3)),
    )
    times = np.array([0.0, 0.1])
    heads = np.tile([[0.0, 0.0, 2.0], [0.0, 0.0, 1.0]], (2, 1, 1))
    turns = np.tile(np.eye(3), (2, 2, 1, 1))
    turns[1, 1] = axis_rotation(0, bend)
    return Recording("limb", bones, 1.0 + np.arange(2.0), times, heads, turns)


def point(place: float, lower: float = 0.0, upper: float = 0.0) -> PointCheck:
    """The lower bone's end, whose height is bounded about a place."""
    up = np.array([[0.0], [0.0], [1.0]])
    where = np.array([[0.0, 0.0, place]])
    bounds = np.array([lower]), np.array([upper])
    return PointCheck("end", 0.0, 0.1, "lower", ALONG, np.zeros(1), where, up, *bounds)


def bend(lower: float, upper: float, end: float = 0.1) -> BendCheck:
    return BendCheck("knee", 0.0, end, "lower", "upper", np.array([1.0, 0.0, 0.0]), lower, upper)


def cone(half_angle: float) -> ConeCheck:
    frame = np.stack([ALONG, np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])])
    return ConeCheck("cone", 0.0, 0.1, "lower", "upper", frame, np.array([1.0, 2.0]), half_angle)


@pytest.mark.parametrize(
    ("check", "worst"),
    [
        (point(0.0), 1000.0 * (1.0 - math.cos(0.5))),
        (point(0.0, upper=0.1), 1000.0 * (1.0 - math.cos(0.5) - 0.1)),
        (point(0.0, upper=0.2), 0.0),
        (bend(-0.6, 0.6), 0.0),
        (bend(-0.6, 0.4), math.degrees(0.1)),
        (bend(0.0, math.inf), 0.0),
        (bend(-math.inf, -0.1), math.degrees(0.6)),
        (cone(0.2), math.degrees(0.5 - math.atan(2.0 * math.tan(0.2)))),
        (cone(0.3), 0.0),
    ],
)
def test_a_check_measures_what_is_shown(check: Check, worst: float) -> None:
    assert check.worst(two_bones(0.5)) == pytest.approx(worst, abs=1e-9)


def test_a_check_looks_only_at_its_time() -> None:
    assert bend(-0.1, 0.1, end=0.05).worst(two_bones(0.5)) == 0.0


def test_a_knee_bent_the_other_way_is_seen() -> None:
    assert bend(0.0, math.inf).worst(two_bones(-0.5)) == pytest.approx(math.degrees(0.5))


def test_every_recipe_is_read_and_says_what_it_is() -> None:
    thesis, scene = (jobs.names(page) for page in jobs.Page)
    results = [jobs.load(name) for name in (*thesis, *scene)]
    assert (len(thesis), len(scene)) == (29, 8)
    assert sum(name.endswith("_fit") for name in thesis) == 2
    assert all(jobs.load(name).problem.scene for name in scene)
    assert all(": " in result.title or result.name.endswith("_fit") for result in results)
    assert {result.clip.suffix for result in results} == {".bvh"}


def row(**changes: object) -> jobs.Json:
    """A result as it should be."""
    solved = {"status": "solved", "solved": True, "seconds": 0.2, "iterations": 4}
    solved |= {"unknowns": 3000, "rows": 1500, "peak_memory_gb": 0.5}
    good = {
        "name": "diagonal",
        "page": "gallery",
        "title": "Diagonal: left",
        "methods": {"implicit": solved},
        "conditions": [],
        "checks": [{"name": "toe", "kind": "point", "worst": 0.1, "unit": "mm", "by": "Blender"}],
        "residuals": {
            "flight_force": 0.0,
            "flight_moment": 1e-4,
            "ground_force": 0.0,
            "ground_moment": 0.0,
        },
        "loads": {"peak_torque_nm": 300.0, "peak_torque_at": "shin", "peak_force_bw": 3.0},
        "from_fit": {"joint_centres_rms_cm": 1.0, "angles_rms_deg": 2.0},
        "looks": {"overlap_cm": 0.0, "below_floor_cm": 0.0, "jerk": 1.0, "least_knee_deg": 10.0},
    }
    return good | changes


def deep(mm: float) -> jobs.Json:
    return {"keeper": "scene", "deeper_mm": mm, "what": "left shank in Crate", "frame": 200.0}


def off(mm: float) -> jobs.Json:
    return {"contact": "Left heel 2", "object": "Crate", "off_mm": mm}


def limp(worst: float) -> jobs.Json:
    return {"name": "Limp", "kind": "torque", "worst": worst, "unit": "N·m", "by": "us"}


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"conditions": [limp(5.0)]}, "Limp"),
        ({"conditions": [limp(math.nan)]}, "Limp"),
        ({"failed": "it took too long"}, "too long"),
        ({"residuals": {"flight_moment": 0.002}}, "flight moment"),
        ({"looks": {"overlap_cm": 9.0, "overlap_at": "arm, hip"}}, "arm, hip"),
        ({"looks": {"least_knee_deg": -4.0}}, "backwards"),
        ({"methods": {"implicit": {"solved": False, "status": "stalled"}}}, "stalled"),
        ({"methods": {}}, "not solved"),
        ({"penetrations": [deep(9.0)]}, "left shank in Crate by 9.0 mm at frame 200"),
        ({"standing": [off(4.0)]}, "Left heel 2 4.0 mm off Crate"),
    ],
)
def test_what_is_wrong_with_a_result_is_said(changes: jobs.Json, word: str) -> None:
    (fault,) = limits.faults(row(**changes))
    assert word in fault


def test_a_good_result_has_no_fault() -> None:
    assert limits.faults(row()) == []


def test_the_page_shows_a_failure_and_the_thesis_s_sizes() -> None:
    page = table.page([row(), row(name="dunk", title="Dunk: up", failed="no way")])
    assert "**failed**: no way" in page
    assert "| results in order | 1 of 2 |" in page
    assert "| jump | 3000-3000 | 1100-2400 | 1500-1500 | 700-1700 |" in page


def test_results_in_a_scene_have_a_table_and_a_count_of_their_own() -> None:
    solid = {"penetrations": [deep(0.4)], "standing": [off(0.2)]}
    crate = row(name="crate_landing", page="world", title="Crate (scene 1): up", **solid)
    assert "| results in order | 1 of 1 |" in table.page([row()])
    found = {f.name: f.value for f in limits.figures([row(), crate]) if f.result == "all"}
    assert (found["results in order"], found["in a scene in order"]) == (1, 1)
    scene = scene_table.scene_section([crate])
    assert "[Crate (scene 1)](../examples/world/crate_landing.toml)" in scene
    assert "| 0.4 | 0.2 |" in scene


@pytest.mark.slow
def test_what_is_asked_for_is_marked_where_it_is() -> None:
    flight = When(phase="flight 1")
    case = AddedMass("case", "RightHand", share=0.1)
    requests = Requests(
        angles=(AngleLimit("knee", "LeftLeg", 0.0, None, flight),),
        cones=(ConeLimit("arm", "LeftArm", math.radians(170), when=flight),),
        torques=(TorqueLimit("weak", ("RightFoot",), bound=1000.0, when=flight),),
        body=BodyChange(added=(case,)),
    )
    problem = MotionProblem(requests=requests)
    adaptation = adapt(fitted_hop(), problem)
    marks = {type(mark): mark for mark in marks_of(adaptation, problem)}
    assert set(marks) == {LimitArc, Cone, Tint, Box}
    motion = adaptation.motion
    names = [body.bone for body in motion.transcription.character.bodies]
    names_of_bodies = [body.name for body in motion.transcription.character.bodies]
    centres = motion.joint_centres(instants(motion))
    np.testing.assert_allclose(marks[Cone].apex, centres[:, names.index("LeftArm")])
    np.testing.assert_allclose(marks[LimitArc].centre, centres[:, names.index("LeftLeg")])
    assert marks[LimitArc].lower == marks[LimitArc].upper == 0.0
    assert marks[Tint].limbs == (names_of_bodies[names.index("RightFoot")],)
    assert marks[Box].size.prod() == pytest.approx(0.007, rel=0.01)  # 7 kg


def test_an_unknown_name_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main.main(["no_such_jump"]) == 2
    assert "no_such_jump" in capsys.readouterr().out
