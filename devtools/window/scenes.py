"""The way from a recording to a file: import, analyse, move the landing, adapt, export, save."""

from __future__ import annotations

from pathlib import Path

import bpy
from mathutils import Vector

from .acts import (
    ASIDE,
    CATEGORY,
    CLIP,
    LANDING,
    PACKAGE,
    ROW,
    SCALE,
    armature,
    choose_row,
    dialog,
    doing,
    fill_in,
    idle,
    landing,
    landing_field,
    open_panel,
    over_viewport,
    part,
    press,
    search,
    shown_action,
)
from .scenes_feel import drags_landing
from .stage import Acting, Scene, Stage, Until

SHIFT = 0.3  # m that the landing goes forward
SAVED = Path("/tmp/artist.blend")


def installed(_: Stage) -> Acting:
    assert PACKAGE in bpy.context.preferences.addons, "the extension is not enabled"
    assert not Path("/work").exists(), "the room sees the checkout"
    yield 0.1


def imports(stage: Stage) -> Acting:
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    yield from search(stage, "import motion capture")
    values = {"global_scale": SCALE, "update_scene_fps": True, "update_scene_duration": True}
    yield from dialog(stage, CLIP, **values)
    yield Until("the armature", lambda: CLIP.stem in bpy.data.objects)
    yield from over_viewport(stage, "KP_Decimal")
    yield stage.hands.wheel(stage.eyes.middle(), 6)  # until the whole jump is in view
    yield 0.3


def opens_sidebar(stage: Stage) -> Acting:
    yield from over_viewport(stage, "n")
    yield Until("the sidebar", lambda: stage.eyes.region("UI").width > 1)
    yield from stage.eyes.open_tab(CATEGORY)


def rests(stage: Stage) -> Acting:
    """Measures redraws of the whole window while nothing of ours goes on."""

    def label() -> str:
        for area in stage.eyes.window.screen.areas:
            area.tag_redraw()
        return "rest"

    stage.gauge.start(label)
    yield 2.0
    stage.gauge.stop()
    assert stage.gauge.stretches["rest"].gaps.count > 2, "the window is hardly redrawn"


def analyses(stage: Stage) -> Acting:
    yield from stage.eyes.find_button("hangtime.analyze")
    stage.gauge.start(lambda: "analyse")
    yield from press(stage, "hangtime.analyze")
    yield Until("an analysis", lambda: armature().hangtime.contacts and idle(), 60)
    yield 0.5
    stage.gauge.stop()
    phases = [row.phase for row in armature().hangtime.contacts]
    assert LANDING in phases, f"the landing was not found: {phases}"


def chooses_landing(stage: Stage) -> Acting:
    settings = armature().hangtime
    row = next(i for i, contact in enumerate(settings.contacts) if contact.phase == LANDING)
    yield from choose_row(stage, row)
    assert settings.active_contact == row, f"row {settings.active_contact} was chosen, not {row}"


def moves_landing(stage: Stage) -> Acting:
    yield from press(stage, "hangtime.put_back")
    yield from fill_in(stage, landing_field("forward"), str(SHIFT))
    assert abs(landing().forward - SHIFT) < 1e-4, f"the landing went {landing().forward:g} m"
    for row in armature().hangtime.contacts:
        went = (Vector(row.at) - Vector(row.found_at)).length
        wanted = SHIFT if row.phase == LANDING else 0.0
        assert abs(went - wanted) < 1e-3, f"{row.name} went {went:g} m, not {wanted:g} m"


def adapts(stage: Stage) -> Acting:
    """With another mass, so that the fit is made anew and all stages can be measured."""
    before = shown_action()
    yield from fill_in(stage, "hangtime.mass", "75")
    yield from stage.eyes.find_button("hangtime.adapt")
    stage.gauge.start(doing)
    yield from press(stage, "hangtime.adapt")
    yield Until("an adapted action", lambda: idle() and shown_action() != before, 90)
    yield 0.5
    stage.gauge.stop()
    recorded = shown_action().hangtime.recording
    assert recorded is not None, "the adapted action does not know its recording"
    yield from lands()


def lands() -> Acting:
    """The landing's bones are where they were put: a contact's bone goes along with it."""
    scene = bpy.context.scene
    row = next(row for row in armature().hangtime.contacts if row.phase == LANDING)
    frame = round((row.start_frame + row.end_frame) / 2)
    adapted = armature().animation_data.action
    scene.frame_set(frame)
    now = armature().matrix_world @ armature().pose.bones[row.bone].head
    armature().animation_data.action = adapted.hangtime.recording
    scene.frame_set(frame)
    then = armature().matrix_world @ armature().pose.bones[row.bone].head
    armature().animation_data.action = adapted
    scene.frame_set(frame)
    yield 0.2
    went = (now - then).length
    assert abs(went - SHIFT) < 0.03, f"{row.bone} went {went:.3f} m, not {SHIFT} m"


