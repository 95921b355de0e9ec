"""Contacts and flights of recordings: by what their notes say, by gravity and by force plates."""

import json
from functools import cache

import numpy as np
import pytest
from hangtime.bridge.formats.bvh import read_bvh
from hangtime.bridge.formats.motion_clip import to_recording
from hangtime.devtools.doctor.damages.damage import at_rate
from hangtime.devtools.filters import low_pass
from hangtime.devtools.recordings import HOPS
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.performance import Performance, contact_points, find_contacts, perform
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import build_character
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.local_poses import LocalPoses
from hangtime.solver.fitting.fit import fit
from hangtime.solver.numerics.rotations import rotation_matrix
from hangtime.tests.helpers.clips import load_recording, mocap_path

FRAME = 1 / 120
TWO_FRAMES = 2 * FRAME + 1e-4
CHILD = "fair1_jumping.bvh"
LISTED = {  # from the recordings' README: flights read at 6 cm
    "forward_jump_116cm.bvh": [(1.51, 1.89)],
    "forward_jump_114cm.bvh": [(2.02, 2.38)],
    "high_jump.bvh": [(1.37, 1.83)],
    HOPS: [
        (1.92, 2.24),
        (3.60, 3.87),
        (4.98, 5.30),
        (6.56, 6.91),
        (10.75, 11.09),
        (12.93, 13.24),
        (14.84, 15.17),
        (18.48, 18.80),
        (20.29, 20.62),
        (21.96, 22.30),
    ],
    "131_03_hop.bvh": [(1.64, 1.85)],
    CHILD: [(2.49, 2.80)],
}
RUNS = [f"run_{i}.bvh" for i in (1, 2, 3)]
IN_PLACE = "hops_in_place.bvh"
JACKS = "cmu1_jumping_jacks.bvh"
DANCE = "rokoko_jesse_dance.bvh"
PLATES = {  # recordings with measured forces; how near both ends of a flight must be to them, s
    "BMC_run.bvh": 0.025,  # a heel strike in a soft shoe; recorded at 150 Hz
}


@cache
def performance(clip: str) -> Performance:
    recording = load_recording(clip)
    return perform(recording, build_character(recording))


def feet_above(p: Performance, threshold: float) -> list[tuple[float, float]]:
    """Intervals, s, in which every ankle, ball and toe tip is more than `threshold` m up."""
    heights = []
    for side in (Side.LEFT, Side.RIGHT):
        foot, toe = p.character.body(Part.FOOT, side), p.character.body(Part.TOE, side)
        assert foot is not None
        assert toe is not None
        tip = p.centres[:, toe] + p.rotations[:, toe] @ p.character.bodies[toe].tip
        heights += [p.centres[:, foot, 2], p.centres[:, toe, 2], tip[:, 2]]
    lowest = np.min(heights, axis=0)
    up = np.concatenate(([0], lowest - np.percentile(lowest, 5) > threshold, [0]))
    edges = np.flatnonzero(np.diff(up))
    spans = [(p.times[a], p.times[b - 1]) for a, b in edges.reshape(-1, 2)]
    return [(a, b) for a, b in spans if b - a > 0.04 and b < p.times[-1]]


def force_crossing(p: Performance, near: float, fraction: float = 0.05) -> float:
    """The instant nearest to `near` at which m (c'' + g) passes 5 % of body weight, s.

    c'' comes from a quartic through 5 frames: anything smoother smears the edge.
    """
    nearby = np.arange(-2, 3) * FRAME
    second = 2 * np.linalg.inv(np.vander(nearby, increasing=True))[2]
    force = 1 + np.convolve(p.com[:, 2], second[::-1], "same") / 9.81 - fraction
    i = np.flatnonzero(np.diff(np.sign(force)))
    instants = p.times[i] + FRAME * force[i] / (force[i] - force[i + 1])
    return float(instants[np.argmin(np.abs(instants - near))])


