"""Import into Blender: what Blender evaluates is what the file says."""

import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.files.import_clip import ImportedClip, import_clip
from hangtime.bridge.formats.acclaim import read_acclaim
from hangtime.bridge.formats.bvh import read_bvh
from hangtime.bridge.formats.guess import ACCLAIM_UNIT
from hangtime.bridge.formats.motion_clip import (
    SUBSTITUTE_BONE,
    MotionClip,
    forward_kinematics,
    to_recording,
)
from hangtime.devtools.recordings import HOPS, read
from hangtime.solver.analysis.performance import find_contacts, perform
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.character import build_character
from hangtime.solver.data.faults import (
    ClipNotOpened,
    Fault,
    NoAction,
    NoArmature,
    NonFiniteKey,
    UnknownClipFormat,
    UnreadableClip,
)
from hangtime.solver.data.recording import Recording
from hangtime.tests.helpers.clips import mocap_path

bpy = pytest.importorskip("bpy")

JUMP_BVH = "forward_jump_116cm.bvh"
DANCE = "rokoko_jesse_dance.bvh"
RUN_FBX = "09_11_cmu.fbx"
CHILD_BVH = "fair1_jumping.bvh"
HOP_FRAMES = 400
Paths = Callable[[str], Path]  # of recordings, by name

ONE_BONE_BVH = """\
HIERARCHY
ROOT Hips
{
OFFSET 0 0 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
End Site
{
OFFSET 0 1.7 0
}
}
MOTION
Frames: 5
Frame Time: 0.04
0 0 0 0 0 100
0 0 0 0 0 160
0 0 0 0 0 200
0 0 0 0 0 260
0 0 0 0 0 320
"""


@pytest.fixture(scope="module")
def path_of(tmp_path_factory: pytest.TempPathFactory) -> Paths:
    """A recording's file by its name; of the ten hops, which are long, a copy of the first."""
    whole, hop = mocap_path(HOPS), tmp_path_factory.mktemp("hop") / HOPS
    hop.with_name("01.asf").write_text(whole.with_name("01.asf").read_text())
    hop.write_text("\n".join(whole.read_text().splitlines()[: 3 + 30 * HOP_FRAMES]))
    return lambda name: hop if name == HOPS else mocap_path(name)


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)


def clip_of(path: Path) -> MotionClip:
    """A BVH or AMC file as it is."""
    return read_bvh(path) if path.suffix == ".bvh" else read_acclaim(path.with_name("01.asf"), path)


def evaluated(armature: "bpy.types.Object", frame: float) -> dict[str, FloatArray]:
    """World matrices (4, 4) by bone, in Blender units."""
    bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))
    world = armature.matrix_world
    return {bone.name: np.array(world @ bone.matrix) for bone in armature.pose.bones}


