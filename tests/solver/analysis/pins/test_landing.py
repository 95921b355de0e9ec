"""Pins on objects: contacts come to lie on the faces, feet stay rigid, edges are told."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.operators.words.messages import sentence
from hangtime.solver.analysis.performance import point_depth
from hangtime.solver.analysis.pins.landing import Footing, Ground, land
from hangtime.solver.analysis.pins.pinned_places import chosen_contacts, phase_of, pinned_footing
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.anatomy import Part
from hangtime.solver.data.contacts import Contact
from hangtime.solver.data.faults import Fault, InsideOut, NoFaceThere, OverTheEdge, UnknownObject
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.scene import SceneObject
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.scene.triangle_mesh import placed_mesh
from hangtime.tests.helpers.fitted_hop import hop
from hangtime.tests.helpers.meshes import box, thing

PIN = Pin("Landing", "ground 2", offset=(0.0, 0.0, 0.2), on="Crate")


def footing(crate: SceneObject | None = None, pin: Pin = PIN) -> Footing:
    """Of the pin's contacts alone."""
    things = () if crate is None else (crate,)
    problem = MotionProblem(pins=(pin,), scene=things)
    found = pinned_footing(problem, hop().performance, hop().schedule)
    return Footing(found.places[chosen()], found.normals[chosen()])


def chosen() -> list[int]:
    return chosen_contacts(PIN, phase_of(PIN, hop().schedule), hop().schedule)


def middle() -> FloatArray:
    return footing(pin=replace(PIN, on=None)).places.mean(axis=0)


def slab(tilt: FloatArray, *, size: tuple[float, float, float] = (1.5, 1.5, 0.2)) -> SceneObject:
    """A slab with its upper face through the middle of the contacts."""
    place = middle() - tilt @ np.array([0.0, 0.0, 0.5 * size[2]])
    return thing("Crate", box(size), tuple(place.tolist()), rotation=tilt)


@pytest.mark.parametrize("degrees", [0.0, 20.0, -30.0])
@pytest.mark.parametrize("axis", [0, 1])
def test_feet_lie_on_a_slope_and_stay_as_long_as_they_are(axis: int, degrees: float) -> None:
    tilt = axis_rotation(axis, np.radians(degrees))
    found, flat = footing(slab(tilt)), footing(pin=replace(PIN, on=None))
    np.testing.assert_allclose((found.places - middle()) @ tilt[:, 2], 0.0, atol=0.004)
    np.testing.assert_allclose(found.normals, np.tile(tilt[:, 2], (len(chosen()), 1)), atol=1e-9)
    contacts = hop().schedule.contacts
    sides = [contacts[i].point.split()[0] for i in chosen()]
    for side in ("Left", "Right"):
        foot = [k for k, name in enumerate(sides) if name == side]
        lengths = [np.linalg.norm(np.ptp(each.places[foot], axis=0)) for each in (found, flat)]
        assert lengths[0] == pytest.approx(lengths[1], abs=1e-6)


@pytest.mark.parametrize("recorded", [0.03, 0.9])
def test_a_palm_lies_on_a_face_with_its_point_inside_the_hand(recorded: float) -> None:
    """As high above it as above the recording's floor, or by a hand's depth."""
    character, tilt = hop().performance.character, axis_rotation(0, 0.3)
    place = np.array([0.1, 0.2, recorded])
    hand = next(body.bone for body in character.bodies if body.part is Part.HAND)
    contact = Contact("Left hand 1", "Left hand", hand, np.zeros(3), 0.0, 1.0, place)
    crate = thing("Crate", box((1.5, 1.5, 0.2)), (0.0, 0.0, 0.5), rotation=tilt)
    ground = Ground("Vault", crate, placed_mesh(crate))
    found = land(ground, [contact], place[None], character, floor_m=0.0)
    above = (found.places[0] - crate.positions[0]) @ tilt[:, 2] - 0.1
    assert above == pytest.approx(min(recorded, point_depth("Left hand", character)), abs=1e-6)


def test_feet_may_stand_on_different_steps() -> None:
    places = footing(pin=replace(PIN, on=None)).places
    contacts = hop().schedule.contacts
    left = np.array([contacts[i].point.startswith("Left") for i in chosen()])
    centre = 0.5 * (places[left].mean(axis=0) + places[~left].mean(axis=0))
    aside = places[left].mean(axis=0) - centre
    aside[2] = 0.0
    vertices, triangles = box((1.0, 1.0, 0.2))
    higher = vertices + 0.5 * aside / np.linalg.norm(aside) + [0.0, 0.0, 0.1]
    mesh = np.concatenate([vertices, higher]), np.concatenate([triangles, triangles + 8])
    found = footing(thing("Crate", mesh, tuple(centre.tolist())))
    step = found.places[left, 2].mean() - found.places[~left, 2].mean()
    assert step == pytest.approx(0.1, abs=0.005)


def test_half_a_foot_over_the_edge_is_told_by_how_much() -> None:
    places = footing(pin=replace(PIN, on=None)).places
    low, high = places.min(axis=0), places.max(axis=0)
    centre, size = 0.5 * (low + high), high - low + 0.1
    cut = int(np.argmin(size[:2]))  # along the feet, which are shorter than they are apart
    size[2], centre[2] = 0.2, centre[2] - 0.1
    over = 0.05 + 0.03
    size[cut] -= over
    centre[cut] += 0.5 * over
    crate = thing("Crate", box(tuple(size.tolist())), tuple(centre.tolist()))
    with pytest.raises(OverTheEdge) as caught:
        footing(crate)
    assert 0.0 < caught.value.metres < over - 0.03  # of the first foot that is
    assert caught.value.contact in {hop().schedule.contacts[i].name for i in chosen()}


@pytest.mark.parametrize(
    ("fault", "crate"),
    [
        (NoFaceThere, thing("Crate", box((1.0, 1.0, 1.0)), (9.0, 0.0, 0.0))),
        (UnknownObject, thing("Box", box((1.0, 1.0, 1.0)))),
    ],
)
def test_what_cannot_be_stood_on_is_refused(fault: type[Fault], crate: SceneObject) -> None:
    with pytest.raises(fault):
        footing(crate)


def test_of_what_is_beside_an_object_both_places_are_told() -> None:
    with pytest.raises(NoFaceThere) as caught:
        footing(thing("Crate", box((1.0, 2.0, 1.0)), (9.0, -1.0, 0.0)))
    x, y = middle()[:2]  # of both feet, which stand within a stride of it
    at = caught.value.at
    assert at is not None
    assert np.hypot(at[0] - x, at[1] - y) < 0.5
    told = f"at x = {at[0]:.2f} m, y = {at[1]:.2f} m (it reaches over x = 8.50 to 9.50 m, y = -2.00"
    assert told in sentence(caught.value)


def test_a_sheet_that_looks_down_is_inside_out() -> None:
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    sheet = thing("Crate", (corners, np.array([[0, 2, 1], [0, 3, 2]])), tuple(middle().tolist()))
    with pytest.raises(InsideOut):
        footing(sheet)
