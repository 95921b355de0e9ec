"""Contacts in the timeline: bars, and retiming by their edges."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

import hangtime
from hangtime.bridge.properties.of_actions.shown_times import recorded_frame, store_times
from hangtime.operators.names import OperatorId
from hangtime.operators.timeline import contact_edge_operator
from hangtime.operators.timeline.contact_edge_state import Edge
from hangtime.operators.timeline.timeline_bars import bars_in
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.tests.blender.helpers import motions, regions, rigs
from hangtime.ui.timeline import handler

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def settings() -> bpy.types.PropertyGroup:
    return motions.analysed().hangtime


def drag(**values: Any) -> set[str]:
    found: set[str] = bpy.ops.hangtime.drag_contact_edge(**values)
    return found


def clicks() -> list[str]:
    """What the extension does with the mouse in timelines."""
    keymaps = bpy.context.window_manager.keyconfigs.addon.keymaps
    ours = (OperatorId.DRAG_CONTACT_EDGE, OperatorId.PICK_CONTACT)
    return [
        item.idname for keymap in keymaps for item in keymap.keymap_items if item.idname in ours
    ]


# ---------------------------------------------------------------- by script


def test_an_edge_is_moved(settings: bpy.types.PropertyGroup) -> None:
    assert drag(contact="Left heel 2", edge="START", frame=75.0) == {"FINISHED"}
    row = settings.contacts["Left heel 2"]
    assert (row.start_frame, row.end_frame) == (75.0, motions.LAST)
    assert row.found_start == motions.LANDING  # so that the next Adapt sees a change
    assert drag(contact="Left toe 1", edge="END", frame=40.5) == {"FINISHED"}
    assert settings.contacts["Left toe 1"].end_frame == 40.5


def test_a_phase_takes_its_contacts_along(settings: bpy.types.PropertyGroup) -> None:
    assert drag(contact="ground 2", edge="START", frame=74.0) == {"FINISHED"}
    starts = {row.name: row.start_frame for row in settings.contacts if row.name.endswith("2")}
    assert set(starts.values()) == {74.0}
    assert settings.contacts["Left toe 1"].end_frame == motions.TAKE_OFF


def test_where_it_cannot_go_it_stops(settings: bpy.types.PropertyGroup) -> None:
    drag(contact="Left heel 2", edge="END", frame=500.0)
    assert settings.contacts["Left heel 2"].end_frame == motions.LAST
    drag(contact="Left heel 2", edge="START", frame=-500.0)
    assert settings.contacts["Left heel 2"].start_frame == 30.0  # where Left heel 1 ends


@pytest.mark.parametrize("name", ["Left hand 1", "flight 1", ""])
def test_a_name_that_is_not_there_is_said(settings: bpy.types.PropertyGroup, name: str) -> None:
    before = [(row.start_frame, row.end_frame) for row in settings.contacts]
    with pytest.raises(RuntimeError, match=f"no contact or ground phase called “{name}”"):
        drag(contact=name, edge="END", frame=20.0)
    assert [(row.start_frame, row.end_frame) for row in settings.contacts] == before


def test_a_contact_that_does_not_count_is_not_retimed(settings: bpy.types.PropertyGroup) -> None:
    settings.contacts["Left heel 2"].used = False
    with pytest.raises(RuntimeError, match="no contact"):
        drag(contact="Left heel 2", edge="START", frame=75.0)


def test_a_contact_is_picked(settings: bpy.types.PropertyGroup) -> None:
    assert bpy.ops.hangtime.pick_contact(contact="Right toe 1") == {"FINISHED"}
    assert settings.contacts[settings.active_contact].name == "Right toe 1"
    with pytest.raises(RuntimeError, match="no contact called “Tail”"):
        bpy.ops.hangtime.pick_contact(contact="Tail")


def test_before_an_analysis_it_is_grey_and_says_why() -> None:
    rigs.reset()
    rigs.make_armature()
    with pytest.raises(RuntimeError, match="Press Analyze first"):
        drag(contact="Left heel 1", edge="END", frame=20.0)


# ---------------------------------------------------------------- bars


def test_bars_are_where_the_shown_action_has_them(settings: bpy.types.PropertyGroup) -> None:
    armature = settings.id_data
    action = bpy.data.actions.new("adapted")
    armature.animation_data_create().action = action
    later = 10.0
    store_times(
        action,
        TimeMap(
            (motions.FIRST, motions.TAKE_OFF, motions.LAST),
            (motions.FIRST, motions.TAKE_OFF + later, motions.LAST + later),
        ),
    )
    bars = bars_in(regions.timeline(0.0, 200.0))
    assert bars is not None
    flight = bars.rows[-1].bars[1]
    assert (flight.start, flight.end) == (motions.TAKE_OFF + later, motions.LANDING + later)
    assert recorded_frame(armature, motions.LANDING + later) == motions.LANDING
    assert recorded_frame(armature, motions.LAST + later + 5.0) == motions.LAST + 5.0


def test_a_row_for_each_point_and_one_for_the_phases(settings: bpy.types.PropertyGroup) -> None:
    settings.active_contact = 3
    settings.contacts["Left toe 2"].used = False
    bars = bars_in(regions.timeline(0.0, 200.0))
    assert bars is not None
    names = [row.name for row in bars.rows]
    assert names == ["Left heel", "Left toe", "Right toe", "Phases"]
    phases = [(bar.name, bar.start, bar.end) for bar in bars.rows[-1].bars]
    assert phases == [
        ("ground 1", motions.FIRST, motions.TAKE_OFF),
        ("flight 1", motions.TAKE_OFF, motions.LANDING),
        ("ground 2", motions.LANDING, motions.LAST),
    ]
    assert [bar.name for row in bars.rows for bar in row.bars if bar.chosen] == ["Left heel 2"]
    assert [bar.name for row in bars.rows for bar in row.bars if not bar.used] == ["Left toe 2"]


def test_the_bars_are_where_the_editor_has_the_frames(settings: bpy.types.PropertyGroup) -> None:
    assert settings is not None
    bars = bars_in(regions.timeline(50.0, 100.0, width=1000))
    assert bars is not None
    rect = next(rect for bar, rect in bars.placed() if bar.name == "Left heel 2")
    assert rect.left == pytest.approx(400.0)
    grip = bars.grip_at(404.0, 0.5 * (rect.bottom + rect.top))
    assert grip is not None
    assert (grip.bar.name, grip.edge) == ("Left heel 2", Edge.START)


def test_they_are_drawn_once_while_nothing_changes(
    settings: bpy.types.PropertyGroup, monkeypatch: pytest.MonkeyPatch
) -> None:
    canvas, overlay = regions.canvas(monkeypatch), handler.BarOverlay()
    monkeypatch.setattr(handler, "bpy", SimpleNamespace(context=regions.timeline(0.0, 120.0)))
    for frame in range(20, 30):
        bpy.context.scene.frame_set(frame)
        overlay.draw()
    assert canvas.made == 1
    assert {"Left heel 1", "Right toe 2", "flight 1"} <= set(canvas.words)
    drag(contact="Left heel 2", edge="START", frame=80.0)
    overlay.draw()
    assert canvas.made == 2
    bpy.context.scene.hangtime.view.timeline = False
    canvas.clear()
    overlay.draw()
    assert canvas.pictures == []
    bpy.context.scene.hangtime.view.timeline = True
    bpy.data.objects.remove(settings.id_data)
    overlay.draw()
    assert canvas.pictures == []


# ---------------------------------------------------------------- the mouse


class Hand:
    """A mouse in a timeline, and the operator that it is given to."""

    def __init__(self, context: Any) -> None:
        self.context = context
        context.window = SimpleNamespace(
            cursor_modal_set=lambda _name: None, cursor_modal_restore=lambda: None
        )
        context.window_manager = SimpleNamespace(
            windows=[], modal_handler_add=lambda _operator: True
        )
        self.said: list[str | None] = []
        context.area.header_text_set = self.said.append
        cls = contact_edge_operator.DragContactEdgeOperator
        names = ("invoke", "modal", "cancel", "execute", "_choose", "_show", "_end", "_finished")
        methods = {name: getattr(cls, name) for name in (*names, "_settings")}
        self.operator = type("Operator", (), methods)()

    def at(self, kind: str, value: str, frame: float, y: float, *, ctrl: bool = False) -> Any:
        bars = bars_in(self.context)
        assert bars is not None
        return SimpleNamespace(
            type=kind,
            value=value,
            mouse_region_x=bars.axis.at(frame),
            mouse_region_y=y,
            ctrl=ctrl,
            shift=False,
        )

    def press(self, name: str, frame: float) -> set[str]:
        bars = bars_in(self.context)
        assert bars is not None
        rect = next(rect for bar, rect in bars.placed() if bar.name == name)
        self.y = 0.5 * (rect.bottom + rect.top)
        return self.operator.invoke(self.context, self.at("LEFTMOUSE", "PRESS", frame, self.y))

    def move(self, frame: float, *, ctrl: bool = False) -> set[str]:
        event = self.at("MOUSEMOVE", "NOTHING", frame, self.y, ctrl=ctrl)
        return self.operator.modal(self.context, event)

    def event(self, kind: str, value: str) -> set[str]:
        return self.operator.modal(self.context, self.at(kind, value, 0.0, self.y))


@pytest.fixture
def hand(settings: bpy.types.PropertyGroup) -> Hand:
    assert settings is not None
    return Hand(regions.timeline(0.0, 200.0))


def test_dragging_with_the_mouse(settings: bpy.types.PropertyGroup, hand: Hand) -> None:
    row = settings.contacts["Left heel 2"]
    assert hand.press("Left heel 2", 70.4) == {"RUNNING_MODAL"}
    assert settings.contacts[settings.active_contact].name == "Left heel 2"
    hand.move(76.7)
    assert row.start_frame == 76.0
    assert hand.said[-1] is not None
    assert hand.said[-1].startswith("Left heel 2 starts at frame 76 (+6)")
    hand.move(76.7, ctrl=True)
    assert row.start_frame == pytest.approx(76.3)
    assert hand.event("TIMER0", "NOTHING") == {"PASS_THROUGH"}  # playback
    assert hand.event("LEFTMOUSE", "RELEASE") == {"FINISHED"}
    assert row.start_frame == pytest.approx(76.3)
    assert hand.said[-1] is None


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_giving_up_puts_everything_back(
    settings: bpy.types.PropertyGroup, hand: Hand, key: str
) -> None:
    hand.press("ground 2", 70.0)
    hand.move(90.0)
    assert settings.contacts["Left toe 2"].start_frame == 90.0
    assert hand.event(key, "PRESS") == {"CANCELLED"}
    for row in settings.contacts:
        assert (row.start_frame, row.end_frame) == (row.found_start, row.found_end)
    assert settings.active_contact == 0


def test_away_from_edges_the_click_is_left_to_the_editor(hand: Hand) -> None:
    assert hand.press("Left heel 2", 90.0) == {"PASS_THROUGH"}
    assert hand.press("flight 1", 55.0) == {"PASS_THROUGH"}
    hand.context.scene.hangtime.view.timeline = False
    assert hand.operator.invoke(
        hand.context, SimpleNamespace(mouse_region_x=350.0, mouse_region_y=hand.y)
    ) == {"PASS_THROUGH"}


def test_an_armature_removed_in_the_middle_ends_the_drag(
    settings: bpy.types.PropertyGroup, hand: Hand
) -> None:
    hand.press("Left heel 2", 70.0)
    event = hand.at("MOUSEMOVE", "NOTHING", 80.0, hand.y)
    bpy.data.objects.remove(settings.id_data)
    assert hand.operator.modal(hand.context, event) == {"CANCELLED"}
    assert hand.said[-1] is None


def test_clicks_are_given_back_on_unregistering() -> None:
    assert sorted(clicks()) == sorted([OperatorId.DRAG_CONTACT_EDGE, OperatorId.PICK_CONTACT])
    hangtime.unregister()
    try:
        assert clicks() == []
    finally:
        hangtime.register()
    assert len(clicks()) == 2
