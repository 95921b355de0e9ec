"""Made saved_settings.blend: a file of an artist's who used every setting, and its reading.

Was run at commit 6d7c404 under Blender 4.2.23 (as a Python module), with the recording
cmu_bvh/forward_jump_116cm.bvh, and is kept to show what is in the file. Later code need not be
able to run it; it must be able to open what it made (tests/blender/test_saved_settings.py). From
the repository, with the Python of the environment that dev.py makes:

    python devtools/package.py tests.data.make_saved_settings RECORDING.bvh

writes saved_settings.blend and, as a new process reads that, saved_settings.json.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from math import radians
from pathlib import Path
from shutil import copyfile
from typing import Any

import bpy
import hangtime
from hangtime.tests.blender.helpers import rigs, stored

FOLDER = Path(__file__).parent
BLEND, READING = FOLDER / "saved_settings.blend", FOLDER / "saved_settings.json"
LAUNCHER = FOLDER.parents[1] / "devtools" / "package.py"
FIRST, LAST = 100, 300
RENAMED = "Unterarm links"  # no part of the body is found by this name
RECIPE = """# What the lists do not ask for.
[[angle]]
name = "Written knee"
bone = "RightLeg"
at_most = 130
phase = "ground 2"
"""
FLIGHT = {"span": "PHASE", "phase": "flight 1"}
LANDING = {"span": "PHASE", "phase": "ground 2"}
OFF = {"used": False}

Rows = list[tuple[str, tuple[str, ...], dict[str, Any]]]  # kind, bones, values

POINTS: Rows = [
    (
        "POINT",
        ("RightHand",),
        {"name": "Hand follows ball", "span": "FRAMES", "first_frame": 195, "last_frame": 205}
        | {"use_bounds": True, "at_least": (-0.3, -0.3, -0.3), "at_most": (0.3, 0.35, 0.4)},
    ),
    (
        "POINT",
        ("Head",),
        {"name": "Head at apex", **FLIGHT, "instant": "APEX", "axes": "TRAVEL"}
        | {"use_bounds": True, "bound_axes": (False, False, True)}
        | {"bound_below": (True, False, True), "bound_above": (False, True, True)}
        | {"at_least": (0.0, 0.0, 1.5), "at_most": (0.0, 0.0, 2.2)},
    ),
    (
        "POINT",
        ("LeftHand",),
        {"name": "Hand on wall", "span": "FRAME", "first_frame": 203, "axes": "SURFACE"}
        | {"use_place": True, "place": (0.4, 0.1, 1.6), "normal": (0.0, 0.6, 0.8)}
        | {"use_offset": True, "offset": (0.01, 0.02, 0.03), "environment": True, "grip": True}
        | OFF,
    ),
]
ANGLES: Rows = [
    (
        "ANGLE",
        ("LeftLeg",),
        {"name": "Left knee", **LANDING, "use_lower": False, "upper": radians(128)},
    ),
    (
        "ANGLE",
        ("RightForeArm",),
        {"name": "Right elbow", "span": "ALWAYS", "lower": radians(-5), "use_upper": False},
    ),
    (
        "ANGLE",
        (RENAMED,),
        {"name": "Left elbow", **LANDING, "instant": "START"}
        | {"lower": radians(-10), "upper": radians(150)},
    ),
    (
        "CONE",
        ("RightUpLeg",),
        {"name": "Right leg", "span": "ALWAYS", "half_angle": radians(100), "stretch": (1.2, 1.3)},
    ),
    (
        "CONE",
        ("LeftArm",),
        {"name": "Left arm", **FLIGHT, "instant": "MIDDLE", "half_angle": radians(60)}
        | {"use_axis": True, "axis": (0.6, 0.0, -0.8), **OFF},
    ),
    (
        "TWIST",
        ("Head",),
        {"name": "Head twist", "span": "FRAMES", "first_frame": 180.5, "last_frame": 220.25}
        | {"lower": radians(-50), "upper": radians(55)},
    ),
]
EFFORTS: Rows = [
    (
        "TORQUE",
        ("LeftFoot", "RightFoot"),
        {"name": "Ankles", "span": "ALWAYS", "torque_by": "SHARE", "share": 1.6},
    ),
    (
        "TORQUE",
        ("RightArm",),
        {"name": "Shoulder", **FLIGHT, "torque": 150.0, "torque_value": 4.0}
        | {"use_dof": True, "dof": 1},
    ),
    (
        "FORCE",
        ("LeftFoot", "LeftToeBase"),
        {"name": "Sandy", **LANDING, "use_peak": False, "use_friction": True, "friction": 0.95}
        | {"shape": "PYRAMID", "use_match": True, "match": 4.0},
    ),
    (
        "FORCE",
        (),
        {"name": "Cap", "span": "PHASE", "phase": "ground 1", "peak": 4.5},
    ),
    ("LIFT", ("LeftToeBase",), {"name": "Toe off", **LANDING, **OFF}),
]
POSES: Rows = [
    (
        "POSE",
        ("LeftUpLeg", "LeftLeg"),
        {"name": "Tuck", **FLIGHT, "instant": "APEX", "hard": False, "weight": 0.25}
        | {"use_pose_frame": True, "pose_frame": 200.0},
    ),
    (
        "POSE",
        ("RightArm", "RightForeArm"),
        {"name": "Arms at end", **FLIGHT, "instant": "END", "slack": radians(40)},
    ),
    (
        "POSE",
        (),
        {"name": "Stiff", "span": "PHASE", "phase": "Hang", "source": "REST", "slack": 0.1, **OFF},
    ),
    (
        "ORIENTATION",
        ("Hips",),
        {"name": "Heading", **FLIGHT, "instant": "MIDDLE", "slack": radians(30)}
        | {"turn": radians(8), "tilt": radians(-4)},
    ),
]
TIMES: Rows = [
    ("TIMING", (), {"name": "Longer flight", **FLIGHT, "factor": 1.06}),
    (
        "TIMING",
        (),
        {"name": "Short wait", **LANDING, "timing_by": "SECONDS", "seconds": 0.6, **OFF},
    ),
    (
        "HOLD",
        (),
        {"name": "Hang", "first_frame": 203, "seconds": 0.4, "ends": True, **OFF},
    ),
]
BODY: Rows = [
    (
        "LOAD",
        ("LeftHand",),
        {"name": "Bag", "by_share": True, "share": 0.02, "use_offset": True}
        | {"offset": (0.0, 0.05, 0.01)},
    ),
    (
        "LIMB",
        ("LeftLeg", "RightLeg"),
        {"name": "Long shanks", "length": 1.1, "mass_factor": 1.2, **OFF},
    ),
    ("LIMB", (RENAMED,), {"name": "Light arm", "mass_factor": 0.5, **OFF}),
]


def main(argv: list[str]) -> int:
    """--read: write the reading of the file that is there; else make the file and its reading."""
    hangtime.register()
    try:
        if argv == ["--read"]:
            bpy.ops.wm.open_mainfile(filepath=str(BLEND))
            READING.write_text(as_lines(stored.stored()), encoding="utf-8")
            return 0
        make(argv[0])
    finally:
        hangtime.unregister()
    command = [sys.executable, str(LAUNCHER), "tests.data.make_saved_settings", "--read"]
    return subprocess.run(command, check=True).returncode


def as_lines(groups: stored.Groups) -> str:
    """JSON, a line for each group."""
    lines = [f"{json.dumps(path)}: {json.dumps(values)}" for path, values in groups.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def make(recording: str) -> None:
    """The file, from an empty one."""
    armature = imported(recording)
    analysed(armature)
    edit_contacts(armature)
    accept_first_result()
    use_presets(armature)
    ask(armature)
    set_singles(armature)
    show_otherwise(armature)
    adapt(armature)
    mark_missed(armature)
    require_all_used()
    save()


# ---------------------------------------------------------------- the recording


def imported(recording: str) -> bpy.types.Object:
    """The recording as the manual imports it, without the frames that are not asked for."""
    rigs.reset()
    bpy.ops.import_anim.bvh(
        filepath=recording,
        global_scale=0.05644,
        update_scene_fps=True,
        update_scene_duration=True,
    )
    armature = bpy.context.object
    armature.name = armature.data.name = "Jumper"
    for curve in armature.animation_data.action.fcurves:
        for key in reversed(curve.keyframe_points):
            if not FIRST <= key.co.x <= LAST:
                curve.keyframe_points.remove(key, fast=True)
        curve.update()
    return armature


def analysed(armature: bpy.types.Object) -> None:
    """Contacts found, where one part's bone had to be chosen, for its name says nothing."""
    settings = armature.hangtime
    settings.mass, settings.mass_table = 62.5, "DE_LEVA"
    settings.use_height, settings.height = True, 1.82
    settings.use_range, settings.first_frame, settings.last_frame = True, FIRST, LAST
    add(armature, "constraints", "TWIST", ("LeftForeArm",), {"name": "Forearm twist", **OFF})
    armature.data.bones["LeftForeArm"].name = RENAMED  # the row finds it by its key
    bpy.ops.hangtime.find_bones()
    settings.parts["left forearm"].bone = RENAMED
    bpy.ops.hangtime.analyze()


