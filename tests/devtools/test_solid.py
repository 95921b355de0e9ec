"""The solid world's measures on what is known, and its verdicts."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hangtime.devtools.checks.mujoco_shapes import (
    Poses,
    capsule_depths,
    convex_pieces,
    floor_depths,
)
from hangtime.devtools.checks.penetrations import Keeper, Penetration, solid_check
from hangtime.devtools.checks.scenery import PlacedObject, distances_to, scene_depths
from hangtime.devtools.solid import limits
from hangtime.devtools.solid.cases import QUICK, Source, cases, groups
from hangtime.devtools.solid.limits import faults, figures
from hangtime.devtools.solid.main import tell
from hangtime.devtools.solid.result import CaseResult, Physics
from hangtime.devtools.solid.table import page
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.scene import SceneObject, SceneRole
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.solid.shapes import Capsule
from hangtime.solver.stages.implicit import Adaptation, unadapted
from hangtime.tests.helpers.fitted_hop import fitted_hop, hop

UPRIGHT = np.array([0.0, 0.0, 0.3])
TWO = (Capsule(0, np.zeros(3), UPRIGHT, 0.05), Capsule(1, np.zeros(3), UPRIGHT, 0.04))
GOOD = Physics(1e-9, 5e-4, 1e-9, 5e-4)


def still(*places: tuple[float, float, float]) -> Poses:
    """One instant of bodies that are not turned."""
    return Poses(np.tile(np.eye(3), (1, len(places), 1, 1)), np.array([places]))


@pytest.mark.parametrize(("apart", "depth"), [(0.2, 0.0), (0.08, 0.01), (0.05, 0.04)])
def test_capsules_are_as_deep_in_each_other_as_they_are_too_near(
    apart: float, depth: float
) -> None:
    found = capsule_depths(TWO, np.array([[0, 1]]), still((0, 0, 0), (apart, 0, 0.1)))
    assert found == pytest.approx(np.array([[depth]]), abs=1e-9)


def test_a_turned_body_takes_its_capsule_along() -> None:
    poses = still((0, 0, 0), (0.2, 0, 0.1))
    poses.turns[0, 1] = axis_rotation(1, -math.pi / 2)  # lies towards the other, and through it
    assert capsule_depths(TWO, np.array([[0, 1]]), poses)[0, 0] == pytest.approx(0.09, abs=1e-6)


def test_a_ball_is_as_deep_in_the_floor_as_its_lowest_point() -> None:
    balls = Capsule(0, np.zeros(3), np.zeros(3), 0.05), Capsule(0, UPRIGHT, UPRIGHT, 0.0)
    found = floor_depths(balls, np.array([1.0]), still((5, 6, 1.03)))
    assert found == pytest.approx(np.array([[0.02, 0.0]]), abs=1e-6)
    sunk = floor_depths(balls, np.array([1.4]), still((5, 6, 1.03)))
    assert sunk == pytest.approx(np.array([[0.42, 0.07]]), abs=1e-6)


def unit_box(low: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of a box, 1 m along each side."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return corners + low, np.array(faces)


def test_a_mesh_falls_into_its_convex_parts_and_else_into_slabs() -> None:
    vertices, faces = unit_box()
    assert len(convex_pieces(vertices, faces)) == 1
    both = np.concatenate([vertices, vertices + 2.0])
    assert len(convex_pieces(both, np.concatenate([faces, faces + 8]))) == 2
    dented = vertices.copy()
    dented[7] = 0.4  # a corner is pushed in
    assert len(convex_pieces(dented, faces)) == 12


@pytest.mark.parametrize("height", [0.98, 1.0, 1.03])
def test_a_point_is_as_far_off_a_moving_box_as_it_is_above_it(height: float) -> None:
    thing = PlacedObject(
        "Box",
        tuple(convex_pieces(*unit_box())),
        np.eye(3)[None],
        np.array([[5.0, 0.0, 0.2]]),
    )
    point = Capsule(0, np.zeros(3), np.zeros(3), 0.0)
    poses = still((5.5, 0.5, 0.2 + height))
    assert distances_to([point], thing, poses)[0, 0] == pytest.approx(height - 1.0, abs=1e-6)
    depth = scene_depths([point], [thing], poses)[0, 0]
    assert depth == pytest.approx(max(1.0 - height, 0.0), abs=1e-6)


def test_a_figure_in_a_box_is_told_with_the_objects_name() -> None:
    adaptation, shown = shown_hop()
    vertices, faces = unit_box()
    middle = shown.heads[10, shown.index("Head")] - 0.5
    still_there = np.zeros(1), middle[None], np.eye(3)[None]
    box = SceneObject("Crate", SceneRole.OBSTACLE, vertices, faces, *still_there)
    scene = solid_check(adaptation, MotionProblem(scene=(box,)), shown.times).worst(shown)[-1]
    assert scene.keeper is Keeper.SCENE
    assert scene.what.endswith("in Crate")
    assert scene.deeper_mm > 100.0


def shown_hop() -> tuple[Adaptation, Recording]:
    """The hop's fit as Blender would show it."""
    adaptation = unadapted(fitted_hop())
    recording, track = hop().performance.recording, adaptation.track
    bones = [recording.index(bone) for bone in track.bones]
    heads, rotations = recording.heads.copy(), recording.rotations.copy()
    pose = adaptation.motion.pose(recording.times)
    heads[:, bones] = pose.centres + adaptation.motion.com(recording.times)[:, None]
    rotations[:, bones] = track.rotations
    return adaptation, replace(recording, heads=heads, rotations=rotations)


