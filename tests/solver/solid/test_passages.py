"""Passages: what goes through a thin object gets one way out of it, the same at all instants."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.scene import SceneObject, SceneRole
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.results.violations import condition_violations
from hangtime.solver.scene.object_motion import ObjectMotion
from hangtime.solver.solid.mesh_surface import MeshSurface
from hangtime.solver.solid.penetrations import placed_at
from hangtime.solver.solid.solid_world import SolidWorld, floor_heights, solid_world
from hangtime.solver.solid.surfaces import axes_in
from hangtime.solver.solid.way_out import WayOut
from hangtime.solver.stages.implicit import adapt
from hangtime.solver.transcription.guard_rows import GuardRows
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.meshes import Triangles, box, thing

BAR = box((0.04, 1.2, 0.04))
SHEET = np.array([[0, -0.6, -0.1], [0, 0.6, -0.1], [0, 0.6, 0.1], [0, -0.6, 0.1]])
SHEETS = [(SHEET, np.array([[0, 1, 2], [0, 2, 3]])), (SHEET, np.array([[0, 2, 1], [0, 3, 2]]))]


def in_the_way(mesh: Triangles, height: float) -> SceneObject:
    """An obstacle across the hop's way, below the middle of its flight."""
    motion, (flight,) = fitted_hop().motion, fitted_hop().schedule.flights
    start, middle, end = motion.com(np.linspace(flight.start, flight.end, 3))
    along = end - start
    turn = axis_rotation(2, float(np.arctan2(along[1], along[0])))
    place = (float(middle[0]), float(middle[1]), height)
    return thing("Bar", mesh, place, role=SceneRole.OBSTACLE, rotation=turn)


def world(of: SceneObject) -> SolidWorld:
    fit = fitted_hop()
    floors = (floor_heights(fit.schedule, fit.places),) * 2
    placed = [(of, ObjectMotion.of(of, 0.0, 1.0))]
    return solid_world(fit.motion, fit.motion, floors, lambda times: times, placed)


def rows_of(of: SceneObject) -> tuple[SolidWorld, GuardRows]:
    found = world(of)
    rows = found.rows(fitted_hop().motion, frozenset())
    assert rows is not None
    return found, rows


def ways(of: SceneObject) -> list[FloatArray | None]:
    """Of each row, its way in the object's axes; None by the nearest face."""
    found, rows = rows_of(of)
    parts = found.surfaces.parts
    first = np.cumsum([0, *(len(part.names) for part in parts)])
    owners = [parts[int(np.searchsorted(first, i, side="right")) - 1] for i in rows.items]
    return [np.array(o.way) if isinstance(o, WayOut) else None for o in owners]


@pytest.mark.parametrize("height", [0.3, 0.4])
def test_legs_that_pass_a_bar_are_lifted_over_it_at_all_instants(height: float) -> None:
    found = ways(in_the_way(BAR, height))
    assert all(way is not None for way in found)
    np.testing.assert_allclose(np.array(found), np.tile([0.0, 0.0, 1.0], (len(found), 1)))


@pytest.mark.parametrize("sheet", SHEETS)
def test_a_sheet_that_is_passed_has_one_way_out_too(sheet: Triangles) -> None:
    found = ways(in_the_way(sheet, 0.25))
    assert found[0] is not None
    assert {tuple(way) for way in found if way is not None} == {tuple(found[0])}
    assert not any(way is None for way in found)


def test_limbs_that_are_lifted_take_the_rest_of_the_leg_along() -> None:
    """At a shank's height the toes below it have rows, too."""
    found, rows = rows_of(in_the_way(BAR, 0.4))
    named = {found.names[i] for i in rows.items}
    assert {"Left toe in Bar", "Left foot in Bar", "Left shank in Bar"} <= named


def test_what_is_given_up_is_not_lifted_along() -> None:
    of = in_the_way(BAR, 0.4)
    found = world(of)
    for given_up in ({"Left toe in Bar"}, {name for name in found.names if "shank" not in name}):
        rows = found.rows(fitted_hop().motion, given_up)
        assert rows is not None
        assert not given_up & {found.names[i] for i in rows.items}


def test_a_wall_that_is_touched_is_left_the_nearest_way() -> None:
    """Beside the hop, by 3 cm too near for the outermost limb."""
    wall = in_the_way(box((3.0, 0.1, 3.0)), 1.0)
    seen = next(p for p in world(wall).surfaces.parts if isinstance(p, MeshSurface))
    placed = placed_at(fitted_hop().motion, np.linspace(0.0, fitted_hop().motion.duration, 100))
    instants, items = np.indices((100, len(seen.names))).reshape(2, -1)
    ends = axes_in(seen.motion, seen.shapes, placed, instants, items)
    outermost = max(float((end[:, 1] + seen.shapes.radius[items]).max()) for end in ends)
    left = wall.rotations[0][:, 1] * (outermost + 0.05 - 0.03)
    assert set(map(type, ways(replace(wall, positions=wall.positions + left)))) == {type(None)}


@pytest.mark.slow
@pytest.mark.parametrize("height", [0.3, 0.4])
def test_a_hop_clears_a_bar_at_the_shanks(height: float) -> None:
    found = adapt(fitted_hop(), MotionProblem(scene=(in_the_way(BAR, height),)))
    assert found.solved
    inside = [row.amount for row in condition_violations(found) if "Bar" in row.name]
    assert max(inside, default=0.0) < 2.0  # mm
