"""Robustness: cancelling, other work, a lost worker and disabling while a motion is adapted."""

from __future__ import annotations

import os
import signal
import time

import addon_utils
import bpy
from mathutils import Vector

from ..driving.actions import (
    PACKAGE,
    armature,
    current_scene,
    extension_module,
    idle,
    origin,
    over_viewport,
    press,
    settings,
    shown_action,
    solve_stage,
    worker_pid,
)
from ..driving.driver import Actions, Driver, Scenario, Until
from ..driving.screen import present, window_manager


def begin(driver: Driver, kilograms: float) -> Actions:
    """Ask for another mass, so that the fit is made anew and the solve takes some seconds, and
    press Adapt, until the worker is at it."""
    settings().mass = kilograms
    yield from press(driver, "hangtime.adapt")
    busy = extension_module("bridge.worker_client").shared
    yield Until("a solve under way", lambda: solve_stage() == "fit" and busy().busy, 60)
    yield 0.5


def begin_in(window: bpy.types.Window, seconds: float) -> Actions:
    """Adapt in the viewport of a window, in which the sidebar may be another's, for some seconds
    of the worker's."""
    area = next(each for each in window.screen.areas if each.type == "VIEW_3D")
    region = next(each for each in area.regions if each.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.hangtime.adapt("INVOKE_DEFAULT")  # type: ignore[attr-defined]  # our own
    yield Until("a solve under way", lambda: solve_stage() == "fit", 60)
    yield seconds


def escapes(driver: Driver) -> Actions:
    kept = shown_action(), len(bpy.data.actions)
    yield from begin(driver, 71.0)
    ended: list[float] = []

    def look() -> bool:  # at a redraw too, which may be long and would hide when it ended
        if not ended and idle():
            ended.append(time.monotonic())
        return bool(ended)

    space = bpy.types.SpaceView3D
    handler = space.draw_handler_add(look, (), "WINDOW", "PRE_VIEW")
    try:
        pressed = time.monotonic()
        driver.input.key("Escape")
        yield Until("idleness after Esc", look, 5)
    finally:
        space.draw_handler_remove(handler, "WINDOW")
    driver.figures["Esc to idle"] = ended[0] - pressed
    yield 0.5
    assert (shown_action(), len(bpy.data.actions)) == kept, "Esc left another action"


def stays_usable(driver: Driver) -> Actions:
    """Playback goes on and objects can be selected while a solve is under way."""
    frame = current_scene().frame_current
    yield from begin(driver, 72.0)
    yield from over_viewport(driver, "alt+a")
    yield Until("deselection during the solve", lambda: not armature().select_get(), 3)
    yield from over_viewport(driver, "a")
    yield Until("selection during the solve", lambda: armature().select_get(), 3)
    yield from over_viewport(driver, "space")
    yield Until("a frame played", lambda: current_scene().frame_current != frame, 3)
    assert not idle(), "the solve was over before anything was tried"
    yield from over_viewport(driver, "space")
    yield Until("the end of the solve", idle, 90)
    assert origin(shown_action()).recording is not None, "nothing was adapted"


def survives_worker(driver: Driver) -> Actions:
    kept = shown_action()
    yield from begin(driver, 73.0)
    pid = worker_pid()
    assert pid is not None, "no worker is running"
    os.kill(pid, signal.SIGKILL)
    yield Until("idleness after the worker's death", idle, 5)
    yield 0.5
    assert shown_action() == kept, "a dead worker changed the action"
    yield from press(driver, "hangtime.adapt")
    yield 0.5
    yield Until("another worker's answer", idle, 90)
    assert worker_pid() not in (None, pid), "there is no new worker"


def outlives_workspace(driver: Driver) -> Actions:
    """The solve's tab is left, where what the status bar said must not stay, and then another is
    deleted meanwhile."""
    window = driver.screen.window
    home = window.workspace
    yield from begin(driver, 74.0)
    window.workspace = bpy.data.workspaces["Animation"]
    yield Until("the end of the solve", idle, 90)
    window.workspace = home
    yield 1.0
    yield from driver.picture("home_again")
    with bpy.context.temp_override(window=window):
        bpy.ops.workspace.duplicate()
    yield 0.5
    kept = shown_action()
    settings().mass = 74.5
    yield from begin_in(window, 0.5)
    with bpy.context.temp_override(window=window):
        bpy.ops.workspace.delete()
    yield Until("the end of the solve", idle, 90)
    yield 0.5
    assert shown_action() != kept, "nothing was adapted"


def drag_outlives_workspace(driver: Driver) -> Actions:
    """Another workspace is shown in the middle of a drag: the pin goes back, and nothing stays."""
    window = driver.screen.window
    home, row = window.workspace, settings().contacts[settings().active_contact]
    kept, pin = shown_action(), Vector(row.at)
    end = driver.screen.place_of(pin + Vector((0.1, 0.1, 0.0)))
    yield driver.input.press(driver.screen.place_of(pin), "the landing's pin")
    yield driver.input.move(end, 0.5)
    assert (Vector(row.at) - pin).length > 0.01, "the pin does not follow the mouse"
    window.workspace = bpy.data.workspaces["Animation"]
    yield Until("the end of the drag", idle, 5)
    yield driver.input.let_go()
    window.workspace = home
    yield 0.5
    assert (Vector(row.at) - pin).length < 1e-4, "the pin did not go back"
    assert shown_action() == kept, "a drag that ended so has adapted"


def closes_its_window(driver: Driver) -> Actions:
    """A solve ends with the window in which it was started, and leaves nothing.

    A key closes it, as none does by itself: by Python Blender would end with it.
    """
    kept = shown_action(), len(bpy.data.actions)
    user = present(window_manager().keyconfigs.user)
    keys = user.keymaps["Window"].keymap_items
    closes = keys.new("wm.window_close", "F10", "PRESS")
    with bpy.context.temp_override(window=driver.screen.window):
        bpy.ops.wm.window_new_main()
    yield 1.5
    other = window_manager().windows[-1]
    settings().mass = 75.0
    yield from begin_in(other, 0.5)
    height = driver.screen.window.height
    yield driver.input.move((other.x + other.width / 2, height - other.y - other.height / 2))
    yield 0.5
    yield driver.input.key("F10")
    yield Until("the window's end", lambda: len(window_manager().windows) == 1, 5)
    keys.remove(closes)
    yield Until("idleness after the window's end", idle, 5)
    yield 1.0
    assert (shown_action(), len(bpy.data.actions)) == kept, "what was dropped left an action"
    yield from press(driver, "hangtime.adapt")
    yield Until("work", lambda: not idle())
    yield Until("the end of the solve", idle, 90)
    assert shown_action() != kept[0], "nothing was adapted afterwards"


def disabled(driver: Driver) -> Actions:
    """The extension goes while a solve is under way, and comes again, three times.

    By Python: the preferences' checkbox is Blender's business.
    """
    before, rows = traces(), len(settings().contacts)
    for kilograms in (76.0, 77.0, 78.0):
        yield from begin(driver, kilograms)
        addon_utils.disable(PACKAGE, default_set=True)
        yield Until("the worker's end", lambda: worker_pid() is None, 3)
        left = traces()
        assert not left, f"the extension is disabled but left {left}"
        yield 0.5
        addon_utils.enable(PACKAGE, default_set=True)
        yield 1.0
        assert len(settings().contacts) == rows, "the settings are gone"
    after = traces()
    assert after == before, f"{before} became {after}"


def traces() -> list[str]:
    """Classes and handlers of the extension that are registered in Blender."""
    names = ("Operator", "Panel", "UIList", "Menu", "GizmoGroup", "Gizmo", "PropertyGroup")
    kinds = [getattr(bpy.types, name) for name in names]
    found = [cls.__name__ for kind in kinds for cls in kind.__subclasses__() if ours(cls)]
    registered = [name for name in found if hasattr(bpy.types, name)]
    for name in dir(bpy.app.handlers):
        handlers = getattr(bpy.app.handlers, name)
        if isinstance(handlers, list):
            registered += [f"{name}: {each.__name__}" for each in handlers if ours(each)]
    return sorted(registered)


def ours(thing: object) -> bool:
    """Whether a class or function is the extension's."""
    return str(getattr(thing, "__module__", "")).startswith(PACKAGE)


def quits(driver: Driver) -> Actions:
    """The run ends here, in the middle of a solve; whoever started Blender looks what is left."""
    yield from begin(driver, 79.0)


SCENARIOS = (
    Scenario("escapes", escapes, ("adapts",)),
    Scenario("stays_usable", stays_usable, ("adapts",), 120),
    Scenario("survives_worker", survives_worker, ("adapts",), 120),
    Scenario("outlives_workspace", outlives_workspace, ("adapts",), 240),
    Scenario("drag_outlives_workspace", drag_outlives_workspace, ("drags_landing",)),
    Scenario("closes_its_window", closes_its_window, ("adapts",), 180),
)
LAST = (Scenario("disabled", disabled, ("adapts",), 120),)
QUITS = (Scenario("quits", quits, ("adapts",), 90),)
