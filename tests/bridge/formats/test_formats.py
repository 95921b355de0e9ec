"""Motion files: every complaint names its line, and what is read is what was recorded."""

from pathlib import Path

import numpy as np
import pytest
from hangtime.bridge.formats.acclaim import find_asf, read_acclaim
from hangtime.bridge.formats.bvh import read_bvh
from hangtime.bridge.formats.guess import ACCLAIM_UNIT
from hangtime.bridge.formats.motion_clip import forward_kinematics, rest_axes, to_recording
from hangtime.bridge.formats.obj import UnreadableMesh, read_obj
from hangtime.devtools.recordings import HOPS
from hangtime.operators.words.doubt_text import file_doubts
from hangtime.solver.data.faults import ClipNotOpened, NonFiniteKey, UnreadableClip
from hangtime.solver.data.reports.recording import Origin
from hangtime.tests.helpers.clips import load_clip, load_recording

HOP_BVH = "hop_01_01.bvh"
HOP = slice(160, 360)  # what it holds of the ten hops, counted from 0

BVH = """\
HIERARCHY
ROOT Hips
{
  OFFSET 0 10 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT Head
  {
    OFFSET 0 5 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 2 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0083333
1 11 2 90 0 0 0 0 0
1 12 2 0 0 90 0 90 90
"""

ASF = """\
# made for this test
:version 1.10
:units
  mass 1.0
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name spine
    direction 0 1 0
    length 20
    axis 0 0 90 XYZ
    dof rx ry
    limits (-10 10)
           (-10 10)
  end
  begin
    id 2
    name head
    direction 0 0 3
    length 10
    axis 0 0 0 XYZ
    dof rz
  end
:hierarchy
  begin
    root spine
    spine head
  end
"""

AMC = """\
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 0 0 0
spine 90 0
head 0
2
root 1 2 3 0 0 90
spine 0 0
head 90
"""


def edited(text: str, line: int, replacement: str) -> str:
    """The text with one line, counted from 1, replaced."""
    lines = text.splitlines()
    lines[line - 1] = replacement
    return "\n".join(lines) + "\n"


def truncated(text: str, lines: int) -> str:
    return "\n".join(text.splitlines()[:lines]) + "\n"


def bvh_file(folder: Path, text: str) -> Path:
    path = folder / "clip.bvh"
    path.write_text(text)
    return path


def acclaim_files(folder: Path, asf: str, amc: str) -> tuple[Path, Path]:
    paths = folder / "01.asf", folder / "01_01.amc"
    for path, text in zip(paths, (asf, amc), strict=True):
        path.write_text(text)
    return paths


# ---------------------------------------------------------------- by hand


def test_bvh_poses_are_those_worked_out_by_hand(tmp_path: Path) -> None:
    clip = read_bvh(bvh_file(tmp_path, BVH))
    heads, rotations = forward_kinematics(clip)
    # The root's position replaces its offset; a quarter turn about z lays the spine along -x.
    np.testing.assert_allclose(heads[0], [[1, 11, 2], [-4, 11, 2]], atol=1e-12)
    # Second frame: the root turns about x, the head about x, then (its own) y.
    quarter_x = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    quarter_y = np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    np.testing.assert_allclose(rotations[1, 1], quarter_x @ quarter_x @ quarter_y, atol=1e-12)
    np.testing.assert_allclose(heads[1, 1], [1, 12, 7], atol=1e-12)
    np.testing.assert_allclose(rest_axes(clip), [[0, 5, 0], [0, 2, 0]])


