"""The certificate: a motion's figures in the laboratory's words, each with the limit that it keeps.

Limits and where they come from are in LIMITS; those of torques follow from the body's height.
Contacts are looked at while a point carries load, from its first instant to its last.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray
from ..body.inverse_dynamics import InverseDynamics
from ..data.constants import STANDARD_GRAVITY
from ..data.reports.certificate import CertificateItem, CertificateLine
from ..data.reports.report import FitQuality
from ..fitting.fit import Fit
from ..human.strength import ECCENTRIC_FACTOR, LEG_JOINTS, peak_torque
from ..transcription.compliant_sole import SINKING_TIME
from ..transcription.contact_pins import PointContact
from ..transcription.motion import DynamicsResidual, Motion, motion_inverse_dynamics
from .flight_summary import FrameOf
from .npz_export import instants

SAMPLE_RATE = 1000.0  # Hz
FINE_RATE = 5000.0  # Hz, at a contact's ends, where points may be fast and load comes in no time
EDGE = 1e-6  # s; forces jump at a contact's ends, which are looked at from inside
LOADED = 0.05  # BW; a point with less may slip
# Of what the body weighs where it is, and BW, for where nothing weighs anything; below, a shoe may
# slip a little, which is no need of friction.
STANDING, LEAST_STANDING = 0.2, 0.02
RISE_TIME = 0.002  # s, over which a loading rate is taken

Item = CertificateItem
LIMITS: Mapping[CertificateItem, tuple[float, str]] = {
    # After Hicks et al., Is my model good enough?, Journal of Biomechanical Engineering 137 (2015):
    # of the largest external force, and of that times the height of the centre of mass.
    Item.RESIDUAL_FORCE_RMS_SHARE: (5.0, "%"),
    Item.RESIDUAL_FORCE_PEAK_SHARE: (5.0, "%"),
    Item.RESIDUAL_MOMENT_RMS_SHARE: (1.0, "%"),
    Item.RESIDUAL_MOMENT_PEAK_SHARE: (1.0, "%"),
    # OpenSim's checklist for simulations, residual reduction: "less than 5-15 N" rms, "10-25 N" at
    # the peak, 50 and 75 N·m; the upper ends.
    Item.RESIDUAL_FORCE_RMS: (15.0, "N"),
    Item.RESIDUAL_FORCE_PEAK: (25.0, "N"),
    Item.RESIDUAL_MOMENT_RMS: (50.0, "N·m"),
    Item.RESIDUAL_MOMENT_PEAK: (75.0, "N·m"),
    # Force plates under jumps and runs of public trials show 0.25 to 0.6, and 60 to 210 BW/s; the
    # hardest landings of gymnasts are of the order of 12 BW.
    Item.FRICTION: (0.6, ""),
    Item.PEAK_FORCE: (12.0, "BW"),
    Item.LOADING_RATE: (210.0, "BW/s"),
    # Of the order that feet and shoes give (`SOLE_COMPLIANCE` in `analysis/grounding.py`).
    Item.SLIDE: (5.0, "mm"),
    Item.UNDER: (5.0, "mm"),
    Item.ABOVE: (10.0, "mm"),
    # What is seen to be another pose.
    Item.FIT_RMS: (5.0, "cm"),
    Item.FIT_WORST_FRAME: (10.0, "cm"),
}
TORQUES = {"Hip": Item.HIP_TORQUE, "Knee": Item.KNEE_TORQUE, "Ankle": Item.ANKLE_TORQUE}


@dataclass(frozen=True)
class LoadedDrift:
    """Where a contact's point is off its place at instants (T,) s while it carries load, m.

    slide: (T,) along the surface. height: (T,) above it, negative under it. furthest: m, of the
    point from where it is held while it touches, loaded or not; furthest_at: when, s.
    """

    times: FloatArray
    slide: FloatArray
    height: FloatArray
    furthest: float
    furthest_at: float


def certificate(
    motion: Motion,
    left: DynamicsResidual,
    torques: FloatArray,
    drifts: Sequence[LoadedDrift],
    fit: FitQuality,
    frame: FrameOf,
) -> tuple[CertificateLine, ...]:
    """Every line of a motion with such residuals, torques (see `between_knots`) and drifts of its
    contacts, and of its fit."""
    return (
        *_of_motion(motion, left, torques, drifts, frame),
        _line(Item.FIT_RMS, fit.joint_centres_rms_cm),
        _line(Item.FIT_WORST_FRAME, fit.worst_frame_rms_cm, fit.worst_frame),
    )


def _of_motion(
    motion: Motion,
    left: DynamicsResidual,
    torques: FloatArray,
    drifts: Sequence[LoadedDrift],
    frame: FrameOf,
) -> Iterator[CertificateLine]:
    yield from _residuals(motion, left, frame)
    yield from _forces(motion, frame)
    yield from _torques(motion, left.times, np.abs(torques), frame)
    yield from _contacts(motion, drifts, frame)


def beside_recording(lines: Sequence[CertificateLine], fit: Fit) -> tuple[CertificateLine, ...]:
    """The lines of an adaptation of a fit, those of the motion with what the fit's own has."""
    if not fit.solved:
        return tuple(lines)
    if not fit.certified:
        left, torques = between_knots(fit.motion)
        drifts = loaded_drifts(fit.motion)
        found = _of_motion(fit.motion, left, torques, drifts, lambda time: time)
        fit.certified.update({line.item: line.value for line in found})
    return tuple(replace(line, recorded=fit.certified.get(line.item)) for line in lines)


