"""Recipes that are exported: what they are read as again is what Adapt would solve."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.recipe.problem import Recipe, parse_recipe
from hangtime.bridge.recipe.shortest import shortest
from hangtime.bridge.takes.options import result_options
from hangtime.operators.solve.adapt import ask_for
from hangtime.operators.solve.written.keys import key_options
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.scene.triangle_mesh import placed_mesh
from hangtime.tests.blender.helpers.solids import add_row, make_box

pytestmark = pytest.mark.usefixtures("_enabled")


def exported(folder: Path) -> MotionProblem:
    return recipe(folder).problem


def recipe(folder: Path) -> Recipe:
    path = folder / "edit.toml"
    assert bpy.ops.hangtime.export_recipe(filepath=str(path)) == {"FINISHED"}
    return parse_recipe(path.read_text(encoding="utf-8"), str(path))


def test_the_world_s_objects_come_along(analysed: bpy.types.Object, tmp_path: Path) -> None:
    landing = next(row for row in analysed.hangtime.contacts if row.phase == "ground 2")
    crate = make_box("Crate", at=(landing.at[0], landing.at[1], 0.1), size=0.2)
    crate.scale, crate.rotation_euler = (8.0, 5.0, 1.0), (0.0, 0.0, 0.3)
    bpy.ops.mesh.primitive_ico_sphere_add(radius=0.2, location=(3.0, 0.0, 0.5))
    ball = bpy.context.object
    ball.name = "Ball / 1"
    add_row(analysed, crate)
    row = add_row(analysed, ball)
    row.role, row.clearance = "CLEAR", 0.05
    for contact in analysed.hangtime.contacts:
        contact.on = crate if contact.phase == "ground 2" else None
    asked = complete(ask_for(bpy.context)).problem
    found = exported(tmp_path)
    assert replace(found, scene=()) == shortest(replace(asked, scene=()))
    assert {pin.on for pin in found.pins} == {"Crate"}
    (clear,) = found.requests.clears
    assert (clear.thing, clear.by) == ("Ball / 1", pytest.approx(0.05))
    assert {path.name for path in tmp_path.iterdir()} == {"edit.toml", "Ball _ 1.obj"}
    text = (tmp_path / "edit.toml").read_text(encoding="utf-8")
    assert "box = [1.6" in text
    places = np.random.default_rng(1).uniform(-0.5, 3.5, (200, 3))
    for mine, theirs in zip(found.scene, asked.scene, strict=True):
        assert (mine.name, mine.role) == (theirs.name, theirs.role)
        np.testing.assert_allclose(
            placed_mesh(mine).distances(places).distance,
            placed_mesh(theirs).distances(places).distance,
            atol=1e-5,
        )


@pytest.mark.usefixtures("analysed")
def test_a_path_from_the_file_s_folder_on_gives_no_warning(
    tmp_path: Path, recwarn: pytest.WarningsRecorder
) -> None:
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    assert bpy.ops.hangtime.export_recipe(filepath="//there.toml") == {"FINISHED"}
    assert (tmp_path / "there.toml").is_file()
    with pytest.raises(RuntimeError, match="No file is given"):
        bpy.ops.hangtime.export_recipe(filepath="")
    assert [str(warning.message) for warning in recwarn] == []


@pytest.mark.skipif(bpy.app.version < (4, 5, 0), reason="paths may be relative since Blender 4.5")
@pytest.mark.parametrize(
    "asked", ["export", "export_recipe", "save_plots", "export_bone_preset", "import_bone_preset"]
)
def test_every_path_may_begin_at_the_file_s_folder(asked: str) -> None:
    path = getattr(bpy.ops.hangtime, asked).get_rna_type().properties["filepath"]
    assert path.is_path_supports_blend_relative


def test_contacts_and_times_that_the_artist_changed_come_along(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    contact = analysed.hangtime.contacts[0]
    contact.end_frame -= 2.0
    added = analysed.hangtime.contacts.add()
    added.name, added.point, added.added, added.used = "Left toe", "Left toe", True, True
    added.bone, added.start_frame, added.end_frame = contact.bone, 200.0, 210.0
    analysed.hangtime.keep_times = True
    assert exported(tmp_path) == shortest(complete(ask_for(bpy.context)).problem)


def test_numbers_have_the_digits_that_were_typed(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    contact = next(row for row in analysed.hangtime.contacts if row.phase == "ground 2")
    contact.at, analysed.hangtime.mass = (0.3, -1.1, 0.25), 70.3
    exported(tmp_path)
    said = (tmp_path / "edit.toml").read_text(encoding="utf-8").splitlines()
    assert {"place = [0.3, -1.1, 0.25]", "mass = 70.3"} <= set(said)


def test_the_rest_of_the_take_and_the_keys_come_along(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    settings = analysed.hangtime
    recipe(tmp_path)
    usual = (tmp_path / "edit.toml").read_text(encoding="utf-8")
    assert not {"[result]", "[keys]"} & set(usual.splitlines())
    options = settings.result
    options.after, options.written_as, options.lock_others = "RETURN", "STRIP", True
    options.use_return_frame, options.return_frame = True, 300
    options.use_blend, options.blend_in, options.blend_out = True, 7, 11
    settings.result_keys.on, settings.result_keys.distance = "REDUCED", 3.0
    found = recipe(tmp_path)
    assert found.result == shortest(result_options(settings))
    assert found.keys == shortest(key_options(settings))
