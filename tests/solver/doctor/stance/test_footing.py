"""The floor, drift at one speed, and feet that stand as no foot can."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.doctor.combined import both
from hangtime.devtools.doctor.damages.damage import Damage, at_rate
from hangtime.devtools.doctor.damages.poses import noisy
from hangtime.devtools.doctor.damages.whole_body import (
    in_place,
    raised,
    rising,
    sliding,
    sunk,
    swaying,
)
from hangtime.devtools.doctor.measure import apart
from hangtime.operators.words.messages import sentence
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.performance import find_contacts, perform
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import build_character
from hangtime.solver.data.faults import UnseenSupport
from hangtime.solver.data.problem import ContactEdit, Mend, MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.scaling import scaled_recording
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.repair import GROUNDING, repaired
from hangtime.solver.doctor.figure import figure_of
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.doctor.stance.feet import FootFault, FootFaultKind, find_feet
from hangtime.solver.doctor.stance.footing import find_footing, find_rise, find_sliding
from hangtime.solver.doctor.stance.in_place import find_in_place
from hangtime.solver.doctor.stance.sinking import find_sinking, lifted_out
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.doctored import character, figure, jump, sparse
from hangtime.tests.helpers.moving import keyed


@pytest.mark.parametrize(
    ("damage", "metres"),
    [
        (raised(0.1), 0.015),
        (raised(-0.2), 0.015),
        *((sliding(each), 0.02) for each in (0.1, 0.3)),
    ],
)
def test_height_and_drift_are_told_and_taken_out(damage: Damage, metres: float) -> None:
    damaged = damage.of(jump())
    performance = perform(damaged.recording, character())
    sliding = find_sliding(performance, figure())
    (found,) = [*([] if sliding is None else [sliding]), *find_footing(performance)]
    assert found.kind is damage.kind
    assert found.remedy is not None
    assert apart(repaired(damaged.recording, found.remedy), damaged.original) < metres


def test_a_short_stance_alone_tells_no_drift() -> None:
    """The feet of who lands roll and turn by 2 cm."""
    part = jump().window(170.0, 300.0)
    assert find_sliding(perform(part, character()), figure()) is None


@pytest.mark.parametrize(("slid", "told"), [((0.1, 0.1), True), ((0.08, 0.15), False)])
def test_drift_is_what_both_stances_tell(slid: tuple[float, float], told: bool) -> None:
    """slid: m/s, before the flight and after it."""
    recording = load_recording(JUMP).window(2.0, 325.0)
    (flight,) = find_contacts(perform(recording, character())).flights
    after = np.clip(recording.times - 0.5 * (flight.start + flight.end), 0.0, None)
    before = recording.times - after
    way = np.outer(slid[0] * before + slid[1] * after, [0.8, -0.6, 0.0])
    moved = replace(recording, heads=recording.heads + way[:, None])
    found = find_sliding(perform(moved, character()), figure())
    assert (found is not None) is told


@pytest.mark.parametrize(
    ("name", "metres"),
    [("131_03_hop.bvh", 0.12), ("131_03_hop.bvh", 0.15), ("cmu1_jumping_jacks.bvh", 0.15)],
)
def test_a_body_that_sways_does_not_drift(name: str, metres: float) -> None:
    """It was told a drift that its longer stances have and others go against: taken out, it left
    the body five times further off."""
    recording = load_recording(name)
    first = recording.frames[0]
    part = at_rate(recording.window(first, first + 5.0 * recording.rate), 24.0)
    swayed, drifted = swaying(metres, 4.0).of(part).recording, sliding(0.2).of(part).recording
    assert find_sliding(perform(swayed, build_character(swayed)), figure_of(swayed)) is None
    assert find_sliding(perform(drifted, build_character(drifted)), figure_of(drifted)) is not None


@pytest.mark.parametrize(("landed", "floors"), [(False, 0), (True, 1)])
def test_who_only_flies_stands_on_no_height(landed: bool, floors: int) -> None:
    """Who lands at its end does."""
    high = raised(0.4).of(jump()).recording
    (flight,) = find_contacts(perform(high, character())).flights
    first, last = high.frames[0] + high.rate * np.array([flight.start, flight.end])
    part = high.window(first + 2.0, high.frames[-1] if landed else last - 2.0)
    found = find_footing(perform(part, character()))
    assert [f.kind for f in found if not f.kind.note] == [FindingKind.FLOOR] * floors
    assert FindingKind.BEGINS_IN_AIR in {f.kind for f in found}


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.05, 0.1, -0.1])
def test_a_floor_that_rises_is_told_as_drift_and_held_level(speed: float) -> None:
    """Without the note of unseen support that the feet leave behind, and at the true heights."""
    damaged = rising(speed).of(jump())
    diagnosis = diagnose(damaged.recording)
    (found,) = diagnosis.findings
    assert found.kind is FindingKind.RISING
    assert found.amount == pytest.approx(speed, abs=0.015)
    assert apart(repaired(damaged.recording, diagnosis.repairs), damaged.original) < 0.02


def test_who_steps_up_does_not_drift() -> None:
    """The feet stand still below, and above."""
    up = np.clip((jump().times - jump().times[100]) / 0.6, 0.0, 1.0) * np.array(
        [[0.0], [0.0], [0.4]]
    )
    stepped = replace(jump(), heads=jump().heads + up.T[:, None])
    assert find_rise(stepped, figure()) is None


@pytest.mark.parametrize("down", [0.1, 0.15])
def test_who_steps_down_to_a_low_floor_does_not_sink(down: float) -> None:
    """Though both heights, of two stances, are on one line."""
    fallen = np.clip((jump().times - jump().times[100]) / 0.6, 0.0, 1.0)[:, None, None]
    heads = jump().heads - np.array([0.0, 0.0, down]) * (1.0 + fallen)
    found = find_footing(perform(replace(jump(), heads=heads), character()))
    (floor,) = (f for f in found if not f.kind.note and f.kind is not FindingKind.SINKING)
    assert floor.kind is FindingKind.FLOOR
    assert floor.amount == pytest.approx(-2.0 * down, abs=0.02)


def test_a_run_that_rises_from_a_floor_at_0_is_told_so() -> None:
    """Its lowest feet are where the floor is."""
    damaged = rising(0.12).of(load_recording("run_2.bvh")).recording
    found = find_footing(perform(damaged, build_character(damaged)))
    (told,) = (f for f in found if not f.kind.note)
    assert (told.kind, told.alternative) == (FindingKind.RISING, None)
    assert told.amount == pytest.approx(0.12, abs=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["run_1.bvh", "run_3.bvh"])
def test_a_run_that_sinks_is_no_run_on_a_low_floor(name: str) -> None:
    """Its stances are too short to tell whether it sinks or its floor slopes: both are offered."""
    damaged = rising(-0.12).of(load_recording(name))
    diagnosis = diagnose(damaged.recording)
    (found,) = (f for f in diagnosis.findings if f.kind is FindingKind.TILTED)
    assert found.alternative is not None
    assert found.alternative.rise == pytest.approx(-0.12, abs=0.02)
    assert apart(repaired(damaged.recording, found.alternative), damaged.original) < 0.02


@pytest.mark.slow
@pytest.mark.parametrize("name", ["run_1.bvh", "run_3.bvh"])
def test_a_run_on_a_treadmill_stands_on_the_floor(name: str) -> None:
    """Feet that go with the belt are not slow; those that turn back in the air are."""
    recording = load_recording(name)
    com = perform(recording, build_character(recording)).com
    pace = (com[-1] - com[0]) / recording.times[-1] * np.array([1.0, 1.0, 0.0])
    heads = recording.heads - (recording.times[:, None] * pace)[:, None]
    kinds = {f.kind for f in diagnose(replace(recording, heads=heads)).findings}
    assert FindingKind.IN_PLACE in kinds
    assert FindingKind.FLOOR not in kinds


@pytest.mark.parametrize("seed", [4, 5])
def test_noise_of_a_runs_short_stances_is_no_drift(seed: int) -> None:
    """Half of a dozen frames may slide alike by chance; its remedy moved the body by 0.7 m."""
    damaged = noisy(6.0, 2.0).do(load_recording("run_3.bvh"), np.random.default_rng(100 + seed))
    kinds = [finding.kind for finding in diagnose(damaged.recording).findings]
    assert FindingKind.NOISE in kinds
    assert FindingKind.SLIDING not in kinds


@pytest.mark.slow
@pytest.mark.parametrize("name", [JUMP, "fair1_jumping.bvh"])
@pytest.mark.parametrize("speed", [0.1, 0.2, 0.5])
def test_drift_is_told_in_spite_of_the_noise_of_video(name: str, speed: float) -> None:
    """What smoothing leaves of it moves feet faster, to and fro."""
    damage = both(noisy(3.0, 1.0), sliding(speed))
    damaged = damage.of(load_recording(name).window(2.0, 500.0))
    diagnosis = diagnose(damaged.recording)
    assert {FindingKind.NOISE, FindingKind.SLIDING} <= {f.kind for f in diagnosis.findings}
    assert diagnosis.repairs.drift == pytest.approx((0.8 * speed, 0.6 * speed), abs=0.06)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("noise", [(3.0, 1.0), (6.0, 2.0)])
def test_noise_alone_is_no_drift(noise: tuple[float, float], seed: int) -> None:
    damaged = noisy(*noise).do(jump(), np.random.default_rng(seed))
    diagnosis = diagnose(damaged.recording)
    assert FindingKind.NOISE in {f.kind for f in diagnosis.findings}
    assert diagnosis.repairs.drift == (0.0, 0.0)


@pytest.mark.parametrize(("name", "seed"), [(JUMP, 1), ("high_jump.bvh", 2)])
def test_what_sways_in_noise_does_not_drift_at_one_speed(name: str, seed: int) -> None:
    """Its stances, few and short, agree within what noise leaves of each."""
    recording, rng = load_recording(name), np.random.default_rng(seed)
    noise = noisy(3.0, 1.0).do(recording.window(3.0, 403.0), rng)
    damaged = swaying(0.04, 2.0).do(noise.recording, rng)
    smooth = repaired(damaged.recording, Repairs(mend=(Mend.NOISE,)))
    performance = perform(smooth, build_character(recording))
    assert find_sliding(performance, figure_of(smooth)) is None


@pytest.mark.slow
def test_how_a_figure_stands_is_told_of_what_is_kept() -> None:
    """A dancer of whom capture loses the floor for all but the first 12 frames: they hid that the
    feet are centimetres above it, and had all else called unseen support."""
    dance = load_recording("rokoko_jesse_dance.bvh")
    diagnosis = diagnose(dance)
    kinds = [finding.kind for finding in diagnosis.findings if not finding.kind.note]
    assert kinds == [FindingKind.LEAP, FindingKind.FLOOR]
    mended = diagnose(repaired(dance, diagnosis.repairs))
    assert [finding for finding in mended.findings if not finding.kind.note] == []
    notes = {finding.kind: finding.frames for finding in diagnosis.findings if finding.kind.note}
    assert {finding.kind: finding.frames for finding in mended.findings} == notes


@pytest.mark.slow
@pytest.mark.parametrize("first", [14.0, 20.0])
def test_a_dance_of_which_little_stands_does_not_slide(first: float) -> None:
    """A third of a second out of five; its drift would move the body by 2 m."""
    dance = load_recording("rokoko_jesse_dance.bvh")
    kinds = {finding.kind for finding in diagnose(dance.window(first, 500.0)).findings}
    assert FindingKind.SLIDING not in kinds


@pytest.mark.slow
@pytest.mark.parametrize("name", ["run_1.bvh", "run_3.bvh", "BMC_run.bvh"])
@pytest.mark.parametrize("belt", [False, True])
def test_hips_in_place_above_steady_feet_get_their_way_back(name: str, *, belt: bool) -> None:
    """A treadmill is the same, whose hips go to and fro."""
    run = load_recording(name)
    damaged = treadmill(run) if belt else in_place().of(run).recording
    found = diagnose(damaged)
    (told,) = (f for f in found.findings if not f.kind.note)
    assert told.kind is FindingKind.IN_PLACE
    assert told.frames
    assert told.amount == pytest.approx(speed_of(run), rel=0.15)
    assert apart(repaired(damaged, found.repairs), run) < 0.12 * apart(damaged, run)
    again = diagnose(repaired(damaged, found.repairs)).findings
    assert [f for f in again if not f.kind.note] == []


def speed_of(recording: Recording) -> float:
    """M/s, of the hips along the floor, in the mean."""
    way = recording.heads[-1, 0] - recording.heads[0, 0]
    return float(np.linalg.norm(way[:2]) / recording.times[-1])


def treadmill(recording: Recording) -> Recording:
    """Without the hips' mean velocity."""
    way = (recording.heads[-1, 0] - recording.heads[0, 0]) * [1.0, 1.0, 0.0]
    share = recording.times / recording.times[-1]
    return replace(recording, heads=recording.heads - (share[:, None] * way)[:, None])


