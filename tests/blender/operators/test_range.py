"""A range that the artist cuts out of a longer action: the keys beyond tell of its ends."""

from __future__ import annotations

from collections.abc import Callable

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature.fcurves import curves_of
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.traces_store import kept
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.operators.solve.adapt import read_wanted
from hangtime.tests.blender.helpers.solids import make_box

FIRST, LAST = 150, 245  # in the push and shortly after the landing
SAME = 2.0  # frames

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def cut(jump: bpy.types.Object) -> bpy.types.Object:
    jump.hangtime.first_frame, jump.hangtime.last_frame = FIRST, LAST
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    return jump


def spans(armature: bpy.types.Object) -> list[tuple[str, float, float]]:
    """Each point and when it touches, as far as that is within the range."""
    rows = (
        (row.point, max(row.found_start, FIRST), min(row.found_end, LAST))
        for row in armature.hangtime.contacts
    )
    return sorted(row for row in rows if row[1] + SAME < row[2])


@pytest.mark.slow
def test_its_contacts_are_the_whole_action_s(cut: bpy.types.Object) -> None:
    ours = spans(cut)
    assert len(ours) == len(cut.hangtime.contacts)
    assert all(FIRST <= row.found_start < row.found_end <= LAST for row in cut.hangtime.contacts)
    cut.hangtime.use_range = False
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    theirs = spans(cut)
    assert [point for point, *_ in ours] == [point for point, *_ in theirs]
    for (_, *mine), (_, *other) in zip(ours, theirs, strict=True):
        assert mine == pytest.approx(other, abs=SAME)


@pytest.mark.slow
def test_no_more_is_adapted_than_the_range(cut: bpy.types.Object) -> None:
    whole = current_action(cut).frame_range.to_tuple()
    recording = complete(read_wanted(cut))
    assert recording.frames[[0, -1]].tolist() == [FIRST - 60.0, LAST + 60.0]
    assert problem_of(cut.hangtime, recording).frames == (FIRST, LAST)
    cut.hangtime.stances["ground 2"].up = 0.03
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    adapted = kept(cut.hangtime.adapted).traces
    assert adapted.frames[0] == FIRST
    assert adapted.frames[-1] == pytest.approx(LAST, abs=10.0)
    assert current_action(cut).frame_range.to_tuple() == pytest.approx(whole, abs=10.0)
    assert "Take: frames 150 to 2" in cut.hangtime.status
    cut.hangtime.result.after = "CUT"
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert current_action(cut).frame_range.to_tuple() == tuple(adapted.frames[[0, -1]])


@pytest.mark.slow
def test_what_was_changed_about_contacts_goes_with_a_take_that_is_moved(
    jump: bpy.types.Object,
) -> None:
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    settings, crate = jump.hangtime, make_box("Crate")
    stance = settings.stances["ground 2"]
    stance.forward, stance.up = 0.2, 0.1
    settings.contacts["Left toe 2"].on = crate
    bpy.context.scene.frame_set(120)
    assert bpy.ops.hangtime.add_contact(point="Left hand") == {"FINISHED"}
    hand = settings.contacts["Left hand added"].at[0]
    jump.location.x += 2.0
    bpy.context.view_layer.update()
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    stance = settings.stances["ground 2"]
    assert (stance.forward, stance.up) == pytest.approx((0.2, 0.1), abs=1e-4)
    assert stance.turn == pytest.approx(0.0, abs=1e-4)
    assert settings.contacts["Left toe 2"].on == crate
    assert settings.contacts["Left hand added"].at[0] == pytest.approx(hand + 2.0, abs=1e-3)


def test_changes_of_contacts_that_are_not_found_any_more_are_told_and_stop_an_update(
    adapted: bpy.types.Object,
) -> None:
    settings, made = adapted.hangtime, adapted.hangtime.adapted
    assert settings.stances["ground 2"].up > 0.0
    settings.first_frame, settings.last_frame = 60, 150  # before the landing
    with pytest.raises(RuntimeError, match=r"changed about Left toe 2.* is gone"):
        bpy.ops.hangtime.update()
    assert settings.analysed
    assert settings.adapted == made


