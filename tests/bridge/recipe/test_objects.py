"""Objects of the scene in recipes: shapes, places, files; read back as written; under a pin."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hangtime.bridge.recipe.objects import placed_objects
from hangtime.bridge.recipe.problem import locate, parse_recipe, write_recipe
from hangtime.solver.analysis.pins.pinned_places import pinned_places
from hangtime.solver.data.contacts import Contact
from hangtime.solver.data.faults import BadRecipe, InsideOut, NotGround
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.scene import SceneObject, SceneRole
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.scene.checks import check_scene
from hangtime.solver.scene.triangle_mesh import mesh_of, placed_mesh
from hangtime.tests.helpers.fitted_hop import hop

CART = """\
[[object]]
name = "Cart"
box = [1, 2, 0.5]
path = [{ frame = 1, place = [0, 0, 0] }, { frame = 25, place = [2, 0, 0], turn = 90 }]
"""


def only(text: str, path: str = "recipe") -> SceneObject:
    (thing,) = parse_recipe(text, path).problem.scene
    return thing


def test_boxes_and_ramps_are_closed_solids_on_their_base() -> None:
    box = only('[[object]]\nbox = [1, 2, 0.5]\nplace = [3, 0, 1]\nturn = 90\nrole = "obstacle"')
    ramp = only('[[object]]\nname = "Ramp"\nramp = [1, 2, 0.5]')
    assert (box.name, box.role) == ("Object 1", SceneRole.OBSTACLE)
    assert (ramp.name, ramp.role) == ("Ramp", SceneRole.GROUND)
    assert mesh_of(box).volume == pytest.approx(1.0)
    assert mesh_of(ramp).volume == pytest.approx(0.5)
    np.testing.assert_allclose(placed_mesh(box).low, [2.0, -0.5, 1.0])
    np.testing.assert_allclose(placed_mesh(box).high, [4.0, 0.5, 1.5])
    heights = placed_mesh(ramp).heights(np.array([[-0.25, 0.1], [0.5, 0.9]])).z
    np.testing.assert_allclose(heights, [0.125, 0.5])
    check_scene(MotionProblem(scene=(box, ramp)))


def test_what_is_written_is_read_again() -> None:
    still = replace(only("[[object]]\nramp = [1, 2, 0.5]"), rotations=axis_rotation(0, 0.3)[None])
    scene = (replace(still, name="Ramp"), only(CART), only("[[object]]\nbox = [1, 1, 1]"))
    assert parse_recipe(write_recipe(MotionProblem(scene=scene))).problem.scene == scene


def test_a_path_moves_an_object() -> None:
    cart = only(CART)
    assert cart.moves
    np.testing.assert_allclose(cart.frames, [1.0, 25.0])
    np.testing.assert_allclose(cart.positions[1], [2.0, 0.0, 0.0])
    np.testing.assert_allclose(cart.rotations[1], axis_rotation(2, np.pi / 2), atol=1e-12)


def test_obj_files_lie_beside_the_recipe(tmp_path: Path) -> None:
    text = "# a wedge\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 -1//1\n"
    (tmp_path / "wedge.obj").write_text(text, encoding="utf-8")
    thing = only('[[object]]\nfile = "wedge.obj"', str(tmp_path / "my.toml"))
    np.testing.assert_array_equal(thing.triangles, [[0, 1, 2], [0, 2, 3]])
    (tmp_path / "wedge.obj").write_text("v 0 0 0\nf 1 2 3\n", encoding="utf-8")
    with pytest.raises(BadRecipe, match="line 2"):
        only('[[object]]\nfile = "wedge.obj"', str(tmp_path / "my.toml"))


@pytest.mark.parametrize(
    ("lines", "line"),
    [
        ('name = "Bare"', 1),
        ("box = [1, 1, 1]\nramp = [1, 1, 1]", 3),
        ("box = [1, 0, 1]", 2),
        ("points = [[0, 0, 0]]\nfaces = [[0, 0, 1]]", 3),
        ("points = [[0, 0]]\nfaces = [[0, 0, 0]]", 2),
        ("box = [1, 1, 1]\nforward = 1", 3),
        ('box = [1, 1, 1]\nunder = "Landing"\nplace = [0, 0, 0]', 4),
        ("box = [1, 1, 1]\naxes = [[1, 0, 0], [0, 2, 0], [0, 0, 1]]", 3),
        ('file = "nowhere.obj"', 2),
        ('file = "/dev/full"', 2),  # which can be read without end
        ('file = "\\u0000"', 2),
        ('box = [1, 1, 1]\nrole = "wall"', 3),
    ],
)
def test_faulty_objects_are_told_with_their_line(lines: str, line: int) -> None:
    with pytest.raises(BadRecipe) as caught:
        parse_recipe(f"[[object]]\n{lines}\n")
    assert caught.value.line == line


def test_faults_of_objects_are_found_in_the_recipe() -> None:
    text = f'{CART}\n[[pin]]\nname = "Landing"\nphase = "ground 2"\non = "Cart"\n'
    assert locate(text, InsideOut("Cart")) == 1
    assert locate(text, NotGround("Landing", "Cart")) == text[: text.index("on =")].count("\n") + 1


def test_a_box_under_a_pin_has_its_top_where_the_pin_lands() -> None:
    text = """
        [[object]]
        name = "Crate"
        box = [0.6, 0.5, 0.3]
        under = "Landing"
        [[pin]]
        name = "Landing"
        phase = "ground 2"
        up = 0.3
        forward = 0.1
        on = "Crate"
        [[object]]
        name = "Hurdle"
        box = [0.1, 1, 0.2]
        role = "obstacle"
        under = "flight 1"
    """
    recipe = parse_recipe(text)
    crate, hurdle = placed_objects(recipe.under, recipe.problem, hop())
    bare = replace(recipe.problem, pins=(replace(recipe.problem.pins[0], on=None),))
    places = pinned_places(bare, hop().performance, hop().schedule)
    landing = places[[c.start > 0.6 for c in hop().schedule.contacts]].mean(axis=0)
    np.testing.assert_allclose(crate.positions[0], landing - [0.0, 0.0, 0.3], atol=1e-9)
    assert hurdle.positions[0, 2] == pytest.approx(hop().schedule.floor_m)
    problem = replace(recipe.problem, scene=(crate, hurdle))
    stood = pinned_places(problem, hop().performance, hop().schedule)
    np.testing.assert_allclose(stood, places, atol=0.005)


def test_a_box_under_hands_has_its_top_where_the_palms_rest() -> None:
    """Points in palms that rest on the floor, at different heights above it, moved up by a box."""
    text = """
        [[object]]
        box = [0.9, 0.5, 0.15]
        under = "Hands"
        [[pin]]
        name = "Hands"
        phase = "ground 2"
        points = ["Left hand", "Right hand"]
        up = 0.15
    """
    recipe, schedule = parse_recipe(text), hop().schedule
    phase = schedule.stances[-1]
    hands = tuple(
        Contact(
            f"{side} hand 1",
            f"{side} hand",
            f"{side}Hand",
            np.zeros(3),
            phase.start,
            phase.end,
            np.array([1.0, y, schedule.floor_m + above]),
        )
        for side, y, above in (("Left", 0.2, 0.02), ("Right", -0.2, 0.045))
    )
    analysis = replace(hop(), schedule=replace(schedule, contacts=schedule.contacts + hands))
    (crate,) = placed_objects(recipe.under, recipe.problem, analysis)
    np.testing.assert_allclose(crate.positions[0], [1.0, 0.0, schedule.floor_m], atol=1e-9)
