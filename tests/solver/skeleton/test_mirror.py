"""Mirrored recordings: the performer with left and right swapped, and what is asked of him."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hangtime.batch.cells.reading import read_clip
from hangtime.bridge.recipe.problem import parse_recipe, write_recipe
from hangtime.operators.words.messages import sentence
from hangtime.solver.data.faults import NotMirrored
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.skeleton.mirror import mirrored, other_side
from hangtime.solver.worker.pipeline import Subject, fit_subject, measure, solve
from hangtime.solver.worker.stage_clock import StageClock
from hangtime.tests.helpers.clips import mocap_path

FRAMES = (20.0, 190.0)
RECIPE = """
mirrored = {}
[[pin]]
name = "Landing"
phase = "ground 2"
points = ["Left heel", "Left toe"]
right = 0.05
[[pin]]
phase = "ground 2"
step = "Left heel 2"
[[contact]]
name = "Left toe 2"
start_frame = 100
"""


@pytest.fixture(scope="module")
def hop() -> Recording:
    return read_clip(Path(mocap_path("hop_01_01.bvh")), MotionProblem(frames=FRAMES)).recording


@pytest.fixture(scope="module")
def subjects(hop: Recording) -> tuple[Subject, Subject]:
    problem = MotionProblem(frames=FRAMES)
    return measure(hop, problem), measure(hop, replace(problem, mirrored=True))


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("LeftFoot", "RightFoot"),
        ("mixamorig:RightHandThumb1", "mixamorig:LeftHandThumb1"),
        ("thigh.L", "thigh.R"),
        ("Bip01 R Clavicle", "Bip01 L Clavicle"),
        ("lfemur", "rfemur"),
        ("upperarm_l", "upperarm_r"),
        ("Left heel 2", "Right heel 2"),
        ("Spine1", "Spine1"),
        ("Landing", "Landing"),
    ],
)
def test_names_of_the_other_side(name: str, other: str) -> None:
    assert other_side(name) == other
    assert other_side(other) == name


def test_mirrored_twice_is_the_clip(hop: Recording) -> None:
    for first in (None, 60.0):
        once = mirrored(hop, first)
        twice = mirrored(once, first)
        assert np.abs(once.heads - hop.heads).max() > 0.05
        np.testing.assert_allclose(twice.heads, hop.heads, atol=1e-12)
        np.testing.assert_allclose(twice.rotations, hop.rotations, atol=1e-12)
        for bone, again in zip(hop.bones, twice.bones, strict=True):
            np.testing.assert_allclose(again.head, bone.head, atol=1e-12)
            np.testing.assert_allclose(again.tail, bone.tail, atol=1e-12)


def test_acclaims_names_have_partners_too(hop: Recording) -> None:
    """CMU's .asf calls them "lhipjoint" and "lthumb", which tell no part of the body."""
    low = {"LHipJoint": "lhipjoint", "RHipJoint": "rhipjoint", "LThumb": "lthumb"}
    low |= {"RThumb": "rthumb"}
    bones = tuple(replace(bone, name=low.get(bone.name, bone.name)) for bone in hop.bones)
    assert {bone.name for bone in bones} >= {"lhipjoint", "rhipjoint"}
    now = mirrored(replace(hop, bones=bones))
    np.testing.assert_array_equal(now.heads, mirrored(hop).heads)


def test_a_mirrored_figure_hangs_together_as_its_rest_does(hop: Recording) -> None:
    """Bones of the mirrored skeleton keep their lengths in every frame, and left is left."""
    other = mirrored(hop)
    assert np.linalg.det(other.rotations) == pytest.approx(1.0)
    for i, bone in enumerate(other.bones):
        if bone.parent >= 0:
            parent = other.bones[bone.parent]
            rest = (bone.head - parent.head) @ parent.rotation
            apart = (other.heads[:, i] - other.heads[:, bone.parent])[:, None]
            now = (apart @ other.rotations[:, bone.parent])[:, 0]
            np.testing.assert_allclose(now, np.tile(rest, (len(now), 1)), atol=1e-4)
    left, right = hop.index("LeftFoot"), hop.index("RightFoot")
    across = hop.heads[0, left] - hop.heads[0, right]
    assert across @ (other.heads[0, left] - other.heads[0, right]) > 0.9 * across @ across
    np.testing.assert_allclose(other.heads[:, left, 2], hop.heads[:, right, 2], atol=1e-12)


