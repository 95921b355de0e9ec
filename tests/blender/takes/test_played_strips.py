"""A recording that a strip of the artist's plays later, slower or in part, and its results; what
else the artist's strips play stays as it is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action, shown_range, source_of
from hangtime.bridge.armature.actions import read_recorded, recorded_action, show
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.keys_digest import keys_digest
from hangtime.bridge.armature.poses import sample
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.armature.strips import hidden_beyond, layers_above
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.results.look_again import look_again
from hangtime.bridge.results.made import note_made
from hangtime.bridge.rows.choices import After, WrittenAs
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import combine, lay_in_slot, write_adapted_incrementally
from hangtime.operators.words.messages import sentence
from hangtime.solver.data.faults import UnreadStrips
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.recording import digest as digest_of
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.tests.blender.helpers import rigs

pytestmark = pytest.mark.usefixtures("_enabled")

SCENE = np.arange(40.0, 88.0)  # where the strip plays
START, SCALE = 40.0, 1.5
FORMS = [form for form in WrittenAs if form is not WrittenAs.SLOT or bpy.app.version >= (4, 5)]


def played(scale: float = SCALE, first: float = 1.0, last: float = 60.0) -> bpy.types.Object:
    """A take of 60 frames, of which a strip plays some from scene frame 40 on."""
    rigs.reset()
    armature = rigs.make_armature()
    rigs.animate(armature, frames=range(1, 61))
    data = armature.animation_data
    strip = data.nla_tracks.new().strips.new("Take", int(START), data.action)
    data.action = None
    strip.action_frame_start, strip.action_frame_end = first, last
    strip.scale = scale
    strip.frame_start, strip.frame_end = START, START + scale * (last - first)
    return armature


def adapt(
    armature: bpy.types.Object, first: float, last: float, **options: object
) -> bpy.types.Action:
    """A result in which some of the scene's frames are 0.1 higher."""
    part = read_recorded(armature, first, last)
    bones = [part.index(bone) for bone in rigs.MOVING]
    heads = part.heads[:, bones[0]] + [0.0, 0.0, 0.1]
    track = PoseTrack(part.frames, rigs.MOVING, part.rotations[:, bones], heads)
    chosen = ResultOptions(blend_in=3.0, blend_out=3.0, **options)
    motion = AdaptedMotion(track, TimeMap((first, last), (first, last)), None, chosen)
    action, written = complete(write_adapted_incrementally(armature, motion))
    if chosen.written_as is WrittenAs.COMBINE:
        combine(armature, action, chosen.after)
    elif chosen.written_as is WrittenAs.SLOT:
        lay_in_slot(armature, source_of(action), action)
    span = written.span if written is not None else None
    note_made(armature, action, span, 0)
    return action


def heights(armature: bpy.types.Object, frames: np.ndarray) -> np.ndarray:
    return sample(armature, frames).matrices[:, 0, 2, 3]


