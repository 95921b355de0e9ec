"""What was found and how well it holds, as numbers with their units in the keys.

bw is the body's weight.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..body.character import Character
from ..data.constants import STANDARD_GRAVITY
from ..data.contacts import Phase, PhaseKind
from ..data.problem import MotionProblem, OffsetAxes, Pin
from ..data.requests import ConeShape, Dynamics, Method
from ..optimisation.sqp import Outcome
from ..stages.fit import Fit
from ..stages.implicit import Adaptation
from ..transcription.constraint import DenseViolation
from ..transcription.contact_pins import PointContact
from ..transcription.motion import Motion, dynamics_residual, pinned_instants
from .flight_summary import apex, flights, frames_per_second, jumps, recorded_apex, scene_frame
from .npz_export import instants
from .torque_curve import exact_torques, torque_curve
from .violations import missed_conditions, pins_of_contacts, shown, worst_constraints

RATE = 1000.0  # Hz, of what is measured between the nodes
LIGHTEST = 0.2  # BW
Json = dict[str, Any]


@dataclass(frozen=True)
class Origin:
    """Where a recording came from and how it was read; None where nothing had to be settled.

    unit_m: m per unit of length in the file. up: its axis that points up.
    """

    clip: str
    unit_m: float | None = None
    unit_guessed: bool = False
    up: str | None = None
    up_guessed: bool = False


def report(
    adaptation: Adaptation,
    problem: MotionProblem,
    origin: Origin,
) -> Json:
    """Everything about an adaptation that a JSON file can hold; what is not finite is None."""
    fit, motion, schedule = adaptation.fit, adaptation.motion, adaptation.setup.schedule
    pins = pins_of_contacts(fit, problem)
    contacts = motion.transcription.contacts
    content = {
        "status": adaptation.outcome.status.value,
        "recording": _recording(fit, origin),
        "figure": _figure(fit, motion, problem),
        "pins": [_pin(pin) for pin in problem.pins],
        "solves": _solves(fit.outcomes, "fit") + _solves(adaptation.outcomes, "adapt"),
        "unknowns": motion.transcription.n_unknowns,
        "rows": len(motion.transcription.values(motion.x, motion.places)),
        "equations": [
            {"name": name, "violation": amount, "unit": unit}
            for name, amount, unit in worst_constraints(adaptation, problem, least=0.0)
        ],
        "conditions": [
            _condition(each, fit, motion.transcription.character)
            for each in missed_conditions(adaptation)
        ],
        "contacts": [
            _contact(motion, adaptation, i, pins.get(contacts[i].contact.name))
            for i in range(len(contacts))
        ],
        "between_nodes": dense_residuals(motion, schedule.phases),
        "forces": _forces(motion, adaptation),
        "objective_end_over_start": adaptation.gain,
        "reduction": _reduction(adaptation),
        "torques": _torques(adaptation, problem) if _in_play(problem) else None,
        "fit_to_recording": closeness(fit),
        "change": change(adaptation),
        "jumps": jumps(fit, motion, schedule),
    }
    finite: Json = _finite(content)
    return finite


# ---------------------------------------------------------------- what went in


def _recording(fit: Fit, origin: Origin) -> Json:
    recording = fit.performance.recording
    seconds = float(recording.times[-1])
    return {
        "clip": origin.clip,
        "action": recording.name,
        "first_frame": float(recording.frames[0]),
        "last_frame": float(recording.frames[-1]),
        "seconds": seconds,
        "frames_per_second": frames_per_second(fit),
        "unit_m": origin.unit_m,
        "unit_guessed": origin.unit_guessed,
        "up_axis": origin.up,
        "up_axis_guessed": origin.up_guessed,
    }


def _figure(fit: Fit, motion: Motion, problem: MotionProblem) -> Json:
    character = motion.transcription.character  # which may carry more than the fit's
    return {
        "mass_kg": character.mass,
        "mass_table": problem.mass_table.value,
        "height_m": character.height,
        "gravity_m_s2": character.gravity,
        "bodies": len(character.bodies),
        "degrees_of_freedom": character.n_dofs,
        "floor_m": fit.schedule.floor_m,
    }


def _pin(pin: Pin) -> Json:
    axes = "offset_world_m" if pin.axes is OffsetAxes.WORLD else "offset_forward_left_up_m"
    return {
        "name": pin.name,
        "phase": pin.phase,
        "points": list(pin.touching),
        axes: list(pin.offset),
        "place_m": None if pin.place is None else list(pin.place),
        "turn_deg": math.degrees(pin.turn),
    }


def _solves(outcomes: Sequence[Outcome], name: str) -> list[Json]:
    return [
        {
            "name": outcome.steps[0].stage if outcome.steps else name,
            "status": outcome.status.value,
            "iterations": len(outcome.steps),
            "violation_over_tolerance": outcome.violation,
        }
        for outcome in outcomes
    ]


# ---------------------------------------------------------------- how well it holds


def _condition(missed: DenseViolation, fit: Fit, character: Character) -> Json:
    amount, unit = shown(missed.amount, missed.kind, character)
    return {
        "name": missed.name,
        "kind": missed.kind.value[0],
        "worst_violation": amount,
        "unit": unit,
        "worst_violation_frame": scene_frame(fit, missed.time),
        "met": missed.amount <= missed.kind.tolerance,
    }


def _contact(motion: Motion, adaptation: Adaptation, i: int, pin: str | None) -> Json:
    fit, at = adaptation.fit, motion.transcription.contacts[i]
    contact = at.contact
    pinned = pinned_instants(at, RATE)
    drift = motion.drift(i, pinned)
    settling = motion.drift(i, _settling(at))
    return {
        "name": contact.name,
        "pin": pin,
        "point": contact.point,
        "bone": contact.bone,
        "friction_coefficient": at.friction,
        "friction_cone": _cone(at),
        "start_s": contact.start,
        "end_s": contact.end,
        "start_frame": scene_frame(fit, contact.start),
        "end_frame": scene_frame(fit, contact.end),
        "pinned_from_s": at.pin_start,
        "pinned_to_s": at.pin_end,
        "fitted_place_m": adaptation.setup.start.places[i].tolist(),
        "place_m": motion.places[i].tolist(),
        "worst_violation_mm": 1000.0 * float(drift.max()),
        "worst_violation_frame": scene_frame(fit, float(pinned[drift.argmax()])),
        "worst_while_settling_mm": 1000.0 * float(settling.max()),
    }


def _cone(contact: PointContact) -> str:
    if contact.friction is None:
        return "none: a grip"
    shape = ConeShape.PYRAMID if contact.pyramid else ConeShape.EXACT
    return str(shape.value)


def _settling(contact: PointContact) -> FloatArray:
    """Instants at which a contact carries force but may still move, its pinned ends among them."""
    span = contact.contact
    before = span.start + instants(contact.pin_start - span.start, RATE)
    after = contact.pin_end + instants(span.end - contact.pin_end, RATE)
    return np.concatenate([before, after])


def dense_residuals(motion: Motion, phases: Sequence[Phase]) -> Json:
    """Root force (bw) and moment (bw·m) that nothing explains, between the nodes too."""
    left = dynamics_residual(motion, (instants(motion.duration, RATE) + 0.5 / RATE)[:-1])
    force, moment = (np.linalg.norm(part, axis=1) for part in (left.force, left.moment))
    content: Json = {"rate_hz": RATE}
    for kind in PhaseKind:
        inside = np.zeros(len(left.times), dtype=bool)
        for phase in phases:
            if phase.kind is kind:
                inside |= (left.times > phase.start) & (left.times < phase.end)
        if inside.any():
            content[kind.value] = {
                "force_rms_bw": _rms(force[inside]),
                "force_max_bw": float(force[inside].max()),
                "moment_rms_bw_m": _rms(moment[inside]),
                "moment_max_bw_m": float(moment[inside].max()),
            }
    return content


def _forces(motion: Motion, adaptation: Adaptation) -> Json:
    fit = adaptation.fit
    times = instants(motion.duration, RATE)
    forces = motion.forces(times) / (motion.transcription.character.mass * STANDARD_GRAVITY)
    ground = forces.sum(axis=1)
    total = np.linalg.norm(ground, axis=1)
    # Where the ground hardly carries, a shoe may slip a little; that is no need of friction.
    carried = np.where(ground[:, 2] > LIGHTEST, ground[:, 2], np.inf)
    grip = np.linalg.norm(ground[:, :2], axis=1) / carried
    peaks = []
    for phase in adaptation.setup.schedule.phases:
        inside = (times >= phase.start) & (times <= phase.end)
        if phase.kind is PhaseKind.GROUND and inside.any():
            at = int(np.argmax(np.where(inside, total, -1.0)))
            peak = {"peak_bw": float(total[at]), "frame": scene_frame(fit, float(times[at]))}
            needed = {"friction_coefficient_needed": float(grip[inside].max())}
            peaks.append({"phase": phase.name, **peak, **needed})
    smallest = float(forces[:, :, 2].min(initial=0.0))
    return {"peaks": peaks, "smallest_vertical_force_bw": smallest}


def closeness(fit: Fit) -> Json:
    """How far the fit is from the recording, at the recording's frames."""
    performance = fit.performance
    apart = fit.motion.joint_centres(performance.times) - performance.centres
    lost = [apex(fit.motion, f) - recorded_apex(fit, f) for f in flights(fit)]
    return {
        "joint_centres_rms_cm": 100.0 * _rms(np.linalg.norm(apart, axis=2)),
        "pelvis_apex_difference_cm": 100.0 * max(lost, key=abs, default=0.0),
    }


