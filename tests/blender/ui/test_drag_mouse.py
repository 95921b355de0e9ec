"""Where the mouse takes hold of what is dragged."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.operators.drag.mouse import Press

VIEW = SimpleNamespace(type="WINDOW", x=0, y=81, width=1057, height=692)
SIDEBAR = SimpleNamespace(type="UI", x=766, y=81, width=291, height=638)  # over the view
CONTEXT = SimpleNamespace(
    area=SimpleNamespace(regions=[VIEW, SIDEBAR]),
    preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),  # none without a window
)


def mouse(x: int, y: int) -> SimpleNamespace:
    """Where the mouse is in the window, and in the view."""
    return SimpleNamespace(
        mouse_x=x, mouse_y=y, mouse_region_x=x - VIEW.x, mouse_region_y=y - VIEW.y
    )


def test_the_way_from_a_button_of_the_sidebar_into_the_view_drags_nothing() -> None:
    press = Press.of(CONTEXT, mouse(830, 200), click=False)
    assert not press.drags(CONTEXT, mouse(780, 250))
    assert not press.drags(CONTEXT, mouse(700, 300))
    assert press.at == (700, 219), "it takes hold where it comes into the view"
    assert press.drags(CONTEXT, mouse(690, 300))
    assert press.drags(CONTEXT, mouse(800, 300)), "then it may go on under the sidebar"
    assert press.at == (700, 219)


def test_a_key_in_the_view_takes_hold_at_once_and_a_handle_after_the_slack() -> None:
    assert Press.of(CONTEXT, mouse(400, 300), click=False).drags(CONTEXT, mouse(401, 300))
    press = Press.of(CONTEXT, mouse(400, 300), click=True)
    assert not press.drags(CONTEXT, mouse(401, 300))
    assert press.drags(CONTEXT, mouse(420, 300))