def test_the_recording_is_where_the_scene_shows_it() -> None:
    armature = played()
    recording = read_recording(armature)
    assert recording.frames[[0, -1]].tolist() == [40.0, 128.0]  # 128.5 is its last
    for frame in (40, 71, 120):
        seen = rigs.world_of(armature, "foot", frame)
        found = recording.heads[frame - 40, recording.index("foot")]
        np.testing.assert_allclose(found, np.array(seen.translation), atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("written_as", FORMS)
@pytest.mark.parametrize("scale", [1.0, 1.5, 0.5])
def test_a_result_is_the_take_there_and_changed_only_in_its_frames(
    written_as: WrittenAs, scale: float
) -> None:
    armature = played(scale)
    take, digest = current_action(armature), keys_digest(current_action(armature))
    last = START + scale * 59.0
    frames = np.arange(30.0, last + 10.0)
    was = sample(armature, frames)
    result = adapt(armature, 50.0, 60.0, written_as=written_as)
    assert current_action(armature) == result
    assert recorded_action(armature) == take
    now = sample(armature, frames)
    lifted = now.matrices[:, 0, 2, 3] - was.matrices[:, 0, 2, 3]
    np.testing.assert_allclose(lifted[(frames >= 50) & (frames <= 60)], 0.1, atol=1e-5)
    outside = (frames < 47) | (frames > 63)
    np.testing.assert_allclose(now.matrices[outside], was.matrices[outside], atol=2e-5)
    show(armature, take)
    assert sample(armature, frames).matrices.tobytes() == was.matrices.tobytes()
    assert keys_digest(take) == digest
    show(armature, result)
    again = sample(armature, frames)
    assert again.matrices.tobytes() == now.matrices.tobytes()
    second = adapt(armature, 50.0, 60.0, written_as=written_as)  # from the take, as it is played
    np.testing.assert_allclose(sample(armature, frames).matrices, now.matrices, atol=2e-5)
    assert second != result


@pytest.mark.parametrize("written_as", [WrittenAs.STRIP, WrittenAs.COMBINE])
def test_what_an_artists_strip_adds_to_the_take_it_adds_to_the_result(
    written_as: WrittenAs,
) -> None:
    armature, frames = played(), np.arange(50.0, 61.0)
    take, tracks = current_action(armature), armature.animation_data.nla_tracks
    layer = tracks.new()
    nod = layer.strips.new("Nod", 30, take.copy())
    nod.blend_type = "ADD"
    layered = heights(armature, frames)
    layer.mute = True
    adds = layered - heights(armature, frames)
    assert np.ptp(adds) > 0.0
    adapt(armature, 50.0, 60.0, written_as=written_as)
    assert layers_above(armature, take) == ["Nod"]
    result, recorded = heights(armature, frames), read_recorded(armature, 50.0, 60.0)
    layer.mute = False
    np.testing.assert_allclose(heights(armature, frames) - result, adds, atol=1e-5)
    assert digest_of(read_recorded(armature, 50.0, 60.0)) == digest_of(recorded)


def test_a_strip_that_plays_a_part_has_the_part_alone() -> None:
    armature = played(1.0, 11.0, 30.0)
    frames = np.arange(30.0, 70.0)
    was = heights(armature, frames)
    recording = read_recording(armature)
    assert recording.frames[[0, -1]].tolist() == [40.0, 59.0]
    adapt(armature, 48.0, 52.0)
    more = heights(armature, frames) - was
    np.testing.assert_allclose(more[18:23], 0.1, atol=1e-5)
    np.testing.assert_allclose(more[[0, 10, 29, -1]], 0.0, atol=1e-5)


def test_cut_leaves_the_adapted_frames_where_they_are_seen() -> None:
    armature = played()
    was = heights(armature, np.arange(50.0, 61.0))
    result = adapt(armature, 50.0, 60.0, after=After.CUT)
    assert tuple(result.frame_range) == (50.0, 60.0)
    np.testing.assert_allclose(heights(armature, np.arange(50.0, 61.0)) - was, 0.1, atol=1e-5)


def test_a_strip_that_is_moved_makes_results_stale() -> None:
    armature = played()
    result = adapt(armature, 50.0, 60.0)
    look_again(armature)
    assert result.hangtime.stale == ""
    strip = armature.animation_data.nla_tracks[0].strips[0]
    strip.frame_start, strip.frame_end = 45.0, 45.0 + SCALE * 59.0
    look_again(armature)
    assert result.hangtime.stale


def test_showing_the_take_leaves_the_strip_to_play_it() -> None:
    armature = played()
    before = heights(armature, SCENE)
    show(armature, recorded_action(armature))
    assert armature.animation_data.action is None
    np.testing.assert_array_equal(heights(armature, SCENE), before)


def test_a_take_that_is_assigned_again_is_read_at_its_own_frames() -> None:
    armature = played()
    adapt(armature, 50.0, 60.0)
    take = recorded_action(armature)
    armature.animation_data.action = take
    assert shown_range(armature, take) == (1.0, 60.0)
    assert read_recorded(armature, None, None).frames[[0, -1]].tolist() == [1.0, 60.0]


def test_who_plays_the_same_take_twice_is_still_refused() -> None:
    armature = played()
    extra = armature.copy()
    bpy.context.scene.collection.objects.link(extra)
    track, take = extra.animation_data.nla_tracks[0], current_action(armature)
    track.strips.new("Again", 200, take)
    adapt(armature, 50.0, 60.0, written_as=WrittenAs.STRIP)
    assert current_action(extra) is None
    with pytest.raises(UnreadStrips):
        read_recording(extra)


def test_an_artists_strip_in_a_results_track_goes_on_and_stays() -> None:
    armature = played()
    take, tracks = current_action(armature), armature.animation_data.nla_tracks
    result = adapt(armature, 50.0, 60.0, written_as=WrittenAs.STRIP)
    idle = take.copy()
    tracks[-1].strips.new("Idle", 200, idle)
    frames = np.arange(200.0, 230.0)
    seen = heights(armature, frames)
    show(armature, take)
    assert current_action(armature) == take
    np.testing.assert_array_equal(heights(armature, frames), seen)
    show(armature, result)
    bpy.context.scene.hangtime.armature = armature
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    np.testing.assert_array_equal(heights(armature, frames), seen)
    assert [strip.name for track in tracks for strip in track.strips] == ["Take", "Idle"]


def test_a_copy_of_a_result_that_the_artist_lays_is_never_muted() -> None:
    armature = played()
    take, tracks = current_action(armature), armature.animation_data.nla_tracks
    result = adapt(armature, 50.0, 60.0, written_as=WrittenAs.STRIP)
    varied = tracks.new()
    varied.strips.new("Varied", 200, result.copy())
    for shown in (take, result):
        show(armature, shown)
        assert current_action(armature) == shown
        assert not varied.mute


def test_each_of_two_recordings_is_switched_for_itself() -> None:
    armature = played()
    first, tracks = current_action(armature), armature.animation_data.nla_tracks
    adapt(armature, 50.0, 60.0, written_as=WrittenAs.STRIP)
    own = list(tracks)
    second, track = first.copy(), tracks.new()
    track.strips.new("Second", 200, second)
    for each in own:
        each.mute = True
    result = adapt(armature, 210.0, 220.0, written_as=WrittenAs.STRIP)
    assert [each.mute for each in tracks] == [True, True, False, False]
    own[1].mute = False  # the shot as a whole
    for shown, muted in ((second, True), (result, False)):
        show(armature, shown)
        assert [each.mute for each in tracks] == [True, False, False, muted]
    assert recorded_action(armature) == second


def test_a_result_that_the_artist_pushed_down_is_switched_once_it_alone_is_seen() -> None:
    armature = played()
    take, data = current_action(armature), armature.animation_data
    before = heights(armature, SCENE)
    result = adapt(armature, 50.0, 60.0)
    data.nla_tracks.new().strips.new("Pushed", int(result.frame_range[0]), result)
    data.action = None
    assert current_action(armature) is None
    with pytest.raises(UnreadStrips):
        read_recording(armature)
    data.nla_tracks[0].mute = True
    after = heights(armature, SCENE)
    assert current_action(armature) == result
    show(armature, take)
    np.testing.assert_array_equal(heights(armature, SCENE), before)
    show(armature, result)
    np.testing.assert_array_equal(heights(armature, SCENE), after)
    assert data.action is None


def test_strips_are_found_again_by_whatever_name_and_on_a_copied_armature() -> None:
    armature = played()
    take = current_action(armature)
    result = adapt(armature, 50.0, 60.0, written_as=WrittenAs.STRIP)
    copied = armature.copy()
    bpy.context.scene.collection.objects.link(copied)
    for track in armature.animation_data.nla_tracks:
        track.name = track.strips[0].name = f"My {track.name}"
    for each in (armature, copied):
        for shown in (take, result):
            show(each, shown)
            assert current_action(each) == shown
            shown.name = f"Best {shown.name}"  # after the strips, by which it is found again
        assert each.animation_data.action is None


@pytest.mark.parametrize("written_as", [f for f in FORMS if f is not WrittenAs.SLOT])
def test_results_of_a_linked_take_are_switched_in_a_file_that_was_opened_again(
    written_as: WrittenAs, tmp_path: Path
) -> None:
    library, shot = str(tmp_path / "library.blend"), str(tmp_path / "shot.blend")
    armature = played()
    bpy.data.libraries.write(library, {current_action(armature)})
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.actions = [current_action(armature).name]
    strip = armature.animation_data.nla_tracks[0].strips[0]
    strip.action = wanted.actions[0]
    strip.frame_start, strip.frame_end = START, START + SCALE * 59.0
    before = heights(armature, SCENE)
    adapt(armature, 50.0, 60.0, written_as=written_as)
    after = heights(armature, SCENE)
    bpy.ops.wm.save_as_mainfile(filepath=shot)
    bpy.ops.wm.open_mainfile(filepath=shot)
    armature = bpy.context.view_layer.objects.active
    bpy.context.scene.hangtime.armature = armature
    for shown, button in ((before, "show_recording"), (after, "show_adapted"), (before, "discard")):
        assert getattr(bpy.ops.hangtime, button)() == {"FINISHED"}
        np.testing.assert_array_equal(heights(armature, SCENE), shown)


def with_walk(armature: bpy.types.Object) -> None:
    """Another strip before the take's, below it, neither of which is held."""
    tracks, take = armature.animation_data.nla_tracks, current_action(armature)
    walk = tracks.new()
    walk.strips.new("Walk", -100, take.copy())
    for track in tracks:
        track.strips[0].extrapolation = "NOTHING"
    walk.mute = True


@pytest.mark.parametrize("written_as", [WrittenAs.ACTION, WrittenAs.STRIP, WrittenAs.COMBINE])
@pytest.mark.parametrize("cut", [False, True])
def test_a_result_shows_as_far_beyond_its_ends_as_the_strip_of_its_take(
    written_as: WrittenAs, cut: bool
) -> None:
    armature = played()
    with_walk(armature)
    walk = armature.animation_data.nla_tracks[-1]
    beyond, inside = np.r_[-90.0:39.0, 130.0:140.0], np.arange(50.0, 61.0)
    recorded = heights(armature, inside)
    walk.mute = False
    before = heights(armature, beyond)
    walk.mute = True
    after = After.CUT if cut else After.CARRY
    result = adapt(armature, 50.0, 60.0, written_as=written_as, after=after)
    hiding = None
    if written_as is WrittenAs.ACTION:
        hiding = hidden_beyond(armature, result, in_slot=False)
    walk.mute = False
    np.testing.assert_allclose(heights(armature, inside) - recorded, 0.1, atol=1e-5)
    assert (hiding == "Take") is (cut and written_as is WrittenAs.ACTION)
    if hiding is None:
        np.testing.assert_array_equal(heights(armature, beyond), before)


def test_a_result_shows_as_far_beyond_its_ends_whatever_was_shown_meanwhile() -> None:
    armature = played()
    with_walk(armature)
    take, data = current_action(armature), armature.animation_data
    data.action_extrapolation = "HOLD_FORWARD"
    whole, cut = (adapt(armature, 50.0, 60.0, after=each) for each in (After.CARRY, After.CUT))
    later = continued(armature, whole)
    asked = [(whole, "NOTHING"), (cut, "HOLD"), (later, "NOTHING"), (take, "HOLD_FORWARD")]
    for result, extrapolation in (*asked, asked[1], asked[3]):
        show(armature, result)
        assert (current_action(armature), data.action_extrapolation) == (result, extrapolation)
    data.action_extrapolation = "HOLD"  # by the artist
    for result, extrapolation in ((whole, "NOTHING"), (take, "HOLD")):
        show(armature, result)
        assert data.action_extrapolation == extrapolation


def continued(armature: bpy.types.Object, result: bpy.types.Action) -> bpy.types.Action:
    """A result that is made from another one."""
    armature.hangtime.source = result
    show(armature, result)
    made = adapt(armature, 70.0, 80.0)
    armature.hangtime.source = None
    assert source_of(made) == result
    return made


@pytest.mark.parametrize("other", [True, False])
def test_a_kept_result_in_a_strip_of_another_shot_is_the_recording(other: bool) -> None:
    armature = played()
    take = current_action(armature)
    kept = adapt(armature, 50.0, 60.0)
    if other:
        armature = armature.copy()
        bpy.context.scene.collection.objects.link(armature)
    armature.animation_data_clear()
    armature.hangtime.property_unset("take_strips")
    armature.animation_data_create().nla_tracks.new().strips.new("Kept", 200, kept)
    assert recorded_action(armature) == kept
    later = 200.0 - kept.frame_range[0]
    frames = np.arange(60.0, 80.0) + later
    was = heights(armature, frames)
    assert read_recorded(armature, None, None).frames[0] == 200.0
    result = adapt(armature, 65.0 + later, 75.0 + later)
    assert (source_of(result), source_of(kept)) == (kept, take)
    np.testing.assert_allclose((heights(armature, frames) - was)[5:16], 0.1, atol=1e-5)
    show(armature, recorded_action(armature))
    assert current_action(armature) == recorded_action(armature) == kept
    np.testing.assert_array_equal(heights(armature, frames), was)


def test_frames_of_a_shown_result_that_its_source_has_not_are_said_to_need_start_from() -> None:
    armature = played()
    kept, settings = adapt(armature, 50.0, 60.0), armature.hangtime
    armature.animation_data.nla_tracks.remove(armature.animation_data.nla_tracks[0])
    settings.use_range, settings.first_frame, settings.last_frame = True, 70, 100
    bpy.context.scene.hangtime.armature = armature
    with pytest.raises(RuntimeError, match=f"from which “{kept.name}” was made.*Start From"):
        bpy.ops.hangtime.analyze()


def test_strips_that_earlier_versions_marked_by_their_actions_are_known() -> None:
    armature = played()
    take, data = current_action(armature), armature.animation_data
    result = adapt(armature, 50.0, 60.0, written_as=WrittenAs.STRIP)
    armature.hangtime.property_unset("take_strips")
    for action in (take, result):
        action["hangtime_in_strip"] = True
    for shown in (take, result):
        show(armature, shown)
        assert current_action(armature) == shown
    second = adapt(armature, 50.0, 60.0, written_as=WrittenAs.STRIP)
    assert current_action(armature) == second
    assert [track.mute for track in data.nla_tracks] == [False, True, False]


def repeats(armature: bpy.types.Object) -> None:
    armature.animation_data.nla_tracks[0].strips[0].repeat = 2.0


def turns_back(armature: bpy.types.Object) -> None:
    armature.animation_data.nla_tracks[0].strips[0].use_reverse = True


def fades(armature: bpy.types.Object) -> None:
    armature.animation_data.nla_tracks[0].strips[0].blend_in = 5.0


def has_company(armature: bpy.types.Object) -> None:
    tracks = armature.animation_data.nla_tracks
    tracks.new().strips.new("Wave", 50, tracks[0].strips[0].action)


def is_starred(armature: bpy.types.Object) -> None:
    has_company(armature)
    armature.animation_data.nla_tracks[0].is_solo = True


def is_assigned_beside_a_star(armature: bpy.types.Object) -> None:
    is_starred(armature)
    armature.animation_data.action = armature.animation_data.nla_tracks[0].strips[0].action


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (repeats, "Take repeats its action"),
        (turns_back, "Take plays backwards"),
        (fades, "Take fades in or out"),
        (has_company, "Take, Wave are several"),
        (is_starred, "Take plays on a starred track"),
        (is_assigned_beside_a_star, "Take plays on a starred track"),
    ],
)
def test_what_strips_make_together_is_refused_by_their_names(
    spoil: Callable[[bpy.types.Object], None], said: str
) -> None:
    armature = played()
    spoil(armature)
    with pytest.raises(UnreadStrips) as caught:
        read_recording(armature)
    assert said in sentence(caught.value)
    bpy.context.scene.hangtime.armature = armature
    with pytest.raises(RuntimeError, match="cannot be read"):
        bpy.ops.hangtime.analyze()
