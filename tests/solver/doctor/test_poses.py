"""Damage of poses is named, alone, and mended."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.clock import dropped, gap, held, slowed
from hangtime.devtools.doctor.damages.damage import Damage
from hangtime.devtools.doctor.damages.poses import (
    begun_at_rest,
    burst,
    ended_at_rest,
    exchanged,
    flipped,
    noisy,
    spiked,
    stretched,
)
from hangtime.devtools.doctor.damages.whole_body import joined, lain, leapt, raised
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.body.anatomy import Part
from hangtime.solver.data.faults import OffBalance, UnseenSupport
from hangtime.solver.data.problem import Mend, MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.mistaken_support import with_cause
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.figure import figure_of
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.frames.spikes import find_spikes
from hangtime.solver.doctor.repairs import Repairs, UpAxis
from hangtime.solver.doctor.upright import find_up
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.worker.pipeline import measure
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.doctored import figure, jump, of_poses, sparse


@pytest.mark.parametrize("every", [4, 5, 8])
@pytest.mark.parametrize("damage", [spiked(120.0), joined(0.4)], ids=lambda damage: damage.name)
def test_what_no_body_can_do_is_told_of_few_frames_too(damage: Damage, every: int) -> None:
    damaged = damage.of(sparse(jump(), every)).recording
    assert damage.kind in [finding.kind for finding in of_poses(damaged)]


@pytest.mark.parametrize(
    "damage",
    [
        *map(spiked, (20.0, 120.0)),
        *map(burst, (2, 5)),
        joined(0.1),
        exchanged(15, Mend.LEGS),
        exchanged(30, Mend.ARMS),
        exchanged(40, Mend.LEGS, last=True),
        exchanged(30, Mend.LEGS, Mend.ARMS),
        held(6),
        stretched(0.05),
        noisy(3.0, 1.0),
        dropped(2),
        *map(gap, (3, 6)),
        gap(2, 2),
        gap(3, 2),
    ],
    ids=lambda damage: damage.name,
)
def test_damage_of_poses_is_named_and_nothing_else(damage: Damage) -> None:
    damaged = damage.of(jump())
    assert [finding.kind for finding in of_poses(damaged.recording)] == [
        *(damage.kind, *damage.also)
    ]


def test_a_spike_is_told_with_its_bone_and_frame() -> None:
    local = jump().rotations.copy()
    bone = jump().index("LeftArm")
    turned = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    local[50, bone] = local[50, bone] @ turned
    found = find_spikes(replace(jump(), rotations=local), figure())
    assert found is not None
    frame = jump().frames[50]
    assert found.frames == ((frame, frame),)
    assert found.part in ("LeftArm", "LeftForeArm")


def test_a_spike_of_the_whole_body_is_told_by_how_far_it_is_away() -> None:
    heads = jump().heads.copy()
    heads[50] += [0.0, 0.4, 0.0]
    found = find_spikes(replace(jump(), heads=heads), figure())
    assert found is not None
    assert (round(found.amount), found.unit) == (40, "cm")
    frame = jump().frames[50]
    assert found.frames == ((frame, frame),)


@pytest.mark.parametrize("frames", [1, pytest.param(3, marks=pytest.mark.slow), 6])
@pytest.mark.parametrize("off", [[0.06, 0.0, 0.0], [0.0, 0.06, 0.06]])
def test_frames_of_a_run_that_are_off_are_a_spike_and_no_cut(off: list[float], frames: int) -> None:
    """From a frame to the next the runner goes about as far as they are off."""
    run = load_recording("run_3.bvh")
    for frame in (40, 57, 74):
        heads = run.heads.copy()
        heads[frame : frame + frames] += off
        (found,) = of_poses(replace(run, heads=heads))
        assert found.kind is FindingKind.SPIKE
        assert found.frames == ((run.frames[frame], run.frames[frame + frames - 1]),)


@pytest.mark.parametrize(
    ("damage", "cm"),
    [
        (spiked(120.0), 0.05),
        (burst(5), 0.1),
        (exchanged(30, Mend.LEGS), 1.5),  # each bone is 5° off
        (exchanged(30, Mend.ARMS), 1.5),
        (flipped(12), 0.1),
        (flipped(12, of_parent=True), 0.1),
        (held(6), 0.05),
        (stretched(0.15), 0.15),
        (gap(1), 0.01),
        (gap(6), 0.1),
        (gap(2, 2), 0.01),
    ],
    ids=[
        "spikes",
        "a burst",
        "exchanged legs",
        "exchanged arms",
        "flips",
        "flips about an axis of the parent",
        "held frames",
        "bone lengths",
        "a missing frame",
        "a gap",
        "two gaps",
    ],
)
def test_the_remedy_brings_the_original_back(damage: Damage, cm: float) -> None:
    damaged = damage.of(jump())
    remedies = [finding.remedy for finding in of_poses(damaged.recording)]
    repairs = Repairs()
    for remedy in remedies:
        assert remedy is not None
        repairs = repairs.joined(remedy)
    assert 100.0 * apart(repaired(damaged.recording, repairs), damaged.original) < cm


def test_the_rest_pose_is_left_out_before_all_else() -> None:
    damaged = begun_at_rest(3).of(jump())
    diagnosis = diagnose(damaged.recording)
    assert [finding.kind for finding in diagnosis.findings] == [FindingKind.BIND_POSE]
    assert diagnosis.repairs == Repairs(trim=3)


@pytest.mark.slow
@pytest.mark.parametrize("frames", [1, 5])
def test_the_rest_pose_at_the_end_is_left_out_likewise(frames: int) -> None:
    """It was told as exchanged arms and a turn by half a turn."""
    damaged = ended_at_rest(frames).of(jump())
    diagnosis = diagnose(damaged.recording)
    assert [finding.kind for finding in diagnosis.findings] == [FindingKind.BIND_POSE]
    assert diagnosis.repairs == Repairs(trim_end=frames)
    assert diagnosis.kept == (jump().frames[0], jump().frames[-1 - frames])


def test_rest_poses_at_both_ends_are_one_finding() -> None:
    damaged = ended_at_rest(2).of(begun_at_rest(3).of(jump()).recording)
    (found,) = diagnose(damaged.recording).findings
    assert (found.kind, found.remedy) == (FindingKind.BIND_POSE, Repairs(trim=3, trim_end=2))
    first, last = jump().frames[0], jump().frames[-1]
    assert found.frames == ((first, first + 2.0), (last - 1.0, last))


@pytest.mark.slow
def test_several_damages_are_mended_together() -> None:
    damaged = spiked(90.0).of(slowed(1.25).of(raised(0.3).of(jump()).recording).recording)
    diagnosis = diagnose(damaged.recording)
    kinds = [FindingKind.SPIKE, FindingKind.TIME_SCALE, FindingKind.FLOOR]
    assert [finding.kind for finding in diagnosis.findings] == kinds
    mended = repaired(damaged.recording, diagnosis.repairs)
    assert mended.rate == pytest.approx(jump().rate)
    assert apart(mended, jump()) < 0.015


def test_frames_in_which_who_runs_is_further_on_the_way_are_spikes() -> None:
    damaged = leapt(0.13, 2).of(load_recording("run_1.bvh"))
    found = find_spikes(damaged.recording, figure_of(damaged.recording))
    assert found is not None
    mended = repaired(damaged.recording, Repairs(mend=(Mend.SPIKES,)))
    assert apart(mended, damaged.original) < 0.2 * apart(damaged.recording, damaged.original)


@pytest.mark.parametrize("up", [UpAxis.Y, UpAxis.X])
def test_a_figure_that_lies_is_set_upright(up: UpAxis) -> None:
    damaged = lain(up).of(jump())
    found = find_up(damaged.recording, figure())
    assert found is not None
    assert found.remedy == Repairs(up=up)
    assert apart(repaired(damaged.recording, found.remedy), damaged.original) < 1e-9
    (unseen,) = measure(damaged.recording, MotionProblem()).analysis.unseen
    assert isinstance(unseen, UnseenSupport)
    assert (unseen.lying, unseen.boxes) == (True, ())  # no box is offered


@pytest.mark.parametrize("up", [UpAxis.Y, UpAxis.X, UpAxis.MINUS_Y])
def test_a_motion_that_lies_though_its_rest_stands_is_set_upright(up: UpAxis) -> None:
    damaged = lain(up, rest=False).of(jump())
    (found,) = diagnose(damaged.recording).findings
    assert (found.kind, found.remedy) == (FindingKind.UP_AXIS, Repairs(up=up))
    assert apart(repaired(damaged.recording, Repairs(up=up)), damaged.original) < 1e-9


def test_who_is_upside_down_in_the_motion_alone_is_set_upright() -> None:
    over = np.diag([1.0, -1.0, -1.0])
    damaged = replace(jump(), heads=jump().heads @ over, rotations=over @ jump().rotations)
    found = find_up(damaged, figure())
    assert found is not None
    assert found.remedy == Repairs(up=UpAxis.MINUS_Z)


def turned_about_the_toes(degrees: np.ndarray) -> Recording:
    """The first frame's pose, turned about the axis from side to side, by so much in each frame."""
    still = jump().heads[0]
    toes = still[figure().of(Part.TOE)].mean(axis=0)
    turns = axis_rotation(0, np.radians(degrees))
    heads = toes + np.einsum("tij,bj->tbi", turns, still - toes)
    return replace(jump(), heads=heads, rotations=turns[:, None] @ jump().rotations[:1])