def _line(
    item: CertificateItem, value: float, frame: float | None = None, where: str = ""
) -> CertificateLine:
    limit, unit = LIMITS[item]
    return CertificateLine(item, value, unit, limit, value <= limit, frame, where)


def _residuals(motion: Motion, left: DynamicsResidual, frame: FrameOf) -> Iterator[CertificateLine]:
    character, times = motion.transcription.character, left.times
    weight = character.mass * STANDARD_GRAVITY
    force, moment = (weight * np.linalg.norm(part, axis=1) for part in (left.force, left.moment))
    largest = float(np.linalg.norm(motion.forces(times).sum(axis=1), axis=1).max(initial=0.0))
    floor = min((place[2] for place in motion.places), default=0.0)
    height = float((motion.com(times)[:, 2] - floor).mean())
    worst = [frame(float(times[each.argmax()])) for each in (force, moment)]
    sizes = [(_rms(each), float(each.max())) for each in (force, moment)]
    shares = [100.0 / max(unit, weight * EDGE) for unit in (largest, largest * height)]
    yield _line(Item.RESIDUAL_FORCE_RMS_SHARE, sizes[0][0] * shares[0])
    yield _line(Item.RESIDUAL_FORCE_PEAK_SHARE, sizes[0][1] * shares[0], worst[0])
    yield _line(Item.RESIDUAL_MOMENT_RMS_SHARE, sizes[1][0] * shares[1])
    yield _line(Item.RESIDUAL_MOMENT_PEAK_SHARE, sizes[1][1] * shares[1], worst[1])
    yield _line(Item.RESIDUAL_FORCE_RMS, sizes[0][0])
    yield _line(Item.RESIDUAL_FORCE_PEAK, sizes[0][1], worst[0])
    yield _line(Item.RESIDUAL_MOMENT_RMS, sizes[1][0])
    yield _line(Item.RESIDUAL_MOMENT_PEAK, sizes[1][1], worst[1])


def _forces(motion: Motion, frame: FrameOf) -> Iterator[CertificateLine]:
    times = instants(motion.duration, SAMPLE_RATE)
    forces = motion.forces(times) / (motion.transcription.character.mass * STANDARD_GRAVITY)
    total = forces.sum(axis=1)
    friction = friction_of(motion, times, forces)
    size = np.linalg.norm(total, axis=1)
    step = round(RISE_TIME * SAMPLE_RATE)
    rate = (total[step:, 2] - total[:-step, 2]) / RISE_TIME
    for item, values in (
        (Item.FRICTION, friction),
        (Item.PEAK_FORCE, size),
        (Item.LOADING_RATE, rate),
    ):
        yield _line(item, float(values.max()), frame(float(times[values.argmax()])))


def friction_of(motion: Motion, times: FloatArray, forces: FloatArray) -> FloatArray:
    """`friction_used` of a motion's contacts."""
    t = motion.transcription
    return friction_used(t.contacts, times, forces, t.character.gravity / STANDARD_GRAVITY)


def friction_used(
    contacts: Sequence[PointContact], times: FloatArray, forces: FloatArray, weight: float
) -> FloatArray:
    """(T,) coefficient that the forces of all contacts together need; 0 where they hardly carry.

    forces: (T, P, 3) body weights. weight: likewise, of the body where it is. Grips, which need
    none, are left out.
    """
    pressed, along = np.zeros(len(times)), np.zeros((len(times), 3))
    for each in contacts:
        if each.friction is not None:
            during = (times >= each.contact.start) & (times <= each.contact.end)
            mine = forces[:, each.point] * during[:, None]
            normals = each.normals(times)
            across = (mine * normals).sum(axis=1)
            pressed += across
            along += mine - across[:, None] * normals
    carried = np.where(pressed > max(STANDING * weight, LEAST_STANDING), pressed, np.inf)
    return np.asarray(np.linalg.norm(along, axis=1) / carried)