def test_acclaim_poses_are_those_worked_out_by_hand(tmp_path: Path) -> None:
    clip = read_acclaim(*acclaim_files(tmp_path, ASF, AMC))
    heads, rotations = forward_kinematics(clip)
    assert [joint.name for joint in clip.joints] == ["root", "spine", "head"]
    # The spine's own x axis is the world's y: a turn about it leaves the spine upright.
    np.testing.assert_allclose(heads[0], [[1, 2, 3], [1, 2, 3], [1, 22, 3]], atol=1e-12)
    np.testing.assert_allclose(rotations[0, 1] @ [0, 0, 1], [1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(heads[1, 2], [-19, 2, 3], atol=1e-12)
    np.testing.assert_allclose(rotations[1, 2] @ [1, 0, 0], [-1, 0, 0], atol=1e-12)
    assert clip.unit == pytest.approx(0.0254 / 0.45)


def test_recording_is_z_up_in_metres(tmp_path: Path) -> None:
    recording = to_recording(read_bvh(bvh_file(tmp_path, BVH)), 0.1, "Y")
    np.testing.assert_allclose(recording.heads[0], [[0.1, -0.2, 1.1], [-0.4, -0.2, 1.1]])
    np.testing.assert_allclose(recording.frames, [1, 2])
    np.testing.assert_allclose(recording.times, [0, 1 / 120])
    head = recording.bones[recording.index("Head")]
    np.testing.assert_allclose((head.head, head.tail), [[0, 0, 1.5], [0, 0, 1.7]], atol=1e-12)
    # The head's own end points where its rotation takes the rest direction.
    up = recording.rotations[0, 1] @ (head.tail - head.head)
    np.testing.assert_allclose(up, [-0.2, 0, 0], atol=1e-12)


@pytest.mark.parametrize(
    ("printed", "rate"),
    [
        ("0.0083333", 120.0),
        (".03333", 30.0),
        ("0.033", 30.0),
        ("0.008342", 120 / 1.001),
        ("0.01", 100.0),
        ("0.0417083", 24 / 1.001),
        ("0.0123456", 1 / 0.0123456),
    ],
)
def test_rate_is_the_one_the_printed_digits_stand_for(
    tmp_path: Path, printed: str, rate: float
) -> None:
    clip = read_bvh(bvh_file(tmp_path, edited(BVH, 18, f"Frame Time: {printed}")))
    assert 1.0 / clip.frame_time == pytest.approx(rate, rel=1e-12)


def test_a_rate_that_is_given_counts_instead_of_the_printed_one(tmp_path: Path) -> None:
    assert 1.0 / read_bvh(bvh_file(tmp_path, BVH), 50.0).frame_time == pytest.approx(50.0)


def test_more_frames_than_announced_are_read_and_counted(tmp_path: Path) -> None:
    assert read_bvh(bvh_file(tmp_path, BVH)).miscount is None
    clip = read_bvh(bvh_file(tmp_path, edited(BVH, 17, "Frames: 1")))
    assert (len(clip.positions), clip.miscount) == (2, (1, 2))


# ---------------------------------------------------------------- complaints


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("", 1),
        ("not a motion\n" + BVH, 1),
        (truncated(BVH, 1), 1),
        (edited(BVH, 2, "JOINT Hips"), 2),
        (edited(BVH, 2, "ROOT"), 2),
        (edited(BVH, 3, "("), 3),
        (edited(BVH, 4, "OFFSET 0 10"), 4),
        (edited(BVH, 4, "OFFSET 0 ten 0"), 4),
        (edited(BVH, 8, "OFFSET 0 nan 0"), 8),
        (edited(BVH, 8, "OFFSET 0 1e30 0"), 8),
        (edited(BVH, 9, "CHANNELS 3 Zrotation Xrotation"), 9),
        (edited(BVH, 9, "CHANNELS 3 Zrotation Xrotation Wrotation"), 9),
        (edited(BVH, 9, "CHANNELS 2 Zrotation Xrotation"), 9),
        (truncated(BVH, 12), 12),
        (truncated(BVH, 15), 15),
        (edited(BVH, 15, ""), 16),  # a brace is missing: MOTION stands inside the root
        (edited(BVH, 16, "MOVES"), 16),
        (edited(BVH, 17, "Frames: many"), 17),
        (edited(BVH, 17, "Frames: 0"), 17),
        (edited(BVH, 17, f"Frames: 1{400 * '0'}"), 17),
        (edited(BVH, 17, "Frames: 3"), 20),
        (edited(BVH, 18, "Frame Time: 0"), 18),
        (edited(BVH, 18, "Frame Time: soon"), 18),
        (edited(BVH, 18, "Frame Time: 1e-30"), 18),
        (edited(BVH, 18, "Frame Time: 1e30"), 18),
        (edited(BVH, 19, "1 11 2 90 0 0 0 0"), 19),
        (edited(BVH, 20, "1 12 2 0 0 90 0 90 90 7"), 20),
        (edited(BVH, 20, "1 12 2 0 0 9O 0 90 90"), 20),
        (truncated(BVH, 19), 19),
    ],
)
def test_malformed_bvh_gives_its_line(tmp_path: Path, text: str, line: int) -> None:
    path = bvh_file(tmp_path, text)
    with pytest.raises(UnreadableClip) as caught:
        read_bvh(path)
    assert (caught.value.path, caught.value.line) == (str(path), line)


