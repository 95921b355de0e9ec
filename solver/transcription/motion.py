"""A transcribed motion as functions of time, and its dynamics residual between the nodes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.inverse_dynamics import GeneralisedForces, InverseDynamics
from ..body.kinematics import Pose, forward_kinematics
from ..data.constants import STANDARD_GRAVITY
from ..data.recording import PoseTrack, Recording
from ..numerics.rotations import cross_matrix
from .contact_pins import PointContact, touching_spans
from .transcription import Transcription

Found = TypeVar("Found")
MIN_SPLIT_SPAN = 0.016  # s; shorter spans are not split further


@dataclass(frozen=True)
class Motion:
    """Unknowns x (K, n_block) of a transcription, with each contact's place (n_contacts, 3) m.

    Methods take instants (T,) s; positions are in the world.
    """

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
        """(T, P, 3) contact force on the body at each point, N, world; zero while not in touch."""
        t = self.transcription
        spans = t.basis.spans(times)
        values = self.x[t.layout.force_block(t.basis.force_nodes(spans))][:, :, t.layout.forces]
        forces = np.einsum("tk,tkn->tn", t.basis.force_weights(times, spans), values)
        newtons = forces * t.character.mass * STANDARD_GRAVITY
        return np.asarray(newtons.reshape(len(times), t.layout.n_points, 3))

    def pose(self, times: FloatArray) -> Pose:
        """Forward kinematics relative to the centre of mass."""
        return forward_kinematics(self.transcription.character, self.angles(times))

    def joint_centres(self, times: FloatArray) -> FloatArray:
        """(T, B, 3) m, world."""
        return np.asarray(self.pose(times).centres + self.com(times)[:, None])

    def joint_rotations(self, times: FloatArray) -> FloatArray:
        """(T, B, 3, 3) of each body's joint, child to parent; the root's to the world."""
        posed = self.pose(times)
        parents = [joint.parent for joint in posed.character.joints[1:]]
        turned = posed.rotations.copy()
        turned[:, 1:] = np.swapaxes(posed.rotations[:, parents], -1, -2) @ turned[:, 1:]
        return turned

    def contact_points(self, times: FloatArray) -> FloatArray:
        """(T, P, 3) m, of the points that touch at some time."""
        points = self.transcription.points
        return np.asarray(self.pose(times).points(points) + self.com(times)[:, None])

    def frames(self, recording: Recording) -> tuple[FloatArray, FloatArray]:
        """The recording's frames, or as many as this motion lasts, and their instants, s; (T,)."""
        times, frames = recording.times, recording.frames
        if abs(times[-1] - self.duration) > 1e-6:
            rate = (len(times) - 1) / float(times[-1])
            times = np.arange(int(self.duration * rate + 1e-6) + 1) / rate
            step = (frames[-1] - frames[0]) / (len(frames) - 1)
            frames = frames[0] + step * np.arange(len(times))
        return frames, np.minimum(times, self.duration)

    def track(self, recording: Recording) -> PoseTrack:
        """Bone poses at the recording's frames, or as many as this motion lasts."""
        frames, times = self.frames(recording)
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
        """(T,) drift of a contact's point from where it is held, m."""
        each = self.transcription.contacts[contact]
        at = self.contact_points(times)[:, each.point]
        return np.asarray(np.linalg.norm(each.pin_error(at, self.places[contact], times), axis=1))


class LastMotion(Generic[Found]):
    """What `find` finds of a motion, kept for the last one: the rounds of a solve, its verdict and
    its report ask the same of it. find: by place and angles alone, of one figure."""

    def __init__(self, find: Callable[[Motion], Found]) -> None:
        self._find = find
        self._last: tuple[Motion, Found] | None = None

    def of(self, motion: Motion) -> Found:
        """As `find`."""
        if self._last is not None:
            last, found = self._last
            same = last.transcription.basis is motion.transcription.basis
            if same and np.array_equal(last.x, motion.x):
                return found
        found = self._find(motion)
        self._last = motion, found
        return found


def motion_inverse_dynamics(
    dynamics: InverseDynamics, motion: Motion, times: FloatArray
) -> GeneralisedForces:
    """Inverse dynamics of a motion at (T,) s (thesis 3.2).

    dynamics: of the motion's character and its points.
    """
    q, v, a = (motion.angles(times, k) for k in range(3))
    return dynamics(q, v, a, motion.com(times, 2), motion.forces(times))


@dataclass(frozen=True)
class DynamicsResidual:
    """Residual of the root's equations of motion at instants (T,) s, world axes.

    force: (T, 3) body weights. moment: (T, 3) about the centre of mass, body weights x m.
    """

    times: FloatArray
    force: FloatArray
    moment: FloatArray


def dynamics_residual(motion: Motion, times: FloatArray) -> DynamicsResidual:
    """Residual m c'' = m g + sum f and L' = sum (p - c) x f at instants (T,) s (thesis 3.2).

    By the solver's own functions, for choosing knots; the figures are measured by another engine.
    """
    t = motion.transcription
    weight = t.character.mass * STANDARD_GRAVITY
    fall = t.character.gravity / STANDARD_GRAVITY
    forces = motion.forces(times) / weight
    total = forces.sum(axis=1)
    force = motion.com(times, 2) / STANDARD_GRAVITY + np.array([0.0, 0.0, fall]) - total
    posed = motion.pose(times)
    rate = t.moment.value_at(posed, *(motion.angles(times, k) for k in (1, 2)))
    if t.points:
        arms = posed.points(t.points)
        rate = rate - np.einsum("tpij,tpj->ti", cross_matrix(arms), forces)
    return DynamicsResidual(times, force, rate)


def pinned_instants(contact: PointContact, rate: float) -> FloatArray:
    """Instants, s, at `rate` Hz (two at least) while a contact's point is pinned."""
    start, end = contact.contact.start, contact.contact.end
    return np.linspace(start, end, max(2, int(np.ceil((end - start) * rate))))


@dataclass(frozen=True)
class DenseTolerance:
    """Tolerances between the nodes, beyond which knots are added.

    flight, ground: rms residual moment of a span, BW·m. drift: of a pinned point, m.
    """

    flight: float
    ground: float
    drift: float


def spans_to_refine(motion: Motion, tolerance: DenseTolerance) -> IntArray:
    """Indices of the spans that exceed a tolerance between the nodes (thesis 6.4)."""
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
    if transcription.support is not None:
        carried[np.concatenate(transcription.support.spans(basis))] = True
    limit = np.where(carried, tolerance.ground, tolerance.flight)
    weak = (np.sqrt(left.mean(axis=1)) > limit) & (length > MIN_SPLIT_SPAN)
    if transcription.points:
        at = motion.contact_points(times)
        spans = np.repeat(np.arange(basis.n_spans), per)
        for i, contact in enumerate(transcription.contacts):
            pinned = (times > contact.contact.start) & (times < contact.contact.end)
            off = contact.pin_error(at[:, contact.point], motion.places[i], times)
            weak[
                spans[
                    pinned & (np.linalg.norm(off, axis=1) > tolerance.drift + contact.contact.slack)
                ]
            ] = True
    return np.flatnonzero(weak)


def split_spans(breaks: Sequence[float] | FloatArray, spans: IntArray) -> FloatArray:
    """Breaks, s, with the middle of each of the spans added."""
    at = np.asarray(breaks)
    return np.sort(np.concatenate([at, 0.5 * (at[spans] + at[spans + 1])]))
