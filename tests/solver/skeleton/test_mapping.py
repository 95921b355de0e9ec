"""Skeletons of all conventions, and of none, are mapped by themselves."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.rigs.actor import JOINTS, actor
from hangtime.devtools.rigs.controls.rest import at_rest
from hangtime.devtools.rigs.layout import Layout, layouts
from hangtime.devtools.rigs.rest import rest_bones
from hangtime.solver.body.anatomy import map_anatomy
from hangtime.solver.data.faults import BoneTaken, MissingPart, NoSpine, NotJoined
from hangtime.solver.data.recording import Bone
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.skeleton.conventions import conventions
from hangtime.solver.skeleton.mapping import Evidence, guess_bones, guess_labels
from hangtime.solver.skeleton.names import side_of
from hangtime.solver.skeleton.parts import ARM, LEG, SIDES, Part, Side
from hangtime.solver.skeleton.tree import tree_of

RIGS = {layout.key: layout for layout in layouts()}
KNOWN = [key for key, layout in RIGS.items() if not layout.unknown]
UNKNOWN = [key for key, layout in RIGS.items() if layout.unknown]


def right(layout: Layout) -> dict[str, str]:
    """The bone of every part but spine and neck, by label."""
    parts = layout.parts
    middle = {"pelvis": parts["pelvis"], "head": parts["head"]}
    sided = {
        f"{side.value} {part.value}": parts[f"{part.value.replace(' ', '_')}.{side.value[0]}"]
        for side in SIDES
        for part in (*ARM, *LEG)
    }
    return middle | sided


def found(bones: Iterable[Bone]) -> dict[str, str]:
    return {label: guess[0] for label, guess in guess_labels(tuple(bones)).items() if guess}


def nameless(bones: Iterable[Bone]) -> tuple[Bone, ...]:
    return tuple(replace(bone, name=f"x{i}") for i, bone in enumerate(bones))


@pytest.mark.parametrize("key", RIGS)
def test_every_part_is_found(key: str) -> None:
    assert found(rest_bones(RIGS[key], actor())) == right(RIGS[key])


@pytest.mark.parametrize("key", KNOWN)
def test_conventions_are_recognised(key: str) -> None:
    guess = guess_bones(tree_of(rest_bones(RIGS[key], actor())))
    assert guess.convention == RIGS[key].name
    assert Evidence.DISPUTED not in guess.evidence.values()


def test_unreal_5_is_told_by_its_spine_and_neck_without_a_metahumans_face() -> None:
    """Manny's skeleton as it is exported without corrective bones."""
    whole = rest_bones(RIGS["metahuman"], actor())
    bones = [replace(b, name="ik_foot_root" if "FACIAL" in b.name else b.name) for b in whole]
    bones = [replace(b, name=b.name.replace("correctiveRoot", "bulge")) for b in bones]
    assert guess_bones(tree_of(bones)).convention == "Unreal 5 (Manny, MetaHuman)"


@pytest.mark.parametrize("key", ["rigify", "mixamo"])
def test_a_copy_whose_names_end_alike_is_of_its_convention(key: str) -> None:
    """Blender gives another number to names that end in one, as Rigify's spine."""
    numbers = {"spine": "spine.007"}
    names = {b.name: numbers.get(b.name, f"{b.name}.001") for b in rest_bones(RIGS[key], actor())}
    bones = [replace(b, name=names[b.name]) for b in rest_bones(RIGS[key], actor())]
    assert found(bones) == {label: names[bone] for label, bone in right(RIGS[key]).items()}
    assert guess_bones(tree_of(bones)).convention == RIGS[key].name


def test_there_is_a_rig_of_every_convention_asked_for() -> None:
    tables = {convention.name for convention in conventions()}
    assert {RIGS[key].name for key in KNOWN} <= tables
    assert len(KNOWN) == 14


def test_of_a_rig_with_controls_the_bones_are_found_that_the_limbs_follow() -> None:
    """Auto-Rig Pro's: its forearms, shanks and hands hang on the root's control."""
    performer = actor()
    rest = at_rest(performer)
    bones = rest.bones(performer)
    assert found(bones) == right(rest.layout)
    assert guess_bones(tree_of(bones)).convention == "Auto-Rig Pro"
    segments = [bones[segment.bone].name for segment in map_anatomy(bones)]
    assert set(segments) == set(rest.layout.parts.values())
    tree = tree_of(bones)
    index = {bone.name: i for i, bone in enumerate(bones)}
    for joint, name in rest.layout.parts.items():
        above = tree.parents[index[name]]
        parent = performer.parents[JOINTS.index(joint)]
        wanted = rest.layout.parts[JOINTS[parent]] if parent >= 0 else None
        assert (bones[above].name if above >= 0 else None) == wanted