def test_a_chain_may_be_longer_than_calls_may_be_nested(tmp_path: Path) -> None:
    joints = 2000
    inner = "".join(f"JOINT J{i}\n{{\nOFFSET 0 1 0\nCHANNELS 0\n" for i in range(joints))
    root = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 0\n"
    text = root + inner + "}\n" * (joints + 1) + "MOTION\nFrames: 0\n"
    with pytest.raises(UnreadableClip, match="no frames"):
        read_bvh(bvh_file(tmp_path, text))


@pytest.mark.parametrize(("value", "line"), [("nan", 19), ("inf", 20), ("-1e999", 20)])
def test_bvh_key_that_is_not_finite_names_bone_and_frame(
    tmp_path: Path, value: str, line: int
) -> None:
    text = edited(BVH, line, f"1 12 2 0 0 90 0 {value} 90")
    with pytest.raises(NonFiniteKey) as caught:
        read_bvh(bvh_file(tmp_path, text))
    assert (caught.value.bone, caught.value.frame) == ("Head", line - 18)


@pytest.mark.slow
def test_every_cut_of_a_bvh_is_noticed(tmp_path: Path) -> None:
    for size in range(len(BVH.rstrip()) - 1):
        with pytest.raises(UnreadableClip):
            read_bvh(bvh_file(tmp_path, BVH[:size]))


def test_file_that_is_absent_or_no_text(tmp_path: Path) -> None:
    with pytest.raises(ClipNotOpened):
        read_bvh(tmp_path / "absent.bvh")
    path = tmp_path / "binary.bvh"
    path.write_bytes(BVH.encode() + b"\xff\xfe")
    with pytest.raises(UnreadableClip) as caught:
        read_bvh(path)
    assert caught.value.line == 21


def test_a_byte_order_mark_is_told_as_such(tmp_path: Path) -> None:
    path = tmp_path / "marked.bvh"
    path.write_bytes(b"\xef\xbb\xbf" + BVH.encode())
    with pytest.raises(UnreadableClip) as caught:
        read_bvh(path)
    assert caught.value.line == 1
    assert "byte order mark" in caught.value.problem


@pytest.mark.parametrize(
    ("asf", "line"),
    [
        ("", 1),
        ("skeleton\n" + ASF, 1),
        (truncated(ASF, 11), 11),
        (edited(ASF, 5, "  length none"), 5),
        (edited(ASF, 8, "  order TX TY TZ RX RY RQ"), 8),
        (edited(ASF, 9, "  axis XXY"), 9),
        (edited(ASF, 10, "  position 0 0"), 10),
        (edited(ASF, 13, "  end"), 13),
        (edited(ASF, 15, ""), 13),  # a bone without a name: the line where it begins
        (edited(ASF, 16, "    direction 0 1"), 16),
        (edited(ASF, 17, "    length long"), 17),
        (edited(ASF, 18, "    axis 0 0 XYZ"), 18),
        (edited(ASF, 19, "    dof rx rx"), 19),
        (edited(ASF, 19, "    dof rx l"), 19),
        (edited(ASF, 22, ""), 23),  # no end before the next begin
        (edited(ASF, 25, "    name spine"), 25),
        (edited(ASF, 33, "    root tail"), 33),
        (edited(ASF, 34, "    neck head"), 34),
        (edited(ASF, 34, ""), 25),  # the bone that the hierarchy forgets
        (truncated(ASF, 34), 34),
    ],
)
def test_malformed_asf_gives_its_line(tmp_path: Path, asf: str, line: int) -> None:
    paths = acclaim_files(tmp_path, asf, AMC)
    with pytest.raises(UnreadableClip) as caught:
        read_acclaim(*paths)
    assert (caught.value.path, caught.value.line) == (str(paths[0]), line)


@pytest.mark.parametrize(
    ("amc", "line"),
    [
        ("", 1),
        (truncated(AMC, 3), 3),
        (edited(AMC, 2, ":RADIANS"), 2),
        (edited(AMC, 3, ""), 4),
        (edited(AMC, 5, "spine 90"), 5),
        (edited(AMC, 5, "spine 90 x"), 5),
        (edited(AMC, 6, "tail 0"), 6),
        (edited(AMC, 6, "spine 0 0"), 6),
        (edited(AMC, 9, ""), 10),
        (truncated(AMC, 9), 9),
    ],
)
def test_malformed_amc_gives_its_line(tmp_path: Path, amc: str, line: int) -> None:
    paths = acclaim_files(tmp_path, ASF, amc)
    with pytest.raises(UnreadableClip) as caught:
        read_acclaim(*paths)
    assert (caught.value.path, caught.value.line) == (str(paths[1]), line)


