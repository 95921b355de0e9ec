"""What is told of a figure whose height is stated, in the recording's own lengths."""

import pytest
from hangtime.solver.data.faults import NoFaceThere, OverTheEdge
from hangtime.solver.worker.stated_scale import own_lengths


def test_where_an_object_ends_is_told_as_the_scene_has_it() -> None:
    with pytest.raises(NoFaceThere) as caught, own_lengths(2.0):
        raise NoFaceThere("Landing", "Left toe", "Box", (0.5, 3.0), ((4.0, 6.0), (-2.0, 2.0)))
    assert (caught.value.at, caught.value.reach) == ((0.25, 1.5), ((2.0, 3.0), (-1.0, 1.0)))
    assert (caught.value.contact, caught.value.thing) == ("Left toe", "Box")
    with pytest.raises(OverTheEdge) as over, own_lengths(2.0):
        raise OverTheEdge("Landing", "Left toe", "Box", 0.1)
    assert over.value.metres == 0.05
