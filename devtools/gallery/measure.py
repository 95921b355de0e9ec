"""Measurements of a result: its physics by MuJoCo, its loads, its distance from the fit."""

import mujoco
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.body.passive_joints import evaluate_passive_torques
from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.data.contacts import Phase, PhaseKind
from ...solver.data.row_kinds import RowKind
from ...solver.stages.implicit import Adaptation
from ...solver.transcription.constraint import dense_violation
from ...solver.transcription.constraint_functions import PeakForce
from ...solver.transcription.motion import Motion
from ...solver.transcription.rows import ROOT_ANGLES
from ...solver.transcription.torque_constraint import TorqueFunction
from ..checks.mjcf import hinge_order
from ..checks.mujoco_check import Residual, check_motion
from .jobs import Json
from .looks import looks

IN_BLENDER = (RowKind.POINT, RowKind.BEND, RowKind.CONE)


def measured(adaptation: Adaptation) -> Json:
    """Everything that is measured without Blender, as JSON."""
    residual, torques = check_motion(adaptation.motion)
    return {
        "mujoco": mujoco.__version__,
        "residuals": _residuals(residual),
        "loads": _loads(adaptation, residual, torques),
        "conditions": conditions(adaptation, residual, torques),
        "from_fit": from_fit(adaptation),
        "shape": shape(adaptation),
        "looks": looks(adaptation),
    }


def _residuals(residual: Residual) -> Json:
    """Root force (BW) and moment (BW·m) that nothing explains, rms."""
    return {
        f"{where}_{part}": residual.rms(part, flying)
        for where, flying in (("flight", True), ("ground", False))
        for part in ("force", "moment")
    }


def _loads(adaptation: Adaptation, residual: Residual, torques: FloatArray) -> Json:
    """The largest joint torque and the largest force of the contacts together."""
    character = adaptation.motion.transcription.character
    angle = int(hinge_order(character)[np.abs(torques).max(axis=0).argmax()])
    joint = next(i for i, j in enumerate(character.joints) if j.first <= angle < j.dofs.stop)
    return {
        "peak_torque_nm": float(np.abs(torques).max()),
        "peak_torque_at": character.bodies[joint].bone,
        "peak_force_bw": float(np.linalg.norm(_needed(adaptation, residual), axis=1).max()),
    }


def _needed(adaptation: Adaptation, residual: Residual) -> FloatArray:
    """(T, 3) BW: the contact force that MuJoCo finds the movement to need."""
    weight = adaptation.motion.transcription.character.mass * STANDARD_GRAVITY
    applied = adaptation.motion.forces(residual.times).sum(axis=1) / weight
    return np.asarray(residual.force + applied)


def conditions(adaptation: Adaptation, residual: Residual, torques: FloatArray) -> list[Json]:
    """Worst violation of each constraint: torques and forces by MuJoCo, turns, poses and
    orientations by the solver's own measure between its rows; the rest is checked in Blender."""
    motion = adaptation.motion
    t = motion.transcription
    weight = t.character.mass * STANDARD_GRAVITY
    order = hinge_order(t.character)
    found = []
    for c in t.constraints:
        during = (residual.times >= c.start) & (residual.times <= c.end)
        entry: Json = {"name": c.name, "kind": c.kind.label, "by": "MuJoCo"}
        if isinstance(c.function, TorqueFunction):
            applied = _of_muscles(motion, residual.times, torques[:, np.argsort(order)])
            applied = applied[during][:, c.function.angles - ROOT_ANGLES]
            lower, upper = weight * c.bounds.lower, weight * c.bounds.upper
            over = np.maximum(np.maximum(applied - upper, lower - applied), 0.0)
            entry |= {"worst": float(over.max(initial=0.0)), "unit": "N·m"}
            entry |= {"bound_nm": (0.5 * (upper - lower)).tolist()}
        elif isinstance(c.function, PeakForce):
            total = np.linalg.norm(_needed(adaptation, residual)[during], axis=1)
            over = np.maximum(total - c.bounds.upper[0], 0.0) / c.bounds.upper[0]
            entry |= {"worst": 100.0 * float(over.max(initial=0.0)), "unit": "% of the bound"}
        elif c.kind in IN_BLENDER:
            continue
        else:
            off = dense_violation(c, t.character, t.basis, t.layout, motion.x)
            worst = off.kind.reported(off.amount, weight)
            entry |= {"worst": worst, "unit": off.kind.reported_unit, "by": "the solver"}
        found.append(entry)
    return found


