"""Never frozen, never lost: what happens while a motion is being adapted."""

from __future__ import annotations

import os
import signal
import time

import bpy

from .window_acts import (
    LANDING,
    armature,
    doing,
    fill_in,
    idle,
    landing_field,
    over_viewport,
    press,
    shown_action,
    worker_pid,
)
from .window_stage import Acting, Scene, Stage, Until


def begin(stage: Stage, forward: float) -> Acting:
    """Ask for another landing and press Adapt, until the worker is at it."""
    yield from fill_in(stage, landing_field("forward"), str(forward))
    yield from press(stage, "hangtime.adapt")
    yield Until("a solve under way", lambda: doing() in ("fit", "solve") and worker_busy())


def worker_busy() -> bool:
    """Whether the worker has a request."""
    from .window_acts import part

    return bool(part("bridge.worker").shared().busy)


def escapes(stage: Stage) -> Acting:
    kept = shown_action(), len(bpy.data.actions)
    yield from begin(stage, 0.25)
    pressed = time.monotonic()
    stage.hands.key("Escape")
    yield Until("idleness after Esc", idle, 5)
    stage.figures["Esc to idle"] = time.monotonic() - pressed
    yield 0.5
    assert (shown_action(), len(bpy.data.actions)) == kept, "Esc left another action"


def stays_usable(stage: Stage) -> Acting:
    """Playback goes on and objects can be selected while a solve is under way."""
    frame = bpy.context.scene.frame_current
    yield from begin(stage, 0.2)
    yield from over_viewport(stage, "space")
    yield Until("a frame played", lambda: bpy.context.scene.frame_current != frame, 5)
    yield from over_viewport(stage, "space", "alt+a")
    deselected = not armature().select_get()
    yield from over_viewport(stage, "a")
    assert deselected, "alt+a did not deselect while a solve was under way"
    assert armature().select_get(), "a did not select"
    yield Until("the end of the solve", idle, 90)
    made = shown_action()
    assert made is not None
    assert made.hangtime.recording is not None, "nothing was adapted"


def survives_worker(stage: Stage) -> Acting:
    kept = shown_action()
    yield from begin(stage, 0.15)
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


SCENES = (
    Scene("escapes", escapes, ("adapts",)),
    Scene("stays_usable", stays_usable, ("adapts",), 120),
    Scene("survives_worker", survives_worker, ("adapts",), 120),
)