def undoes(stage: Stage) -> Acting:
    name = shown_action().name
    yield from over_viewport(stage, "ctrl+z")
    yield Until("what was before it", lambda: name not in bpy.data.actions)
    yield from over_viewport(stage, "ctrl+shift+z")
    yield Until("the adapted motion after redo", lambda: shown_action().name == name)
    assert len(shown_action().fcurves) > 50, "redo brought an empty action"


def pins_bone(stage: Stage) -> Acting:
    """Adds a pin to a bone that is selected with the mouse in pose mode, and takes it back."""
    settings = armature().hangtime
    yield from over_viewport(stage, "ctrl+Tab")
    yield Until("pose mode", lambda: armature().mode == "POSE")
    bone = armature().pose.bones["LeftForeArm"]
    middle = armature().matrix_world @ (bone.head + bone.tail) / 2
    yield stage.hands.click(stage.eyes.place_of(middle), bone.name)
    yield Until("a selected bone", lambda: bpy.context.active_object.data.bones.active)
    x, y = yield from stage.eyes.find_button("hangtime.remove_constraint", ASIDE)
    yield stage.hands.move((x, y - ROW))
    yield 0.3  # a menu opens only where Blender has seen the pointer rest
    yield stage.hands.click((x, y - ROW), "the menu of constraints")
    yield 0.4
    yield from stage.picture("menu_of_constraints")
    yield stage.hands.key("p")
    yield Until("a constraint", lambda: len(settings.constraints) == 1)
    row, active = settings.constraints[0], armature().data.bones.active
    found = row.kind, [each.name for each in row.bones]
    assert found == ("POINT", [active.name]), f"{found} was added for {active.name}"
    yield from stage.picture("pinned_bone")
    yield from over_viewport(stage, "ctrl+Tab")
    yield from press(stage, "hangtime.remove_constraint", ASIDE)
    yield Until("no constraint", lambda: not armature().hangtime.constraints)


def compares(stage: Stage) -> Acting:
    adapted = shown_action()
    recorded = adapted.hangtime.recording
    yield from press(stage, "hangtime.compare")
    yield Until("the recording", lambda: shown_action() == recorded)
    yield from press(stage, "hangtime.compare")
    yield Until("the adapted motion", lambda: shown_action() == adapted)


def accepts(stage: Stage) -> Acting:
    result = armature().hangtime.adapted
    yield from press(stage, "hangtime.accept")
    yield Until("an accepted result", lambda: result.hangtime.accepted)
    assert shown_action() == result, "the accepted action is not shown"


def exports_fbx(stage: Stage) -> Acting:
    yield from open_panel(stage, "ExportPanel")
    yield from export(
        stage, "hangtime.export_fbx", Path("/tmp/accepted.fbx"), b"Kaydara FBX Binary"
    )


def exports_gltf(stage: Stage) -> Acting:
    yield from export(stage, "hangtime.export_gltf", Path("/tmp/accepted.glb"), b"glTF")


def export(stage: Stage, command: str, path: Path, begins: bytes) -> Acting:
    yield from press(stage, command)
    yield from dialog(stage, path)
    yield Until("the file", path.is_file, 30)
    yield 1.0
    written = path.read_bytes()
    assert written.startswith(begins), f"{path.name} begins with {written[:20]!r}"
    assert len(written) > 100_000, f"{path.name} holds {len(written)} bytes"


def saves(stage: Stage) -> Acting:
    yield from over_viewport(stage, "ctrl+s")
    yield from dialog(stage, SAVED)
    yield Until("the file", lambda: SAVED.is_file() and not bpy.data.is_dirty)


def reloads(stage: Stage) -> Acting:
    kept = shown_action().name, landing().forward, len(armature().hangtime.contacts)
    armature().hangtime.stances[LANDING].forward = 0.1  # not saved: must not come back
    yield from search(stage, "revert")
    yield stage.hands.key("Return")
    yield Until("the file as saved", lambda: abs(landing().forward - kept[1]) < 1e-4)
    again = shown_action().name, landing().forward, len(armature().hangtime.contacts)
    assert again == kept, f"{kept} was saved, {again} came back"
    assert part("operators.solve.common").chosen_armature(bpy.context) == armature()


SCENES = (
    Scene("installed", installed),
    Scene("imports", imports, ("installed",)),
    Scene("opens_sidebar", opens_sidebar, ("imports",)),
    Scene("rests", rests, ("opens_sidebar",)),
    Scene("analyses", analyses, ("opens_sidebar",), 90),
    Scene("chooses_landing", chooses_landing, ("analyses",)),
    Scene("drags_landing", drags_landing, ("chooses_landing",), 120),
    Scene("moves_landing", moves_landing, ("chooses_landing",)),
    Scene("adapts", adapts, ("moves_landing",), 120),
    Scene("undoes", undoes, ("adapts",)),
    Scene("compares", compares, ("adapts",)),
    Scene("pins_bone", pins_bone, ("chooses_landing",)),
)
LAST = (
    Scene("accepts", accepts, ("adapts",)),
    Scene("exports_fbx", exports_fbx, ("accepts",)),
    Scene("exports_gltf", exports_gltf, ("exports_fbx",)),
    Scene("saves", saves, ("adapts",)),
    Scene("reloads", reloads, ("saves",)),
)