def edit_contacts(armature: bpy.types.Object) -> None:
    """A landing moved and turned, a contact moved by itself by its empty, one retimed, one
    switched off, and one added in its stead."""
    settings = armature.hangtime
    stance = settings.stances["ground 2"]
    stance.forward, stance.left, stance.up, stance.turn = 0.2, 0.04, 0.06, radians(12)
    settings.contacts["Right toe 2"].start_frame = 233.5
    settings.contacts["Left heel 1"].end_frame = 130.0
    settings.contacts["Right heel 1"].used = False
    bpy.context.scene.frame_set(103)
    bpy.ops.hangtime.add_contact(point="Right heel")
    settings.contacts[-1].end_frame = 114.0
    settings.whole_stance = False
    settings.active_contact = settings.contacts.find("Left toe 2")
    bpy.ops.hangtime.place_by_empty()
    settings.contacts["Left toe 2"].empty.location.z += 0.004
    bpy.context.view_layer.update()
    bpy.context.view_layer.objects.active = armature


# ---------------------------------------------------------------- what is asked for


def use_presets(armature: bpy.types.Object) -> None:
    """All of them. Joint limits that the recording itself breaks are switched off."""
    settings = armature.hangtime
    bpy.ops.hangtime.preset_joint_limits()
    for row in settings.constraints:
        row.used = row.used and not row.status and row.kind == "ANGLE"
    bpy.ops.hangtime.preset_joint_strength()
    for row in list(settings.constraints)[-3:]:
        row.torque *= 2.5  # a performer who is stronger than most
        row.used = row.name == "Ankle Strength"  # one is enough to wait for
    bpy.ops.hangtime.preset_soft_landing()
    bpy.context.scene.frame_set(203)
    select(armature, "LeftHand")
    bpy.ops.hangtime.preset_limp_limb()
    select(armature, "RightHand")
    bpy.ops.hangtime.preset_carry_weight()
    settings.body_changes[-1].mass = 1.5
    bpy.ops.object.mode_set(mode="OBJECT")


