"""Workflow from a recording to a file: import, analyse, move the landing, adapt, export, save."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import bpy
from mathutils import Vector

from ..driving.actions import (
    ASIDE,
    CATEGORY,
    CLIP,
    LANDING,
    PACKAGE,
    ROW,
    SCALE,
    active_bone,
    armature,
    choose_row,
    current_scene,
    curves_of,
    dialog,
    extension_module,
    fill_in,
    idle,
    landing,
    landing_field,
    open_panel,
    origin,
    over_viewport,
    pose_bone,
    press,
    search,
    settings,
    show_action,
    shown_action,
    solve_stage,
)
from ..driving.driver import Actions, Driver, Scenario, Until
from ..driving.manual_pictures import keep
from ..driving.screen import present
from .latency import drags_landing

SHIFT = 0.3  # m that the landing goes forward
SAVED = Path("/tmp/artist.blend")


def installed(_: Driver) -> Actions:
    assert PACKAGE in present(bpy.context.preferences).addons, "the extension is not enabled"
    assert not Path("/mnt/checkout/solver").exists(), "the sandbox sees more than devtools"
    yield 0.1


def imports(driver: Driver) -> Actions:
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    yield from search(driver, "import motion capture")
    values = {"global_scale": SCALE, "update_scene_fps": True, "update_scene_duration": True}
    yield from dialog(driver, CLIP, **values)
    yield Until("the armature", lambda: CLIP.stem in bpy.data.objects)
    yield from over_viewport(driver, "KP_Decimal")
    yield driver.input.wheel(driver.screen.middle(), 4)  # until the whole jump is in view
    yield 0.3


def opens_sidebar(driver: Driver) -> Actions:
    yield from over_viewport(driver, "n")
    yield Until("the sidebar", lambda: driver.screen.region("UI").width > 1)
    yield from driver.screen.open_tab(CATEGORY)


def rests(driver: Driver) -> Actions:
    """Measures redraws of the whole window while nothing of ours goes on."""

    def label() -> str:
        for area in driver.screen.window.screen.areas:
            area.tag_redraw()
        return "rest"

    driver.profiler.start(label)
    yield 2.0
    driver.profiler.stop()
    assert driver.profiler.profiles["rest"].gaps.count > 2, "the window is hardly redrawn"


def analyses(driver: Driver) -> Actions:
    yield from driver.screen.find_button("hangtime.analyze")
    driver.profiler.start(lambda: "analyse")
    yield from press(driver, "hangtime.analyze")
    yield Until("an analysis", lambda: settings().contacts and idle(), 60)
    yield 0.5
    driver.profiler.stop()
    phases = [row.phase for row in settings().contacts]
    assert LANDING in phases, f"the landing was not found: {phases}"
    yield from keep(driver, "analyzed")


def chooses_landing(driver: Driver) -> Actions:
    """The analysis has chosen its first contact; another one of it is chosen by hand."""
    own = settings()
    rows = [i for i, contact in enumerate(own.contacts) if contact.phase == LANDING]
    assert own.active_contact == rows[0], f"row {own.active_contact} is chosen, not {rows[0]}"
    yield from choose_row(driver, rows[1])
    assert own.active_contact == rows[1], f"row {own.active_contact} was chosen, not {rows[1]}"


def moves_landing(driver: Driver) -> Actions:
    yield from press(driver, "hangtime.put_back")
    yield from fill_in(driver, landing_field("forward"), str(SHIFT))
    assert abs(landing().forward - SHIFT) < 1e-4, f"the landing went {landing().forward:g} m"
    for row in settings().contacts:
        went = (Vector(row.at) - Vector(row.found_at)).length
        wanted = SHIFT if row.phase == LANDING else 0.0
        assert abs(went - wanted) < 1e-3, f"{row.name} went {went:g} m, not {wanted:g} m"


def adapts(driver: Driver) -> Actions:
    """With another mass, so that the fit is made anew and all stages can be measured."""
    before = shown_action()
    yield from fill_in(driver, "hangtime.mass", "75")
    yield from driver.screen.find_button("hangtime.adapt")
    driver.profiler.start(solve_stage)
    yield from press(driver, "hangtime.adapt")
    yield Until("an adapted action", lambda: idle() and shown_action() != before, 90)
    yield 0.5
    driver.profiler.stop()
    recorded = origin(shown_action()).recording
    assert recorded is not None, "the adapted action does not know its recording"
    yield from lands()


def lands() -> Actions:
    """The landing's bones are where they were put: a contact's bone goes along with it."""
    scene = current_scene()
    row = next(row for row in settings().contacts if row.phase == LANDING)
    frame = round((row.start_frame + row.end_frame) / 2)
    adapted = shown_action()
    scene.frame_set(frame)
    now = armature().matrix_world @ pose_bone(row.bone).head
    show_action(origin(adapted).recording)
    scene.frame_set(frame)
    then = armature().matrix_world @ pose_bone(row.bone).head
    show_action(adapted)
    scene.frame_set(frame)
    yield 0.2
    went = (now - then).length
    assert abs(went - SHIFT) < 0.03, f"{row.bone} went {went:.3f} m, not {SHIFT} m"


def undoes(driver: Driver) -> Actions:
    name = shown_action().name
    yield from over_viewport(driver, "ctrl+z")
    yield Until("what was before it", lambda: name not in bpy.data.actions)
    yield from over_viewport(driver, "ctrl+shift+z")
    yield Until("the adapted motion after redo", lambda: shown_action().name == name)
    assert len(curves_of(shown_action())) > 50, "redo brought an empty action"


def pins_bone(driver: Driver) -> Actions:
    """Adds a pin to a bone that is selected with the mouse in pose mode, and takes it back."""
    own = settings()
    yield from over_viewport(driver, "ctrl+Tab")
    yield Until("pose mode", lambda: armature().mode == "POSE")
    bone = pose_bone("LeftForeArm")
    middle = armature().matrix_world @ (bone.head + bone.tail) / 2
    yield driver.input.click(driver.screen.place_of(middle), bone.name)
    yield Until("a selected bone", active_bone)
    x, y = yield from driver.screen.find_button("hangtime.remove_constraint", ASIDE)
    yield driver.input.move((x, y - ROW))
    yield 0.3  # a menu opens only where Blender has seen the pointer rest
    yield driver.input.click((x, y - ROW), "the menu of constraints")
    yield 0.4
    yield from driver.picture("menu_of_constraints")
    yield driver.input.key("p")
    yield Until("a constraint", lambda: len(own.constraints) == 1)
    row, active = own.constraints[0], active_bone()
    found = row.kind, [each.name for each in row.bones]
    assert found == ("POINT", [active]), f"{found} was added for {active}"
    yield from driver.picture("pinned_bone")
    yield from over_viewport(driver, "ctrl+Tab")
    yield from press(driver, "hangtime.remove_constraint", ASIDE)
    yield Until("no constraint", lambda: not settings().constraints)


def compares(driver: Driver) -> Actions:
    adapted = shown_action()
    recorded = origin(adapted).recording
    for action, button in ((recorded, 0.2), (adapted, 0.5)):
        yield from press(driver, f'action="{action.name}", switch=True', button)
        yield Until(action.name, partial(shows, action))


def shows(action: bpy.types.Action) -> bool:
    return shown_action() == action


def accepts(driver: Driver) -> Actions:
    result = settings().adapted
    yield from press(driver, "hangtime.accept")
    yield Until("an accepted result", lambda: origin(result).accepted)
    assert shown_action() == result, "the accepted action is not shown"


def exports_fbx(driver: Driver) -> Actions:
    yield from open_panel(driver, "ExportPanel")
    path = Path("/tmp/accepted.fbx")
    yield from export(driver, path, b"Kaydara FBX Binary", "FBX")


def exports_gltf(driver: Driver) -> Actions:
    path = Path("/tmp/accepted.glb")
    yield from export(driver, path, b"glTF", "GLTF")


def export(driver: Driver, path: Path, begins: bytes, form: str) -> Actions:
    yield from press(driver, "hangtime.export", 0.25)  # the first of two in a row
    yield from dialog(driver, path, format=form)
    yield Until("the file", path.is_file, 30)
    yield 1.0
    written = path.read_bytes()
    assert written.startswith(begins), f"{path.name} begins with {written[:20]!r}"
    assert len(written) > 100_000, f"{path.name} holds {len(written)} bytes"


def saves(driver: Driver) -> Actions:
    yield from over_viewport(driver, "ctrl+s")
    yield from dialog(driver, SAVED)
    yield Until("the file", lambda: SAVED.is_file() and not bpy.data.is_dirty)


def reloads(driver: Driver) -> Actions:
    kept = shown_action().name, landing().forward, len(settings().contacts)
    settings().stances[LANDING].forward = 0.1  # not saved: must not come back
    yield from search(driver, "revert")
    yield driver.input.key("Return")
    yield Until("the file as saved", lambda: abs(landing().forward - kept[1]) < 1e-4)
    again = shown_action().name, landing().forward, len(settings().contacts)
    assert again == kept, f"{kept} was saved, {again} came back"
    assert extension_module("operators.solve.common").chosen_armature(bpy.context) == armature()


SCENARIOS = (
    Scenario("installed", installed),
    Scenario("imports", imports, ("installed",)),
    Scenario("opens_sidebar", opens_sidebar, ("imports",)),
    Scenario("rests", rests, ("opens_sidebar",)),
    Scenario("analyses", analyses, ("opens_sidebar",), 90),
    Scenario("chooses_landing", chooses_landing, ("analyses",)),
    Scenario("drags_landing", drags_landing, ("chooses_landing",), 120),
    Scenario("moves_landing", moves_landing, ("chooses_landing",)),
    Scenario("adapts", adapts, ("moves_landing",), 120),
    Scenario("undoes", undoes, ("adapts",)),
    Scenario("compares", compares, ("adapts",)),
    Scenario("pins_bone", pins_bone, ("chooses_landing",), 120),
)
LAST = (
    Scenario("accepts", accepts, ("adapts",)),
    Scenario("exports_fbx", exports_fbx, ("accepts",)),
    Scenario("exports_gltf", exports_gltf, ("exports_fbx",)),
    Scenario("saves", saves, ("adapts",)),
    Scenario("reloads", reloads, ("saves",)),
)
