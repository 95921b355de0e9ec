"""Frames of the recording where they are in the action that is shown."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import bpy
import numpy as np

from ....solver.data.reports.jumps import TimeMap
from ...accessors import current_action
from ...hidden_texts import HiddenText, listed, number
from ..action import action_settings


def store_times(action: bpy.types.Action, times: TimeMap) -> None:
    """Keeps the time map of an adapted action with it."""
    action_settings(action).times = json.dumps([times.recorded_frame, times.adapted_frame])


def shown_frames(armature: bpy.types.Object) -> Callable[[float], float]:
    """The frame of the shown action for each of the recording's."""
    recorded, adapted = _corners(armature)
    return lambda frame: _mapped(frame, recorded, adapted)


def recorded_frame(armature: bpy.types.Object, frame: float) -> float:
    """The frame of the recording for one of the shown action."""
    recorded, adapted = _corners(armature)
    return _mapped(frame, adapted, recorded)


def _corners(armature: bpy.types.Object) -> tuple[list[float], list[float]]:
    """Recorded and adapted frames; the same where the shown action is none that was adapted."""
    action = current_action(armature)
    return TIMES.of(action_settings(action).times if action is not None else "")


def _read_times(content: Any) -> tuple[list[float], list[float]]:
    recorded, adapted = ([number(frame) for frame in listed(each)] for each in listed(content))
    if len(recorded) != len(adapted) or not recorded:
        raise ValueError(content)
    if any(after < before for each in (recorded, adapted) for before, after in pairwise(each)):
        raise ValueError(content)
    return recorded, adapted


TIMES = HiddenText("times", _read_times, ([0.0], [0.0]))


def _mapped(frame: float, before: list[float], after: list[float]) -> float:
    """Linear in between; outside of the corners as far from the nearest one."""
    outside = frame - min(max(frame, before[0]), before[-1])
    return float(np.interp(frame - outside, before, after)) + outside