@pytest.mark.parametrize("clip", LISTED)
def test_the_listed_flights_are_what_six_centimetres_show(clip: str) -> None:
    read = [s for s in feet_above(performance(clip), 0.06) if s[1] - s[0] > 0.15]
    assert len(read) == len(LISTED[clip])
    assert np.abs(np.array(read) - LISTED[clip]).max() <= TWO_FRAMES + 0.005  # rounded to 10 ms


@pytest.mark.parametrize("clip", LISTED)
def test_flights_hold_the_listed_ones_and_little_more(clip: str) -> None:
    """6 cm take at most 60 ms at 1 m/s, the slowest take-off here, and 40 ms coming down."""
    found = np.array([(f.start, f.end) for f in find_contacts(performance(clip)).flights])
    before, after = (found - LISTED[clip]).T * [[-1], [1]]
    assert np.all((before >= -FRAME) & (before <= 0.065))
    assert np.all((after >= -FRAME) & (after <= 0.045))


@pytest.mark.parametrize("clip", [*LISTED, *RUNS, IN_PLACE, JACKS])
def test_the_body_falls_in_every_flight(clip: str) -> None:
    p = performance(clip)
    for flight in find_contacts(p).flights:
        if flight.end == p.times[-1]:
            continue
        during = (p.times >= flight.start) & (p.times <= flight.end)
        fall = 2 * np.polyfit(p.times[during], p.com[during, 2], 2)[0]
        assert fall == pytest.approx(-9.81, abs=3.4 if clip == IN_PLACE else 1.1)


def test_flights_end_where_the_centre_of_mass_says() -> None:
    """Within 2 frames for most, 3 for all: such crossings themselves err by up to 30 ms when
    compared with force plates, more than the feet do.
    """
    late = []
    for clip in [c for c in LISTED if c != CHILD] + RUNS + [IN_PLACE]:
        p = performance(clip)
        for flight in find_contacts(p).flights:
            ends = (flight.start, flight.end)
            late += [t - force_crossing(p, t) for t in ends if 0.0 < t < p.times[-1]]
    assert len(late) > 70
    assert np.abs(late).max() <= 3 * FRAME + 1e-3
    assert np.mean(np.abs(late) <= TWO_FRAMES) > 0.85
    assert abs(np.median(late)) < FRAME


@pytest.mark.parametrize("clip", RUNS)
def test_runs(clip: str) -> None:
    p = performance(clip)
    flights = find_contacts(p).flights
    for start, end in feet_above(p, 0.035):
        assert 0.07 - FRAME <= end - start <= 0.13 + FRAME  # as listed
        (flight,) = [f for f in flights if f.start < end and f.end > start]
        assert -0.055 <= flight.start - start <= FRAME
        assert -0.03 - FRAME <= flight.end - end <= 0.03  # heel strikes high, a sole is pressed
    assert all(0.08 < f.end - f.start < 0.18 for f in flights if f.end < p.times[-1])


def test_many_hops() -> None:
    in_place = performance(IN_PLACE)
    hops = find_contacts(in_place).flights
    assert len(hops) == len(feet_above(in_place, 0.06)) == 13
    jacks = performance(JACKS)
    found = find_contacts(jacks).flights
    listed = feet_above(jacks, 0.035)
    assert len(found) == len(listed) == 6
    for flight, (start, end) in zip(found, listed, strict=True):
        assert -2 / 30 <= flight.start - start <= 1 / 30
        assert -0.01 <= flight.end - end <= 3 / 30  # one toe hangs lower than the other


def test_no_flight_in_a_dance_whose_floor_drifts() -> None:
    assert find_contacts(performance(DANCE)).flights == ()


def test_a_toe_that_pauses_in_the_air_as_it_comes_down_does_not_touch_yet() -> None:
    """Recorded in a turning step of the ten hops, whose other foot carries: 3.5 cm up."""
    hops = performance(HOPS)
    starts = [c.start for c in find_contacts(hops).contacts if c.point == "Left toe"]
    (landed,) = [t for t in starts if 9.08 < t < 9.42]
    points, floor_m = contact_points(hops)
    track = points["Left toe"].track
    swinging = (hops.times > landed - 0.08) & (hops.times < landed - 0.03)
    assert track[swinging, 2].min() - floor_m > 0.02
    speeds = np.linalg.norm(np.gradient(track, hops.times, axis=0)[swinging, :2], axis=1)
    assert speeds.min() > 1.0
    assert landed > 9.24  # the pause is at 9.21