@pytest.mark.parametrize(
    "name",
    ["forward_jump_116cm.bvh", pytest.param("fair1_jumping.bvh", marks=pytest.mark.slow)],
)
@pytest.mark.parametrize("every", [1, 4])
def test_a_jump_in_place_is_given_the_way_on_which_its_feet_stand(name: str, every: int) -> None:
    """Its clock was told to be wrong, or nothing: what it does in flight the feet do not tell."""
    original = sparse(load_recording(name), every)
    damaged = in_place().of(original).recording
    (told,) = (f for f in diagnose(damaged).findings if not f.kind.note)
    assert told.kind is FindingKind.IN_PLACE
    assert told.amount > 0.2
    given = repaired(damaged, told.remedy or Repairs())
    assert apart(given, original) < 0.25 * apart(damaged, original)
    assert not [f for f in diagnose(given).findings if not f.kind.note]


@pytest.mark.parametrize("name", ["hops_in_place.bvh", "high_jump.bvh", "run_2.bvh"])
def test_who_moves_on_one_spot_or_goes_along_the_floor_is_not_in_place(name: str) -> None:
    recording = load_recording(name)
    assert find_in_place(perform(recording, build_character(recording))) is None


def test_feet_that_rest_without_a_contact_do_not_skid() -> None:
    """The artist took their contacts away."""
    first = float(jump().frames[0])
    stands = MotionProblem(frames=(first, first + 60.0))
    found = analyse(jump(), stands).schedule.contacts
    without = tuple(ContactEdit(contact.name, remove=True) for contact in found)
    (told,) = analyse(jump(), replace(stands, contacts=without)).unseen
    assert isinstance(told, UnseenSupport)
    assert (told.resting, told.skidding) == (True, False)
    assert "the feet rest on the ground, but no contact holds them" in sentence(told)


