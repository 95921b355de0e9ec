"""Never frozen, never lost: what happens while a motion is being adapted."""

from __future__ import annotations

import os
import signal
import time

import addon_utils
import bpy

from .acts import (
    PACKAGE,
    armature,
    doing,
    idle,
    over_viewport,
    part,
    press,
    shown_action,
    worker_pid,
)
from .stage import Acting, Scene, Stage, Until


def begin(stage: Stage, kilograms: float) -> Acting:
    """Ask for another mass, so that the fit is made anew and the solve takes some seconds, and
    press Adapt, until the worker is at it."""
    armature().hangtime.mass = kilograms
    yield from press(stage, "hangtime.adapt")
    busy = part("bridge.worker_client").shared
    yield Until("a solve under way", lambda: doing() == "fit" and busy().busy)
    yield 0.5


def escapes(stage: Stage) -> Acting:
    kept = shown_action(), len(bpy.data.actions)
    yield from begin(stage, 71.0)
    ended: list[float] = []

    def look() -> bool:  # at a redraw too, which may be long and would hide when it ended
        if not ended and idle():
            ended.append(time.monotonic())
        return bool(ended)

    space = bpy.types.SpaceView3D
    handler = space.draw_handler_add(look, (), "WINDOW", "PRE_VIEW")
    try:
        pressed = time.monotonic()
        stage.hands.key("Escape")
        yield Until("idleness after Esc", look, 5)
    finally:
        space.draw_handler_remove(handler, "WINDOW")
    stage.figures["Esc to idle"] = ended[0] - pressed
    yield 0.5
    assert (shown_action(), len(bpy.data.actions)) == kept, "Esc left another action"


def stays_usable(stage: Stage) -> Acting:
    """Playback goes on and objects can be selected while a solve is under way."""
    frame = bpy.context.scene.frame_current
    yield from begin(stage, 72.0)
    yield from over_viewport(stage, "alt+a")
    yield Until("deselection during the solve", lambda: not armature().select_get(), 3)
    yield from over_viewport(stage, "a")
    yield Until("selection during the solve", lambda: armature().select_get(), 3)
    yield from over_viewport(stage, "space")
    yield Until("a frame played", lambda: bpy.context.scene.frame_current != frame, 3)
    assert not idle(), "the solve was over before anything was tried"
    yield from over_viewport(stage, "space")
    yield Until("the end of the solve", idle, 90)
    assert shown_action().hangtime.recording is not None, "nothing was adapted"


def survives_worker(stage: Stage) -> Acting:
    kept = shown_action()
    yield from begin(stage, 73.0)
    pid = worker_pid()
    assert pid is not None, "no worker is running"
    os.kill(pid, signal.SIGKILL)
    yield Until("idleness after the worker's death", idle, 5)
    yield 0.5
    assert shown_action() == kept, "a dead worker changed the action"
    yield from press(stage, "hangtime.adapt")
    yield 0.5
    yield Until("another worker's answer", idle, 90)
    assert worker_pid() not in (None, pid), "there is no new worker"


def disabled(stage: Stage) -> Acting:
    """The extension goes while a solve is under way, and comes again, three times.

    By Python: the preferences' checkbox is Blender's business.
    """
    before, rows = traces(), len(armature().hangtime.contacts)
    for kilograms in (76.0, 77.0, 78.0):
        yield from begin(stage, kilograms)
        addon_utils.disable(PACKAGE, default_set=True)
        yield Until("the worker's end", lambda: worker_pid() is None, 3)
        left = traces()
        assert not left, f"the extension is disabled but left {left}"
        yield 0.5
        addon_utils.enable(PACKAGE, default_set=True)
        yield 1.0
        assert len(armature().hangtime.contacts) == rows, "the settings are gone"
    after = traces()
    assert after == before, f"{before} became {after}"


def traces() -> list[str]:
    """What of the extension is in Blender: classes and handlers."""
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


def quits(stage: Stage) -> Acting:
    """The play ends here, in the middle of a solve; whoever started Blender looks what is left."""
    yield from begin(stage, 79.0)


SCENES = (
    Scene("escapes", escapes, ("adapts",)),
    Scene("stays_usable", stays_usable, ("adapts",), 120),
    Scene("survives_worker", survives_worker, ("adapts",), 120),
)
LAST = (
    Scene("disabled", disabled, ("adapts",), 120),
    Scene("quits", quits, ("adapts",)),
)