def test_who_does_push_ups_lies_in_truth() -> None:
    """On the toes, which are lowest, and along the figure the last, all the while."""
    lying = turned_about_the_toes(80.0 + 10.0 * np.sin(2.0 * np.pi * jump().times))
    assert find_up(lying, figure()) is None


def test_who_lies_still_lies_in_truth() -> None:
    """Nothing goes, so that nothing tells what carries."""
    assert find_up(turned_about_the_toes(np.full(len(jump().times), 90.0)), figure()) is None


def test_who_hangs_by_the_feet_and_swings_is_upside_down_in_truth() -> None:
    """The feet keep their place and the hands go, as of a turned object, but above the floor."""
    swings = 180.0 + 30.0 * np.sin(2.0 * np.pi * 0.35 * jump().times)
    hanging = turned_about_the_toes(swings)
    lifted = hanging.heads + np.array([0.0, 0.0, 2.2])
    assert find_up(replace(hanging, heads=lifted), figure()) is None


def test_a_figure_that_lies_is_told_so_not_that_it_sits() -> None:
    lying = lain(UpAxis.Y).of(jump()).recording
    sits = OffBalance(((10.0, 80.0), (120.0, 200.0)))
    (told,) = with_cause((sits,), lying, {})
    assert isinstance(told, UnseenSupport)
    assert told.lying
    assert (told.first, told.last) == (10.0, 200.0)
    assert with_cause((sits,), jump(), {}) == (sits,)
