"""Latency: updates of the ghost that follows a dragged pin, and cost of overlays per redraw."""

from __future__ import annotations

import math
import re
import time
from dataclasses import dataclass, field
from itertools import cycle, islice
from typing import TYPE_CHECKING

import bpy
from mathutils import Vector

from ..driving.actions import (
    ASIDE,
    LANDING,
    armature,
    current_scene,
    extension_module,
    idle,
    scene_settings,
    settings,
    shown_action,
    worker_seconds,
)
from ..driving.driver import Actions, Driver, Scenario, Until
from ..driving.input_device import Place
from ..driving.manual_pictures import keep
from ..driving.screen import present

if TYPE_CHECKING:  # as in actions.py
    from ....operators.solve.live import Live

DRAG = 4.0  # s that the pin is dragged about while the ghost's updates are counted
LEGS = 4
JERK = 8.0  # px, by which the mouse goes at once as it moves off: more than a click may tremble
MOVED = 0.1  # cm, by which the pin has moved in a ghost that counts
CRATE = (0.8, 0.8, 0.25)  # m
CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
ON_TOP = 0.03  # m, by which the ghost may be off while it follows
CONSTRAINTS = 20
REDRAWS = 2.0  # s of redraws that are measured
# What is drawn in the viewport. All else is of the sidebar, whose values are read after its panels.
OF_VIEWPORT = re.compile(r"^(Overlay|PlotOverlay|PinHandles|LimitHandles)\.")
BONES = ("LeftUpLeg", "RightUpLeg", "LeftArm", "RightArm", "LeftLeg")


def live() -> Live:
    """The extension's solves of the pin that is dragged."""
    found: Live = extension_module("operators.solve.live").live()
    return found


@dataclass
class GhostCounter:
    """Counts the ghosts of a live drag that came to be drawn: (time, version) of each new one."""

    seen: list[tuple[float, int]] = field(default_factory=list)

    def look(self) -> None:
        """Called at each redraw of a viewport."""
        drag = live()
        if drag.seen is None or drag.seen.summary.moved_cm < MOVED:
            return
        if not self.seen or self.seen[-1][1] != drag.version:
            self.seen.append((time.monotonic(), drag.version))

    def rate(self, since: float, until: float) -> float:
        """Per second."""
        return sum(since <= at <= until for at, _ in self.seen) / (until - since)


def drags_landing(driver: Driver) -> Actions:
    """Grips the chosen pin, moves it about while the ghost follows, lets go 0.2 m further."""
    own = settings()
    before = shown_action()
    row = own.contacts[own.active_contact]
    pin = Vector(row.at)
    start = driver.screen.place_of(pin)
    end = driver.screen.place_of(pin + 0.2 * Vector(own.stances[LANDING].forward_axis))
    ghosts = GhostCounter()
    space = bpy.types.SpaceView3D
    handler = space.draw_handler_add(ghosts.look, (), "WINDOW", "POST_PIXEL")
    try:
        yield driver.input.press(start, "the landing's pin")
        moved_off = time.monotonic()
        driver.input.move(towards(end, start, JERK), 0.0)
        yield driver.input.move(end, 0.5)
        assert (Vector(row.at) - pin).length > 0.01, "the pin does not follow the mouse"
        yield Until("the ghost", lambda: len(ghosts.seen) > 0, 40)
        driver.figures["first ghost after the mouse moves"] = 1000.0 * (
            ghosts.seen[0][0] - moved_off
        )
        begun, first, taken = time.monotonic(), live().version, worker_seconds()
        driver.profiler.start(lambda: "drag")
        for place in islice(cycle(about(end)), LEGS):
            yield driver.input.move(place, DRAG / LEGS)
        driver.profiler.stop()
        rate = ghosts.rate(begun, time.monotonic())
        updates = live().version - first
        made = updates / (time.monotonic() - begun)
        took = 1000.0 * (worker_seconds() - taken) / max(1, updates)
        yield from driver.picture("ghost_follows")
        yield driver.input.move(end, 0.5)
        yield 1.0
        yield from keep(driver, "drag")
        yield driver.input.let_go()
    finally:
        space.draw_handler_remove(handler, "WINDOW")
    driver.figures["ghost updates per second during a drag"] = rate
    driver.figures["ghost updates per second during a drag, drawn or not"] = made
    driver.figures["worker's processor time per update during a drag"] = took
    yield Until("an adapted action", lambda: idle() and shown_action() != before, 60)
    went = (Vector(row.at) - pin).length
    assert 0.1 < went < 0.3, f"the pin went {went:.3f} m, not about 0.2 m"


