"""For whom the file with the result is, in a recipe."""

import pytest
from hangtime.bridge.recipe.export import ExportOptions
from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.bridge.rows.choices import Engine, FileFormat, RootMotion
from hangtime.solver.data.faults import BadRecipe


def test_the_file_is_asked_for() -> None:
    text = """
    [export]
    engine = "godot"
    format = "fbx"
    root = "in place"
    skin = true
    at_origin = true
    """
    asked = ExportOptions(Engine.GODOT, FileFormat.FBX, RootMotion.IN_PLACE, True, True)
    assert parse_recipe(text).export == asked
    assert parse_recipe("[export]").export == ExportOptions()
    assert parse_recipe("mass = 70").export is None


@pytest.mark.parametrize("line", ['engine = "cry"', 'format = "dae"', "leaf_bones = true"])
def test_what_no_file_is_is_refused_with_its_line(line: str) -> None:
    with pytest.raises(BadRecipe) as fault:
        parse_recipe(f"[export]\n{line}\n")
    assert fault.value.line == 2
