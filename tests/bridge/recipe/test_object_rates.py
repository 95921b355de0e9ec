"""Steady motions of objects, as a recipe writes them."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.bridge.recipe.object_rates import RATE_KEYS, rate_values, read_rates
from hangtime.bridge.recipe_syntax.table import Source, Table
from hangtime.solver.data.faults import BadRecipe
from hangtime.solver.data.scene import SteadyMotion
from hangtime.tests.helpers.moving import ground


def table(**values: object) -> Table:
    return Table(Source("recipe", {}), ("object", 0), values, RATE_KEYS)


def test_rates_are_read_in_metres_and_degrees() -> None:
    found = read_rates(table(velocity=[3, 0, 0], spin=90, pivot=[1, 2, 0], belt=[0, -2, 0]))
    assert found == SteadyMotion((3.0, 0.0, 0.0), np.pi / 2, (1.0, 2.0, 0.0), (0.0, -2.0, 0.0))


def test_an_object_without_rates_has_none() -> None:
    assert read_rates(table()) is None
    assert rate_values(ground(None)) == {}


@pytest.mark.parametrize(
    "steady",
    [
        SteadyMotion(velocity=(1.0, 0.5, 0.0)),
        SteadyMotion(spin=np.radians(30.0), pivot=(1.0, 0.0, 0.0)),
        SteadyMotion(belt=(0.0, 0.0, -1.0)),
    ],
)
def test_what_is_written_is_read_again(steady: SteadyMotion) -> None:
    thing = replace(ground(None), steady=steady)
    values = {key: list(v) if isinstance(v, tuple) else v for key, v in rate_values(thing).items()}
    assert read_rates(table(**values)) == steady


def test_a_pivot_without_a_spin_is_refused() -> None:
    with pytest.raises(BadRecipe, match="spins about"):
        read_rates(table(pivot=[0, 0, 0]))
