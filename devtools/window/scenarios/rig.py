"""A generated Rigify character with its feet in IK: analyse, drag, scrub, edit a key, switch the
strip off, export."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

from ..driving.actions import (
    CATEGORY,
    LANDING,
    RIG,
    armature,
    current_scene,
    curves_of,
    extension_module,
    idle,
    open_panel,
    over_viewport,
    pose_bone,
    press,
    select_alone,
    settings,
)
from ..driving.driver import Actions, Driver, Scenario, Until
from ..driving.screen import present, window_manager
from .workflow import export

FILE = Path("/tmp/artist.rigify.blend")
FOOT = "foot_ik.L"
AHEAD = 0.2  # m
STANDS = "Left toe"
SLIDES = 0.002  # m, a millimetre of the solution and one of the rig
LIFT = 0.1  # m, of a key in the graph editor
WRITING = 200.0  # s that controls may take on a busy machine
KEPT: dict[float, dict[str, Matrix]] = {}  # poses of the take as it was opened, by frame


def shown() -> bpy.types.Action:
    """The action whose keys the artist edits, in a strip or not."""
    found: bpy.types.Action = extension_module("bridge.accessors").current_action(armature())
    return found


def poses(frame: int) -> dict[str, Matrix]:
    """Each bone's matrix as Blender shows it at a frame."""
    current_scene().frame_set(frame)
    return {bone.name: bone.matrix.copy() for bone in present(armature().pose).bones}


def opens(driver: Driver) -> Actions:
    """By Python: opening a file is Blender's business. Its script, Rigify's own panel, may run, as
    who opens such a file lets it."""
    with bpy.context.temp_override(window=window_manager().windows[0]):
        bpy.ops.wm.open_mainfile(filepath=str(FILE), load_ui=False, use_scripts=True)
    yield Until("the rig", lambda: RIG in bpy.data.objects)
    driver.screen.forget()
    yield 2.0
    yield from driver.screen.open_tab(CATEGORY)
    yield from over_viewport(driver, "KP_Decimal")
    KEPT.update((frame, poses(frame)) for frame in (10, 30, 45))


def analyses(driver: Driver) -> Actions:
    yield from press(driver, "hangtime.analyze")
    yield Until("an analysis", lambda: settings().contacts and idle(), 90)
    own = settings()
    row = own.contacts[own.active_contact]
    assert row.phase == LANDING, f"{row.name} is chosen, not one of the landing"


def drags_landing(driver: Driver) -> Actions:
    """The ghost follows, and what is written are keys of the rig's controls."""
    own, before = settings(), shown()
    row = own.contacts[own.active_contact]
    pin = Vector(row.at)
    to = pin + AHEAD * Vector(own.stances[LANDING].forward_axis)
    live = extension_module("operators.solve.live").live
    yield driver.input.press(driver.screen.place_of(pin), "the landing's pin")
    yield driver.input.move(driver.screen.place_of(to), 0.5)
    yield Until("the ghost", lambda: live().seen is not None, 60)
    yield from driver.picture("rig_ghost")
    yield driver.input.let_go()
    yield Until("an adapted action", lambda: idle() and shown() != before, WRITING)
    went = (Vector(row.at) - pin).length
    assert 0.5 * AHEAD < went < 1.5 * AHEAD, f"the pin went {went:.3f} m, not about {AHEAD} m"
    landed = poses(45)[FOOT].translation - KEPT[45][FOOT].translation
    assert abs(landed.length - went) < 0.05, f"{FOOT} went {landed.length:.3f} m, not {went:.3f} m"
    yield 0.5


def scrubs(driver: Driver) -> Actions:
    """Click into the timeline, in the flight and twice in the landing, where the toes stand: their
    pinned point is at its place. The foot's control is at the ankle, which goes on over them."""
    own = settings()
    row = next(r for r in own.contacts if (r.point, r.phase) == (STANDS, LANDING))
    region = driver.screen.region(area="DOPESHEET_EDITOR")
    seen, toes = dict[int, Vector](), dict[int, Matrix]()
    for frame in (26, 42, 48):
        x, _ = region.view2d.view_to_region(frame, 0, clip=False)
        place = driver.screen.on_screen(region.x + x, region.y + region.height - 12)
        yield driver.input.press(place, "the timeline")
        yield driver.input.let_go()
        yield Until(f"frame {frame}", partial(at_frame, frame))
        seen[frame] = pose_bone(FOOT).matrix.translation.copy()
        toes[frame] = armature().matrix_world @ pose_bone(row.bone).matrix
    yield from driver.picture("rig_scrubbed")
    flown = (seen[26] - seen[48]).length
    assert flown > 0.1, f"{FOOT} is {flown:.3f} m from its landing in the flight"
    pin = Vector(row.at)
    slid = (toes[42] @ toes[48].inverted() @ pin - pin).xy.length
    assert slid < SLIDES, f"{STANDS} slides by {slid:.4f} m where it stands"


