"""What is reported of a real hop, against the motion itself and against Newton."""

import gc
import json
import math
import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hangtime.operators.words.report_text import apex_words, as_text
from hangtime.solver.data.contacts import PhaseKind
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.reports.report import Report, StageReport, as_json
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.status import Durations, Status
from hangtime.solver.results.fit_quality import fit_quality
from hangtime.solver.results.npz_export import instants, sample, save
from hangtime.solver.results.report import report
from hangtime.solver.results.violations import worst_constraints
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.tests.helpers.fitted_hop import fitted_hop

PROBLEM = MotionProblem(pins=(Pin("Landing", "ground 2", offset=(0.3, 0.0, 0.2)),))


@cache
def further() -> Adaptation:
    """The hop with its landing 0.3 m further and 0.2 m up."""
    return adapt(fitted_hop(), PROBLEM)


@cache
def found() -> Report:
    return report(further(), PROBLEM, Origin("hop.bvh", 0.0564, True, "Y", True))


@cache
def content() -> dict:
    return as_json(found())


@cache
def trajectory() -> dict[str, np.ndarray]:
    return sample(further().motion)


def phases(kind: str) -> list:
    return [p for p in further().setup.schedule.phases if p.kind.value == kind]


def test_no_apex_is_told_of_a_clip_that_ends_in_the_air() -> None:
    """It would be the height at the clip's end, and no apex."""
    fit = fitted_hop()
    (flight,) = (p for p in fit.schedule.phases if p.kind is PhaseKind.FLIGHT)
    assert fit_quality(fit).pelvis_apex_difference_cm is not None
    in_the_air = replace(fit, schedule=replace(fit.schedule, duration=flight.end))
    told = fit_quality(in_the_air).pelvis_apex_difference_cm
    assert told is None
    assert apex_words(told) == ""
    assert apex_words(-0.01) == ", apex as high as recorded"


def test_the_body_that_the_fit_turns_furthest_is_told() -> None:
    hop = fitted_hop()
    performance, told = hop.performance, fit_quality(hop)
    frame = int(np.argmin(np.abs(performance.recording.frames - told.most_turned_frame)))
    (body,) = [i for i, b in enumerate(performance.character.bodies) if b.name == told.most_turned]
    now = hop.motion.pose(performance.times[frame : frame + 1]).rotations[0, body]
    cosine = (np.trace(performance.rotations[frame, body].T @ now) - 1.0) / 2.0
    assert told.most_turned_deg == pytest.approx(np.degrees(np.arccos(cosine)), rel=1e-6)
    assert 1.0 < told.most_turned_deg < 60.0


def test_the_hop_is_solved() -> None:
    assert content()["status"] == "solved"


def test_a_report_is_json_without_infinities() -> None:
    assert json.loads(json.dumps(content(), allow_nan=False)) == content()


def test_what_is_not_finite_becomes_none() -> None:
    origin = Origin("hop.bvh", unit_m=math.nan)
    assert as_json(report(further(), PROBLEM, origin))["recording"]["unit_m"] is None


def test_numbers_carry_units() -> None:
    bare = {"bodies", "degrees_of_freedom", "unknowns", "rows", "iterations", "violation"}
    bare |= {"value", "limit", "recorded", "worst_violation"}  # whose unit is beside them
    units = ("_m", "_s", "_frame", "_kg", "_hz", "_bw", "_bw_m", "_mm", "_cm", "_deg", "seconds")
    units += ("frame", "_frames", "_per_second", "_over_tolerance", "_coefficient_needed", "_m_s2")
    units += ("_coefficient", "_over_start", "_share", "_rad2")

    def check(key: str, value: object) -> None:
        match value:
            case bool() | None | str():
                pass
            case dict():
                for inner, each in value.items():
                    check(inner, each)
            case list():
                for each in value:
                    check(key, each)
            case _:
                assert key in bare or key.endswith(units), key

    check("", content())


def test_contacts_of_the_landing_carry_the_pins_name() -> None:
    landing = phases("ground")[1]
    for contact in content()["contacts"]:
        in_landing = contact["end_s"] > landing.start and contact["start_s"] < landing.end
        assert contact["pin"] == ("Landing" if in_landing else None)


def test_contacts_state_frames_of_the_scene() -> None:
    recording = fitted_hop().performance.recording
    for contact in content()["contacts"]:
        frame = recording.frames[0] + 120.0 * contact["start_s"]
        assert contact["start_frame"] == pytest.approx(frame, abs=0.01)