def select(armature: bpy.types.Object, bone: str) -> None:
    """In pose mode, this alone."""
    bpy.ops.object.mode_set(mode="POSE")
    for each in armature.data.bones:
        each.select = each.name == bone
    armature.data.bones.active = armature.data.bones[bone]


def ask(armature: bpy.types.Object) -> None:
    """The rows of the tables above, and what they point to."""
    scene = bpy.context.scene
    for kind, bones, values in (*POINTS, *ANGLES, *EFFORTS, *POSES, *TIMES):
        add(armature, "constraints", kind, bones, values)
    for kind, bones, values in BODY:
        add(armature, "body_changes", kind, bones, values)
    scene.frame_set(200)
    armature.hangtime.constraints["Hand follows ball"].target = ball(armature)
    armature.hangtime.active_constraint = 5


def ball(armature: bpy.types.Object) -> bpy.types.Object:
    """An empty that moves, about where the right hand is at this frame."""
    made = bpy.data.objects.new("Ball", None)
    bpy.context.scene.collection.objects.link(made)
    made.location = armature.pose.bones["RightHand"].head
    made.keyframe_insert("location", frame=195)
    made.location.z += 0.05
    made.keyframe_insert("location", frame=205)
    return made


def add(
    armature: bpy.types.Object, to: str, kind: str, bones: tuple[str, ...], values: dict[str, Any]
) -> None:
    """A new row of a list, these values set."""
    operators: dict[str, Callable[..., object]] = {
        "constraints": bpy.ops.hangtime.add_constraint,
        "body_changes": bpy.ops.hangtime.add_body_change,
    }
    operators[to](kind=kind)
    row = getattr(armature.hangtime, to)[-1]
    row.bones.clear()
    for bone in bones:
        row.bones.add().name = bone
    for name, value in values.items():
        setattr(row, name, value)


