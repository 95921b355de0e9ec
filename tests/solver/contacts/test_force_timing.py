"""Contacts begin and end when force plates say, at whatever rate the feet are recorded."""

import csv
import json

import numpy as np
import pytest
from hangtime.bridge.formats.bvh import read_bvh
from hangtime.bridge.formats.motion_clip import to_recording
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.performance import find_contacts, perform
from hangtime.solver.body.character import build_character
from hangtime.solver.data.contacts import ContactSchedule
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.numerics.interpolation import interpolate
from hangtime.tests.helpers.clips import load_recording, mocap_path

RUN = "BMC_run.bvh"  # the one recording held here with measured forces
WITHIN = 0.025  # s; one of its feet lands flat, so that nothing turns
LOADED = 0.05  # of the body's weight
JUMP = "forward_jump_116cm.bvh"


def schedule_of(recording: Recording) -> ContactSchedule:
    return find_contacts(perform(recording, build_character(recording)))


def at_rate(recording: Recording, rate: float) -> Recording:
    """The recording at another number of frames a second, cubic between its own."""
    times = np.arange(0.0, recording.times[-1] + 1e-9, 1.0 / rate)
    heads, turned = (
        interpolate(recording.times, of, times) for of in (recording.heads, recording.rotations)
    )
    left, _, right = np.linalg.svd(turned)  # the nearest rotations
    return Recording(recording.name, recording.bones, times * rate, times, heads, left @ right)


def measured(side: str) -> tuple[float, float]:
    """When a foot's plate is loaded, s."""
    path = mocap_path(RUN)
    weight = json.loads(path.with_suffix(".json").read_text())["subject_mass_kg"] * 9.81
    with path.with_name("BMC_run_grf.csv").open() as file:
        rows = list(csv.DictReader(file))
    loaded = [float(r["time_s"]) for r in rows if float(r[f"{side}_fy_N"]) > LOADED * weight]
    return loaded[0], loaded[-1]


@pytest.mark.parametrize("side", ["left", "right"])
def test_stances_against_force_plates(side: str) -> None:
    recording = to_recording(read_bvh(mocap_path(RUN)), 0.01, "Y")
    start, end = measured(side)
    mine = [
        c
        for c in schedule_of(recording).contacts
        if c.point.startswith(side.capitalize()) and c.start < end and c.end > start
    ]
    assert min(c.start for c in mine) == pytest.approx(start, abs=WITHIN)
    assert max(c.end for c in mine) == pytest.approx(end, abs=WITHIN)


@pytest.mark.slow
@pytest.mark.parametrize("rate", [24, 30, 60, 100, 240])
def test_times_do_not_depend_on_the_frame_rate(rate: int) -> None:
    recording = load_recording(JUMP)
    (usual,), (flight,) = (
        schedule_of(each).flights for each in (recording, at_rate(recording, rate))
    )
    assert flight.start == pytest.approx(usual.start, abs=0.5 / rate)
    assert flight.end == pytest.approx(usual.end, abs=0.5 / rate)


@pytest.mark.slow
def test_a_landing_between_coarse_frames_is_the_same_wherever_the_range_begins() -> None:
    """Between frames of 24/1.001 a second the feet are interpolated, and bend at the frames."""
    recording, rate = load_recording(JUMP), 24.0 / 1.001
    coarse, (usual,) = at_rate(recording, rate), schedule_of(recording).flights
    landings = []
    for first in (19, 22, 23, 27):
        schedule = analyse(coarse, MotionProblem(frames=(float(first), 55.0))).schedule
        landings += [flight.end + first / rate for flight in schedule.flights]
    assert len(landings) == 4
    assert max(landings) - min(landings) < 0.005
    assert np.abs(np.array(landings) - usual.end).max() < 1.0 / rate


@pytest.mark.parametrize("rate", [24, 30])
def test_the_last_frames_of_a_run_fly_though_the_body_is_about_its_highest_point(rate: int) -> None:
    """In two or three frames there it goes up and comes back, and tells no acceleration."""
    recording = load_recording("run_1.bvh")
    usual, coarse = (schedule_of(each).flights for each in (recording, at_rate(recording, rate)))
    assert len(coarse) == len(usual) == 4
    assert coarse[-1].start == pytest.approx(usual[-1].start, abs=0.5 / rate)


@pytest.mark.parametrize("clip", ["run_1.bvh", "run_2.bvh", "fair1_jumping.bvh", JUMP])
def test_heel_and_toe_hand_over(clip: str) -> None:
    """The force moves along the foot while both ends are down."""
    contacts = schedule_of(load_recording(clip)).contacts
    for heel in (c for c in contacts if "heel" in c.point):
        toe = heel.point.replace("heel", "toe")
        both = [min(c.end, heel.end) - max(c.start, heel.start) for c in contacts if c.point == toe]
        assert max(both) > 0.03


def test_a_foot_that_turns_smoothly_in_the_air_has_not_landed() -> None:
    schedule = schedule_of(load_recording("fair1_jumping.bvh"))
    landing = schedule.flights[0].end
    landed = [c.start for c in schedule.contacts if abs(c.start - landing) < 0.1]
    assert len(landed) == 4
    assert max(landed) - min(landed) < 0.03  # a filtered recording: nothing in it is an impact