@pytest.mark.slow
def test_feet_that_skid_while_they_stand_are_told_as_such() -> None:
    """It was said that nothing touches."""
    after = np.clip((jump().times - jump().times[-80]) / 0.25, 0.0, 1.0)
    away = (after - np.sin(2.0 * np.pi * after) / (2.0 * np.pi))[:, None] * [0.35, 0.0, 0.0]
    skidded = replace(jump(), heads=jump().heads + away[:, None])
    found = {finding.kind: finding for finding in diagnose(skidded).findings}
    assert FindingKind.UNSEEN_SUPPORT not in found
    ((first, last),) = found[FindingKind.SKIDDING].frames
    assert jump().frames[-80] <= first < last <= jump().frames[-50]
    (told,) = analyse(skidded, MotionProblem()).unseen
    assert isinstance(told, UnseenSupport)
    assert (told.skidding, told.boxes) == (True, ())


@pytest.mark.parametrize(
    "seconds", [0.15, *(pytest.param(s, marks=pytest.mark.slow) for s in (0.2, 0.3))]
)
def test_feet_below_the_floor_for_a_moment_are_told_with_its_frames(seconds: float) -> None:
    damaged = sunk(0.09, seconds).of(jump()).recording
    deep = jump().heads[:, 0, 2] - damaged.heads[:, 0, 2] > 0.05
    (found,) = (f for f in diagnose(damaged).findings if not f.kind.note)
    ((first, last),) = found.frames
    assert found.kind is FindingKind.SINKING
    assert found.amount == pytest.approx(9.0, abs=2.0)
    inside = (jump().frames >= first) & (jump().frames <= last)
    assert deep[inside].all()
    assert inside[deep].mean() > 0.7
    lifted = repaired(damaged, found.remedy or Repairs())
    assert apart(lifted, jump()) < 0.5 * apart(damaged, jump())
    assert diagnose(lifted).findings == ()