def test_pins_hold_and_the_worst_frame_is_while_pinned() -> None:
    for i, contact in enumerate(content()["contacts"]):
        assert contact["worst_violation_mm"] < 1.0
        recording = fitted_hop().performance.recording
        at = (contact["worst_violation_frame"] - recording.frames[0]) / 120.0
        assert contact["start_s"] - 1e-4 <= at <= contact["end_s"] + 1e-4
        drift = further().motion.drift(i, np.array([at]))
        assert 1000.0 * drift[0] == pytest.approx(contact["worst_violation_mm"], abs=0.01)


def test_the_landing_moved_as_asked() -> None:
    for contact in content()["contacts"]:
        moved = np.subtract(contact["place_m"], contact["fitted_place_m"])
        expected = (0.3, 0.2) if contact["pin"] else (0.0, 0.0)
        assert (np.hypot(*moved[:2]), moved[2]) == pytest.approx(expected, abs=1e-9)


def test_nothing_is_unexplained_between_the_nodes() -> None:
    left = content()["between_nodes"]
    assert left["flight"]["force_rms_bw"] < 0.003
    assert left["flight"]["moment_rms_bw_m"] < 0.001
    assert left["ground"]["force_rms_bw"] < 0.02


def test_a_spoilt_motion_is_reported_so() -> None:
    solved = further()
    x = solved.outcome.x.copy()
    middle = len(x) // 2
    x[middle : middle + 3, 2] += 0.05  # m; the centre of mass bulges upwards
    spoilt = replace(
        solved,
        outcomes=(*solved.outcomes, replace(solved.outcome, x=x, status=Status.STALLED)),
    )
    bad = report(spoilt, PROBLEM, Origin("hop.bvh"))
    assert bad.status is Status.STALLED
    parts = (bad.between_nodes.ground, bad.between_nodes.flight)
    assert max(part.force_rms_bw for part in parts if part is not None) > 0.1
    fallen = next(v for v in worst_constraints(spoilt, PROBLEM) if v.kind is RowKind.BALANCE)
    span = solved.motion.duration * solved.fit.performance.recording.rate
    off = fallen.frame - float(solved.fit.performance.recording.frames[0]) - 0.5 * span
    assert abs(off) < 0.2 * span  # where the bulge is; knots are not even
    assert worst_constraints(solved, PROBLEM) == []
    assert "No motion was found" in as_text(bad)


def test_the_text_names_what_matters() -> None:
    text = as_text(replace(found(), stages=(StageReport("Fitting", 1.0),)))
    for word in ("hop.bvh", "Landing", "Left toe 2", "Guessed", "Fitting 1.0 s", "crouch"):
        assert word in text
    assert not re.search(r"\de-\d", text), "numbers have no exponents"


# ---------------------------------------------------------------- the trajectory


def test_samples_cover_the_clip_and_no_more() -> None:
    time = trajectory()["time"]
    assert time[0] == 0.0
    assert 0.0 <= further().motion.duration - time[-1] < 1e-3
    assert np.allclose(np.diff(time), 1e-3, atol=1e-12)
    assert instants(0.25, 240.0)[-1] == pytest.approx(0.25)


def test_shapes_and_names_agree() -> None:
    t = trajectory()
    count, bodies, points = len(t["time"]), len(t["body_names"]), len(t["contact_names"])
    assert t["com"].shape == (count, bodies, 3)
    assert t["rotation"].shape == (count, bodies, 3, 3)
    assert t["inertia"].shape == (bodies, 3, 3)
    assert t["contact_point"].shape == t["contact_force"].shape == (count, points, 3)
    assert sorted(t["contact_names"]) == ["Left heel", "Left toe", "Right heel", "Right toe"]
    assert t["mass"].sum() == pytest.approx(70.0)


def test_times_that_changed_are_told() -> None:
    flight, ground = (
        next(p for p in found().phases if p.phase == name) for name in ("flight 1", "ground 2")
    )
    (now,), (was,) = phases("flight"), fitted_hop().schedule.flights
    assert flight.adapted_s == pytest.approx(now.end - now.start)
    assert flight.recorded_s == pytest.approx(was.end - was.start)
    told = f"takes {flight.adapted_s:.3f} s instead of {flight.recorded_s:.3f} s"
    assert f"Flight 1    {told}" in as_text(found())
    assert ground.adapted_s == pytest.approx(ground.recorded_s)
    assert "Ground 2    takes" not in as_text(found())


