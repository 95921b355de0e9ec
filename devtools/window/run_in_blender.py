"""Entry point within the Blender that has the window: runs the chosen scenarios, then quits.

The extension was installed there from its zip. Each scenario acts as a person would and then says
what must be true.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

import bpy

from .driving.actions import FOLDER
from .driving.driver import Driver, Scenario, drive_by_timer, run_scenarios
from .driving.input_device import InputDevice
from .driving.profiler import Profiler
from .driving.screen import Screen, present
from .scenarios import latency, manual, recording, rig, robustness, workflow

OUT = Path("/mnt/out")
SCENARIOS = (
    *workflow.SCENARIOS,
    *manual.SCENARIOS,
    *latency.SCENARIOS,
    *robustness.SCENARIOS,
    *workflow.LAST,
    *recording.SCENARIOS,
    *robustness.LAST,
    *rig.SCENARIOS,
    *robustness.QUITS,
)


def start() -> None:
    """Begin once Blender's window is there; Blender is quit at its end."""
    preferences = present(bpy.context.preferences)
    preferences.view.show_splash = False
    preferences.system.viewport_aa = "OFF"  # drawn once; the others draw again and again
    preferences.view.filebrowser_display_type = "SCREEN"  # the dialog in the window that is there
    ending = ExitStack()
    device = InputDevice()
    ending.callback(device.close)
    driver = Driver(OUT, device, Screen(device), Profiler(FOLDER))
    ending.callback(bpy.ops.wm.quit_blender)
    ending.callback(driver.keep)
    names, without = os.environ.get("SCENARIOS", "").split(), os.environ.get("WITHOUT", "")
    wanted = chosen(names, without)
    drive_by_timer(run_scenarios(driver, wanted), ending.close)


def chosen(names: Sequence[str], without: str) -> list[Scenario]:
    """The scenarios of those names and whatever they need, in order; where no name is given all
    but those that only take pictures for the manual, and those whose names begin with `without`."""
    usual = {scenario.name for scenario in SCENARIOS if scenario not in manual.SCENARIOS}
    left_out = {name for name in usual if without and name.startswith(without)}
    wanted = set(names) or usual - left_out
    for scenario in reversed(SCENARIOS):
        if scenario.name in wanted:
            wanted.update(scenario.needs)
    return [scenario for scenario in SCENARIOS if scenario.name in wanted]
