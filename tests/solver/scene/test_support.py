"""Support that the floor does not explain: boxes that would, and ground of the scene that does."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hangtime.bridge.recipe.object_texts import support_texts
from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.operators.words.analysis_text import starter_recipe
from hangtime.solver.analysis.analyse import Analysis, analyse
from hangtime.solver.analysis.grounding import PLACE_BAND
from hangtime.solver.analysis.performance import point_depth
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.contacts import (
    ContactPoint,
    Interval,
    KnownContacts,
    PhaseKind,
    PointKind,
)
from hangtime.solver.data.faults import UnseenSupport
from hangtime.solver.data.problem import AddedContact, ContactEdit, MotionProblem, Unseen
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.scene import SceneObject, SceneRole, SupportBox
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.finding import Finding, FindingKind
from hangtime.solver.scene.support import boxes_beneath, steps_on_walls
from hangtime.solver.worker.pipeline import measure
from hangtime.solver.worker.protocol import Analysed, Request, RequestKind
from hangtime.solver.worker.service import Service
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import HOP, HOP_CLIP, frames_of, hop
from hangtime.tests.helpers.meshes import box, thing

DROP = 0.3  # m


@cache
def drop() -> Recording:
    """The hop as a jump down: raised until it leaves, and in the flight no more bit by bit."""
    return raised(lambda share: 1.0 - share)


def raised(how: Callable[[FloatArray], FloatArray]) -> Recording:
    """The hop, by so many times DROP higher, by the share (T,) of its flight that is over."""
    recording = load_recording(HOP_CLIP).window(*frames_of(HOP_CLIP, HOP))
    (flight,) = (p for p in hop().schedule.phases if p.kind is PhaseKind.FLIGHT)
    share = np.clip((recording.times - flight.start) / (flight.end - flight.start), 0.0, 1.0)
    heads = recording.heads.copy()
    heads[..., 2] += DROP * how(share)[:, None]
    return replace(recording, heads=heads)


@cache
def offered(height: float | None = None) -> tuple[SupportBox, ...]:
    (found,) = measure(drop(), MotionProblem(height=height)).analysis.unseen
    assert isinstance(found, UnseenSupport)
    return found.boxes


def boxes(**changed: object) -> tuple[SceneObject, ...]:
    """The boxes that are offered, as their recipe's lines say."""
    scene = parse_recipe("\n".join(support_texts(offered()))).problem.scene
    return tuple(replace(thing, **changed) for thing in scene)  # type: ignore[arg-type]


def standing(analysis: Analysis) -> set[str]:
    """The contacts of the first stance."""
    first = analysis.schedule.phases[0]
    return {contact.point for contact in analysis.schedule.of_phase(first)}


def test_a_box_is_offered_whose_top_is_at_the_soles() -> None:
    (box,) = offered()
    first = hop().schedule.phases[0]
    places = np.array([c.place for c in hop().schedule.of_phase(first)])
    assert box.size[2] == pytest.approx(DROP, abs=0.015)
    np.testing.assert_allclose(box.place, [*places.mean(axis=0)[:2], 0.0], atol=0.05)
    assert 0.3 < box.size[0] < 0.45  # a foot's length, and its edge
    assert 0.2 < box.size[1] < 0.6


