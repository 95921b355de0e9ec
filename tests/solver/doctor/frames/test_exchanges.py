"""Legs and arms that capture took for each other are told, and exchanged back."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.poses import exchanged, noisy
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.data.faults import UnseenSupport
from hangtime.solver.data.problem import Mend, MotionProblem, Unseen
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.repair import as_asked, repaired
from hangtime.solver.doctor.figure import figure_of
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.frames.exchanges import LIMBS, find_exchange
from hangtime.solver.doctor.limbs import partners
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.worker.pipeline import measure
from hangtime.tests.helpers.clips import load_recording

HOP = "131_03_hop.bvh"  # on one leg
JACKS = "cmu1_jumping_jacks.bvh"  # arms out to the sides


@cache
def hop() -> Recording:
    return load_recording(HOP).window(1, 600)


def told(recording: Recording) -> list[FindingKind]:
    return [finding.kind for finding in diagnose(recording).findings]


def on_other_axes(recording: Recording) -> Recording:
    """The same motion on a rig whose bones of the right side have axes of their own."""
    turn, right = (
        axis_rotation(1, 2.0) @ axis_rotation(0, 0.7),
        [b for b, bone in enumerate(recording.bones) if bone.name.startswith("Right")],
    )
    rotations, bones = recording.rotations.copy(), list(recording.bones)
    rotations[:, right] = rotations[:, right] @ turn
    for b in right:
        bones[b] = replace(bones[b], rotation=bones[b].rotation @ turn)
    return replace(recording, bones=tuple(bones), rotations=rotations)


@pytest.mark.slow
@pytest.mark.parametrize("limbs", LIMBS)
def test_frames_and_bone_are_told_and_nothing_that_follows_from_it(limbs: Mend) -> None:
    """Neither a jump, nor another clock, nor that something carries the body unseen."""
    damaged = exchanged(30, limbs).of(hop())
    (found,) = (f for f in diagnose(damaged.recording).findings if not f.kind.note)
    away = np.abs(damaged.recording.heads - hop().heads).max(axis=(1, 2)) > 1e-6
    assert found.frames == ((hop().frames[away][0], hop().frames[away][-1]),)
    assert found.part[-3:] in {Mend.LEGS: ("Hip", "nee"), Mend.ARMS: ("der", "bow")}[limbs]
    assert found.remedy == Repairs(mend=(limbs,))


@pytest.mark.parametrize("limbs", LIMBS)
@pytest.mark.parametrize("name", [HOP, JACKS])
def test_bones_may_have_any_axes(name: str, limbs: Mend) -> None:
    plain, other = load_recording(name), on_other_axes(load_recording(name))
    where = (plain.frames > 60) & (plain.frames <= 80)
    parts = LIMBS[limbs]
    one, two = (
        partners(each, figure_of(each), parts)[0].exchanged(each, where) for each in (plain, other)
    )
    assert np.abs(one.heads - two.heads).max() < 1e-9
    found = find_exchange(two, figure_of(two), limbs)
    assert found is not None
    assert found.frames == ((61.0, 80.0),)
    assert found.remedy is not None
    assert apart(repaired(two, found.remedy), other) < 1e-9


def test_each_limb_points_as_its_partner_did() -> None:
    """Arms that hang at one side, or are raised, do so at the other."""
    recording = load_recording(JACKS)
    arms = partners(recording, figure_of(recording), LIMBS[Mend.ARMS])[0]
    changed = arms.exchanged(recording, np.ones(len(recording.frames), bool))

    def ways(clip: Recording) -> np.ndarray:
        upper, lower = (clip.heads[:, arms.bones[:, k]] for k in (0, 1))
        return (lower - upper) / np.linalg.norm(lower - upper, axis=-1, keepdims=True)

    assert np.abs(ways(changed) - ways(recording)[:, ::-1]).max() < 1e-9
    assert (
        np.abs(changed.heads[:, arms.bones[:, 0]] - recording.heads[:, arms.bones[:, 0]]).max()
        < 1e-9
    )


def test_what_lasts_to_an_end_is_the_shorter_part() -> None:
    frames = hop().frames
    for last in (True, False):
        pair = partners(hop(), figure_of(hop()), LIMBS[Mend.LEGS])[0]
        where = frames > frames[-61] if last else frames <= frames[60]
        found = find_exchange(pair.exchanged(hop(), where), figure_of(hop()), Mend.LEGS)
        assert found is not None
        assert found.frames == ((frames[where][0], frames[where][-1]),)


@pytest.mark.parametrize("limbs", LIMBS)
@pytest.mark.parametrize("share", [0.6, 0.8])
def test_where_most_is_exchanged_limbs_that_point_inwards_tell_it(
    limbs: Mend, share: float
) -> None:
    """Of a walk and a hop: steps alone say that the rest is."""
    pair, count = partners(hop(), figure_of(hop()), LIMBS[limbs])[0], len(hop().frames)
    first = (count - round(share * count)) // 2
    where = (np.arange(count) >= first) & (np.arange(count) < first + share * count)
    found = find_exchange(pair.exchanged(hop(), where), figure_of(hop()), limbs)
    assert found is not None
    assert found.frames == ((hop().frames[where][0], hop().frames[where][-1]),)


@pytest.mark.slow
@pytest.mark.parametrize("rate", [30.0, 60.0])
def test_arms_are_told_in_the_noise_of_video(rate: float) -> None:
    clip = noisy(3.0, 1.0, rate).of(hop()).recording
    damaged = exchanged(15, Mend.ARMS).of(clip)
    assert FindingKind.EXCHANGED_ARMS in told(damaged.recording)
    assert not {FindingKind.EXCHANGED_ARMS, FindingKind.EXCHANGED_LEGS} & set(told(clip))


def test_the_problem_that_asks_for_it_is_mended() -> None:
    damaged = exchanged(40, Mend.LEGS).of(hop()).recording
    mended = as_asked(damaged, MotionProblem(mend=(Mend.LEGS,)))
    assert apart(mended, hop()) < 0.015


@pytest.mark.slow
def test_no_box_is_offered_where_legs_are_exchanged() -> None:
    """Neither foot touches the floor there, for one is where the other was."""
    jacks = exchanged(30, Mend.LEGS, angles=True).of(load_recording(JACKS)).recording
    (unseen,) = measure(jacks, MotionProblem()).analysis.unseen
    assert isinstance(unseen, UnseenSupport)
    assert unseen.exchanged
    assert unseen.boxes == ()
    assert measure(jacks, MotionProblem(mend=(Mend.LEGS,))).analysis.unseen == ()
    with pytest.raises(UnseenSupport) as refused:
        measure(jacks, MotionProblem(unseen=Unseen.REFUSE))
    assert refused.value == unseen
