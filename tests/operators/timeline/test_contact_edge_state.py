"""Pulling the edge of a contact or phase: where it goes and stops; no Blender."""

from __future__ import annotations

import pytest
from hangtime.operators.timeline.contact_edge_state import (
    Edge,
    EdgeDrag,
    EdgeDragState,
    Touch,
    contact_drag,
    phase_drag,
)

CLIP = (60.0, 330.0)
JUMP = (
    Touch("Left heel 1", "Left heel", 60.0, 135.9),
    Touch("Left toe 1", "Left toe", 60.0, 175.4),
    Touch("Right toe 1", "Right toe", 60.0, 175.4),
    Touch("Left heel 2", "Left heel", 230.8, 330.0),
    Touch("Left toe 2", "Left toe", 233.7, 330.0),
    Touch("Right toe 2", "Right toe", 230.8, 330.0),
)


def grabbed(name: str, edge: Edge, mouse: float | None = None) -> EdgeDrag:
    drag = contact_drag(JUMP, name, edge, CLIP)
    drag.begin(drag.origin if mouse is None else mouse)
    return drag


def test_the_edge_follows_the_mouse_on_whole_frames() -> None:
    drag = grabbed("Left heel 2", Edge.START, mouse=231.3)
    assert drag.move(238.6) == {"Left heel 2": 238.0}
    assert drag.change == pytest.approx(7.2)
    assert drag.release()
    assert drag.stage is EdgeDragState.DONE


def test_tenths_of_frames_when_asked() -> None:
    drag = grabbed("Left heel 2", Edge.START)
    assert drag.move(237.43, fine=True)["Left heel 2"] == pytest.approx(237.4)


def test_a_click_moves_nothing_although_the_edge_is_between_frames() -> None:
    drag = grabbed("Left heel 2", Edge.START)
    drag.slack = 1.5
    assert drag.move(231.9) == {"Left heel 2": 230.8}
    assert not drag.release()


def test_once_it_follows_it_goes_back_as_well() -> None:
    drag = grabbed("Left heel 2", Edge.START)
    drag.slack = 1.5
    drag.move(236.0)
    assert drag.move(231.1) == {"Left heel 2": 231.0}


def test_giving_up_restores() -> None:
    drag = grabbed("Left toe 1", Edge.END)
    drag.move(150.0)
    assert drag.cancel() == {"Left toe 1": 175.4}
    assert drag.stage is EdgeDragState.CANCELLED
    assert drag.change == 0.0


@pytest.mark.parametrize(
    ("name", "edge", "mouse", "stops"),
    [
        ("Left heel 1", Edge.START, 0.0, 60.0),  # the clip's first frame
        ("Left heel 2", Edge.END, 999.0, 330.0),  # its last
        ("Left heel 1", Edge.END, 20.0, 61.0),  # its own other end
        ("Left toe 1", Edge.START, 300.0, 174.4),
        ("Left heel 2", Edge.START, 70.0, 135.9),  # the same point's contact before
        ("Left toe 1", Edge.END, 300.0, 233.7),  # and after
    ],
)
def test_where_a_contact_s_edge_stops(name: str, edge: Edge, mouse: float, stops: float) -> None:
    assert grabbed(name, edge).move(mouse)[name] == pytest.approx(stops)


def test_an_unknown_contact_is_refused() -> None:
    with pytest.raises(KeyError):
        contact_drag(JUMP, "Left hand 1", Edge.START, CLIP)


def pulled(stance: tuple[float, float], edge: Edge, to: float) -> dict[str, float]:
    drag = phase_drag(JUMP, stance, edge, CLIP)
    drag.begin(drag.origin)
    return drag.move(to)


def test_an_earlier_landing_is_that_of_the_points_that_land_first() -> None:
    edges = pulled((230.8, 330.0), Edge.START, 225.0)
    assert edges == {"Left heel 2": 225.0, "Right toe 2": 225.0, "Left toe 2": 233.7}


def test_a_later_landing_takes_the_others_along_as_it_passes_them() -> None:
    edges = pulled((230.8, 330.0), Edge.START, 240.0)
    assert edges == dict.fromkeys(("Left heel 2", "Right toe 2", "Left toe 2"), 240.0)


def test_an_earlier_take_off_cuts_short_what_it_passes() -> None:
    edges = pulled((60.0, 175.4), Edge.END, 120.0)
    assert set(edges.values()) == {120.0}
    assert pulled((60.0, 175.4), Edge.END, 170.0)["Left heel 1"] == 135.9


@pytest.mark.parametrize(
    ("stance", "edge", "to", "stops"),
    [
        ((60.0, 175.4), Edge.END, 300.0, 229.8),  # a frame of flight is left
        ((230.8, 330.0), Edge.START, 100.0, 176.4),
        ((230.8, 330.0), Edge.START, 400.0, 329.0),
    ],
)
def test_a_flight_remains_between_stances(
    stance: tuple[float, float], edge: Edge, to: float, stops: float
) -> None:
    edges = pulled(stance, edge, to)
    assert (max if edge is Edge.END else min)(edges.values()) == pytest.approx(stops)