@pytest.mark.parametrize("key", UNKNOWN)
def test_unknown_names_are_told_by_the_shape(key: str) -> None:
    guess = guess_bones(tree_of(rest_bones(RIGS[key], actor())))
    assert guess.convention == ""
    limbs = [e for (part, _), e in guess.evidence.items() if part in (Part.THIGH, Part.FOREARM)]
    assert set(limbs) == {Evidence.SHAPE}


@pytest.mark.parametrize("key", ["mixamo", "unreal", "xsens", "daz", "auto_rig_pro", "unity"])
def test_the_shape_alone_tells_the_limbs_of_a_convention_without_its_names(key: str) -> None:
    bones = rest_bones(RIGS[key], actor())
    names = {b.name: f"x{i}" for i, b in enumerate(bones)}
    wanted = {label: names[bone] for label, bone in right(RIGS[key]).items()}
    mine = found(nameless(bones))
    needed = [label for label in wanted if not label.endswith(("toe", "hand", "clavicle"))]
    assert {label: mine.get(label) for label in needed} == {k: wanted[k] for k in needed}


def test_a_lying_skeleton_of_another_size_is_told_as_well() -> None:
    turn = axis_rotation(0, np.array([1.3]))[0] @ axis_rotation(2, np.array([0.7]))[0]
    bones = nameless(rest_bones(RIGS["gibberish"], actor()))
    turned = [replace(b, head=40.0 * turn @ b.head, tail=40.0 * turn @ b.tail) for b in bones]
    assert found(turned) == found(bones)


def test_without_clavicles_toes_and_hands_the_rest_is_found() -> None:
    gone = ("k", "y", "p")  # the gibberish rig's
    whole = rest_bones(RIGS["gibberish"], actor())
    keep = [i for i, bone in enumerate(whole) if not bone.name.startswith(gone)]
    index = {old: new for new, old in enumerate(keep)}

    def above(bone: Bone) -> int:
        parent = bone.parent
        while parent >= 0 and parent not in index:
            parent = whole[parent].parent
        return index.get(parent, -1)

    bones = [replace(whole[i], parent=above(whole[i])) for i in keep]
    wanted = {
        label: bone for label, bone in right(RIGS["gibberish"]).items() if bone[0] not in gone
    }
    wanted_limbs = {k: b for k, b in wanted.items() if not k.endswith("forearm")}
    mine = found(bones)
    assert {k: mine.get(k) for k in wanted_limbs} == wanted_limbs


JOINTS_BY_NAME = {
    "upper_arm": "{s}_Shoulder",
    "forearm": "{s}_Elbow",
    "hand": "{s}_Wrist",
    "thigh": "{s}_Hip",
    "shank": "{s}_Knee",
    "foot": "{s}_Ankle",
}
SEGMENTS_BY_NAME = {
    "clavicle": "clavicle_{s}",
    "upper_arm": "upperarm_{s}",
    "forearm": "lowerarm_{s}",
    "hand": "hand_{s}",
    "thigh": "thigh_{s}",
    "shank": "calf_{s}",
    "foot": "foot_{s}",
}
MIXTURES = {
    "toes by another name than Unreal's": SEGMENTS_BY_NAME | {"toe": "toes_{s}"},
    "clavicles and toes by other names than SMPL's": JOINTS_BY_NAME
    | {"clavicle": "{s}_Clavicle", "toe": "{s}_Ball"},
    "a foot below an ankle": {"foot": "Ankle.{s}", "toe": "Foot.{s}"},
    "a shoulder above an arm of an unknown name": {"clavicle": "Shoulder.{s}"},
}


@pytest.mark.parametrize("words", MIXTURES.values(), ids=list(MIXTURES))
def test_names_of_several_kinds_are_told_together(words: dict[str, str]) -> None:
    """On a rig whose other bones have no words."""
    layout = RIGS["gibberish"]
    names = {layout.parts["pelvis"]: "pelvis", layout.parts["head"]: "head"}
    for joint, bone in layout.parts.items():
        part, _, side = joint.partition(".")
        names.setdefault(bone, words.get(part, bone).format(s=side.upper()))
    bones = [replace(b, name=names.get(b.name, b.name)) for b in rest_bones(layout, actor())]
    assert found(bones) == {label: names[bone] for label, bone in right(layout).items()}


