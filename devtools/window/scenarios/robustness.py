"""Robustness: cancelling, other work, a lost worker and disabling while a motion is adapted."""

from __future__ import annotations

import os
import signal
import time

import addon_utils
import bpy

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


def begin(driver: Driver, kilograms: float) -> Actions:
    """Ask for another mass, so that the fit is made anew and the solve takes some seconds, and
    press Adapt, until the worker is at it."""
    settings().mass = kilograms
    yield from press(driver, "hangtime.adapt")
    busy = extension_module("bridge.worker_client").shared
    yield Until("a solve under way", lambda: solve_stage() == "fit" and busy().busy, 60)
    yield 0.5


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
)
LAST = (Scenario("disabled", disabled, ("adapts",), 120),)
QUITS = (Scenario("quits", quits, ("adapts",), 90),)
