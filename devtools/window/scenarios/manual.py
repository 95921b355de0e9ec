"""Pictures of the manual that no other scenario passes by; dev.py window --manual plays them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ..driving.actions import (
    LANDING,
    VALUE,
    armature,
    current_scene,
    extension_module,
    idle,
    over_viewport,
    press,
    scene_settings,
    settings,
    shown_action,
    solving,
)
from ..driving.driver import Actions, Driver, Scenario, Until
from ..driving.manual_pictures import Frame, frame_of, keep
from ..driving.screen import window_manager

if TYPE_CHECKING:  # as in actions.py
    from ....bridge.properties.constraint import HangtimeConstraint

IN_FLIGHT, LANDED = 205, 240  # frames of the recording
REACH = 0.05  # m that a hand goes up
UNREACHABLE = 1.0  # m that the hips go up
HIGH = 150  # px of a timeline that shows all rows
PLOTS = 160  # px at the viewport's foot
REPORT = (860, 640)  # px of its window that are shown


def shows_result(driver: Driver) -> Actions:
    """After a drag: the panels Solve and Result."""
    current_scene().frame_set(LANDED)
    driver.screen.forget()
    yield from driver.screen.find_button("hangtime.accept")
    yield from rests_aside(driver)
    yield from keep(driver, "result")


def rests_aside(driver: Driver) -> Actions:
    """The pointer is where it lights up nothing, and tooltips go."""
    yield driver.input.move(driver.screen.free_place())
    yield 0.8


def opens_report(driver: Driver) -> Actions:
    yield from press(driver, "hangtime.show_report", 0.8)
    yield Until("the report's window", lambda: len(window_manager().windows) == 2)
    yield 1.5
    window = window_manager().windows[-1]
    area = window.screen.areas[0]
    text = next(region for region in area.regions if region.type == "WINDOW")
    top = window.y + window.height - text.y - text.height
    wide, high = min(text.width, REPORT[0]), min(text.height, REPORT[1])
    yield from keep(driver, "report", Frame(window.x + text.x, top, wide, high))
    with bpy.context.temp_override(window=window):
        bpy.ops.wm.window_close()
    yield Until("the end of the report's window", lambda: len(window_manager().windows) == 1)
    yield 0.5


def shows_plots(driver: Driver) -> Actions:
    """Across the whole viewport: its sidebar is closed meanwhile."""
    view = scene_settings().view
    view.plots, view.plot_bone = True, "LeftLeg"
    current_scene().frame_set(IN_FLIGHT)
    yield from over_viewport(driver, "n")
    yield 1.0
    whole = frame_of(driver, driver.screen.region())
    foot = Frame(whole.left, whole.top + whole.height - PLOTS, whole.width, PLOTS)
    yield from keep(driver, "plots", foot)
    view.plots = False
    yield from over_viewport(driver, "n")
    yield 0.5


def holds_constraints(driver: Driver) -> Actions:
    """A point, a joint limit and a cone in the flight, asked for by Python and adapted."""
    stance = settings().stances[LANDING]
    stance.forward = stance.left = stance.up = 0.0
    current_scene().frame_set(IN_FLIGHT)
    add("POINT", "LeftHand").place[2] += REACH
    add("ANGLE", "LeftLeg")
    add("CONE", "RightUpLeg")
    yield from adapts_anew(driver)
    driver.screen.forget()
    yield from driver.screen.find_button("half_angle", VALUE)
    yield from rests_aside(driver)
    yield from keep(driver, "constraints")
    settings().constraints.clear()


def tells_failure(driver: Driver) -> Actions:
    """What no body can do, by Python; the best that was found is not taken."""
    current_scene().frame_set(IN_FLIGHT)
    add("POINT", "Hips").place[2] += UNREACHABLE
    failed = extension_module("operators.solve.session").session
    yield from press(driver, "hangtime.adapt")
    yield Until("a failure", lambda: idle() and failed().failure is not None, 200)
    driver.screen.forget()
    yield from driver.screen.find_button("hangtime.use_best")
    yield from rests_aside(driver)
    yield from keep(driver, "failure")
    settings().constraints.clear()


def add(kind: str, bone: str) -> HangtimeConstraint:
    """A constraint about a bone, at the frame that is shown."""
    kinds = extension_module("bridge.constraint_kinds").KINDS
    row: HangtimeConstraint = extension_module("bridge.constraints.rows").add_constraint(
        armature(), kinds[kind], [bone], float(current_scene().frame_current)
    )
    return row


def adapts_anew(driver: Driver) -> Actions:
    before = shown_action()
    yield from press(driver, "hangtime.adapt")
    yield Until("work", lambda: solving() is not None)
    yield Until("an adapted action", lambda: idle() and shown_action() != before, 150)
    yield 0.5


def heightens_timeline(driver: Driver) -> Actions:
    """The edge between viewport and timeline is pulled up, and put back."""
    area = driver.screen.area("DOPESHEET_EDITOR")
    edge, middle = area.y + area.height, area.x + area.width / 2
    low, high = (driver.screen.on_screen(middle, y) for y in (edge, edge + HIGH - area.height))
    yield driver.input.press(low, "the timeline's edge")
    yield driver.input.move(high, 0.5)
    yield driver.input.let_go()
    yield from over_timeline(driver)
    yield from keep(driver, "timeline", frame_of(driver, driver.screen.area("DOPESHEET_EDITOR")))
    yield driver.input.press(high, "the timeline's edge")
    yield driver.input.move(low, 0.5)
    yield driver.input.let_go()
    yield 0.5


def over_timeline(driver: Driver) -> Actions:
    """All of the clip is in sight in the timeline."""
    yield driver.input.move(driver.screen.middle(area="DOPESHEET_EDITOR"))
    yield driver.input.key("Home")
    yield from rests_aside(driver)


SCENARIOS = (
    Scenario("shows_result", shows_result, ("drags_landing",)),
    Scenario("opens_report", opens_report, ("drags_landing",)),
    Scenario("shows_plots", shows_plots, ("drags_landing",)),
    Scenario("heightens_timeline", heightens_timeline, ("analyses",)),
    Scenario("holds_constraints", holds_constraints, ("analyses",), 200),
    Scenario("tells_failure", tells_failure, ("analyses",), 250),
)