def test_where_one_foot_stands_the_body_is_not_lifted_for_the_other() -> None:
    """Its leg is wrong, as of a pose that failed."""
    parts = figure().sided
    leg = [parts[part, Side.LEFT] for part in (Part.THIGH, Part.SHANK, Part.FOOT)]
    toe = parts.get((Part.TOE, Side.LEFT))
    sunk_leg = [*leg, *([toe] if toe is not None else [])]
    depth = 0.1 * np.exp(-(((jump().times - jump().times[60]) / 0.1) ** 2))
    heads = jump().heads.copy()
    heads[:, sunk_leg, 2] -= depth[:, None]
    leaning = replace(jump(), heads=heads)
    found = find_sinking(perform(leaning, character()))
    assert found is not None
    assert found.remedy is None
    assert lifted_out(leaning, None).heads == pytest.approx(heads)


def test_of_who_rides_no_ride_is_mended() -> None:
    """What sinks on a lift was told with a remedy that moved nothing."""
    ridden, up = sunk(0.12, 0.2).of(jump()).recording, np.array([0.0, 0.0, 0.3])
    frames = float(jump().frames[0]), jump().rate, float(jump().frames[-1])
    lift = keyed(lambda t: (t * up, np.eye(3)), frames)
    heads = ridden.heads + ridden.times[:, None, None] * up
    told = diagnose(replace(ridden, heads=heads), scene=(lift,)).findings
    (found,) = (f for f in told if f.kind is FindingKind.SINKING)
    assert found.remedy is None


