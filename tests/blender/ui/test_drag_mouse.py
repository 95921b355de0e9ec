"""Where the mouse takes hold of what is dragged."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.operators.drag import limit_mixin
from hangtime.operators.drag.limit_mixin import LimitDrag
from hangtime.operators.drag.mouse import Press
from hangtime.operators.solve.session import session

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


class Limit(LimitDrag):
    """Of a constraint, without Blender's operator."""

    row = SimpleNamespace(name="Knee", met="", status="")
    find_row = take = pull = let_go = lambda self, *_: self.row
    text = staticmethod(lambda: "At most 30.0° (+1.0°)")


def test_the_header_tells_a_limit_and_the_status_bar_the_keys(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    header: list[str] = []
    status: list[str | None] = []
    bar = SimpleNamespace(say=status.append, clear=lambda: status.append(None))
    monkeypatch.setattr(session(), "status_bar", bar)
    monkeypatch.setattr(limit_mixin, "required_armature", lambda _: None)
    monkeypatch.setattr(limit_mixin, "closes", lambda _: False)
    context = SimpleNamespace(
        area=SimpleNamespace(regions=[VIEW], header_text_set=header.append),
        preferences=CONTEXT.preferences,
        region_data=True,
        window=True,
        window_manager=SimpleNamespace(modal_handler_add=lambda _: None),
    )
    drag = Limit()
    drag.invoke(context, mouse(400, 300))
    assert status == [limit_mixin.KEY_HINTS]
    moved, released = mouse(420, 300), mouse(420, 300)
    moved.type, moved.value = "MOUSEMOVE", "NOTHING"
    released.type, released.value = "LEFTMOUSE", "RELEASE"
    drag.modal(context, moved)
    assert header == ["Knee: At most 30.0° (+1.0°)"]
    assert drag.modal(context, released) == {"FINISHED"}
    assert status == [limit_mixin.KEY_HINTS, None]