def lands_on_crate(driver: Driver) -> Actions:
    """Drags the landing's pin onto a crate; the ghost's foot lands on it. Esc puts it back."""
    own = settings()
    row = own.contacts[own.active_contact]
    pin = Vector(row.at)
    crate = add_crate(pin + 0.35 * Vector(own.stances[LANDING].forward_axis))
    yield from driver.screen.find_button("hangtime.select_surface", ASIDE)
    begun = live().version
    yield driver.input.press(driver.screen.place_of(pin), "the landing's pin")
    top = crate.matrix_world.translation + Vector((0.0, 0.0, CRATE[2]))
    yield driver.input.move(driver.screen.place_of(top), 1.0)
    assert row.on == crate, f"the pin is on {row.on}, not on the crate"

    def landed() -> bool:
        return live().version > begun and abs(ghost_height(row.point) - top.z) < ON_TOP

    yield Until("the ghost on the crate", landed, 60)
    yield from driver.picture("world_panel")
    yield from keep(driver, "world")
    yield driver.input.key("Escape")
    yield Until("the end of the drag", idle)
    yield driver.input.let_go()  # else the next click is none
    assert row.on is None, "the pin stayed on the crate"
    assert (Vector(row.at) - pin).length < 1e-4, "the pin did not go back"
    own.surfaces.clear()
    bpy.data.objects.remove(crate)


def add_crate(base: Vector) -> bpy.types.Object:
    """A crate on the floor at a place, as ground; m, as the scene's units are."""
    corners = [[(x - 0.5) * CRATE[0], (y - 0.5) * CRATE[1], z * CRATE[2]] for x, y, z in CORNERS]
    mesh = bpy.data.meshes.new("Crate")
    mesh.from_pydata(corners, [], FACES)
    crate = bpy.data.objects.new("Crate", mesh)
    crate.location = (base.x, base.y, 0.0)
    current_scene().collection.objects.link(crate)
    row = extension_module("operators.lists.surfaces").row_of(settings(), crate)
    row.object, row.name, row.role = crate, crate.name, "GROUND"
    present(bpy.context.view_layer).update()
    return crate


def ghost_height(point: str) -> float:
    """How high, m, a point of the ghost is at its last frame."""
    traces = present(live().seen).traces
    return float(traces.points[-1, traces.contacts.index(point), 2])


def towards(end: Place, start: Place, far: float) -> Place:
    """The place so far, pixels, from a start on the way to an end."""
    share = far / math.dist(start, end)
    return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])


def about(place: Place) -> list[Place]:
    """Places around one, some 60 pixels away."""
    x, y = place
    turns = [math.tau * i / LEGS for i in range(LEGS)]
    return [(x + 60 * math.cos(turn), y + 30 * math.sin(turn)) for turn in turns]


def overlays(driver: Driver) -> Actions:
    """Measures the cost of drawing with many constraints, in our code and as a whole."""
    own, view = settings(), scene_settings().view
    kinds = extension_module("bridge.constraint_kinds").KINDS
    drawn = [kinds[name] for name in ("POINT", "CONE", "ANGLE", "POSE", "TWIST")]
    add = extension_module("bridge.constraints.rows").add_constraint
    for i in range(CONSTRAINTS):
        add(armature(), drawn[i % len(drawn)], [BONES[i // len(drawn)]], 200.0)
    area = driver.screen.area()

    def redraw(label: str) -> str:
        area.tag_redraw()
        return label

    yield 1.0
    yield from driver.picture("overlays_of_constraints")
    driver.profiler.start(lambda: redraw("overlays"))
    yield REDRAWS
    view.show = False
    driver.profiler.start(lambda: redraw("no overlays"))
    yield REDRAWS
    driver.profiler.stop()
    view.show = True
    own.constraints.clear()
    calls = driver.profiler.profiles["overlays"].calls
    ours = {name: spans for name, spans in calls.items() if OF_VIEWPORT.search(name)}
    assert "Overlay.draw_view" in ours, f"no overlay was drawn: {list(calls)}"
    redraws = ours["Overlay.draw_view"].count
    assert redraws > 2, f"only {redraws} redraws were measured"
    name = "overlay per redraw with 20 constraints"
    driver.figures[name] = 1000 * sum(spans.busy_total for spans in ours.values()) / redraws
    by_clock = 1000 * sum(spans.total for spans in ours.values()) / redraws
    driver.figures[f"{name}, by the clock"] = by_clock


SCENARIOS = (
    Scenario("lands_on_crate", lands_on_crate, ("chooses_landing",), 120),
    Scenario("overlays", overlays, ("analyses",)),
)
