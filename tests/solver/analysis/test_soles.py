"""Soles of a skin: they tell the floor, and how far heel and toe reach, whatever the bones say."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.solver.analysis.performance import Performance, contact_points, perform
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import build_character
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Recording, Skin
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.repair import placed_skin, unplaced, unplaced_skin
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.repairs import Repairs, UpAxis
from hangtime.tests.helpers.clips import JUMP, load_recording

BACK, FRONT = 0.06, 0.22  # m along the floor, from the ankle to the ends of a shoe
TOES = ("LeftToeBase", "RightToeBase")
NEAR = 0.005  # m; of a shoe's points 2 of 100 lie beyond its ends


@cache
def without_toes() -> Recording:
    """A jump on a figure whose feet have no toes, and whose foot bones point into the floor."""
    recording = load_recording(JUMP)
    kept = [i for i, bone in enumerate(recording.bones) if bone.name not in TOES]
    names = [bone.name for bone in recording.bones]
    bones = []
    for i in kept:
        bone = recording.bones[i]
        tail = bone.tail
        if bone.name in ("LeftFoot", "RightFoot"):
            tail = bone.head + np.array([0.0, 0.0, -0.2]) + 2.0 * (bone.tail - bone.head)
        parent = kept.index(bone.parent) if bone.parent >= 0 else -1
        bones.append(replace(bone, parent=parent, tail=tail))
    assert set(TOES) <= set(names)
    return replace(
        recording,
        bones=tuple(bones),
        heads=recording.heads[:, kept],
        rotations=recording.rotations[:, kept],
    )


def shod(recording: Recording) -> Performance:
    """The recording with shoes, which stand on the floor at 0 in its first frame."""
    character = build_character(recording)
    bare = perform(recording, character)
    points, owners = [], []
    chance = np.random.default_rng(3)
    for side in (Side.LEFT, Side.RIGHT):
        foot = character.body(Part.FOOT, side)
        assert foot is not None
        bone = recording.index(character.bodies[foot].bone)
        ankle, turn = bare.centres[0, foot], bare.rotations[0, foot]
        along = chance.uniform(-BACK, FRONT, 3000)
        aside, up = chance.uniform(-0.04, 0.04, 3000), chance.uniform(0.0, 0.1, 3000)
        up[:1000] = 0.0  # the sole
        ahead = ahead_of(recording, bone)
        placed = ankle * [1, 1, 0] + np.outer(along, ahead) + np.outer(up, [0.0, 0.0, 1.0])
        placed += np.outer(aside, np.cross([0.0, 0.0, 1.0], ahead))
        points.append((placed - ankle) @ turn + recording.bones[bone].head)
        owners.append(np.full(3000, bone))
    names = tuple(bone.name for bone in recording.bones)
    skin = Skin(("Shoes",), names, np.concatenate(points), np.concatenate(owners))
    return perform(recording, character, skin)


def ahead_of(recording: Recording, foot: int) -> FloatArray:
    """(3,) along the floor, where a foot of the jump's recording points in the first frame."""
    whole = load_recording(JUMP)
    name = recording.bones[foot].name
    toes = whole.heads[0, whole.index(name.replace("Foot", "ToeBase"))]
    ahead = (toes - whole.heads[0, whole.index(name)]) * [1, 1, 0]
    return np.asarray(ahead / np.linalg.norm(ahead))


@pytest.mark.parametrize("recording", [load_recording(JUMP), without_toes()], ids=["toes", "none"])
def test_soles_tell_floor_and_ends(recording: Recording) -> None:
    performance = shod(recording)
    points, floor = contact_points(performance)
    assert floor == 0.0
    for side in ("Left", "Right"):
        ankle = performance.recording.heads[0, recording.index(f"{side}Foot")]
        ahead = ahead_of(recording, recording.index(f"{side}Foot"))
        heel, toe = ((points[f"{side} {end}"].track[0] - ankle) @ ahead for end in ("heel", "toe"))
        assert -BACK < heel < -0.5 * BACK
        assert 0.75 * FRONT < toe < FRONT + NEAR


def test_bones_that_point_into_the_floor_do_not_lower_it() -> None:
    recording = without_toes()
    _, floor = contact_points(perform(recording, build_character(recording)))
    assert floor == 0.0


def test_floor_under_the_soles() -> None:
    stands, down = shod(without_toes()), np.array([0.0, 0.0, -0.3])
    sunk = replace(stands.recording, heads=stands.recording.heads + down)
    points, floor = contact_points(perform(sunk, stands.character, stands.skin))
    assert floor == pytest.approx(-0.3, abs=0.01)
    standing = points["Left heel"].track[0, 2]
    assert standing == pytest.approx(floor, abs=0.01)


@pytest.mark.slow
def test_the_doctor_has_a_figure_stand_on_its_soles() -> None:
    """Also one that was read in inches, with another axis up."""
    stands = shod(without_toes())
    read = Repairs(up=UpAxis.Y, scale=0.0254, floor=-0.3)
    skin = unplaced_skin(stands.skin, read)
    back = placed_skin(skin, read)
    assert stands.skin is not None
    assert back is not None
    assert back.points == pytest.approx(stands.skin.points)
    found = diagnose(unplaced(stands.recording, read), skin=skin)
    told = {finding.kind: finding.amount for finding in found.findings}
    assert {FindingKind.UP_AXIS, FindingKind.SIZE} <= set(told)
    assert told[FindingKind.FLOOR] == pytest.approx(-0.3, abs=0.02)


def test_other_skin_is_another_fit() -> None:
    skin = shod(without_toes()).skin
    assert skin is not None
    other = replace(skin, points=skin.points + 1e-3)
    one, same, another = (
        MotionProblem(skin=s).known_to_fit() for s in (skin, replace(skin), other)
    )
    assert one == same != another