@pytest.mark.slow  # it fits
def test_contacts_are_the_other_sides_and_forces_too(subjects: tuple[Subject, Subject]) -> None:
    plain, other = subjects
    was = {c.name: (c.start, c.end) for c in plain.schedule.contacts}
    now = {other_side(c.name): (c.start, c.end) for c in other.schedule.contacts}
    assert now.keys() == was.keys()
    for name, times in was.items():
        assert now[name] == pytest.approx(times, abs=0.002)
    fits = [fit_subject(subject, StageClock()).motion for subject in subjects]
    times = np.linspace(0.02, fits[0].duration - 0.02, 200)
    forces = [motion.forces(times) for motion in fits]
    places = [{c.contact.point: c.point for c in motion.transcription.contacts} for motion in fits]
    weight = forces[0].sum(axis=1)[:, 2].mean()
    # Times may be 2 ms apart, in which a force rises by a tenth of the weight or more.
    for name, point in places[0].items():
        mine, theirs = forces[0][:, point, 2], forces[1][:, places[1][other_side(name)], 2]
        assert np.abs(mine - theirs).max() < 0.15 * weight
        assert np.abs(mine - forces[1][:, places[1][name], 2]).max() > 0.1 * weight


def test_a_recipe_names_what_was_recorded_and_right_is_where_the_artist_says() -> None:
    plain, other = (parse_recipe(RECIPE.format(word)).problem for word in ("false", "true"))
    assert plain.pins[0].touching == ("Left heel", "Left toe")
    assert other.pins[0].touching == ("Right heel", "Right toe")
    assert (plain.pins[1].step, other.pins[1].step) == ("Left heel 2", "Right heel 2")
    assert other.contacts[0].name == "Right toe 2"
    assert other.pins[0].offset == plain.pins[0].offset == (0.0, -0.05, 0.0)
    assert parse_recipe(write_recipe(other)).problem == other


@pytest.mark.slow  # it fits
def test_a_mirrored_landing_goes_to_the_right_as_the_recorded_one_does(hop: Recording) -> None:
    recipe = 'frames = [20, 190]\nmirrored = {}\n[[pin]]\nphase = "ground 2"\nright = 0.05\n'
    for word in ("false", "true"):
        problem = parse_recipe(recipe.format(word)).problem
        result = solve(measure(hop, problem), StageClock())
        assert result.fault is None
        setup = result.adaptation.setup
        fitted, placed = setup.fitted.places, result.adaptation.motion.places
        moved = (np.array(placed) - np.array(fitted))[-1]
        ahead = np.array(placed)[-4:].mean(axis=0) - np.array(placed)[:4].mean(axis=0)
        assert np.cross(ahead, moved)[2] < 0.0  # to the right of where the hop goes


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "LeftFoot",
            "Fuss links",
            "“Fuss links” is on one side of the body, which its name does not tell",
        ),
        ("RightHand", "RightPaw", "cannot be mirrored: “LeftHand” has no “RightHand”"),
    ],
)
def test_a_clip_without_matching_names_is_told(
    hop: Recording, old: str, new: str, said: str
) -> None:
    bones = tuple(replace(b, name=new) if b.name == old else b for b in hop.bones)
    with pytest.raises(NotMirrored) as raised:
        mirrored(replace(hop, bones=bones))
    assert said in sentence(raised.value)


def test_a_clip_without_sides_in_its_names_is_told(hop: Recording) -> None:
    bones = tuple(replace(b, name=f"bone {i}") for i, b in enumerate(hop.bones))
    with pytest.raises(NotMirrored) as raised:
        mirrored(replace(hop, bones=bones))
    assert "no bone's name tells its side" in sentence(raised.value)