@pytest.mark.parametrize("clip", ["forward_jump_116cm.bvh", "high_jump.bvh"])
def test_feet_stand_on_the_floor_and_stay_there(clip: str) -> None:
    p = performance(clip)
    points, found = contact_points(p)[0], find_contacts(p)
    assert found.floor_m == 0.0
    for c in found.contacts:
        track = points[c.point].track[(p.times > c.start + 0.03) & (p.times < c.end - 0.03)]
        assert abs(c.place[2]) < 0.03
        if len(track):
            assert (
                np.median(np.linalg.norm(track - c.place, axis=1)) < 0.025
            )  # a heel that rises slowly
    first, last = found.phases[0], found.phases[-1]
    for phase in (first, last):
        touching = {c.point for c in found.of_phase(phase)}
        assert touching == {name for name, point in points.items() if point.kind.is_of_foot}
    for side in ("Left", "Right"):
        heel, toe = (
            [c for c in found.contacts if c.point == f"{side} {e}"] for e in ("heel", "toe")
        )
        assert heel[0].end < toe[0].end - 0.06  # the foot rolls over the toe when it leaves


def as_filmed(recording: Recording, seed: int) -> Recording:
    """As video capture gives it: 30 Hz, turns off by 1.5° and the body by 4 mm, eight times as much
    in the camera's depth, all of it slower than 4 Hz."""
    clean, rng = at_rate(recording, 30.0), np.random.default_rng(seed)
    local = LocalPoses.of(clean)
    frames, bones = local.rotations.shape[:2]

    def slow(*shape: int) -> FloatArray:
        noise = low_pass(rng.normal(size=(frames, *shape)), 30.0, 4.0)
        return np.asarray(noise / noise.std())

    turns = np.radians(1.5) / np.sqrt(3.0) * slow(bones, 3)
    local.heads[:, 0] += 0.004 * np.array([1.0, 8.0, 1.0]) * slow(3)
    filmed = LocalPoses(local.rotations @ rotation_matrix(turns), local.heads)
    return filmed.posed(clean)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("clip", ["forward_jump_116cm.bvh", "high_jump.bvh", CHILD])
def test_standing_feet_stand_however_video_capture_shifts_them(clip: str, seed: int) -> None:
    """They were three times as many contacts."""
    filmed = as_filmed(load_recording(clip), seed)
    found = find_contacts(perform(filmed, build_character(filmed)))
    clean = find_contacts(performance(clip))
    assert abs(len(found.contacts) - len(clean.contacts)) <= 3
    assert len(found.flights) == len(clean.flights)


@pytest.mark.slow
def test_what_video_capture_shifts_is_fitted_by_centimetres() -> None:
    filmed = as_filmed(load_recording("high_jump.bvh"), 0)
    found = analyse(filmed, MotionProblem())
    motion = fit(found.performance, found.schedule).motion
    off = motion.joint_centres(found.performance.times) - found.performance.centres
    assert np.sqrt((off**2).sum(axis=2).mean()) < 0.06


@pytest.mark.parametrize("trial", PLATES)
def test_flights_against_force_plates(trial: str) -> None:
    path = mocap_path(trial)
    recording = to_recording(read_bvh(path), 0.01, "Y")
    flights = find_contacts(perform(recording, build_character(recording))).flights
    about = json.loads(path.with_suffix(".json").read_text())
    measured = [f for f in about["flights"] if f["how"] == "between plate contacts"]
    assert measured
    for true in measured:
        (found,) = [f for f in flights if f.start < true["end_s"] and f.end > true["start_s"]]
        assert found.start == pytest.approx(true["start_s"], abs=PLATES[trial])
        assert found.end == pytest.approx(true["end_s"], abs=PLATES[trial])