def test_a_fit_is_nowhere_deeper_than_itself() -> None:
    adaptation, shown = shown_hop()
    for each in solid_check(adaptation, MotionProblem(), shown.times).worst(shown):
        assert each.deeper_mm < 1e-3


def test_a_figure_that_sinks_is_in_the_floor_by_as_much() -> None:
    adaptation, shown = shown_hop()
    shown.heads[:, :, 2] -= 0.02
    floor, body = solid_check(adaptation, MotionProblem(), shown.times).worst(shown)
    assert (floor.keeper, body.deeper_mm) == (Keeper.FLOOR, pytest.approx(0.0, abs=1e-3))
    assert floor.deeper_mm == pytest.approx(20.0, abs=0.01)
    assert "foot in the floor" in floor.what


def test_a_forearm_turned_into_the_trunk_is_named_with_its_frame() -> None:
    adaptation, shown = shown_hop()
    arm, trunk = shown.index("LeftForeArm"), shown.index("Hips")
    shown.heads[7, arm] = shown.heads[7, trunk]
    _, body = solid_check(adaptation, MotionProblem(), shown.times).worst(shown)
    assert body.deeper_mm > 50.0
    assert body.frame == shown.frames[7]
    assert "left forearm" in body.what


def test_every_edit_and_every_result_is_a_case_and_most_share_a_fit() -> None:
    known = cases()
    assert sum(case.source is Source.FIGURES for case in known) == 15
    assert {case.name for case in known} >= set(QUICK)
    assert max(len(group) for group in groups(known)) > 15
    assert sum(len(group) for group in groups(known)) == len(known)


def test_a_case_is_asked_with_solids_and_without() -> None:
    case = cases()[0]
    for on in (True, False):
        assert case.solid(on).requests.solution.solid is on
        assert case.solid(on).pins == case.problem.pins


def result(depth: float = 0.5, **changes: object) -> CaseResult:
    deep = Penetration(Keeper.BODY, depth, "left hand in right thigh", 150.0)
    good = CaseResult(
        "dunk",
        Source.GALLERY,
        solved=True,
        penetrations=(deep,),
        physics=GOOD,
        seconds=1.2,
        free_seconds=1.0,
    )
    return replace(good, **changes)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        (result(7.0), "left hand in right thigh by 7.0 mm at frame 150"),
        (result(math.nan), "nan mm"),
        (result(failed="it took too long"), "too long"),
        (result(solved=False), "not solved"),
        (result(physics=replace(GOOD, flight_moment=0.002)), "flight: root moment"),
    ],
)
def test_what_is_wrong_with_a_case_is_said(wrong: CaseResult, word: str) -> None:
    (fault,) = faults(wrong)
    assert word in fault


def test_a_miss_ends_with_one_but_where_it_is_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert tell([result()], tmp_path, 1.0, write_page=False) == 0
    assert tell([result(7.0)], tmp_path, 1.0, write_page=False) == 1
    monkeypatch.setitem(limits.KNOWN_MISSES, "deepest new penetration, own body", 8.0)
    assert tell([result(7.0)], tmp_path, 1.0, write_page=False) == 0
    assert tell([result(9.0)], tmp_path, 1.0, write_page=False) == 1


def test_the_median_of_the_times_is_judged_and_the_worst_told() -> None:
    found = {f.name: f for f in figures([result(), result(seconds=3.0), result(seconds=1.0)])}
    assert found["time with solids over without, median"].value == 1.2
    worst = found["time with solids over without, worst"]
    assert (worst.value, worst.must, worst.ok) == (3.0, None, True)


def test_the_page_has_every_case_and_says_what_it_misses() -> None:
    every = [result(), result(9.0, name="briefcase")]
    words = page(every, figures(every), 12.0)
    assert "| dunk |" in words
    assert "**left hand in right thigh by 9.0 mm at frame 150**" in words
    assert "about 12 minutes" in words
