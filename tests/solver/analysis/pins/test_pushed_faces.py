"""What contacts push against: the steep faces that they are at, and what the artist says."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.analysis.pins.pushed_faces import pushed_normals
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.requests import PointRequest, Requests, Vector, When
from hangtime.solver.data.scene import SceneRole, SteadyMotion
from hangtime.tests.helpers.fitted_hop import hop
from hangtime.tests.helpers.meshes import box, thing
from hangtime.tests.helpers.moving import ground

UP, OUT = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)
WALL = thing("Wall", box((3.0, 0.2, 3.0)), (0.0, -0.1, 1.5), role=SceneRole.OBSTACLE)  # face: y = 0
CRATE = thing("Crate", box((1.0, 1.0, 0.8)), (0.0, 0.5, 0.4))


def normal_at(
    place: Vector, *, asked: Vector | None = None, pushes_back: bool = True
) -> tuple[float, ...]:
    """Of the hop's first contact, were it there."""
    schedule, contact = hop().schedule, hop().schedule.contacts[0]
    point = PointRequest(contact.name, contact.bone, When(), normal=asked, environment=pushes_back)
    problem = MotionProblem(requests=Requests(points=(point,)), scene=(WALL, CRATE))
    floor, character = schedule.floor_m, hop().performance.character
    (found,) = pushed_normals(
        problem, [contact], np.array([place]) + floor * np.array(UP), character, floor
    )
    return tuple(found.tolist())


@pytest.mark.parametrize(
    ("place", "normal"),
    [
        ((0.0, 0.03, 1.5), OUT),
        ((0.0, -0.02, 1.5), OUT),  # sunk in, as soles do
        ((0.0, 0.3, 1.5), UP),  # nothing is there
        ((1.2, 0.03, 0.0), UP),  # on the floor beside it
        ((0.0, 0.03, 0.8), UP),  # on the crate before it
        ((0.4, 0.99, 0.795), UP),  # on the crate's rim
        ((0.4, 1.01, 0.8), UP),  # over the crate's rim, as toes are
        ((0.4, 1.03, 0.82), UP),
        ((0.4, 1.01, 0.5), OUT),  # at the crate's side
    ],
)
def test_what_is_at_a_steep_face_and_stands_on_nothing_pushes_off_from_it(
    place: Vector, normal: Vector
) -> None:
    assert normal_at(place) == pytest.approx(normal)


def test_what_rides_on_a_lift_stands_there_whatever_it_passes() -> None:
    schedule, character = hop().schedule, hop().performance.character
    lift = ground(SteadyMotion(velocity=(0.0, 0.0, 1.0)), "Lift")
    riding = replace(schedule.contacts[0], on=lift.name)
    problem, place = MotionProblem(scene=(WALL, lift)), np.array([[0.0, 0.03, 1.5]])
    (found,) = pushed_normals(problem, [riding], place, character, schedule.floor_m)
    assert tuple(found) == UP


def test_what_the_artist_says_counts() -> None:
    assert normal_at((0.0, 0.03, 1.5), asked=(0.0, 0.0, 2.0)) == pytest.approx(UP)
    assert normal_at((0.0, 0.3, 1.5), asked=(1.0, 0.0, 0.0)) == pytest.approx((1.0, 0.0, 0.0))

    bounded = normal_at((0.0, 0.3, 1.5), asked=(1.0, 0.0, 0.0), pushes_back=False)
    assert bounded == pytest.approx(UP)  # of a point that has a contact's name alone


def test_a_motion_without_contacts_pushes_against_nothing() -> None:
    problem, character = MotionProblem(scene=(WALL,)), hop().performance.character
    assert pushed_normals(problem, [], np.zeros((0, 3)), character, 0.0).shape == (0, 3)
