"""A solved motion as functions of time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.inverse_dynamics import GeneralisedForces, InverseDynamics
from ..body.kinematics import Pose, forward_kinematics
from ..data.constants import STANDARD_GRAVITY
from ..data.recording import PoseTrack, Recording
from ..numerics.rotations import cross_matrix
from .contact_pins import PointContact
from .transcription import Transcription, touching_spans


@dataclass(frozen=True)
class Motion:
    """Unknowns x (K, n_block) of a transcription, with each contact's place (n_contacts, 3) m."""

    transcription: Transcription
    x: FloatArray
    places: FloatArray

    @property
    def duration(self) -> float:
        return float(self.transcription.basis.breaks[-1])

    def com(self, times: FloatArray, derivative: int = 0) -> FloatArray:
        """(T, 3) centre of mass, m, or its derivative."""
        t = self.transcription
        return t.basis.combine(self.x[:, t.layout.com], times, derivative)

    def angles(self, times: FloatArray, derivative: int = 0) -> FloatArray:
        """(T, n_angles) joint angles, rad, or their derivative."""
        t = self.transcription
        return t.basis.combine(self.x[:, t.layout.angles], times, derivative)

    def forces(self, times: FloatArray) -> FloatArray:
        """(T, P, 3) force on the body at each touching point, N, world; zero while not in touch."""
        t = self.transcription
        spans = t.basis.spans(times)
        values = self.x[t.basis.force_nodes(spans) + 1][:, :, t.layout.forces]
        forces = np.einsum("tk,tkn->tn", t.basis.force_weights(times, spans), values)
        newtons = forces * t.character.mass * STANDARD_GRAVITY
        return np.asarray(newtons.reshape(len(times), t.layout.n_points, 3))

    def pose(self, times: FloatArray) -> Pose:
        """The figure relative to its centre of mass."""
        return forward_kinematics(self.transcription.character, self.angles(times))

    def joint_centres(self, times: FloatArray) -> FloatArray:
        """(T, B, 3) m, world."""
        return np.asarray(self.pose(times).centres + self.com(times)[:, None])

    def contact_points(self, times: FloatArray) -> FloatArray:
        """(T, P, 3) m, world places of the points that touch at some time."""
        points = self.transcription.points
        return np.asarray(self.pose(times).points(points) + self.com(times)[:, None])

    def track(self, recording: Recording) -> PoseTrack:
        """The bones' poses at the recording's frames, or as many as this motion lasts."""
        times, frames = recording.times, recording.frames
        if abs(times[-1] - self.duration) > 1e-6:
            rate = (len(times) - 1) / float(times[-1])
            times = np.arange(int(self.duration * rate + 1e-6) + 1) / rate
            step = (frames[-1] - frames[0]) / (len(frames) - 1)
            frames = frames[0] + step * np.arange(len(times))
        posed = self.pose(times)
        bones = [recording.index(b.bone) for b in self.transcription.character.bodies]
        rest = np.stack([recording.bones[b].rotation for b in bones])
        return PoseTrack(
            frames=frames,
            bones=tuple(recording.bones[b].name for b in bones),
            rotations=posed.rotations @ rest,
            root_head=posed.centres[:, 0] + self.com(times),
        )

    def drift(self, contact: int, times: FloatArray) -> FloatArray:
        """(T,) distance of a contact's point from where it is held, m."""
        each = self.transcription.contacts[contact]
        at = self.contact_points(times)[:, each.point]
        return np.asarray(np.linalg.norm(each.off(at, self.places[contact], times), axis=1))


def motion_efforts(
    dynamics: InverseDynamics, motion: Motion, times: FloatArray
) -> GeneralisedForces:
    """Inverse dynamics of a motion at (T,) s; `dynamics` is of its character and its points."""
    q, v, a = (motion.angles(times, k) for k in range(3))
    return dynamics(q, v, a, motion.com(times, 2), motion.forces(times))


SHORTEST_SPLIT = 0.016  # s; shorter spans are not split further


@dataclass(frozen=True)
class DynamicsResidual:
    """Root force (T, 3) in body weights and moment (T, 3) in body weights x m that nothing
    explains, at instants (T,) s."""

    times: FloatArray
    force: FloatArray
    moment: FloatArray


def dynamics_residual(motion: Motion, times: FloatArray) -> DynamicsResidual:
    """The equations of motion evaluated between the nodes (by the solver's own functions).

    Quick, for choosing knots; the figures are measured by another engine.
    """
    t = motion.transcription
    weight = t.character.mass * STANDARD_GRAVITY
    fall = t.character.gravity / STANDARD_GRAVITY
    forces = motion.forces(times) / weight
    total = forces.sum(axis=1)
    force = motion.com(times, 2) / STANDARD_GRAVITY + np.array([0.0, 0.0, fall]) - total
    rate = t.moment.value(*(motion.angles(times, k) for k in range(3)))
    if t.points:
        arms = motion.pose(times).points(t.points)
        rate = rate - np.einsum("tpij,tpj->ti", cross_matrix(arms), forces)
    return DynamicsResidual(times, force, rate)


def pinned_instants(contact: PointContact, rate: float) -> FloatArray:
    """Instants at `rate` Hz while a contact's point is pinned."""
    count = max(2, int(np.ceil((contact.pin_end - contact.pin_start) * rate)))
    return np.linspace(contact.pin_start, contact.pin_end, count)


@dataclass(frozen=True)
class DenseTolerance:
    """What must hold between the nodes, else knots are added.

    flight, ground: rms moment that a span may leave unexplained, BW·m. drift: how far a pinned
    point may wander, m.
    """

    flight: float
    ground: float
    drift: float


def weak_spans(motion: Motion, promise: DenseTolerance) -> IntArray:
    """Indices of the spans in which the motion breaks a promise between the nodes."""
    transcription = motion.transcription
    basis = transcription.basis
    per = 6
    inside = (np.arange(per) + 0.5) / per
    length = np.diff(basis.breaks)
    times = (basis.breaks[:-1, None] + length[:, None] * inside).ravel()
    left = (dynamics_residual(motion, times).moment ** 2).sum(axis=1).reshape(-1, per)
    carried = np.zeros(basis.n_spans, dtype=bool)
    for contact in transcription.contacts:
        carried[touching_spans(basis, contact.contact)] = True
    limit = np.where(carried, promise.ground, promise.flight)
    weak = (np.sqrt(left.mean(axis=1)) > limit) & (length > SHORTEST_SPLIT)
    if transcription.points:
        at = motion.contact_points(times)
        spans = np.repeat(np.arange(basis.n_spans), per)
        for i, contact in enumerate(transcription.contacts):
            pinned = (times > contact.pin_start) & (times < contact.pin_end)
            off = contact.off(at[:, contact.point], motion.places[i], times)
            weak[spans[pinned & (np.linalg.norm(off, axis=1) > promise.drift)]] = True
    return np.flatnonzero(weak)


def split(breaks: Sequence[float] | FloatArray, spans: IntArray) -> FloatArray:
    """Breaks with the middle of each of the spans added."""
    at = np.asarray(breaks)
    return np.sort(np.concatenate([at, 0.5 * (at[spans] + at[spans + 1])]))
