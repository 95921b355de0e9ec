"""Takes for game engines: a real jump in every format, read again by Blender's importers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.read import record
from hangtime.bridge.exports.engines import CONVENTIONS, ENDINGS, format_of
from hangtime.bridge.exports.export import export_takes
from hangtime.bridge.files.reimport import reimport
from hangtime.bridge.recipe.export import ExportOptions
from hangtime.bridge.rows.choices import Engine, FileFormat
from hangtime.devtools.rigs.actor import actor
from hangtime.devtools.rigs.build import build
from hangtime.devtools.rigs.files import Way, lost, ways
from hangtime.devtools.rigs.layout import layouts
from hangtime.solver.data.faults import SameUsdNames, SeveralTakes
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import animated_rig
from hangtime.tests.blender.helpers.fbx import fbx_file

FRAMES = np.arange(170.0, 200.0)  # around the take-off
MM, DEGREES = 0.1, 0.05
ENGINES = [engine for engine in Engine if engine is not Engine.NONE]


def jumping(key: str) -> bpy.types.Object:
    """A rig with the part of the jump, turned and moved to one side."""
    armature = build(next(each for each in layouts() if each.key == key), actor())
    armature.rotation_euler.z = 0.7
    action = armature.animation_data.action
    action.name = "Longer Jump"
    action.use_frame_range = True
    action.frame_start, action.frame_end = FRAMES[[0, -1]]
    return armature


@pytest.mark.slow
@pytest.mark.parametrize("way", list(ways()), ids=lambda way: way.name)
def test_a_jump_comes_back_from_every_file(way: Way, tmp_path: Path) -> None:
    armature, path = jumping("mixamo"), tmp_path / f"jump{ENDINGS[way.format]}"
    shown, action = record(armature, FRAMES), armature.animation_data.action
    export_takes(armature, [action], path, ExportOptions(way.engine, way.format))
    begins = 0.0 if way.engine is Engine.NONE else FRAMES[0]
    mm, degrees = lost(shown, reimport(path, FRAMES, begins=begins, native=way.native), way.format)
    assert mm < MM
    assert degrees < DEGREES


@pytest.mark.slow
@pytest.mark.parametrize(
    ("engine", "form"),
    [
        *((Engine.NONE, form) for form in FileFormat),
        (Engine.UNITY, FileFormat.FBX),
        (Engine.UNREAL, FileFormat.FBX),
        (Engine.UNREAL, FileFormat.USD),
    ],
)
def test_a_scene_in_centimetres_gives_the_same_file(
    engine: Engine, form: FileFormat, tmp_path: Path
) -> None:
    armature, path = jumping("cmu"), tmp_path / f"jump{ENDINGS[form]}"
    shown = record(armature, FRAMES)
    bpy.context.scene.unit_settings.scale_length = 0.01
    armature.scale *= 100.0
    export_takes(armature, [armature.animation_data.action], path, ExportOptions(engine, form))
    begins = 0.0 if engine is Engine.NONE else FRAMES[0]
    bpy.context.scene.unit_settings.scale_length = 1.0
    mm, _ = lost(shown, reimport(path, FRAMES, begins=begins), form)
    assert mm < MM


@pytest.mark.parametrize("engine", [Engine.UNREAL, Engine.UNITY])
def test_an_engine_finds_no_transformation_on_the_armature(engine: Engine, tmp_path: Path) -> None:
    armature = jumping("mixamo")
    armature.location = (3.0, -1.0, 0.0)
    other = rigs.make_armature(name="Armature")
    path = tmp_path / "jump.fbx"
    export_takes(armature, [armature.animation_data.action], path, ExportOptions(engine))
    found = fbx_file(path)
    name = "Armature" if engine is Engine.UNREAL else armature.name
    assert found.transformations[name] == pytest.approx((0, 0, 0, 0, 0, 0, 1, 1, 1), abs=1e-4)
    assert found.takes == ("Longer Jump",)
    # 1 is a centimetre to an FBX, and Unreal reads what the numbers say.
    assert found.unit == (1.0 if engine is Engine.UNREAL else 100.0)
    assert found.up == (2 if engine is Engine.UNREAL else 1)
    thigh = armature.data.bones["mixamorig:LeftUpLeg"]
    length = armature.scale.x * (thigh.head_local - thigh.children[0].head_local).length  # m
    knee = found.transformations[thigh.children[0].name]
    assert np.linalg.norm(knee[:3]) == pytest.approx(length * 100.0 / found.unit, rel=1e-4)
    assert knee[6:] == pytest.approx((1.0, 1.0, 1.0), abs=1e-4)
    assert other.name == "Armature"
    assert armature.name == "Mixamo"


@pytest.mark.slow
@pytest.mark.parametrize("form", [FileFormat.FBX, FileFormat.GLTF])
def test_several_takes_go_into_one_file_by_their_names(form: FileFormat, tmp_path: Path) -> None:
    armature, path = jumping("cmu"), tmp_path / f"jumps{ENDINGS[form]}"
    first = armature.animation_data.action
    second = first.copy()
    second.name = "Short Hop"
    second.frame_start += 10.0
    blocks = {kind: set(getattr(bpy.data, kind)) for kind in ("objects", "actions", "armatures")}
    export_takes(armature, [first, second], path, ExportOptions(Engine.UNITY, form))
    assert blocks == {kind: set(getattr(bpy.data, kind)) for kind in blocks}
    assert armature.animation_data.action == first
    assert not armature.animation_data.nla_tracks
    shown = record(armature, FRAMES[10:])
    for take, begins in ((first, 170.0), (second, 180.0)):
        again = reimport(path, shown.frames, take=take.name, begins=begins)
        mm, degrees = lost(shown, again, form)
        assert mm < MM
        assert degrees < DEGREES


def test_a_usd_holds_one_take(tmp_path: Path) -> None:
    armature = jumping("cmu")
    action = armature.animation_data.action
    with pytest.raises(SeveralTakes):
        export_takes(
            armature,
            [action, action.copy()],
            tmp_path / "jumps.usda",
            ExportOptions(format=FileFormat.USD),
        )


def test_bones_that_a_usd_could_not_tell_apart_are_refused(tmp_path: Path) -> None:
    armature = animated_rig()
    armature.data.bones["head"].name = "foot?"
    armature.data.bones["foot"].name = "foot!"
    action = armature.animation_data.action
    objects = set(bpy.data.objects)
    with pytest.raises(SameUsdNames):
        export_takes(
            armature, [action], tmp_path / "rig.usda", ExportOptions(format=FileFormat.USD)
        )
    assert set(bpy.data.objects) == objects


def test_readers_of_usd_find_the_skeleton_under_a_root_of_its_own(tmp_path: Path) -> None:
    armature = jumping("cmu")
    path = tmp_path / "jump.usda"
    export_takes(
        armature, [armature.animation_data.action], path, ExportOptions(format=FileFormat.USD)
    )
    kinds = [line.split()[1] for line in path.read_text().splitlines() if "def " in line]
    assert kinds == ["Xform", "SkelRoot", "Skeleton", "SkelAnimation"]


@pytest.mark.parametrize("name", ["Longer Jump", "Longer Jump " + "x" * 51])
def test_godot_gets_gltf_and_repeats_what_is_a_cycle(name: str, tmp_path: Path) -> None:
    armature, path = jumping("cmu"), tmp_path / "run.glb"
    action = armature.animation_data.action
    action.name, action.use_cyclic = name, True
    options = ExportOptions(Engine.GODOT)
    assert format_of(options) is CONVENTIONS[Engine.GODOT].format is FileFormat.GLTF
    export_takes(armature, [action], path, options)
    assert f'"name":"{name[:58]}-loop"'.encode() in path.read_bytes()


@pytest.mark.parametrize("engine", ENGINES)
def test_bones_that_deform_go_to_an_engine_and_hang_on_each_other(
    engine: Engine, tmp_path: Path
) -> None:
    """As Rigify's do, whose deform bones hang on bones that do not deform."""
    prefixed = [
        rigs.BoneSpec("root", None, (0.0, 0.0, 0.0), (0.0, 0.3, 0.0)),
        *(_prefixed(spec, "ORG-", "ORG-") for spec in rigs.BODY),
        *(_prefixed(spec, "DEF-", "ORG-") for spec in rigs.BODY),
    ]
    armature = rigs.make_armature(prefixed)
    for bone in armature.data.bones:
        bone.use_deform = bone.name.startswith("DEF-")
    for spec in rigs.BODY:
        follows = armature.pose.bones[f"DEF-{spec.name}"].constraints.new("COPY_TRANSFORMS")
        follows.target, follows.subtarget = armature, f"ORG-{spec.name}"
    hips = armature.pose.bones["ORG-hips"]
    hips.rotation_mode = "XYZ"
    for frame, turn in ((1, 0.0), (10, 1.0)):
        hips.rotation_euler.z = turn
        hips.keyframe_insert("rotation_euler", frame=frame)
    shown, path = record(armature, np.arange(1.0, 11.0)), tmp_path / "rig.fbx"
    action = armature.animation_data.action
    export_takes(armature, [action], path, ExportOptions(engine, FileFormat.FBX), pelvis="DEF-hips")
    again = reimport(path, shown.frames, begins=1.0)
    names = [bone.name for bone in again.bones]
    above = {bone.name: names[bone.parent] for bone in again.bones if bone.parent >= 0}
    assert above == {
        f"DEF-{spec.name}": f"DEF-{spec.parent}" if spec.parent else "root" for spec in rigs.BODY
    }
    columns = [shown.index(name) for name in names]
    np.testing.assert_allclose(again.heads, shown.heads[:, columns], atol=1e-4)


def _prefixed(spec: rigs.BoneSpec, own: str, above: str) -> rigs.BoneSpec:
    parent = f"{above}{spec.parent}" if spec.parent else "root"
    return rigs.BoneSpec(f"{own}{spec.name}", parent, spec.head, spec.tail, spec.roll)