def assert_same_motion(imported: ImportedClip, recording: Recording, scale: float = 1.0) -> None:
    """Heads and tails to 0.1 mm at frames all over the clip.

    Apart from tails of bones without length, which Blender 4.2 lengthens otherwise than 4.5.
    """
    shortest = 1.01 * SUBSTITUTE_BONE * imported.unit_m
    total = len(recording.frames)
    scene = bpy.context.scene
    assert (scene.frame_start, scene.frame_end) == (1, total)
    for t in (0, 1, total // 3, total // 2, total - 2, total - 1):
        poses = evaluated(imported.armature, recording.frames[t])
        assert len(poses) == len(recording.bones)
        for b, bone in enumerate(recording.bones):
            matrix = poses[bone.name]
            head = recording.heads[t, b]
            np.testing.assert_allclose(scale * matrix[:3, 3], head, atol=1e-4, err_msg=bone.name)
            tail = head + recording.rotations[t, b] @ (bone.tail - bone.head)
            if np.linalg.norm(bone.tail - bone.head) < shortest:
                continue
            length = imported.armature.data.bones[bone.name].length
            reached = scale * (matrix[:3, 3] + length * matrix[:3, 1])
            np.testing.assert_allclose(reached, tail, atol=1e-4, err_msg=bone.name)


@pytest.mark.parametrize(
    "relative",
    [CHILD_BVH, *(pytest.param(p, marks=pytest.mark.slow) for p in (JUMP_BVH, DANCE, HOPS))],
)
def test_blender_evaluates_what_the_file_says(relative: str, path_of: Paths) -> None:
    path = path_of(relative)
    recording = read(path)
    assert_same_motion(import_clip(path), recording)
    render = bpy.context.scene.render
    rate = 1.0 / clip_of(path).frame_time
    assert render.fps / render.fps_base == pytest.approx(rate, rel=1e-6)


@pytest.mark.parametrize("relative", [CHILD_BVH, HOPS])
def test_unit_and_up_can_be_told(relative: str, path_of: Paths) -> None:
    path = path_of(relative)
    imported = import_clip(path, unit=0.03, up="Y")
    assert (imported.unit_m, imported.unit_guessed) == (0.03, False)
    assert (imported.up, imported.up_guessed) == ("Y", False)
    assert_same_motion(imported, to_recording(clip_of(path), 0.03, "Y"))


@pytest.mark.parametrize("relative", [JUMP_BVH, HOPS])
def test_scene_in_centimetres(relative: str, path_of: Paths) -> None:
    path = path_of(relative)
    bpy.context.scene.unit_settings.scale_length = 0.01
    assert_same_motion(import_clip(path), read(path), 0.01)


@pytest.mark.slow
def test_what_was_guessed_is_told(path_of: Paths) -> None:
    child = import_clip(mocap_path(CHILD_BVH))
    assert (child.unit_m, child.unit_guessed, child.up, child.up_guessed) == (
        0.0254,
        True,
        "Z",
        True,
    )
    hops = import_clip(path_of(HOPS))
    assert (hops.unit_m, hops.unit_guessed) == (pytest.approx(ACCLAIM_UNIT), False)


def test_acclaim_bones_are_the_files(path_of: Paths) -> None:
    armature = import_clip(path_of(HOPS)).armature
    shin = armature.data.bones["ltibia"]
    assert shin.parent.name == "lfemur"
    assert shin.length == pytest.approx(7.49137 * ACCLAIM_UNIT, abs=1e-5)
    assert armature.data.bones["lfemur"].parent.name == "lhipjoint"


def test_half_frames_lie_between_whole_ones(tmp_path: Path) -> None:
    path = tmp_path / "roll.bvh"
    path.write_text(ONE_BONE_BVH)
    armature = import_clip(path, unit=1.0).armature
    y = evaluated(armature, 2.5)["Hips"][:3, 1]
    # Half way between 160 and 200 degrees about x the bone hangs upside down.
    np.testing.assert_allclose(y, [0, 0, -1], atol=1e-5)


def test_import_from_edit_mode(path_of: Paths) -> None:
    other = import_clip(mocap_path(JUMP_BVH)).armature
    bpy.context.view_layer.objects.active = other
    bpy.ops.object.mode_set(mode="EDIT")
    imported = import_clip(path_of(HOPS))
    assert imported.armature is not other
    assert_same_motion(imported, read(path_of(HOPS)))


# ---------------------------------------------------------------- FBX


def export_fbx(path: Path, **options: object) -> None:
    """By Blender's exporter, whose own deprecated calls are not this test's subject."""
    with warnings.catch_warnings(action="ignore"):
        bpy.ops.export_scene.fbx(filepath=str(path), **options)


@pytest.mark.slow
def test_fbx_of_unknown_size_falls_as_bodies_do() -> None:
    """A run: gravity is right only where length and rate are. It counts frames from 0, has one in
    T-pose before, and sparse keys, which the importer joins by straight lines.
    """
    imported = import_clip(mocap_path(RUN_FBX))
    assert (imported.unit_m, imported.unit_guessed) == (pytest.approx(ACCLAIM_UNIT), True)
    assert (bpy.context.scene.frame_start, bpy.context.scene.frame_end) == (0, 165)
    assert bpy.context.scene.render.fps == 120
    recording = read_recording(imported.armature, first=1, last=165)
    p = perform(recording, build_character(recording))
    whole = [f for f in find_contacts(p).flights if f.start > 0.0]  # one is cut off by the clip
    assert len(whole) == 3
    for flight in whole:
        during = (p.times >= flight.start) & (p.times <= flight.end)
        fall = 2 * np.polyfit(p.times[during], p.com[during, 2], 2)[0]
        assert fall == pytest.approx(-9.81, abs=2.5)  # 12 frames of a run
    assert np.ptp(p.com[:, 1]) / p.times[-1] == pytest.approx(3.5, abs=0.1)  # m/s


@pytest.mark.slow
def test_fbx_of_our_own_export_keeps_its_size_and_rate(tmp_path: Path) -> None:
    original = import_clip(mocap_path(CHILD_BVH)).armature
    wanted = {frame: evaluated(original, frame) for frame in (1, 200, 330, 654)}
    path = tmp_path / "child.fbx"
    export_fbx(path, bake_anim_simplify_factor=0.0, add_leaf_bones=False)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    imported = import_clip(path)
    assert (imported.unit_m, imported.unit_guessed) == (1.0, False)
    render = bpy.context.scene.render
    assert render.fps / render.fps_base == pytest.approx(120 / 1.001, rel=1e-5)
    first = bpy.context.scene.frame_start
    for frame, poses in wanted.items():
        found = evaluated(imported.armature, first + frame - 1)
        for bone in ("Hips", "Head", "LeftFoot"):
            np.testing.assert_allclose(found[bone][:3, 3], poses[bone][:3, 3], atol=1e-3)


def test_fbx_without_armature_or_motion(tmp_path: Path) -> None:
    bpy.ops.mesh.primitive_cube_add()
    export_fbx(tmp_path / "cube.fbx")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.object.armature_add()
    export_fbx(tmp_path / "still.fbx", bake_anim=False)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with pytest.raises(NoArmature):
        import_clip(tmp_path / "cube.fbx")
    with pytest.raises(NoAction):
        import_clip(tmp_path / "still.fbx")
    assert len(bpy.data.objects) == len(bpy.data.armatures) == len(bpy.data.meshes) == 0


@pytest.mark.parametrize("kept", [0, 1000, 150_000])
def test_truncated_fbx(tmp_path: Path, kept: int, capfd: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "cut.fbx"
    path.write_bytes(mocap_path(RUN_FBX).read_bytes()[:kept])
    with pytest.raises(UnreadableClip) as caught:
        import_clip(path)
    assert (caught.value.path, caught.value.line) == (str(path), None)
    assert str(path) not in caught.value.problem
    assert "Traceback" not in "".join(capfd.readouterr())
    assert len(bpy.data.objects) == 0


# ---------------------------------------------------------------- complaints


def test_faults_leave_nothing_behind(tmp_path: Path) -> None:
    rate = bpy.context.scene.render.fps
    short = tmp_path / "short.bvh"
    short.write_text(ONE_BONE_BVH.replace("Frames: 5", "Frames: 6"))
    with pytest.raises(UnreadableClip) as caught:
        import_clip(short)
    assert caught.value.line == 18
    broken = tmp_path / "broken.bvh"
    broken.write_text(ONE_BONE_BVH.replace("200", "nan"))
    with pytest.raises(NonFiniteKey) as not_finite:
        import_clip(broken)
    assert (not_finite.value.bone, not_finite.value.frame) == ("Hips", 3)
    lonely = tmp_path / "lonely.amc"
    lonely.write_text(":DEGREES\n1\nroot 0 0 0 0 0 0\n")
    wrong: dict[Path, type[Fault]] = {
        lonely: UnreadableClip,
        tmp_path / "absent.fbx": ClipNotOpened,
        tmp_path / "absent.bvh": ClipNotOpened,
        tmp_path / "a.asf": UnreadableClip,
        tmp_path / "clip.usda": UnknownClipFormat,
    }
    for path, fault in wrong.items():
        with pytest.raises(fault):
            import_clip(path)
    assert len(bpy.data.objects) == len(bpy.data.armatures) == len(bpy.data.actions) == 0
    assert bpy.context.scene.render.fps == rate


def test_what_our_parser_accepts_blender_imports_alike(tmp_path: Path) -> None:
    """Two roots, doubled and spaced names, other channel orders, a joint that slides."""
    path = tmp_path / "odd.bvh"
    path.write_text(
        """hierarchy
ROOT left  hip
{
OFFSET 1 2 3
CHANNELS 6 Xrotation Zposition Yrotation Xposition Zrotation Yposition
JOINT part
{
OFFSET 0 2 0
CHANNELS 4 Yrotation Xrotation Zrotation Xposition
JOINT part
{
OFFSET 0 0 0
CHANNELS 0
}
}
}
ROOT second
{
OFFSET 5 0 0
CHANNELS 3 Xrotation Yrotation Zrotation
End Site
{
OFFSET 0 1 1
}
}
MOTION
Frames: 2
Frame Time: 0.04
10 1 20 2 30 3 40 50 60 7 80 90 100

-10 1 20 2 30 3 -40 150 60 7 180 90 -100
"""
    )
    clip = read_bvh(path)
    assert [joint.name for joint in clip.joints] == ["left_hip", "part", "part.001", "second"]
    imported = import_clip(path, unit=1.0, up="Y")
    heads = forward_kinematics(clip)[0]
    for t in (0, 1):
        poses = evaluated(imported.armature, t + 1)
        for j, joint in enumerate(clip.joints):
            x, y, z = heads[t, j]
            np.testing.assert_allclose(poses[joint.name][:3, 3], [x, -z, y], atol=1e-4)


def test_acclaim_skeleton_can_be_named(tmp_path: Path) -> None:
    amc = mocap_path(HOPS)
    asf = tmp_path / "elsewhere.asf"
    asf.write_text(amc.with_name("01.asf").read_text())
    few = tmp_path / "few" / "motion.amc"
    few.parent.mkdir()
    few.write_text("\n".join(amc.read_text().splitlines()[:123]))
    imported = import_clip(few, asf=asf, rate=60.0)
    assert bpy.context.scene.render.fps == 60
    clip = read_acclaim(asf, few, 60.0)
    assert_same_motion(imported, to_recording(clip, ACCLAIM_UNIT, "Y"))
