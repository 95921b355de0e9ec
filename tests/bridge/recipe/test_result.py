"""The rest of the take in a recipe."""

import pytest
from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.bridge.recipe.result import (
    ResultOptions,
    require_return_after,
    require_return_within,
)
from hangtime.bridge.rows.choices import After, WrittenAs
from hangtime.solver.data.faults import BadRecipe, ReturnTooEarly, ReturnTooLate


def test_what_becomes_of_the_rest_is_read() -> None:
    text = """
    [result]
    after = "return"
    return_frame = 400
    blend_in = 12
    blend_out = 0
    lock_others = true
    written_as = "strip"
    """
    assert parse_recipe(text).result == ResultOptions(
        After.RETURN, 400.0, 12.0, 0.0, True, WrittenAs.STRIP
    )
    assert parse_recipe("mass = 70").result is None


@pytest.mark.parametrize(
    ("line", "told"),
    [('after = "loop"', "after"), ("blend_in = -1", "blend_in"), ("fade = 3", "fade")],
)
def test_what_cannot_be_is_refused_with_its_line(line: str, told: str) -> None:
    with pytest.raises(BadRecipe, match=told) as fault:
        parse_recipe(f"[result]\n{line}\n")
    assert fault.value.line == 2


def test_a_take_is_not_back_before_it_was_away() -> None:
    options = ResultOptions(After.RETURN, return_frame=200.0)
    require_return_after(options, 199.0)
    with pytest.raises(ReturnTooEarly):
        require_return_after(options, 200.0)


def test_a_take_is_not_back_after_its_end() -> None:
    options = ResultOptions(After.RETURN, return_frame=336.0)
    require_return_within(options, 336.0)
    require_return_within(ResultOptions(After.RETURN), 335.0)  # as soon as there is room
    require_return_within(ResultOptions(After.CARRY, return_frame=420.0), 336.0)
    with pytest.raises(ReturnTooLate):
        require_return_within(options, 335.0)
