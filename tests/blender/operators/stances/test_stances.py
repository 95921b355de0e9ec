"""Contacts are moved one by one, with their stance, or by an empty; and become pins."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.constraints.leaps import leaps_of
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.bridge.properties.stances import moving_with
from hangtime.operators.headless.doubts import doubts_about
from hangtime.operators.solve.adapt import window_doubts
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.faults import BeyondPrecision
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.worker.pipeline import measure, unfitted
from hangtime.solver.worker.possible import check_requested
from hangtime.tests.blender.helpers.jump_scene import FIRST, LAST, drift, landing, pins
from hangtime.tests.blender.helpers.solids import make_box

AT = "found_at", "at"

pytestmark = pytest.mark.usefixtures("_enabled")


def test_a_contact_takes_its_stance_along(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    moved = landing(settings)[0]
    moved.place = np.add(moved.found_at, (0.1, -0.2, 0.3))
    for row in settings.contacts:
        shift = np.subtract(row.place, row.found_at)
        wanted = (0.1, -0.2, 0.3) if row.phase == "ground 2" else (0.0, 0.0, 0.0)
        np.testing.assert_allclose(shift, wanted, atol=1e-6)
    stance = settings.stances["ground 2"]
    forward = np.array(stance.forward_axis)
    axes = [forward, np.cross([0, 0, 1], forward), [0, 0, 1]]
    np.testing.assert_allclose(stance.shifted, np.dot(axes, [0.1, -0.2, 0.3]), atol=1e-6)
    assert stance.turn == pytest.approx(0.0, abs=1e-6)


def test_a_shift_is_told_in_millimetres_and_kept_exactly(analysed: bpy.types.Object) -> None:
    stance = analysed.hangtime.stances["ground 2"]
    stance.forward, stance.left, stance.up = wanted = (0.3667291, 0.0047641, -0.0001249)
    assert (stance.forward, stance.left, stance.up) == pytest.approx((0.367, 0.005, 0.0), abs=1e-7)
    np.testing.assert_allclose(stance.shifted, wanted, atol=1e-7)


def test_a_contact_moves_alone_where_that_is_wished(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    settings.whole_stance = False
    moved, *others = landing(settings)
    moved.place = np.add(moved.found_at, (0.0, 0.0, 0.1))
    assert all(tuple(row.place) == tuple(row.found_at) for row in others)


def test_in_a_walk_a_contact_takes_its_foot_along_and_the_stance_where_that_is_wished(
    analysed: bpy.types.Object,
) -> None:
    settings = analysed.hangtime
    heel, toe = (settings.contacts[f"Left {point} 2"] for point in ("heel", "toe"))

    def going() -> set[str]:
        for row in settings.contacts:
            row.at = row.found_at
        heel.place = np.add(heel.found_at, (0.0, 0.0, 0.1))
        return {row.name for row in settings.contacts if row.at[2] > row.found_at[2] + 0.05}

    assert settings.moves == "AUTO"
    stance = {row.name for row in landing(settings)}
    assert going() == stance > {heel.name, toe.name}
    for row in settings.contacts:  # as if nothing had flown
        row.phase = heel.phase
    for moves, names in (
        ("AUTO", {heel.name, toe.name}),
        ("FOOT", {heel.name, toe.name}),
        ("STANCE", set(settings.contacts.keys())),
        ("CONTACT", {heel.name}),
    ):
        settings.moves = moves
        assert (settings.moves, going()) == (moves, names)


def test_a_landing_goes_as_a_whole_also_where_the_jumper_walks_on(
    analysed: bpy.types.Object,
) -> None:
    settings = analysed.hangtime
    heel, step = settings.contacts["Left heel 2"], settings.contacts["Right heel 1"]
    middle = 0.5 * (heel.start_frame + heel.end_frame)
    for point in ("heel", "toe"):  # the right foot comes down again
        stood, again = (settings.contacts[f"Right {point} {count}"] for count in (2, 1))
        again.phase, again.start_frame, again.end_frame = heel.phase, middle + 9.0, stood.end_frame
        stood.end_frame = middle

    def going(row) -> set[str]:
        return {each.name for each in moving_with(settings, row)}

    assert going(heel) == {row.name for row in landing(settings)} > {"Right heel 1"}
    assert going(step) == {"Right heel 1", "Right toe 1"}


def test_scripts_of_earlier_versions_move_what_they_did(analysed: bpy.types.Object) -> None:
    for whole, moves in ((False, "CONTACT"), (True, "STANCE")):
        analysed.hangtime.whole_stance = whole
        assert analysed.hangtime.moves == moves


def test_a_stance_turns_about_its_middle(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    stance, rows = settings.stances["ground 2"], landing(settings)
    stance.turn = np.pi / 2
    was = np.array([row.found_at for row in rows])
    now = np.array([row.place for row in rows])
    x, y, z = (was - was.mean(axis=0)).T
    np.testing.assert_allclose(now - now.mean(axis=0), np.stack([-y, x, z], axis=1), atol=1e-6)
    np.testing.assert_allclose(now.mean(axis=0), was.mean(axis=0), atol=1e-6)
    assert bpy.ops.hangtime.put_back.poll()
    settings.active_contact = settings.contacts.find(rows[0].name)
    assert bpy.ops.hangtime.put_back() == {"FINISHED"}
    assert stance.turn == 0.0
    assert all(tuple(row.place) == tuple(row.found_at) for row in rows)


def test_a_landing_out_of_reach_is_told_as_the_command_line_tells_it(
    analysed: bpy.types.Object,
) -> None:
    settings = analysed.hangtime
    recording = read_recorded(analysed, first=FIRST, last=LAST)
    (usual,) = leaps_of(settings, recording, 1.0)
    settings.stances["ground 2"].up = 3.0
    settings.stances["ground 2"].turn = np.radians(720.0)
    (leap,) = leaps_of(settings, recording, 1.0)
    assert leap.asked[2] == pytest.approx(usual.recorded[2] + 3.0, abs=1e-5)
    problem = problem_of(settings, recording)
    told = window_doubts(settings, recording, problem)
    assert "turn ground 2 by 720°" in told[0]
    assert "ground 2 would be 3.0" in told[1]
    subject = measure(recording, problem)
    assert set(told[:2]) <= set(doubts_about(problem, None, subject, Origin("jump.bvh")))


@pytest.mark.parametrize("degrees", [270.0, 360.0])
def test_a_stance_turns_as_far_and_the_same_way_round_as_a_recipe_says(
    analysed: bpy.types.Object, degrees: float
) -> None:
    """Places alone do not tell 270° from a quarter to the other side, nor 360° from nothing."""
    settings = analysed.hangtime
    settings.stances["ground 2"].turn = np.radians(degrees)
    settings.stances["ground 2"].forward = 0.0
    found = list(pins(analysed).values())
    assert {pin.phase for pin in found} == {"ground 2"}
    assert len(found) == len(landing(settings))
    np.testing.assert_allclose([np.degrees(pin.turn) for pin in found], degrees, atol=1e-4)


def test_a_whole_turn_outlasts_another_analysis(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    settings.stances["ground 2"].turn = 2 * np.pi
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert settings.stances["ground 2"].turn == pytest.approx(2 * np.pi)
    assert settings.stances["ground 1"].turn == 0.0
    assert bpy.ops.hangtime.put_back() == {"FINISHED"}
    assert pins(analysed) == {}


@pytest.mark.parametrize("number", [float("nan"), float("inf")])
def test_a_place_that_is_no_number_is_refused_and_put_back(
    analysed: bpy.types.Object, number: float, capfd: pytest.CaptureFixture[str]
) -> None:
    """As a script sets it; it passed for a landing that nobody had moved."""
    settings = analysed.hangtime
    settings.stances["ground 2"].forward = number
    with pytest.raises(RuntimeError, match="toe 2” has a place or a frame that is no number"):
        bpy.ops.hangtime.adapt()
    settings.active_contact = settings.contacts.find(landing(settings)[0].name)
    assert bpy.ops.hangtime.put_back() == {"FINISHED"}
    assert pins(analysed) == {}
    landing(settings)[0].place = (number, 0.0, 0.0)
    with pytest.raises(RuntimeError, match=r"that is no number|too coarse for contacts"):
        bpy.ops.hangtime.adapt()
    assert bpy.ops.hangtime.put_back() == {"FINISHED"}
    assert pins(analysed) == {}
    assert "Traceback" not in capfd.readouterr().err
    landing(settings)[0].end_frame = float("nan")
    with pytest.raises(RuntimeError, match="has a place or a frame that is no number"):
        bpy.ops.hangtime.adapt()


def add_to_landing(settings: bpy.types.PropertyGroup, point: str) -> bpy.types.PropertyGroup:
    bpy.context.scene.frame_set(round(landing(settings)[0].start_frame) + 2)
    assert bpy.ops.hangtime.add_contact(point=point) == {"FINISHED"}
    return settings.contacts[settings.active_contact]


@pytest.mark.parametrize("degrees", [-165.0, 145.0, -270.0])
def test_another_analysis_turns_a_stance_no_further(
    analysed: bpy.types.Object, degrees: float
) -> None:
    """Contacts are put back one by one, and half moved they told another winding."""
    stance = analysed.hangtime.stances["ground 2"]
    stance.turn, stance.left = np.radians(degrees), 0.3
    bpy.ops.hangtime.analyze()
    assert np.degrees(stance.turn) == pytest.approx(degrees, abs=1e-3)
    assert {round(np.degrees(pin.turn), 2) for pin in pins(analysed).values()} == {degrees}


def test_contacts_that_are_moved_one_by_one_wind_nothing(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    settings.moves = "CONTACT"
    moving = landing(settings)
    for order in permutations(range(len(moving))):
        for at in order:
            moving[at].place = np.add(moving[at].found_at, (0.5, 0.0, 0.0))
        assert settings.stances["ground 2"].turn == pytest.approx(0.0, abs=1e-4)
        for at in order:
            moving[at].place = moving[at].found_at


def test_contacts_that_do_not_count_tell_no_turn(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    settings.moves = "CONTACT"
    heel, *others = landing(settings)
    for row in others:
        row.used = False
    heel.place = np.add(heel.found_at, (0.2, 0.3, 0.0))
    assert settings.stances["ground 2"].turn == pytest.approx(0.0, abs=1e-6)


def test_a_contact_that_is_added_goes_where_its_stance_was_moved_and_turned(
    analysed: bpy.types.Object,
) -> None:
    """The stance's move, which was an average with the new one's none, stays as it was set."""
    settings, crate = analysed.hangtime, make_box("Crate")
    stance = settings.stances["ground 2"]
    stance.forward, stance.up, stance.turn = 0.3, 0.2, np.pi / 2
    was = (*stance.shifted, stance.turned)
    for row in landing(settings):
        row.on = crate
    added = add_to_landing(settings, "Left hand")
    stance = settings.stances["ground 2"]
    assert (*stance.shifted, stance.turned) == was
    assert added.on == crate
    found = next(row for row in landing(settings) if not row.added)
    before, after = (np.subtract(getattr(added, at), getattr(found, at)) for at in AT)
    np.testing.assert_allclose(after, (-before[1], before[0], before[2]), atol=1e-5)
    found.place = np.add(found.place, (0.0, 0.0, 0.1))  # the whole stance's
    assert stance.up == pytest.approx(0.3, abs=1e-5)
    assert bpy.ops.hangtime.remove_contact() == {"FINISHED"}
    stance = settings.stances["ground 2"]
    stance.left += 0.1
    np.testing.assert_allclose(stance.shifted, np.add(was[:3], (0.0, 0.1, 0.1)), atol=1e-5)


def test_a_contact_goes_where_those_went_that_the_artist_made_the_stance_of(
    analysed: bpy.types.Object,
) -> None:
    settings = analysed.hangtime
    add_to_landing(settings, "Left hand")
    for name in [row.name for row in landing(settings) if not row.added]:
        settings.contacts.remove(settings.contacts.find(name))
    settings.stances["ground 2"].forward = 0.5
    first, second = landing(settings)[0], add_to_landing(settings, "Right hand")
    moves = [np.subtract(row.at, row.found_at) for row in (first, second)]
    np.testing.assert_allclose(moves[1], moves[0], atol=1e-6)
    assert np.linalg.norm(moves[0]) == pytest.approx(0.5, abs=1e-5)


def test_where_contacts_were_moved_one_by_one_the_nearest_s_move_is_an_added_one_s(
    analysed: bpy.types.Object,
) -> None:
    settings = analysed.hangtime
    settings.whole_stance = False
    for row in landing(settings):
        if row.point.startswith("Left"):
            row.place = np.add(row.found_at, (0.0, 0.0, 0.2))
    added = add_to_landing(settings, "Left heel")
    np.testing.assert_allclose(np.subtract(added.at, added.found_at), (0, 0, 0.2), atol=1e-6)


def test_a_contact_that_is_added_to_a_stance_that_stays_is_where_it_was_recorded(
    analysed: bpy.types.Object,
) -> None:
    added = add_to_landing(analysed.hangtime, "Left hand")
    np.testing.assert_allclose(added.at, added.found_at, atol=1e-6)
    assert "Left hand added" not in pins(analysed)


@pytest.mark.slow
def test_an_empty_carries_its_stance(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    first, second = landing(settings)[:2]
    for row in (first, second):
        settings.active_contact = settings.contacts.find(row.name)
        assert bpy.ops.hangtime.place_by_empty() == {"FINISHED"}
    np.testing.assert_allclose(first.empty.location, first.place, atol=1e-6)
    first.empty.location.x += 0.25
    bpy.context.view_layer.update()
    for row in landing(settings):
        np.testing.assert_allclose(np.subtract(row.place, row.found_at), (0.25, 0, 0), atol=1e-6)
    np.testing.assert_allclose(second.empty.location, second.place, atol=1e-6)
    second.place = second.found_at
    np.testing.assert_allclose(first.empty.location, first.found_at, atol=1e-6)
    first.empty.location.x += 0.25  # which the operator has to look at itself
    settings.keep_times = True
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    for row in landing(settings):
        np.testing.assert_allclose(np.subtract(row.place, row.found_at), (0.25, 0, 0), atol=1e-6)
        assert drift(analysed, row) < 0.002


def test_an_empty_that_was_deleted_is_replaced(analysed: bpy.types.Object) -> None:
    row = landing(analysed.hangtime)[0]
    analysed.hangtime.active_contact = analysed.hangtime.contacts.find(row.name)
    bpy.ops.hangtime.place_by_empty()
    for collection in row.empty.users_collection:
        collection.objects.unlink(row.empty)
    bpy.ops.hangtime.place_by_empty()
    assert row.empty.name in bpy.context.view_layer.objects
    np.testing.assert_allclose(row.empty.location, row.place, atol=1e-6)


def test_a_copied_character_leaves_the_originals_empty_alone(analysed: bpy.types.Object) -> None:
    row = landing(analysed.hangtime)[0]
    analysed.hangtime.active_contact = analysed.hangtime.contacts.find(row.name)
    bpy.ops.hangtime.place_by_empty()
    empty, place = row.empty, tuple(row.empty.location)
    empty.select_set(False)
    analysed.select_set(True)
    bpy.context.view_layer.objects.active = analysed
    bpy.ops.object.duplicate()
    copy = bpy.context.view_layer.objects.active
    copy.hangtime.stances["ground 2"].forward = 0.3
    bpy.context.view_layer.update()
    assert tuple(empty.location) == place
    assert analysed.hangtime.stances["ground 2"].forward == 0.0
    bpy.ops.hangtime.place_by_empty()
    own = bpy.context.view_layer.objects.active
    assert own not in (empty, copy)
    np.testing.assert_allclose(own.location, landing(copy.hangtime)[0].place, atol=1e-6)


@pytest.mark.slow
def test_pins_call_contacts_what_they_are_called_after_the_corrections(
    analysed: bpy.types.Object,
) -> None:
    settings = analysed.hangtime
    settings.stances["ground 2"].up = 0.1
    assert pins(analysed)["Left heel 2"].touching == ("Left heel 2",)
    settings.contacts["Left heel 1"].used = False
    settings.contacts["Right toe 2"].start_frame = 236.0
    problem = problem_of(settings, read_recorded(analysed, FIRST, LAST))
    removed, later = problem.contacts
    assert (removed.name, removed.remove) == ("Left heel 1", True)
    assert (later.name, later.start_frame, later.end_frame) == ("Right toe 2", 236.0, None)
    pin = pins(analysed)["Left heel 2"]
    assert pin.touching == ("Left heel 1",)
    schedule = analyse(read_recorded(analysed, FIRST, LAST), problem).schedule
    assert "Left heel 1" in {c.name for c in schedule.contacts if c.start > 1.0}
    np.testing.assert_allclose(pin.place, settings.contacts["Left heel 2"].at, atol=1e-6)


def test_a_scene_of_other_units_is_read_in_metres(analysed: bpy.types.Object) -> None:
    bpy.context.scene.unit_settings.scale_length = 0.5
    settings = analysed.hangtime
    settings.stances["ground 2"].up = 0.1
    place = pins(analysed)["Left heel 2"].place
    np.testing.assert_allclose(place, 0.5 * np.array(settings.contacts["Left heel 2"].at))


def test_a_landing_beyond_what_single_precision_tells_is_refused_by_name(
    analysed: bpy.types.Object,
) -> None:
    """It was told to contradict itself by centimetres, which are rounding."""
    analysed.hangtime.stances["ground 2"].forward = 1e7
    recording = read_recorded(analysed, FIRST, LAST)
    subject = measure(recording, problem_of(analysed.hangtime, recording))
    with pytest.raises(BeyondPrecision) as caught:
        check_requested(unfitted(subject), subject.problem)
    assert caught.value.request in {row.name for row in landing(analysed.hangtime)}