@pytest.mark.parametrize(("higher", "on"), [(0.0, "Crate"), (0.2, None), (-0.2, None)])
def test_a_contact_that_is_added_where_an_object_ends_is_on_it(
    higher: float, on: str | None
) -> None:
    """So what else the recording has in the object may stay there."""
    recording = load_recording(HOP_CLIP).window(*frames_of(HOP_CLIP, HOP))
    middle = float(recording.frames[len(recording.frames) // 2])
    touch = AddedContact("Left hand", middle, middle + 12)
    bare = analyse(recording, MotionProblem(added=(touch,)))
    (hand,) = (c for c in bare.schedule.contacts if c.point == "Left hand")
    palm = hand.place[2] - point_depth("Left hand", bare.performance.character) + higher
    crate = thing("Crate", box((1.0, 1.0, palm)), (*hand.place[:2], 0.5 * palm))
    found = analyse(recording, MotionProblem(added=(touch,), scene=(crate,)))
    (hand,) = (c for c in found.schedule.contacts if c.point == "Left hand")
    assert hand.on == on


def test_a_contact_that_is_added_near_the_floor_is_on_what_those_that_were_found_are_on() -> None:
    """A floor 2 cm above the recording's had a foot that was put down again step up to it."""
    recording = load_recording(HOP_CLIP).window(*frames_of(HOP_CLIP, HOP))
    found = hop().schedule.contacts[-1]
    middle, end = recording.frames[0] + recording.rate * np.array(
        [0.5 * (found.start + found.end), found.end]
    )
    floor = thing("Floor", box((20.0, 20.0, 1.0)), (0.0, 0.0, hop().schedule.floor_m - 0.48))
    again = MotionProblem(
        contacts=(ContactEdit(found.name, end_frame=middle),),
        added=(AddedContact(found.point, middle, end),),
        scene=(floor,),
    )
    halves = [c for c in analyse(recording, again).schedule.contacts if c.point == found.point]
    assert [c.on for c in halves[-2:]] == [None, None]
    assert abs(halves[-1].place[2] - halves[-2].place[2]) < 0.01


@pytest.mark.parametrize(("degrees", "wall"), [(75.0, True), (0.0, False), (-60.0, False)])
def test_no_box_is_offered_for_soles_that_point_up(degrees: float, *, wall: bool) -> None:
    """Of who stands on the toes heels are as high."""
    times, slope = np.linspace(0.0, 0.5, 31), np.radians(degrees)
    tip = 0.2 * np.array([0.0, np.cos(slope), np.sin(slope)])
    points = {
        f"Left {end}": ContactPoint(
            kind, "LeftFoot", np.zeros(3), np.tile([0.0, 0.0, 1.0] + share * tip, (31, 1))
        )
        for end, kind, share in (("heel", PointKind.HEEL, 0.0), ("toe", PointKind.TOE, 1.0))
    }
    gap = Interval(0.0, 0.5)
    assert bool(boxes_beneath(times, points, gap, 0.0)) is not wall
    told = [name for name, _ in steps_on_walls(times, points, gap)]
    assert told == (["Left heel", "Left toe"] if wall else [])


def test_the_box_explains_what_carried_the_body() -> None:
    (box,) = boxes()
    found = analyse(drop(), MotionProblem(scene=(box,)))
    assert [p.name for p in found.schedule.phases] == ["ground 1", "flight 1", "ground 2"]
    first = found.schedule.of_phase(found.schedule.phases[0])
    assert {contact.on for contact in first} == {box.name}
    assert standing(found) == standing(hop())
    top = float(box.vertices[:, 2].max())
    low, high = PLACE_BAND
    assert all(top + low <= contact.place[2] <= top + high for contact in first)
    landing = found.schedule.of_phase(found.schedule.phases[2])
    assert {contact.on for contact in landing} == {None}


def sinking(since: float) -> SceneObject:
    """The box as a lift: half a second long, from that instant, s, on, it sinks by a metre."""
    (box,), recording = boxes(), drop()
    down = -np.clip((recording.times - since) / 0.5, 0.0, 1.0)
    places = box.positions[0] + down[:, None] * np.array([0.0, 0.0, 1.0])
    turns = np.tile(box.rotations[0], (len(down), 1, 1))
    return replace(box, frames=recording.frames, positions=places, rotations=turns)


def test_the_flight_off_a_box_that_is_not_there_is_a_flight() -> None:
    """The same as with the box; what is unseen ends where the feet leave."""
    without = measure(drop(), MotionProblem()).analysis.schedule
    explained = measure(drop(), MotionProblem(scene=boxes())).analysis.schedule
    assert [phase.name for phase in without.phases] == ["ground 1", "flight 1", "ground 2"]
    for one, other in zip(without.flights, explained.flights, strict=True):
        assert (one.start, one.end) == pytest.approx((other.start, other.end), abs=0.02)
    (unseen,) = without.unseen
    assert (unseen.start, unseen.end) == (0.0, without.flights[0].start)


def test_a_recipe_to_start_from_pins_a_stance_in_which_something_touches() -> None:
    """Who jumps onto something unseen lands where no contact is."""
    analysis = measure(raised(lambda share: share), MotionProblem()).analysis
    assert [phase.name for phase in analysis.schedule.stances] == ["ground 1"]
    text = starter_recipe(analysis, MotionProblem(), Path("clip.bvh"), Path("recipe.toml"))
    (pin,) = parse_recipe(text).problem.pins
    assert pin.phase == "ground 1"


def test_where_the_recording_stands_on_one_of_two_boxes_neither_is_said_to_be_moved() -> None:
    (box,) = offered()
    low = replace(box, place=(*box.place[:2], -box.size[2]))
    assert "with the recording" not in "".join(support_texts([low, replace(low, turn=1.0)]))
    other = replace(low, size=(*low.size[:2], low.size[2] + 0.3))
    assert "with the recording" not in "".join(support_texts([low, other]))
    assert "with the recording" in "".join(support_texts([other]))


def test_it_stays_one_where_the_landing_is_corrected() -> None:
    found = measure(drop(), MotionProblem()).analysis.schedule
    landing = min(found.contacts, key=lambda contact: contact.start)
    recording = drop()
    later = float(recording.frames[0]) + (landing.start + 0.03) * recording.rate
    edits = tuple(ContactEdit(c.name, start_frame=later) for c in found.contacts if c.start < later)
    corrected = measure(recording, MotionProblem(contacts=edits)).analysis.schedule
    (flight,) = corrected.flights
    assert flight.start == pytest.approx(found.flights[0].start, abs=1e-6)
    assert flight.end == min(contact.start for contact in corrected.contacts)


def lower(metres: float) -> Recording:
    """The jump down, its landing so far below 0."""
    return replace(drop(), heads=drop().heads - [0.0, 0.0, metres])


def damage(recording: Recording, *scene: SceneObject) -> list[Finding]:
    return [each for each in diagnose(recording, scene=scene).findings if not each.kind.note]


def offered_for(recording: Recording) -> str:
    """The text of the box that is offered."""
    (found,) = analyse(recording, MotionProblem()).unseen
    assert isinstance(found, UnseenSupport)
    (text,) = support_texts(found.boxes)
    return text


@pytest.mark.slow
def test_who_stands_at_0_before_he_jumps_down_stands_on_the_floor() -> None:
    """It was to be lowered to where it lands, and the box stayed below."""
    recording = lower(DROP)
    assert damage(recording) == []
    text = offered_for(recording)
    assert "with the recording" not in text
    scene = parse_recipe(text).problem.scene
    assert analyse(recording, MotionProblem(scene=scene)).unseen == ()
    assert damage(recording, *scene) == []


@pytest.mark.slow
def test_the_floor_and_the_box_are_right_alone_and_together() -> None:
    recording = lower(1.0)
    (floor,) = damage(recording)
    assert floor.kind is FindingKind.FLOOR
    assert floor.remedy is not None
    text = offered_for(recording)
    scene = parse_recipe(text).problem.scene
    assert analyse(recording, MotionProblem(scene=scene)).unseen == ()
    assert damage(recording, *scene) == []  # it is where the scene has it
    lowered = repaired(recording, floor.remedy)
    assert damage(lowered) == []
    lines = text.splitlines()
    (place,) = (line for line in lines if line.startswith("place"))
    (told,) = (line for line in lines if line.startswith("# with the recording raised by"))
    both = parse_recipe(text.replace(place, told[told.index("place =") :])).problem.scene
    assert analyse(lowered, MotionProblem(scene=both)).unseen == ()
    assert damage(lowered, *both) == []
    np.testing.assert_allclose(
        parse_recipe(offered_for(lowered)).problem.scene[0].positions, both[0].positions, atol=2e-3
    )


def test_a_lift_that_waits_explains_what_carried_the_body() -> None:
    (flight,) = (p for p in hop().schedule.phases if p.kind is PhaseKind.FLIGHT)
    lift = sinking(flight.start + 0.1)
    found = analyse(drop(), MotionProblem(scene=(lift,)))
    first = found.schedule.of_phase(found.schedule.phases[0])
    assert {contact.on for contact in first} == {lift.name}
    still = analyse(drop(), MotionProblem(scene=boxes()))
    for contact, same in zip(found.schedule.contacts, still.schedule.contacts, strict=True):
        np.testing.assert_allclose(contact.place, same.place, atol=1e-6)


@pytest.mark.slow
def test_only_ground_at_rest_beneath_the_feet_explains_anything() -> None:
    for changed in (
        {"role": SceneRole.OBSTACLE},
        {"positions": np.array([[5.0, 0.0, 0.0]])},
    ):
        assert analyse(drop(), MotionProblem(scene=boxes(**changed))).unseen
    assert analyse(drop(), MotionProblem(scene=(sinking(-0.1),))).unseen


def test_who_asks_for_it_is_refused_what_something_unseen_carries() -> None:
    (box,) = boxes()
    refusing = MotionProblem(unseen=Unseen.REFUSE)
    with pytest.raises(UnseenSupport) as caught:
        measure(drop(), replace(refusing, height=1.2 * hop().performance.character.height))
    np.testing.assert_allclose(caught.value.boxes[0].size, offered()[0].size, atol=0.02)
    assert measure(drop(), replace(refusing, scene=(box,))).analysis.unseen == ()


def test_a_scene_changes_nothing_where_the_floor_explains_all() -> None:
    under = np.array([[*hop().schedule.contacts[0].place[:2], -0.01]])
    crate = replace(boxes()[0], positions=under)
    recording = load_recording(HOP_CLIP).window(*frames_of(HOP_CLIP, HOP))
    found = analyse(recording, MotionProblem(scene=(crate,)))
    assert {contact.on for contact in found.schedule.contacts} == {None}


def test_at_another_stature_the_box_is_still_in_the_recordings_lengths() -> None:
    tall = 1.2 * hop().performance.character.height
    plain, scaled = offered(), offered(tall)
    np.testing.assert_allclose(scaled[0].size, plain[0].size, atol=0.02)
    np.testing.assert_allclose(scaled[0].place, plain[0].place, atol=0.02)


def test_a_body_that_hangs_has_no_box() -> None:
    recording = load_recording(HOP_CLIP).window(*frames_of(HOP_CLIP, HOP))
    recording = replace(recording, heads=recording.heads.copy())
    recording.heads[..., 2] += 1.0 + 0.5 * np.sin(6.0 * recording.times)[:, None]
    recording.heads[:8, :, 2] -= recording.heads[:8, :, 2].min()  # the floor is told
    found = analyse(recording, MotionProblem()).unseen
    assert found
    assert all(isinstance(each, UnseenSupport) and each.boxes == () for each in found)


@pytest.mark.slow
def test_a_worker_looks_again_where_what_was_stood_on_is_another() -> None:
    service, recording = Service(), drop()

    def explained(*scene: SceneObject) -> bool:
        request = Request(1, RequestKind.ANALYSE, recording, MotionProblem(scene=scene))
        answer = service.answer(request, lambda _: None)
        assert isinstance(answer, Analysed)
        return not answer.unseen

    (box,) = boxes()
    aside = replace(box, name="Crate", positions=np.array([[5.0, 0.0, 0.0]]))
    scenes = ((), (box,), (box, aside), (aside,))
    assert [explained(*scene) for scene in scenes] == [False, True, True, False]
    assert not explained(replace(box, positions=box.positions - [0.0, 0.0, 0.1]))


@pytest.mark.slow
def test_what_is_known_of_other_frames_leaves_a_drop_a_flight() -> None:
    there = replace(drop(), known=(KnownContacts(-500.0, -400.0, ()),))
    was, now = (measure(each, MotionProblem()).analysis.schedule for each in (drop(), there))
    assert len(was.flights) == 1
    assert now.flights == was.flights
    whole = replace(drop(), known=(KnownContacts(-500.0, float(drop().frames[0]) + 1.0, ()),))
    assert len(measure(whole, MotionProblem()).analysis.schedule.flights) == 1
