"""An FBX of several takes and armatures: what is read is told, and can be chosen."""

from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")

from hangtime.bridge.files.import_clip import ImportedClip, import_clip
from hangtime.operators.headless.cli import main
from hangtime.operators.words.doubt_text import file_doubts
from hangtime.solver.data.faults import NoAction, NotInFile
from hangtime.solver.data.reports.recording import Origin
from hangtime.tests.helpers.clips import mocap_path

HEIGHTS = {"a_idle": (1.0, 1.0), "jump": (1.0, 1.5), "walk": (1.0, 1.2)}  # of the hips, m
LAST = 20
WHOLE_SCENE = {"bake_anim_use_all_actions": False, "bake_anim_use_nla_strips": False}


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 0, LAST


def figure(name: str, takes: tuple[str, ...], bones: int = 2, turned_in: str = "") -> None:
    """An armature of bones in a row, the first of which rises in each take as HEIGHTS tells; the
    second turns in one alone."""
    bpy.ops.object.armature_add()
    armature = bpy.context.object
    armature.name = name
    bpy.ops.object.mode_set(mode="EDIT")
    made = armature.data.edit_bones
    for i in range(1, bones):
        bone = made.new(f"Bone {i}")
        bone.head, bone.tail, bone.parent = (0, 0, i), (0, 0, i + 1), made[i - 1]
    bpy.ops.object.mode_set(mode="OBJECT")
    hips, second = armature.pose.bones[:2]
    second.rotation_mode = "XYZ"
    armature.animation_data_create()
    for take in takes:
        armature.animation_data.action = bpy.data.actions.new(take)
        armature.animation_data.action.use_fake_user = True
        for frame, height in zip((0, LAST), HEIGHTS[take], strict=True):
            hips.location.y = height
            hips.keyframe_insert("location", frame=frame)
            if take == turned_in:
                second.rotation_euler.x = 0.5 + 0.01 * frame
                second.keyframe_insert("rotation_euler", frame=frame)
    second.rotation_euler.x = 0.0


def crate() -> None:
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.object.name = "Crate"
    for frame, place in ((0, 0.0), (LAST, 3.0)):
        bpy.context.object.location.x = place
        bpy.context.object.keyframe_insert("location", frame=frame)
    bpy.context.object.animation_data.action.name = "AAA crate"  # the file's first take


def exported(path: Path, **options: object) -> Path:
    bpy.ops.export_scene.fbx(filepath=str(path), add_leaf_bones=False, **options)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return path


def risen(made: ImportedClip) -> float:
    """How far the hips rise in what is read, m."""
    heights = []
    for frame in (bpy.context.scene.frame_start, bpy.context.scene.frame_end):
        bpy.context.scene.frame_set(frame)
        heights.append((made.armature.matrix_world @ made.armature.pose.bones[0].head).z)
    return heights[1] - heights[0]


def told(made: ImportedClip) -> list[str]:
    return file_doubts(Origin("takes.fbx", chosen=made.chosen))


def test_of_several_takes_the_one_that_moves_is_read_and_the_others_are_named(
    tmp_path: Path,
) -> None:
    figure("Hero", ("a_idle", "jump"))
    path = exported(tmp_path / "takes.fbx")
    made = import_clip(path, unit=1.0)
    assert risen(made) == pytest.approx(0.5, abs=1e-3)
    (line,) = told(made)
    assert "2 takes of “Hero”: “jump” is read, and not “a_idle” (else say --take)" in line


def test_another_take_is_read_where_its_name_is_given(tmp_path: Path) -> None:
    figure("Hero", ("jump", "walk"))
    path = exported(tmp_path / "takes.fbx")
    for name in ("walk", "WALK", "Hero|walk", "Hero|Hero|walk"):
        made = import_clip(path, unit=1.0, take=name)
        assert risen(made) == pytest.approx(0.2, abs=1e-3)
        assert told(made) == []
        bpy.ops.wm.read_factory_settings(use_empty=True)
    with pytest.raises(NotInFile) as fault:
        import_clip(path, take="run")
    assert (fault.value.what, fault.value.known) == ("take", ("jump", "walk"))
    assert len(bpy.data.objects) == len(bpy.data.actions) == 0


@pytest.mark.parametrize("start_and_end", [True, False])
def test_a_take_of_a_crate_alone_is_no_armatures(tmp_path: Path, start_and_end: bool) -> None:
    """Blender's exporter writes it for all: with keys at both ends of what stands still, or none,
    and the armature moved as the crate is."""
    crate()
    figure("Hero", ("jump",))
    bpy.context.object.location.x = 5.0
    path = exported(tmp_path / "crate.fbx", bake_anim_force_startend_keying=start_and_end)
    made = import_clip(path, unit=1.0)
    assert risen(made) == pytest.approx(0.5, abs=1e-3)
    assert made.armature.matrix_world.translation.x == pytest.approx(5.0, abs=1e-4)
    assert told(made) == []
    with pytest.raises(NotInFile):
        import_clip(path, take="AAA crate")


def test_where_a_crate_alone_moves_nothing_is_read(tmp_path: Path) -> None:
    """The whole scene as one take, in which the armature stands still."""
    figure("Hero", ("a_idle",))
    crate()
    path = exported(tmp_path / "crate.fbx", **WHOLE_SCENE)
    with pytest.raises(NoAction):
        import_clip(path)


def test_of_several_armatures_that_move_the_others_are_named_and_can_be_read(
    tmp_path: Path,
) -> None:
    figure("Hero", ("jump",), bones=4)
    figure("Friend", ("walk",))
    path = exported(tmp_path / "two.fbx", **WHOLE_SCENE)
    made = import_clip(path, unit=1.0)
    assert made.armature.name == "Hero"
    (line,) = told(made)
    assert "2 armatures that move: “Hero” is read, and not “Friend” (else say --armature)" in line
    bpy.ops.wm.read_factory_settings(use_empty=True)
    made = import_clip(path, unit=1.0, armature="friend")
    assert made.armature.name == "Friend"
    assert risen(made) == pytest.approx(0.2, abs=1e-3)
    assert told(made) == []
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with pytest.raises(NotInFile) as fault:
        import_clip(path, armature="Foe")
    assert fault.value.known == ("Hero", "Friend")


def test_a_bone_without_keys_in_the_take_has_no_pose_of_another_take(tmp_path: Path) -> None:
    figure("Hero", ("a_idle", "jump"), turned_in="a_idle")
    path = exported(tmp_path / "takes.fbx", bake_anim_force_startend_keying=False)
    made = import_clip(path, unit=1.0, take="jump")
    bpy.context.scene.frame_set(LAST // 2)
    turned = made.armature.pose.bones[1].matrix_basis.to_euler()
    assert turned.x == pytest.approx(0.0, abs=1e-4)


@pytest.mark.parametrize("option", ["--take", "--armature"])
def test_a_file_of_another_kind_takes_no_such_option(option: str, capsys) -> None:
    assert main(["analyze", str(mocap_path("run_2.bvh")), option, "jump"]) == 2
    assert f"“{option}” does not count for run_2.bvh" in capsys.readouterr().err