def at_frame(frame: int) -> bool:
    return abs(current_scene().frame_current - frame) <= 1


def edits_key(driver: Driver) -> Actions:
    """Move one key of the foot's control in the graph editor.

    By Python: choosing the bone, the editor and the curve is Blender's business.
    """
    bpy.ops.object.mode_set(mode="POSE")
    select_alone(FOOT)
    path = pose_bone(FOOT).path_from_id("location")
    curves = curves_of(shown())
    for curve in curves:
        curve.hide = (curve.data_path, curve.array_index) != (path, 2)
    curve = next(c for c in curves if not c.hide)
    key = curve.keyframe_points[len(curve.keyframe_points) // 2]
    was, others = key.co.copy(), [point.co.y for point in curve.keyframe_points if point != key]
    area = driver.screen.area()
    area.type = "GRAPH_EDITOR"
    yield 0.5
    middle = driver.screen.middle(area="GRAPH_EDITOR")
    yield driver.input.move(middle)
    yield driver.input.key("Home")
    yield 0.5
    yield driver.input.key("alt+a")
    region = driver.screen.region(area="GRAPH_EDITOR")
    x, y = region.view2d.view_to_region(was.x, was.y, clip=False)
    yield driver.input.click(driver.screen.on_screen(region.x + x, region.y + y), "a key")
    yield 0.2
    yield driver.input.key("g", "y")
    yield driver.input.type(str(LIFT))
    yield driver.input.key("Return")
    yield 0.5
    yield from driver.picture("rig_graph_editor")
    area.type = "VIEW_3D"
    yield 0.5
    moved = key.co.y - was.y
    now = [point.co.y for point in curve.keyframe_points if point != key]
    assert abs(moved - LIFT) < 1e-4, f"the key went by {moved:g}, not {LIFT}"
    assert now == others, "other keys went along"
    current_scene().frame_set(round(was.x))
    bpy.ops.object.mode_set(mode="OBJECT")


def strip_off(driver: Driver) -> Actions:
    """The result as a strip on top: muted, the take is there to the bit."""
    before = shown()
    settings().result.written_as = "STRIP"
    yield from driver.screen.open_tab(CATEGORY)
    yield from press(driver, "hangtime.adapt")
    yield Until("a result in a strip", lambda: idle() and shown() != before, WRITING)
    assert "Hand polish" in settings().status, "what was edited by hand was left behind in silence"
    data = present(armature().animation_data)
    track = data.nla_tracks[-1]
    apart = max(difference(frame) for frame in KEPT)
    assert apart > 0.1, f"the result is the take ({apart:g})"
    track.mute = True
    apart = max(difference(frame) for frame in KEPT)
    yield 0.5
    yield from driver.picture("rig_strip_off")
    assert apart == 0.0, f"with the strip off, bones are {apart:g} from the take's"
    track.mute = False
    yield 0.2


def difference(frame: float) -> float:
    """The largest of bones' matrices from the take's as it was opened."""
    now = poses(int(frame))
    return max(
        abs(now[name][i][j] - was[i][j])
        for name, was in KEPT[frame].items()
        for i in range(4)
        for j in range(4)
    )


def exports(driver: Driver) -> Actions:
    yield from press(driver, "hangtime.accept")
    yield 0.5
    yield from open_panel(driver, "ExportPanel")
    yield from export(driver, Path("/tmp/accepted.rig.fbx"), b"Kaydara FBX Binary", "FBX")


SCENARIOS = (
    Scenario("rig_opens", opens, ("opens_sidebar",)),
    Scenario("rig_analyses", analyses, ("rig_opens",), 120),
    Scenario("rig_drags_landing", drags_landing, ("rig_analyses",), 300),
    Scenario("rig_scrubs", scrubs, ("rig_drags_landing",)),
    Scenario("rig_edits_key", edits_key, ("rig_drags_landing",)),
    Scenario("rig_strip_off", strip_off, ("rig_edits_key",), 300),
    Scenario("rig_exports", exports, ("rig_strip_off",), 120),
)