def test_source_s_names_are_biped_s() -> None:
    layout = RIGS["gibberish"]
    ends = {"pelvis": "Pelvis", "head": "Head1", "upper_arm": "UpperArm", "forearm": "Forearm"}
    ends |= {part: part.capitalize() for part in ("clavicle", "hand", "thigh", "foot")}
    ends |= {"shank": "Calf", "toe": "Toe0"}
    names = {}
    for joint, bone in layout.parts.items():
        part, _, side = joint.partition(".")
        if part in ends:
            names[bone] = "ValveBiped.Bip01_" + (f"{side.upper()}_" if side else "") + ends[part]
    bones = [replace(b, name=names.get(b.name, b.name)) for b in rest_bones(layout, actor())]
    assert found(bones) == {label: names[bone] for label, bone in right(layout).items()}
    assert guess_bones(tree_of(bones)).convention == "Biped"


def test_what_one_hand_holds_is_no_part_of_an_arm() -> None:
    bones = list(rest_bones(RIGS["gibberish"], actor()))
    hand = next(i for i, bone in enumerate(bones) if bone.name == RIGS["gibberish"].parts["hand.r"])
    alone = found(bones)
    for name, ahead in (("grip", 0.1), ("barrel", 0.4), ("muzzle", 0.8)):
        at = bones[hand].head - [0.0, ahead, 0.0]
        above = hand if name == "grip" else len(bones) - 1
        bones.append(Bone(name, above, at, at - [0.0, 0.1, 0.0], np.eye(3)))
    assert found(bones) == alone == right(RIGS["gibberish"])


def test_rigify_s_deform_bones_hang_together_across_families() -> None:
    """As Rigify generates them: DEF-thigh.L is below ORG-spine, which DEF-spine stands for."""
    bones = []
    for bone in rest_bones(RIGS["rigify"], actor()):
        parent = bone.parent
        bones.append(
            replace(bone, name=f"ORG-{bone.name}", parent=2 * parent if parent >= 0 else -1)
        )
        bones.append(replace(bone, name=f"DEF-{bone.name}", parent=2 * parent))
    bones = [*bones, replace(bones[0], name="head", parent=-1)]  # a control of a part's name
    segments = map_anatomy(bones)
    assert {bones[s.bone].name[:4] for s in segments} == {"DEF-"}
    tree = tree_of(bones)
    names = [bone.name for bone in bones]
    assert tree.parents[names.index("DEF-thigh.L")] == names.index("DEF-spine")


def test_legs_that_hang_on_another_root_are_told() -> None:
    bones = [
        replace(b, parent=-1) if b.name.endswith("UpLeg") else b
        for b in rest_bones(RIGS["mixamo"], actor())
    ]
    with pytest.raises(NotJoined) as caught:
        map_anatomy(bones)
    assert caught.value.bones[0] == "mixamorig:LeftUpLeg"


def test_what_is_no_humanoid_names_what_is_missing() -> None:
    bones = [b for b in rest_bones(RIGS["gibberish"], actor()) if b.name[0] in "xqw"]
    with pytest.raises(MissingPart):
        map_anatomy(bones)


@pytest.mark.parametrize("head", [{}, {"head": "mixamorig:Head"}])
def test_a_bone_that_was_chosen_for_another_part_is_told(head: dict[str, str]) -> None:
    bones = rest_bones(RIGS["mixamo"], actor())
    with pytest.raises(BoneTaken) as caught:
        map_anatomy(bones, {"left foot": "mixamorig:Head"} | head)
    told = {caught.value.part, caught.value.by}
    assert (told, caught.value.bone) == ({"head", "left foot"}, "mixamorig:Head")


def test_a_hand_is_no_head() -> None:
    with pytest.raises(NoSpine):
        map_anatomy(rest_bones(RIGS["mixamo"], actor()), {"head": "mixamorig:LeftHand"})


@pytest.mark.parametrize(
    ("name", "side"),
    [
        ("左足首", Side.LEFT),
        ("Oberarm_links", Side.LEFT),
        ("brazo_izq", Side.LEFT),
        ("bras_droit", Side.RIGHT),
        ("手_右", Side.RIGHT),
        ("Becken", Side.MIDDLE),
    ],
)
def test_sides_in_other_languages(name: str, side: Side) -> None:
    assert side_of(name) is side