def _torques(
    motion: Motion, times: FloatArray, torques: FloatArray, frame: FrameOf
) -> Iterator[CertificateLine]:
    """Largest torque components of the legs' joints, both sides. torques: sizes."""
    t = motion.transcription
    mass = t.character.mass
    for part, name in LEG_JOINTS.items():
        found = [
            (torques[:, joint.first - 3 : joint.dofs.stop - 3].max(axis=1), body)
            for body, joint in zip(t.character.bodies, t.character.joints, strict=True)
            if body.part is part
        ]
        sizes, body = max(found, key=lambda each: float(each[0].max()))
        value = float(sizes.max()) / mass
        limit = ECCENTRIC_FACTOR * peak_torque(part, mass, t.character.height) / mass
        at = frame(float(times[sizes.argmax()]))
        yield CertificateLine(
            TORQUES[name], value, "N·m/kg", limit, value <= limit, at, body.side.value
        )


def loaded_drifts(motion: Motion) -> list[LoadedDrift]:
    """Of every contact, over the whole of it: first and last instants too."""
    contacts = motion.transcription.contacts
    fine = EDGE + instants(SINKING_TIME, FINE_RATE)
    ends = [t for c in contacts for t in (c.contact.start + fine, c.contact.end - fine)]
    touches = [np.clip((c.contact.start, c.contact.end), 0.0, motion.duration) for c in contacts]
    grid = instants(motion.duration, SAMPLE_RATE)
    times = np.unique(np.concatenate([grid, *touches, *ends]))
    times = times[(times >= 0.0) & (times <= motion.duration)]
    on = [(times >= c.contact.start) & (times <= c.contact.end) for c in contacts]
    times = times[np.any(on, axis=0)] if contacts else times[:0]
    forces = motion.forces(times) / (motion.transcription.character.mass * STANDARD_GRAVITY)
    places = motion.contact_points(times) if contacts else np.zeros((len(times), 0, 3))
    drifts = []
    for i, each in enumerate(contacts):
        touching = (times >= each.contact.start) & (times <= each.contact.end)
        held = times[touching]
        off = each.pin_error(places[touching, each.point], motion.places[i], held)
        apart = np.linalg.norm(off, axis=1)
        last = int(apart.argmax())
        loaded = touching & (np.linalg.norm(forces[:, each.point], axis=1) > LOADED)
        at = times[loaded]
        rigid = replace(each, sole=None)  # what the sole gives counts
        off = rigid.pin_error(places[loaded, each.point], motion.places[i], at)
        off = off if each.held is None else off @ each.held
        normals = each.normals(at)
        height = (off * normals).sum(axis=1)
        slide = np.linalg.norm(off - height[:, None] * normals, axis=1)
        drifts.append(LoadedDrift(at, slide, height, float(apart[last]), float(held[last])))
    return drifts


def _contacts(
    motion: Motion, drifts: Sequence[LoadedDrift], frame: FrameOf
) -> Iterator[CertificateLine]:
    names = [each.contact.name for each in motion.transcription.contacts]
    for item, sizes in (
        (Item.SLIDE, [each.slide for each in drifts]),
        (Item.UNDER, [-each.height for each in drifts]),
        (Item.ABOVE, [each.height for each in drifts]),
    ):
        worst = [float(each.max(initial=0.0)) for each in sizes]
        which = int(np.argmax(worst)) if worst else 0
        if not worst or not worst[which]:
            yield _line(item, 0.0)
            continue
        at = frame(float(drifts[which].times[sizes[which].argmax()]))
        yield _line(item, 1000.0 * worst[which], at, names[which])


def between_knots(motion: Motion) -> tuple[DynamicsResidual, FloatArray]:
    """What is left of the root's equations of motion off the knots, where accelerations jump, and
    the torques (T, n_angles - 3), N·m, there: both are ends of one recursive Newton-Euler pass."""
    t = motion.transcription
    times = (instants(motion.duration, SAMPLE_RATE) + 0.5 / SAMPLE_RATE)[:-1]
    found = motion_inverse_dynamics(InverseDynamics(t.character, t.points), motion, times)
    weight = t.character.mass * STANDARD_GRAVITY
    left = DynamicsResidual(times, found.root_force / weight, found.root_moment / weight)
    return left, found.torques


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
