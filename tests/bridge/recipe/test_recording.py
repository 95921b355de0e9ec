"""Repairs of the recording in a recipe."""

import re

import pytest
from hangtime.bridge.recipe import recording
from hangtime.bridge.recipe.problem import parse_recipe, parse_text, write_recipe
from hangtime.bridge.recipe.recording import FILE, RECORDING, FileReading
from hangtime.bridge.recipe_syntax.toml_text import sections
from hangtime.solver.data.faults import BadRecipe
from hangtime.solver.data.problem import Mend, MotionProblem
from hangtime.solver.doctor.repairs import MissingFrames, Repairs, UpAxis

MISSING = (MissingFrames(-5, 1), MissingFrames(57, 4), MissingFrames(103, -36))
MENDS = (Mend.HELD_FRAMES, Mend.FLIPS)
FULL = Repairs(
    UpAxis.MINUS_X, MISSING, 2, MENDS, 0.8, 1.6, (0.1, -0.25), 0.12, 30, -0.05, (1.5, -0.25)
)


def test_repairs_come_back() -> None:
    texts = sections(RECORDING.header, RECORDING.write(FULL))
    assert parse_recipe("\n".join(texts)).repairs == FULL


@pytest.mark.parametrize("key", [*FILE.keys, *RECORDING.keys])
def test_every_key_is_at_the_top_of_the_module(key: str) -> None:
    assert re.search(rf"^{key} = ", recording.__doc__ or "", re.MULTILINE)


def test_how_a_file_is_read_comes_back() -> None:
    stated = FileReading(0.0254, "Z", 120.0, "../01.asf", "Rig", "Jump")
    assert parse_recipe("\n".join(sections(FILE.header, FILE.write(stated)))).file == stated
    assert parse_recipe("mass = 70\n").file == FileReading()


@pytest.mark.parametrize(
    "line", ["unit = 0", 'up = "X"', "up = 1", "rate = -30", "rate = 1e12", 'scale = "1"']
)
def test_a_mistake_about_the_file_is_told_with_its_line(line: str) -> None:
    with pytest.raises(BadRecipe) as told:
        parse_recipe(f"[file]\n{line}\n")
    assert told.value.line == 2


def test_in_blender_where_the_file_is_read_already_its_keys_are_refused() -> None:
    with pytest.raises(BadRecipe, match=r"counts in a recipe.*the armature.*s action"):
        parse_text("[file]\nunit = 0.0254\n", "Text")


def test_a_recipe_that_says_nothing_repairs_nothing() -> None:
    assert parse_recipe("mass = 70\n").repairs is None
    assert RECORDING.write(Repairs()) == {}


@pytest.mark.parametrize(
    "line",
    [
        'repair = ["warts"]',
        "trim = 1.5",
        "trim_end = -1",
        "time_scale = 0",
        "scale = 1e-6",
        "scale = 1e300",
        "drift = [12, 12]",
        "drift = [1e6, 0]",
        'up = "W"',
        "drift = [1]",
        "rise = 50",
        "tilt = [1.5]",
        "tilt = [0, -40]",
        "missing = { soon = 4 }",
        "missing = { 57 = 0 }",
        "missing = [57, 4]",
    ],
)
def test_a_mistake_is_told_with_its_line(line: str) -> None:
    with pytest.raises(BadRecipe) as told:
        parse_recipe(f"[recording]\n{line}\n")
    assert told.value.line == 2


def test_what_is_good_enough_comes_back() -> None:
    problem = parse_recipe("good_enough = 0.003").problem
    assert problem.good_enough == 0.003
    assert "good_enough = 0.003" in write_recipe(problem)
    assert "good_enough" not in write_recipe(MotionProblem())
    with pytest.raises(BadRecipe, match="zero or more"):
        parse_recipe("good_enough = -1")
