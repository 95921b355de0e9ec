"""A recipe's [loop]."""

import pytest
from hangtime.bridge.recipe.problem import parse_recipe, write_recipe
from hangtime.bridge.rows.choices import LoopRoot
from hangtime.solver.data.faults import BadRecipe


def test_loop_is_read_and_written() -> None:
    recipe = parse_recipe('frames = [1, 90]\n[loop]\nroot = "in place"\n')
    assert recipe.problem.loop
    assert recipe.loop is not None
    assert recipe.loop.root is LoopRoot.IN_PLACE
    assert parse_recipe(write_recipe(recipe.problem)).problem == recipe.problem


def test_loop_is_off_unless_asked_for() -> None:
    recipe = parse_recipe("frames = [1, 90]\n")
    assert not recipe.problem.loop
    assert recipe.loop is None


def test_unknown_root_is_said() -> None:
    with pytest.raises(BadRecipe, match="feet") as caught:
        parse_recipe('[loop]\nroot = "feet"\n')
    assert caught.value.line == 2