def _of_muscles(motion: Motion, times: FloatArray, torques: FloatArray) -> FloatArray:
    """(T, n_angles - 3) N·m as limits are on them: without passive tissue's, about orthogonal axes.

    torques: (T, n_angles - 3) about the angles' own axes, in their order. The third axis of a ball
    joint is the first times the middle angle's sine and the one across times its cosine.
    """
    character = motion.transcription.character
    q, v = motion.angles(times), motion.angles(times, 1)
    found = torques.copy()
    for joint in character.joints[1:]:
        if joint.axes.dofs == 3:
            first, third = joint.first - ROOT_ANGLES, joint.first - ROOT_ANGLES + 2
            middle = q[:, joint.first + 1]
            found[:, third] -= np.sin(middle) * torques[:, first]
            found[:, third] /= np.cos(middle)
    passive = evaluate_passive_torques(character, q, v, orthogonal=True)
    return np.asarray(found - passive[:, ROOT_ANGLES:])


def from_fit(adaptation: Adaptation) -> Json:
    """Distance of the motion from the fit at corresponding instants, root included."""
    motion, fitted = adaptation.motion, adaptation.fit.motion
    times = np.linspace(0.0, motion.duration, int(motion.duration * 240.0))
    old = adaptation.setup.context.timeline.to_old(times)
    apart = np.linalg.norm(motion.joint_centres(times) - fitted.joint_centres(old), axis=2)
    turned = (motion.angles(times) - fitted.angles(old))[:, 3:]
    return {
        "joint_centres_rms_cm": 100.0 * float(np.sqrt((apart**2).mean())),
        "angles_rms_deg": float(np.degrees(np.sqrt((turned**2).mean()))),
    }


# ---------------------------------------------------------------- what the thesis tells of


def shape(adaptation: Adaptation) -> Json:
    """Measures that the thesis's claims are about: crouch, flight, and places of the hands."""
    motion, phases = adaptation.motion, adaptation.setup.schedule.phases
    flights = [p for p in phases if p.kind is PhaseKind.FLIGHT]
    if not flights:
        return {}
    flight = max(flights, key=lambda p: p.end - p.start)
    before = [p for p in phases if p.end <= flight.start + 1e-9]
    times = _during(flight)
    centres, com = motion.joint_centres(times), motion.com(times)
    content: Json = {
        "flight_s": flight.end - flight.start,
        "flight_length_m": float(np.linalg.norm((com[-1] - com[0])[:2])),
        "apex_m": float(com[:, 2].max()),
    }
    if before:
        content["crouch_m"] = float(motion.joint_centres(_during(before[-1]))[:, 0, 2].min())
    bodies = motion.transcription.character.bodies
    places = {(body.part.value, body.side): centres[:, i] for i, body in enumerate(bodies)}
    for (part, side), place in places.items():
        if part == "hand":
            out = np.linalg.norm((place - com)[:, :2], axis=1)
            arm = place - places["upper arm", side]
            content[f"{side.value}_hand_highest_m"] = float(place[:, 2].max())
            content[f"{side.value}_hand_out_m"] = float(out.mean())
            content[f"{side.value}_arm_raised_m"] = float(arm[:, 2].max())
    return content


def _during(phase: Phase) -> FloatArray:
    return np.linspace(phase.start, phase.end, 2 + int((phase.end - phase.start) * 240.0))
