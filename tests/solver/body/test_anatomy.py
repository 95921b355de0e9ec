"""Names of bones in the wild, and the body parts that they stand for."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from hangtime.devtools.recordings import HOPS
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.anatomy import Part, Segment, Side, map_anatomy, split_side
from hangtime.solver.data.faults import MissingPart, NoSpine
from hangtime.solver.data.recording import Bone
from hangtime.tests.helpers.clips import load_recording

# bone: parent, in the order of a file. {s} stands for the side.
MIXAMO = """
mixamorig:Hips: | mixamorig:Spine: mixamorig:Hips | mixamorig:Spine1: mixamorig:Spine
mixamorig:Spine2: mixamorig:Spine1 | mixamorig:Neck: mixamorig:Spine2
mixamorig:Head: mixamorig:Neck | mixamorig:HeadTop_End: mixamorig:Head
mixamorig:{s}Shoulder: mixamorig:Spine2 | mixamorig:{s}Arm: mixamorig:{s}Shoulder
mixamorig:{s}ForeArm: mixamorig:{s}Arm | mixamorig:{s}Hand: mixamorig:{s}ForeArm
mixamorig:{s}HandThumb1: mixamorig:{s}Hand | mixamorig:{s}HandIndex1: mixamorig:{s}Hand
mixamorig:{s}UpLeg: mixamorig:Hips | mixamorig:{s}Leg: mixamorig:{s}UpLeg
mixamorig:{s}Foot: mixamorig:{s}Leg | mixamorig:{s}ToeBase: mixamorig:{s}Foot
mixamorig:{s}Toe_End: mixamorig:{s}ToeBase
"""
RIGIFY = """
spine: | spine.001: spine | spine.002: spine.001 | spine.003: spine.002 | spine.004: spine.003
neck: spine.004 | head: neck | pelvis.{s}: spine
shoulder.{s}: spine.003 | upper_arm.{s}: shoulder.{s} | forearm.{s}: upper_arm.{s}
hand.{s}: forearm.{s} | palm.01.{s}: hand.{s} | f_index.01.{s}: palm.01.{s}
thigh.{s}: spine | shin.{s}: thigh.{s} | foot.{s}: shin.{s} | toe.{s}: foot.{s}
heel.02.{s}: foot.{s} | breast.{s}: spine.003
"""
UNREAL = """
root: | pelvis: root | spine_01: pelvis | spine_02: spine_01 | spine_03: spine_02
neck_01: spine_03 | head: neck_01
clavicle_{s}: spine_03 | upperarm_{s}: clavicle_{s} | upperarm_twist_01_{s}: upperarm_{s}
lowerarm_{s}: upperarm_{s} | hand_{s}: lowerarm_{s} | index_01_{s}: hand_{s}
thigh_{s}: pelvis | thigh_twist_01_{s}: thigh_{s} | calf_{s}: thigh_{s}
calf_twist_01_{s}: calf_{s} | foot_{s}: calf_{s} | ball_{s}: foot_{s}
ik_foot_root: root | ik_foot_{s}: ik_foot_root
"""
MOTION_BUILDER = """
Reference: | Hips: Reference | Spine: Hips | Spine1: Spine | Neck: Spine1 | Head: Neck
{s}Shoulder: Spine1 | {s}Arm: {s}Shoulder | {s}ArmRoll: {s}Arm | {s}ForeArm: {s}Arm
{s}ForeArmRoll: {s}ForeArm | {s}Hand: {s}ForeArm
{s}UpLeg: Hips | {s}UpLegRoll: {s}UpLeg | {s}Leg: {s}UpLeg | {s}LegRoll: {s}Leg
{s}Foot: {s}Leg | {s}ToeBase: {s}Foot
"""
ROKOKO = """
Hips: | Spine1: Hips | Spine2: Spine1 | Spine3: Spine2 | Spine4: Spine3 | Neck: Spine4 | Head: Neck
{s}Shoulder: Spine4 | {s}Arm: {s}Shoulder | {s}ForeArm: {s}Arm | {s}Hand: {s}ForeArm
{s}Finger2Metacarpal: {s}Hand
{s}Thigh: Hips | {s}Shin: {s}Thigh | {s}Foot: {s}Shin | {s}Toe: {s}Foot
"""
BIPED = """
Bip01: | Bip01 Pelvis: Bip01 | Bip01 Spine: Bip01 Pelvis | Bip01 Spine1: Bip01 Spine
Bip01 Neck: Bip01 Spine1 | Bip01 Head: Bip01 Neck
Bip01 {s} Clavicle: Bip01 Neck | Bip01 {s} UpperArm: Bip01 {s} Clavicle
Bip01 {s} Forearm: Bip01 {s} UpperArm | Bip01 {s} Hand: Bip01 {s} Forearm
Bip01 {s} Thigh: Bip01 Pelvis | Bip01 {s} Calf: Bip01 {s} Thigh
Bip01 {s} Foot: Bip01 {s} Calf | Bip01 {s} Toe0: Bip01 {s} Foot
"""
JOINTS = """
Hips: | Chest: Hips | Neck: Chest | Head: Neck
{s}Collar: Chest | {s}Shoulder: {s}Collar | {s}Elbow: {s}Shoulder | {s}Wrist: {s}Elbow
{s}Hip: Hips | {s}Knee: {s}Hip | {s}Ankle: {s}Knee | {s}Toe: {s}Ankle
"""
WORDS = ("Left", "Right")
RIGS = {  # names, sides, left: upper arm, shank, clavicle, toe
    "Mixamo": (
        MIXAMO,
        WORDS,
        ("mixamorig:LeftArm", "mixamorig:LeftLeg", "mixamorig:LeftShoulder"),
        "mixamorig:LeftToeBase",
    ),
    "Rigify": (RIGIFY, ("L", "R"), ("upper_arm.L", "shin.L", "shoulder.L"), "toe.L"),
    "Unreal": (UNREAL, ("l", "r"), ("upperarm_l", "calf_l", "clavicle_l"), "ball_l"),
    "MotionBuilder": (MOTION_BUILDER, WORDS, ("LeftArm", "LeftLeg", "LeftShoulder"), "LeftToeBase"),
    "Rokoko": (ROKOKO, WORDS, ("LeftArm", "LeftShin", "LeftShoulder"), "LeftToe"),
    "Biped": (
        BIPED,
        ("L", "R"),
        ("Bip01 L UpperArm", "Bip01 L Calf", "Bip01 L Clavicle"),
        "Bip01 L Toe0",
    ),
    "joints": (JOINTS, WORDS, ("LeftShoulder", "LeftKnee", "LeftCollar"), "LeftToe"),
}
RECORDED = (
    "forward_jump_116cm.bvh",
    "high_jump.bvh",
    "run_1.bvh",
    "131_03_hop.bvh",
    HOPS,
    "fair1_jumping.bvh",
    "cmu1_jumping_jacks.bvh",
    "rokoko_jesse_dance.bvh",
)
LIMBS = (
    Part.UPPER_ARM,
    Part.FOREARM,
    Part.HAND,
    Part.THIGH,
    Part.SHANK,
    Part.FOOT,
    Part.TOE,
)


def skeleton(pairs: Sequence[tuple[str, str]]) -> tuple[Bone, ...]:
    names = [name for name, _ in pairs]
    point = np.zeros(3)
    return tuple(
        Bone(name, names.index(parent) if parent else -1, point, point, np.eye(3))
        for name, parent in pairs
    )


def rig(text: str, sides: tuple[str, str]) -> tuple[Bone, ...]:
    """Bones of a rig, parents first; lines with {s} once a side."""
    entries = [entry.strip() for line in text.split("\n") for entry in line.split(" | ")]
    pairs = []
    for side in sides:
        for entry in filter(None, entries):
            name, _, parent = f"{entry} ".partition(": ")
            pair = (name.strip().format(s=side), parent.strip().format(s=side))
            if pair not in pairs:
                pairs.append(pair)
    return skeleton(pairs)


def named(bones: Sequence[Bone], segments: Sequence[Segment]) -> dict[tuple[Part, Side], str]:
    return {(s.part, s.side): bones[s.bone].name for s in segments}


def check_tree(bones: Sequence[Bone], segments: Sequence[Segment]) -> None:
    """Parents first, every bone once, and every limb hangs together."""
    order = [s.bone for s in segments]
    assert order == sorted(set(order))
    assert segments[0].part is Part.PELVIS
    place = {(s.part, s.side): s.bone for s in segments}
    for side in (Side.LEFT, Side.RIGHT):
        for limb in (LIMBS[:3], LIMBS[3:]):
            bone = [place[part, side] for part in limb if (part, side) in place]
            for upper, lower in pairwise(bone):
                above = bones[lower].parent
                while above > upper:
                    above = bones[above].parent
                assert above == upper


@pytest.mark.parametrize("name", RIGS)
def test_common_rigs(name: str) -> None:
    text, sides, (arm, shank, clavicle), toe = RIGS[name]
    bones = rig(text, sides)
    segments = map_anatomy(bones)
    check_tree(bones, segments)
    found = named(bones, segments)
    left = Side.LEFT
    assert found[Part.UPPER_ARM, left] == arm
    assert found[Part.SHANK, left] == shank
    assert found[Part.CLAVICLE, left] == clavicle
    assert found[Part.TOE, left] == toe
    assert sum(s.part is Part.SPINE for s in segments) >= 1
    if name != "Biped":  # its arms hang on the neck, which then is the last of the spine
        assert sum(s.part is Part.NECK for s in segments) >= 1
    twisted = [n for n in found.values() if "wist" in n or "Roll" in n or n.startswith("ik")]
    assert twisted == []


@pytest.mark.parametrize("relative", RECORDED)
def test_recordings(relative: str) -> None:
    bones = load_recording(relative).bones
    segments = map_anatomy(bones)
    check_tree(bones, segments)
    kinds = {(s.part, s.side) for s in segments}
    for side in (Side.LEFT, Side.RIGHT):
        assert {(part, side) for part in (*LIMBS, Part.CLAVICLE)} <= kinds
    assert sum(s.part is Part.SPINE for s in segments) >= 3
    for segment in segments:
        name = bones[segment.bone].name.lower()
        if segment.side is not Side.MIDDLE:
            assert name.startswith(segment.side.value[0])


def test_a_recording_with_one_bone_for_the_trunk() -> None:
    bones = load_recording("BMC_run.bvh").bones
    check_tree(bones, map_anatomy(bones))


@pytest.mark.parametrize(
    ("name", "side", "word"),
    [
        ("mixamorig:LeftUpLeg", Side.LEFT, "upleg"),
        ("upper_arm.L", Side.LEFT, "upperarm"),
        ("DEF-thigh.R", Side.RIGHT, "thigh"),
        ("calf_r", Side.RIGHT, "calf"),
        ("lfemur", Side.LEFT, "femur"),
        ("rclavicle", Side.RIGHT, "clavicle"),
        ("Bip01 R Calf", Side.RIGHT, "calf"),
        ("Foot_Left", Side.LEFT, "foot"),
        ("lowerback", Side.MIDDLE, "lowerback"),
        ("root", Side.MIDDLE, "root"),
        ("Neck", Side.MIDDLE, "neck"),
    ],
)
def test_sides(name: str, side: Side, word: str) -> None:
    assert split_side(name) == (side, word)


@pytest.mark.parametrize(
    ("gone", "part"),
    [
        ("LeftUpLeg", "left thigh"),
        ("RightLeg", "right shank"),
        ("LeftFoot", "left foot"),
        ("LeftForeArm", "left forearm"),
        ("Head", "head"),
    ],
)
def test_a_missing_part_is_named(gone: str, part: str) -> None:
    bones = [
        Bone(b.name.replace(gone, f"x{i}") if b.name == gone else b.name, *rest(b))
        for i, b in enumerate(rig(MOTION_BUILDER, WORDS))
    ]
    with pytest.raises(MissingPart) as caught:
        map_anatomy(bones)
    assert caught.value.part == part
    assert caught.value.tried


def rest(bone: Bone) -> tuple[int, FloatArray, FloatArray, FloatArray]:
    return bone.parent, bone.head, bone.tail, bone.rotation


def test_a_rig_without_trunk_names_the_spine() -> None:
    bones = skeleton(
        [("Hips", ""), ("Head", "Hips")]
        + [
            (f"{side}{word}", f"{side}{parent}" if parent != "Hips" else parent)
            for side in WORDS
            for word, parent in (
                ("Arm", "Hips"),
                ("ForeArm", "Arm"),
                ("UpLeg", "Hips"),
                ("Leg", "UpLeg"),
                ("Foot", "Leg"),
            )
        ]
    )
    with pytest.raises(NoSpine) as caught:
        map_anatomy(bones)
    assert (caught.value.pelvis, caught.value.head) == ("Hips", "Head")


def test_hands_toes_and_clavicles_may_be_absent() -> None:
    gone = ("Hand", "ToeBase")
    kept = [b for b in rig(MOTION_BUILDER, WORDS) if not b.name.endswith(gone)]
    names = [b.name for b in kept]
    old = rig(MOTION_BUILDER, WORDS)
    bones = skeleton(
        [(b.name, old[b.parent].name if b.parent >= 0 else "") for b in kept if b.name in names]
    )
    kinds = {s.part for s in map_anatomy(bones)}
    assert kinds.isdisjoint({Part.HAND, Part.TOE})


def test_chosen_bones_win() -> None:
    bones = rig(UNREAL, ("l", "r"))
    found = named(bones, map_anatomy(bones, {"left foot": "ball_l", "right hand": "index_01_r"}))
    assert found[Part.FOOT, Side.LEFT] == "ball_l"
    assert found[Part.HAND, Side.RIGHT] == "index_01_r"


def test_a_chosen_bone_plays_one_part_only() -> None:
    """The ball that the artist calls the foot cannot be the toe as well."""
    bones = rig(UNREAL, ("l", "r"))
    segments = map_anatomy(bones, {"left foot": "ball_l"})
    assert len({s.bone for s in segments}) == len(segments)


def test_a_rig_in_the_artist_s_language_is_chosen_bone_by_bone() -> None:
    german = {"Foot": "Fuss", "Leg": "Schenkel", "Head": "Kopf"}
    old = rig(MOTION_BUILDER, WORDS)

    def translated(name: str) -> str:
        for english, word in german.items():
            name = word if name == english else name
            name = f"{name.removesuffix(english)}{word}" if name.endswith(f"t{english}") else name
        return name

    bones = skeleton(
        [(translated(b.name), translated(old[b.parent].name) if b.parent >= 0 else "") for b in old]
    )
    chosen = {"head": "Kopf"}
    for side in WORDS:
        chosen[f"{side.lower()} foot"] = f"{side}Fuss"
        chosen[f"{side.lower()} shank"] = f"{side}Schenkel"
    check_tree(bones, map_anatomy(bones, chosen))


def test_unknown_choices_are_refused() -> None:
    bones = rig(UNREAL, ("l", "r"))
    with pytest.raises(MissingPart) as caught:
        map_anatomy(bones, {"left foot": "foot.L"})
    assert caught.value.tried == ("foot.L",)
    for label in ("left tail", "left head", "foot", "spine"):  # no part, of no side, or of several
        with pytest.raises(MissingPart) as caught:
            map_anatomy(bones, {label: "foot_l"})
        assert caught.value.part == label