def set_singles(armature: bpy.types.Object) -> None:
    """What there is one of."""
    settings = armature.hangtime
    settings.use_new_mass, settings.new_mass, settings.gravity = True, 66.5, 9.5
    settings.method, settings.objective, settings.stay_close = "IMPLICIT_TORQUES", "POWER", 2.5
    settings.requests = bpy.data.texts.new("Requests")
    settings.requests.from_string(RECIPE)


def show_otherwise(armature: bpy.types.Object) -> None:
    """Every switch of the display against its default."""
    view = bpy.context.scene.hangtime.view
    for prop in stored.own_properties(view):
        if prop.type == "BOOLEAN":
            setattr(view, prop.identifier, not prop.default)
    view.ghost_step, view.plot_bone = 12, "LeftLeg"
    bpy.context.scene.hangtime.armature = armature


# ---------------------------------------------------------------- results


def accept_first_result() -> None:
    """A result that is kept, with its report as a text, before anything but pins was asked for."""
    bpy.ops.hangtime.fit()
    bpy.ops.hangtime.adapt()
    bpy.ops.hangtime.accept()
    bpy.ops.hangtime.show_report()


def adapt(armature: bpy.types.Object) -> None:
    """The result that is shown, in which everything holds."""
    settings = armature.hangtime
    bpy.ops.hangtime.adapt()
    rows = (*settings.constraints, *settings.body_changes)
    missed = [row.name for row in rows if row.used and row.met != "MET"]
    assert not missed, missed


def mark_missed(armature: bpy.types.Object) -> None:
    """As a solve leaves a row that could not be held."""
    for rows in (armature.hangtime.constraints, armature.hangtime.body_changes):
        row = next(row for row in reversed(rows) if not row.used)
        row.met, row.status = "MISSED", "Missed by 12 mm at frame 213"


def save() -> None:
    """By way of a neutral folder, for Blender keeps the file's path in the file."""
    bpy.ops.outliner.orphans_purge(do_recursive=True)
    with tempfile.TemporaryDirectory() as scratch:
        path = Path(scratch) / BLEND.name
        bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True, copy=True)
        copyfile(path, BLEND)


# ---------------------------------------------------------------- is it all there?


def require_all_used() -> None:
    """Every property of every group must differ from its default somewhere in the file, and in
    lists' rows every item of an enumeration must occur."""
    changed: set[tuple[str, str]] = set()
    wanted: set[tuple[str, str]] = set()
    for path, owner in stored.owners():
        for where, group in stored.groups_of(path, owner.hangtime):
            in_list = where != path and where[-1].isdigit()
            for prop in stored.own_properties(group):
                note(group, prop, in_list, wanted, changed)
    seen = {kind for kind, _ in wanted}
    known = {each.__name__ for each in bpy.types.PropertyGroup.__subclasses__()}
    unseen = {name for name in known if name.startswith("Hangtime")} - seen
    missing = sorted(wanted - changed)
    assert not missing, missing
    assert not unseen, unseen


def note(
    group: bpy.types.PropertyGroup,
    prop: bpy.types.Property,
    in_list: bool,
    wanted: set[tuple[str, str]],
    changed: set[tuple[str, str]],
) -> None:
    """What one property of one group adds to what is wanted, and to what is there."""
    kind, value = type(group).__name__, getattr(group, prop.identifier)
    if prop.identifier == "name" and not in_list:
        return  # Blender's own, of every group; only rows of lists are called something
    wanted.add((kind, prop.identifier))
    if stored.is_group(prop) or differs(prop, value):
        changed.add((kind, prop.identifier))
    if prop.type == "ENUM" and in_list:
        wanted.update((kind, f"{prop.identifier} {item}") for item in prop.enum_items.keys())  # noqa: SIM118
        changed.add((kind, f"{prop.identifier} {value}"))


def differs(prop: bpy.types.Property, value: Any) -> bool:
    """Whether a value is not what it is before anyone sets it."""
    if prop.type in ("POINTER", "COLLECTION", "STRING"):
        return bool(value)
    if getattr(prop, "is_array", False):
        return tuple(value) != tuple(prop.default_array)
    return bool(value != prop.default)