@pytest.mark.parametrize(
    ("first", "last", "told"),
    [
        (200, 330, "begin in the air, and what is moved bends the rest of that flight"),
        (110, 200, "choose some that end after its landing"),
        (110, 260, ""),
    ],
)
def test_a_range_that_cuts_a_flight_is_told(
    jump: bpy.types.Object, first: int, last: int, told: str, capfd: pytest.CaptureFixture[str]
) -> None:
    jump.hangtime.first_frame, jump.hangtime.last_frame = first, last
    capfd.readouterr()
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    said = capfd.readouterr().out
    assert told in said
    assert ("in the air" in said) == bool(told)


def test_a_range_beyond_the_take_ends_with_it_and_that_is_told(
    jump: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    first, last = current_action(jump).frame_range
    jump.hangtime.first_frame, jump.hangtime.last_frame = -400, 1_000_000
    for operator, told in ((bpy.ops.hangtime.analyze, "Info"), (bpy.ops.hangtime.examine, "War")):
        capfd.readouterr()
        assert operator() == {"FINISHED"}
        said = capfd.readouterr().out
        assert told in said
        assert f"Frame -400 was asked for, but the recording begins at {first:g}" in said
        assert f"Frame 1000000 was asked for, but the recording ends at {last:g}" in said
        assert "cycle" not in said
    rows = jump.hangtime.contacts
    assert min(row.start_frame for row in rows) == first
    assert max(row.end_frame for row in rows) == last


def repeats(jump: bpy.types.Object) -> None:
    for curve in curves_of(jump):
        curve.modifiers.new("CYCLES")


def is_extrapolated(jump: bpy.types.Object) -> None:
    for curve in curves_of(jump):
        curve.extrapolation = "LINEAR"


def is_carried(jump: bpy.types.Object) -> None:
    jump.parent = bpy.data.objects.new("Lift", None)
    jump.parent.keyframe_insert("location", frame=1.0)


def follows(jump: bpy.types.Object) -> None:
    constraint = jump.pose.bones["Head"].constraints.new("DAMPED_TRACK")
    constraint.target = bpy.data.objects.new("Ball", None)


@pytest.mark.parametrize("goes_on", [repeats, is_extrapolated, is_carried, follows])
def test_what_goes_on_beyond_its_keys_is_read_there(
    jump: bpy.types.Object, goes_on: Callable[[bpy.types.Object], None]
) -> None:
    first, last = current_action(jump).frame_range
    goes_on(jump)
    jump.hangtime.first_frame, jump.hangtime.last_frame = int(first), int(last) + 50
    assert complete(read_wanted(jump)).frames[-1] == last + 50


def test_keys_beyond_an_action_s_own_range_are_read_where_they_are_asked_for(
    jump: bpy.types.Object,
) -> None:
    action = current_action(jump)
    last = action.frame_range[1]
    action.use_frame_range = True
    action.frame_start, action.frame_end = 1.0, last - 100.0
    jump.hangtime.first_frame, jump.hangtime.last_frame = 1, int(last) + 50
    assert complete(read_wanted(jump)).frames[-1] == last


def test_a_trim_keeps_to_the_take(
    jump: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    settings, last = jump.hangtime, int(current_action(jump).frame_range[1])
    before = settings.first_frame, settings.last_frame
    for begin in (last, last + 64):
        with pytest.raises(RuntimeError, match=r"has no keys \(they lie from frame 1 to"):
            bpy.ops.hangtime.trim(first=begin, last=last + 164)
    assert (settings.first_frame, settings.last_frame) == before
    assert bpy.ops.hangtime.trim(first=110, last=1500) == {"FINISHED"}
    assert (settings.first_frame, settings.last_frame) == (110, last)
    assert f"Frame 1500 was asked for, but the recording ends at {last}" in capfd.readouterr().out
