"""A process that does cases of a campaign with one fault planted in the product.

As a program of `run_cases`: the fault's name, then the arguments of `child`.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from hangtime.bridge import worker_client
from hangtime.bridge.action_slots import all_curves
from hangtime.devtools.campaign import child
from hangtime.devtools.campaign.families import clips, recipes, sessions
from hangtime.operators.files.outbox import Outbox
from hangtime.solver.data.faults import UnreadableClip
from hangtime.solver.optimisation import sqp

NEVER = 1e4  # s


def raw_traceback() -> None:
    """A damaged file ends a reader by what Python raises."""

    def read(path: Path) -> Any:
        try:
            return usual(path)
        except UnreadableClip as fault:
            raise KeyError("OFFSET") from fault

    usual, clips.read_bvh = clips.read_bvh, read


def pose_of_nan() -> None:
    """A value that is no number comes through a reader."""

    def recording(clip: Any) -> Any:
        made = usual(clip)
        made.heads[-1] = np.nan
        return made

    usual, clips._recording = clips._recording, recording


def lost_key() -> None:
    """A recipe that is written anew loses its pins."""
    recipes.write_recipe = lambda *_, **__: ""


def scratch_left() -> None:
    """A temporary file stays."""

    def parse(*arguments: Any) -> Any:
        tempfile.mkstemp()
        return usual(*arguments)

    usual, recipes.parse_recipe = recipes.parse_recipe, parse


def half_an_output() -> None:
    """What was not delivered stays in the output folder."""
    Outbox.__exit__ = lambda *_: None  # type: ignore[method-assign, assignment]


def key_changed() -> None:
    """An operator shifts the recording's keys."""

    def operator(case: Any, name: str) -> bool:
        for action in sessions.bpy.data.actions:
            for curve in all_curves(action):
                curve.keyframe_points[0].co[1] += 1.0
        return usual(case, name)

    usual, sessions.operator = sessions.operator, operator


def cost_of_nan() -> None:
    """Steps of a solve are no numbers."""

    def advance(self: Any, stage: str) -> Any:
        step = usual(self, stage)
        self.x = self.x * np.nan
        return step

    usual = sqp._ChordIterate.advance
    sqp._ChordIterate.advance = advance  # type: ignore[method-assign]


def silent_worker() -> None:
    """Whoever asked waits for ever."""
    worker_client.PendingRequest.wait = lambda *_: time.sleep(NEVER)  # type: ignore[assignment]


def busy_for_ever() -> None:
    """A reader that does not end, and keeps a core."""

    def read(_: Path) -> Any:
        while True:
            pass

    clips.read_bvh = read


FAULTS: dict[str, Callable[[], None]] = {
    plant.__name__: plant
    for plant in (
        *(raw_traceback, pose_of_nan, lost_key, scratch_left, half_an_output),
        *(key_changed, cost_of_nan, silent_worker, busy_for_ever),
    )
}


def main(argv: list[str]) -> int:
    FAULTS[argv[0]]()
    return child.main(argv[1:])