def _reduction(adaptation: Adaptation) -> Json | None:
    """The reduced figure, with the curve that its size is chosen by."""
    space = adaptation.setup.space
    if space is None:
        return None
    return {
        "kind": space.kind.value,
        "degrees_of_freedom": space.basis.shape[1],
        "eigenvalues_rad2": space.eigenvalues.tolist(),
        "explained_share": space.explained.tolist(),
    }


def _in_play(problem: MotionProblem) -> bool:
    """Whether torques matter to the problem."""
    solution = problem.requests.solution
    return (
        bool(problem.requests.torques)
        or solution.method is not Method.IMPLICIT
        or solution.dynamics is Dynamics.STANDARD
    )


def _torques(adaptation: Adaptation, problem: MotionProblem) -> Json:
    """The largest torque at every joint, and the splines that hold them."""
    motion, torques = adaptation.motion, adaptation.setup.torques
    times = (instants(motion.duration, RATE) + 0.5 / RATE)[:-1]
    sizes = np.abs(exact_torques(motion, torques, times))
    character = motion.transcription.character
    peaks = {}
    for body, joint in zip(character.bodies[1:], character.joints[1:], strict=True):
        peaks[body.bone] = float(sizes[:, joint.first - 3 : joint.dofs.stop - 3].max())
    curve = torque_curve(motion, torques, longest=problem.requests.solution.torque_span)
    return {
        "peaks_nm": [{"bone": bone, "peak_nm": peak} for bone, peak in peaks.items()],
        "spline_unknowns": curve.n_coefficients * sizes.shape[1],
        "spline_error_rms_nm": curve.error,
    }


# ---------------------------------------------------------------- what changed


def change(adaptation: Adaptation) -> Json:
    """How far the motion is from the fit, at the recording's frames and on its own time."""
    times = adaptation.fit.performance.times
    moved = adaptation.setup.context.timeline.to_new(times)
    kept = moved <= adaptation.motion.duration
    was, now = adaptation.fit.motion, adaptation.motion
    places = now.joint_centres(moved[kept]) - was.joint_centres(times[kept])
    angles = now.angles(moved[kept])[:, 3:] - was.angles(times[kept])[:, 3:]
    return {
        "joint_centres_rms_cm": 100.0 * _rms(np.linalg.norm(places, axis=2)),
        "joint_angles_rms_deg": math.degrees(_rms(angles)),
    }


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _finite(value: Any) -> Any:
    """The same with plain numbers, and None for those that JSON cannot hold."""
    match value:
        case dict():
            return {key: _finite(each) for key, each in value.items()}
        case list() | tuple():
            return [_finite(each) for each in value]
        case float() | np.floating():
            return float(value) if math.isfinite(value) else None
    return value
