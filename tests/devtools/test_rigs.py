"""The rigs' layouts, the comparison and the verdicts."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.devtools.rigs.actor import JOINTS, actor
from hangtime.devtools.rigs.controlled import ControlResult, Worst, control_figures
from hangtime.devtools.rigs.layout import Layout, layouts
from hangtime.devtools.rigs.limits import figures
from hangtime.devtools.rigs.main import CONTROLS
from hangtime.devtools.rigs.recorded import recorded
from hangtime.devtools.rigs.rest import rest_bones
from hangtime.devtools.rigs.result import Edited, FileResult, RigResult, compared
from hangtime.devtools.rigs.table import page
from hangtime.solver.analysis.performance import Performance, contact_points, perform
from hangtime.solver.body.anatomy import Part
from hangtime.solver.body.character import Body, build_character

GOOD = RigResult("mixamo", "Mixamo", False, 40, "Mixamo", difference_mm=1.0, solved=True)


def test_every_rig_has_each_joint_once_and_where_the_actor_has_it() -> None:
    performer = actor()
    for layout in layouts():
        assert set(layout.parts) == set(JOINTS), layout.key
        if not layout.lowered:
            heads = {bone.name: bone.head for bone in rest_bones(layout, performer)}
            for joint, bone in layout.parts.items():
                assert heads[bone] == pytest.approx(performer.at(joint), abs=1e-12)


@cache
def performed(key: str) -> Performance:
    recording = recorded(next(each for each in layouts() if each.key == key), actor())
    return perform(recording, build_character(recording))


def by_part(performance: Performance) -> dict[tuple[str, str, int], tuple[int, Body]]:
    """Index and body, by part, side and place along it."""
    found: dict[tuple[str, str, int], tuple[int, Body]] = {}
    for i, body in enumerate(performance.character.bodies):
        key = body.part.value, body.side.value
        found[*key, sum(known[:2] == key for known in found)] = i, body
    return found


@pytest.mark.slow
@pytest.mark.parametrize("layout", layouts(), ids=lambda layout: layout.key)
def test_the_performer_has_the_same_body_on_every_rig(layout: Layout) -> None:
    """However a rig cuts spine and neck, rolls its bones, rests its arms and ends its hands."""
    one = performed("cmu")
    other = performed(layout.key)
    bodies, others = by_part(one), by_part(other)
    assert set(others) == set(bodies)
    for key, (i, body) in bodies.items():
        j, same = others[key]
        axes, again = one.character.joints[i].axes, other.character.joints[j].axes
        assert again.dofs == axes.dofs, key
        if body.part not in (Part.FOOT, Part.TOE, Part.NECK, Part.HEAD):  # which not all tell
            turned, back = (p.rotations[:, k] for p, k in ((one, i), (other, j)))
            assert same.mass == pytest.approx(body.mass, rel=1e-6), key
            inertia = back @ same.inertia @ np.swapaxes(back, 1, 2)
            mine = turned @ body.inertia @ np.swapaxes(turned, 1, 2)
            assert inertia == pytest.approx(mine, abs=0.03 * float(mine.max())), key
    points, again_points = contact_points(one)[0], contact_points(other)[0]
    for name in ("Left heel", "Right toe"):
        apart = np.linalg.norm(again_points[name].track - points[name].track, axis=1)
        assert apart.max() < (1e-9 if name == "Left heel" else 2e-3), name


def test_a_limit_on_a_bone_without_a_joint_is_one_on_that_it_moves_with() -> None:
    character = performed("metahuman").character
    assert dict(character.joined) == {
        "spine_05": "spine_04",
        "spine_02": "spine_01",
        "neck_02": "neck_01",
    }
    assert character.bodies[character.moved_by("Limit", "spine_05")].bone == "spine_04"


def test_the_largest_difference_is_found_at_frames_of_both() -> None:
    centres = np.zeros((4, 2, 3))
    one = Edited(np.arange(4.0), centres, True)
    other = Edited(np.arange(1.0, 5.0), centres.copy(), True)
    other.centres[1, 1] = [0.0, 0.003, 0.004]
    assert compared(other, one, ("a", "b")) == (pytest.approx(5.0), "b", 2.0)


def test_a_rig_that_is_mapped_wrongly_misses_the_limit_by_name() -> None:
    bad = replace(GOOD, name="Unreal", wrong=("left toe: none",))
    counted = figures([GOOD, bad])[0]
    assert (counted.value, counted.ok, counted.where) == (1, False, "Unreal")
    assert "left toe: none" in page([GOOD, bad], [], figures([GOOD, bad]), 1.0)


def test_a_skeleton_of_unknown_names_that_is_mapped_wrongly_misses_the_limit() -> None:
    strange = replace(GOOD, name="Greek words", unknown=True)
    counted = figures([GOOD, strange, replace(strange, name="Welsh", wrong=("head: none",))])[1]
    assert (counted.value, counted.must, counted.ok, counted.where) == (1, 2, False, "Welsh")


def test_a_difference_beyond_the_limit_is_told_with_its_place() -> None:
    far = replace(GOOD, name="Daz", difference_mm=12.0, joint="foot.l", frame=99.0)
    worst = figures([GOOD, far])[2]
    assert not worst.ok
    assert worst.where == "Daz: foot.l, frame 99"


def test_a_file_that_loses_more_than_it_may_is_told_with_its_format() -> None:
    bad = replace(GOOD, name="VRM", files=(FileResult("FBX", 0.01, 0.3), FileResult("glTF", 2, 0)))
    found = {figure.name: figure for figure in figures([GOOD, bad])}
    place, turn = (figure for name, figure in found.items() if name.startswith("file"))
    assert (place.ok, place.where) == (False, "VRM, glTF")
    assert (turn.ok, turn.where) == (False, "VRM, FBX")


def on_controls(key: str) -> ControlResult:
    slight = Worst(0.01, "foot.l", 3.0)
    return ControlResult(key, key, 100, True, slight, slight, slight, slight)


def test_a_control_rig_that_is_refused_is_a_miss_that_says_why() -> None:
    nothing = dict.fromkeys(("off", "turned", "skin", "drift"))
    refused = replace(on_controls("arp_ik"), **nothing, refused="In IK.")
    results = [*map(on_controls, CONTROLS[1:]), refused]
    written = control_figures(results)[1]
    assert (written.value, written.must, written.ok) == (3, 4, False)
    assert written.where == "arp_ik"
    assert "| **refused** | In IK. |" in page([GOOD], results, figures([GOOD]), 1.0)


def test_a_bone_off_the_solution_is_told_with_its_rig_bone_and_frame() -> None:
    far = replace(on_controls("arp_fk"), off=Worst(50.0, "hand.r", 7.0))
    off = control_figures([on_controls("rigify_fk"), far])[2]
    assert (off.value, off.ok, off.where) == (50.0, False, "arp_fk: hand.r, frame 7")