@pytest.mark.parametrize("factor", [0.01, 0.1, 10.0])
@pytest.mark.parametrize("mend", [Mend.IN_PLACE, Mend.FLOATING, Mend.SINKING])
def test_what_stands_wrong_is_mended_in_any_size(mend: Mend, factor: float) -> None:
    """Limits in metres are those of persons."""
    wrong = sunk(0.12, 0.2).of(in_place().of(jump()).recording).recording
    asked = Repairs(mend=(mend,))
    one, other = repaired(wrong, asked), repaired(scaled_recording(wrong, factor), asked)
    assert other.heads == pytest.approx(factor * one.heads, abs=1e-3 * factor)


@pytest.mark.parametrize("mend", sorted(GROUNDING, key=lambda mend: mend.value))
def test_a_single_pose_stays_as_it_is(mend: Mend) -> None:
    pose = jump().part(slice(0, 1))
    assert repaired(pose, Repairs(mend=(mend,))).heads == pytest.approx(pose.heads)


@pytest.mark.parametrize("name", ["01_01.amc", "run_2.bvh", "hops_in_place.bvh"])
def test_soles_on_uneven_floors_and_toes_that_strike_do_not_sink(name: str) -> None:
    recording = load_recording(name)
    found = find_footing(perform(recording, build_character(recording)))
    assert FindingKind.SINKING not in {finding.kind for finding in found}


def test_feet_that_float_sink_or_slide_are_told_by_point_and_frames() -> None:
    assert find_feet(perform(jump(), character())) == ()
    for height, kind in ((0.2, FootFaultKind.FLOATS), (-0.2, FootFaultKind.SINKS)):
        heads = jump().heads + np.array([0.0, 0.0, height])
        found = find_feet(perform(replace(jump(), heads=heads), character()))
        assert {fault.kind for fault in found} == {kind}
        assert {fault.point for fault in found} >= {"Left heel", "Right toe"}
        assert max(fault.amount for fault in found) > 0.15
    slid = sliding(0.3).of(jump()).recording
    assert FootFaultKind.SLIDES in {f.kind for f in find_feet(perform(slid, character()))}


@pytest.mark.slow
def test_feet_that_slide_are_noted_and_those_that_swing_low_are_not() -> None:
    """As video capture has it: the body to and fro, twice in a stance."""
    assert FindingKind.SLIDING_FEET not in {f.kind for f in diagnose(jump()).findings}
    swayed = swaying(0.03, 0.5).of(jump()).recording
    (found,) = (f for f in diagnose(swayed).findings if f.kind is FindingKind.SLIDING_FEET)
    assert found.kind.note
    assert 3.0 < found.amount < 8.0
    swung = feet_that_slide("131_03_hop.bvh")
    assert swung
    assert max(fault.amount for fault in swung) < 0.15


def feet_that_slide(name: str) -> list[FootFault]:
    recording = load_recording(name)
    faults = find_feet(perform(recording, build_character(recording)))
    return [fault for fault in faults if fault.kind is FootFaultKind.SLIDES]