def test_durations_that_were_not_found_are_told() -> None:
    assert found().durations is Durations.FOUND
    assert "As recorded" not in as_text(found())
    for instead in (Durations.NONE_FOUND, Durations.NOT_MET):
        assert "Durations   As recorded: " in as_text(replace(found(), durations=instead))


def test_newton_holds_for_the_samples_alone() -> None:
    """Force by central differences of momentum; away from instants at which it jumps."""
    t = trajectory()
    step = t["time"][1]
    com = np.einsum("b,tbi->ti", t["mass"] / t["mass"].sum(), t["com"])
    acceleration = (com[2:] - 2 * com[1:-1] + com[:-2]) / step**2
    force = t["contact_force"][1:-1].sum(axis=1)
    left = t["mass"].sum() * (acceleration - t["gravity"]) - force
    breaks = further().motion.transcription.basis.breaks
    clear = np.abs(t["time"][1:-1, None] - breaks).min(axis=1) > 1.5 * step
    assert np.abs(left[clear]).max() / (70.0 * 9.81) < 1e-4


def test_euler_holds_for_the_samples_alone() -> None:
    """Moment about the centre of mass by central differences of angular momentum, in flight."""
    t = trajectory()
    step = t["time"][1]
    com = np.einsum("b,tbi->ti", t["mass"] / t["mass"].sum(), t["com"])
    velocity = np.gradient(t["com"] - com[:, None], step, axis=0)
    turning = np.gradient(t["rotation"], step, axis=0) @ np.swapaxes(t["rotation"], -1, -2)
    spin = np.stack([turning[..., 2, 1], turning[..., 0, 2], turning[..., 1, 0]], axis=-1)
    world = t["rotation"] @ t["inertia"] @ np.swapaxes(t["rotation"], -1, -2)
    momentum = np.einsum("tbij,tbj->ti", world, spin)
    momentum += np.einsum("b,tbi->ti", t["mass"], np.cross(t["com"] - com[:, None], velocity))
    (flight,) = phases("flight")
    inside = (t["time"] > flight.start + 0.005) & (t["time"] < flight.end - 0.005)
    moment = np.gradient(momentum, step, axis=0)[inside] / (70.0 * 9.81)
    assert np.sqrt((moment**2).sum(axis=1).mean()) < 1e-3


def test_forces_are_zero_out_of_contact() -> None:
    t = trajectory()
    names = list(t["contact_names"])
    touching = np.zeros(t["contact_force"].shape[:2], dtype=bool)
    for contact in further().setup.schedule.contacts:
        during = (t["time"] >= contact.start) & (t["time"] <= contact.end)
        touching[:, names.index(contact.point)] |= during
    assert np.all(t["contact_force"][~touching] == 0.0)
    assert np.abs(t["contact_force"][touching]).max() > 300.0


def test_a_saved_trajectory_loads_without_pickles(tmp_path) -> None:
    save(further().motion, tmp_path / "trajectory.npz", rate=50.0)
    with np.load(tmp_path / "trajectory.npz", allow_pickle=False) as saved:
        assert set(saved) == set(trajectory())
        assert len(saved["time"]) == len(instants(further().motion.duration, 50.0))


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs Linux")
def test_a_full_disk_is_told_once() -> None:
    """What Python complains of afterwards, which it cannot raise, fails a test."""
    with pytest.raises(OSError, match="No space left"):
        save(further().motion, Path("/dev/full"), rate=50.0)
    gc.collect()


def test_physics_that_fails_between_the_nodes_is_said() -> None:
    """The equations may hold at the nodes, where the solver drove them to zero, alone."""
    good = found()
    assert "more than it should be" not in as_text(good)
    assert good.between_nodes.flight is not None
    flight = replace(good.between_nodes.flight, moment_rms_bw_m=0.002)
    bad = replace(good, between_nodes=replace(good.between_nodes, flight=flight))
    assert "more than it should be" in as_text(bad)


@pytest.mark.parametrize(
    ("pin", "told"), [("Left heel 2", "Left heel 2"), ("Heel", "Heel: Left heel 2")]
)
def test_a_pin_called_like_its_contact_is_named_once(pin: str, told: str) -> None:
    problem = MotionProblem(pins=(Pin(pin, "ground 2", ("Left heel 2",)),))
    names = {each.name for each in worst_constraints(further(), problem, least=0.0)}
    assert {name for name in names if "Left heel 2" in name} == {told}
