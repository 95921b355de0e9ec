"""A damaged clip: examined, looked at, repaired with one click, analysed and adapted."""

from __future__ import annotations

import bpy
from mathutils import Vector

from ..driving.actions import (
    LANDING,
    armature,
    current_scene,
    curves_of,
    fill_in,
    idle,
    landing_field,
    press,
    settings,
    shown_action,
)
from ..driving.driver import Actions, Driver, Scenario, Until
from ..driving.manual_pictures import frame_of, keep
from ..driving.screen import present
from .workflow import imports

SPIKED, BONE, TURN = 150, "LeftArm", 0.8  # a frame, whose key of this bone is turned, rad
RAISED = 0.2  # m above the floor
RATE = 150  # frames a second, 1.25 times too many
FAULTS = {"spike", "time scale", "floor"}


def imports_damaged(driver: Driver) -> Actions:
    """Imported again, so that nothing is known of it, and damaged by Python."""
    yield from imports(driver)
    for curve in curves_of(shown_action()):
        if f'"{BONE}"].rotation' in curve.data_path and curve.array_index == 2:
            next(key for key in curve.keyframe_points if key.co[0] == SPIKED).co[1] += TURN
    armature().location.z = RAISED
    present(current_scene().render).fps = RATE
    current_scene().frame_set(SPIKED - 20)
    yield 0.5


def examines(driver: Driver) -> Actions:
    yield from driver.screen.find_button("hangtime.examine")
    driver.profiler.start(lambda: "examine")
    yield from press(driver, "hangtime.examine")
    yield Until("findings", lambda: settings().findings and idle(), 60)
    yield 0.5
    driver.profiler.stop()
    found = {row.name for row in settings().findings}
    assert found == FAULTS, f"{found} was found, not {FAULTS}"
    assert not settings().contacts, "the recording was analysed"
    yield from keep(driver, "examined")


def shows_finding(driver: Driver) -> Actions:
    driver.screen.forget()
    yield from press(driver, 'hangtime.show_finding(kind="spike")')
    yield Until("the frame", lambda: current_scene().frame_current == SPIKED)
    data = armature().data
    assert isinstance(data, bpy.types.Armature)
    assert present(data.bones.active).name == BONE, "another bone is active"
    yield from doubts_in_timeline(driver)


def doubts_in_timeline(driver: Driver) -> Actions:
    """A picture of the workspace whose dope sheet is high."""
    window = driver.screen.window
    usual = window.workspace
    window.workspace = bpy.data.workspaces["Animation"]
    yield 1.0
    current_scene().frame_set(SPIKED + 20)  # else the playhead hides what is wrong there
    yield 0.5
    yield from driver.picture("doubts_in_timeline")
    yield from keep(driver, "doubts", frame_of(driver, driver.screen.area("DOPESHEET_EDITOR")))
    window.workspace = usual
    yield 1.0
    driver.screen.forget()


def keys_now() -> list[float]:
    """The tenth key of each of the shown action's curves."""
    return [curve.keyframe_points[9].co.y for curve in curves_of(shown_action())]


def repairs_all(driver: Driver) -> Actions:
    action, keys = shown_action(), keys_now()
    yield from press(driver, "hangtime.repair_all")
    yield Until("repairs", lambda: bool(settings().repairs))
    assert shown_action() == action, "another action is shown"
    assert keys == keys_now(), "keys changed"
    rate = current_scene().render.fps / current_scene().render.fps_base
    assert abs(rate - RATE / 1.25) < 0.1, f"the scene has {rate:g} frames a second"
    height = armature().matrix_world.translation.z
    assert abs(height) < 0.03, f"the armature is {height:.2f} m up"
    yield 0.5
    yield from keep(driver, "repaired")


def adapts_repaired(driver: Driver) -> Actions:
    before = shown_action()
    yield from press(driver, "hangtime.analyze")
    yield Until("an analysis", lambda: settings().contacts and idle(), 60)
    yield from fill_in(driver, landing_field("forward"), "0.2")
    yield from press(driver, "hangtime.adapt")
    yield Until("an adapted action", lambda: idle() and shown_action() != before, 90)
    yield 0.5
    rows = [row for row in settings().contacts if row.phase == LANDING]
    went = (Vector(rows[0].at) - Vector(rows[0].found_at)).length
    assert abs(went - 0.2) < 1e-3, f"the landing went {went:g} m"


SCENARIOS = (
    Scenario("imports_damaged", imports_damaged, ("opens_sidebar",)),
    Scenario("examines", examines, ("imports_damaged",), 90),
    Scenario("shows_finding", shows_finding, ("examines",)),
    Scenario("repairs_all", repairs_all, ("examines",)),
    Scenario("adapts_repaired", adapts_repaired, ("repairs_all",), 150),
)