def test_amc_key_that_is_not_finite_names_bone_and_frame(tmp_path: Path) -> None:
    paths = acclaim_files(tmp_path, ASF, edited(AMC, 9, "spine 0 nan"))
    with pytest.raises(NonFiniteKey) as caught:
        read_acclaim(*paths)
    assert (caught.value.bone, caught.value.frame) == ("spine", 2)


def test_asf_is_found_by_stem_then_by_number_then_alone(tmp_path: Path) -> None:
    amc = tmp_path / "07_walk_03.amc"
    with pytest.raises(UnreadableClip, match="no ASF"):
        find_asf(amc)
    for name in ("other.asf", "07_walk.ASF", "07_walk_03.asf"):
        (tmp_path / name).touch()
        assert find_asf(amc).name == name
    with pytest.raises(UnreadableClip, match="more than one"):
        find_asf(tmp_path / "unlike.amc")


# ---------------------------------------------------------------- recordings


@pytest.mark.slow
def test_both_forms_of_one_recording_agree() -> None:
    """The BVH was made without the thorax's and wrists' lengths: so legs and spine are compared in
    place, the arms and head from the neck on."""
    acclaim, biovision = load_clip(HOPS), load_clip(HOP_BVH)
    a, b = forward_kinematics(acclaim)[0][HOP], forward_kinematics(biovision)[0]
    a_names = [joint.name for joint in acclaim.joints]
    b_names = [joint.name for joint in biovision.joints]
    from_root = {"root": "Hips", "lfemur": "LeftUpLeg", "ltoes": "LeftToeBase"}
    from_root |= {"rtibia": "RightLeg", "rtoes": "RightToeBase", "thorax": "Spine1"}
    from_neck = {"head": "Head", "lradius": "LeftForeArm", "rwrist": "RightHand"}
    a_neck = a[:, a_names.index("lowerneck")]
    b_neck = b[:, b_names.index("Neck")]
    for pairs, a_origin, b_origin in ((from_root, 0.0, 0.0), (from_neck, a_neck, b_neck)):
        for a_name, b_name in pairs.items():
            left = a[:, a_names.index(a_name)] - a_origin
            right = b[:, b_names.index(b_name)] - b_origin
            assert ACCLAIM_UNIT * np.abs(left - right).max() < 2e-5, a_name


def test_recording_of_the_hops_flies_where_the_list_says() -> None:
    recording = load_recording(HOPS)
    feet = [i for i, bone in enumerate(recording.bones) if "toe" in bone.name]
    lowest = recording.heads[:, feet, 2].min(axis=1)
    flight = (recording.times > 1.96) & (recording.times < 2.20)
    stance = (recording.times > 2.59) & (recording.times < 3.19)
    assert lowest[flight].min() > lowest[stance].max()


@pytest.mark.parametrize("vertex", ["v 0 nan 1", "v 0 0 inf", "v 1e400 0 0"])
def test_a_mesh_with_a_place_that_is_no_number(vertex: str, tmp_path: Path) -> None:
    """The analysis would look for ground at no place at all."""
    path = tmp_path / "crate.obj"
    path.write_text(f"v 0 0 0\n{vertex}\n")
    with pytest.raises(UnreadableMesh) as caught:
        read_obj(path)
    assert caught.value.line == 2


def test_bones_of_which_a_motion_says_nothing_are_told(tmp_path: Path) -> None:
    """One that its skeleton gives no freedom needs no line."""
    silent = "".join(line for line in AMC.splitlines(True) if not line.startswith("head"))
    assert read_acclaim(*acclaim_files(tmp_path, ASF, AMC)).unmoved == ()
    clip = read_acclaim(*acclaim_files(tmp_path, ASF, silent))
    assert clip.unmoved == ("head",)
    (told,) = file_doubts(Origin("clip.amc", unmoved=clip.unmoved))
    assert told.startswith("clip.amc has no line of “head”, which its skeleton's file lets move")
