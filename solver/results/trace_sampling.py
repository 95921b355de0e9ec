"""Traces of recordings and of solved motions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..analysis.performance import Performance, contact_points
from ..arrays import FloatArray
from ..body.character import Character
from ..body.inverse_dynamics import InverseDynamics
from ..data.constants import STANDARD_GRAVITY
from ..data.contacts import ContactSchedule, Phase, PhaseKind
from ..data.recording import Recording
from ..data.traces import UNSEEN_SUPPORT, FlightParabola, Traces
from ..solid.shape_changes import AS_IS, ShapeChanges
from ..solid.shapes import Capsules, capsules
from ..transcription.motion import Motion, motion_inverse_dynamics

PARABOLA_POINTS = 25
MOMENT = 1e-3  # s, half of what speeds are taken over


@dataclass(frozen=True)
class _Figure:
    """Bodies' rotations to the world (T, B, 3, 3) and joint centres (T, B, 3) m."""

    rotations: FloatArray
    centres: FloatArray

    def at(self, index: FloatArray | slice) -> _Figure:
        return _Figure(self.rotations[index], self.centres[index])


def recorded_traces(performance: Performance, changes: ShapeChanges = AS_IS) -> Traces:
    """Of a recording as it was analysed: figure and centre of mass. changes: of the shapes."""
    character, times = performance.character, performance.times
    figure = _Figure(performance.rotations, performance.centres)
    index = np.arange(len(times))
    before, after = np.maximum(index - 1, 0), np.minimum(index + 1, len(times) - 1)
    spent = times[after] - times[before]
    none = np.zeros((len(times), 0, 3))
    points, _ = contact_points(performance)
    return Traces(
        frames=performance.recording.frames,
        bones=tuple(body.bone for body in character.bodies),
        heads=figure.centres,
        tails=_tails(character, figure),
        com=performance.com,
        velocity=(performance.com[after] - performance.com[before]) / spent[:, None],
        momentum=_momentum(character, figure.at(before), figure.at(after), spent),
        contacts=tuple(points),
        points=np.stack([point.track for point in points.values()], axis=1),
        forces=none,
        weight=character.mass * character.gravity,
        joints=(),
        torques=none[:, :, 0],
        flights=(),
        **_solids(character, figure, changes),
    )


def motion_traces(
    motion: Motion,
    recording: Recording,
    schedule: ContactSchedule,
    dynamics: InverseDynamics | None,
    changes: ShapeChanges = AS_IS,
) -> Traces:
    """Of a solved motion, at the frames of its track.

    dynamics: of the motion's character, which touches at the motion's points; None leaves out
    torques and momentum, which takes a third of the time. changes: of the solid shapes.
    """
    character = motion.transcription.character
    frames, times = motion.frames(recording)
    per_second = float((recording.frames[-1] - recording.frames[0]) / recording.times[-1])
    figure = _figure(motion, times)
    momentum = np.zeros((len(times), 3))
    if dynamics is not None:
        before, after = np.maximum(times - MOMENT, 0.0), np.minimum(times + MOMENT, motion.duration)
        figures = (_figure(motion, before), _figure(motion, after))
        momentum = _momentum(character, *figures, after - before)
    names = {c.point: c.contact.point for c in motion.transcription.contacts}
    return Traces(
        frames=frames,
        bones=tuple(body.bone for body in character.bodies),
        heads=figure.centres,
        tails=_tails(character, figure),
        com=motion.com(times),
        velocity=motion.com(times, 1),
        momentum=momentum,
        contacts=tuple(
            names.get(i, UNSEEN_SUPPORT) for i in range(len(motion.transcription.points))
        ),
        points=_points(motion, figure),
        forces=motion.forces(times),
        weight=character.mass * STANDARD_GRAVITY,
        joints=() if dynamics is None else tuple(body.bone for body in character.bodies[1:]),
        torques=_torques(motion, times, dynamics),
        flights=tuple(
            _flight(motion, phase, float(frames[0]), per_second)
            for phase in schedule.phases
            if phase.kind is PhaseKind.FLIGHT
        ),
        **_solids(character, figure, changes),
    )


def _figure(motion: Motion, times: FloatArray) -> _Figure:
    posed = motion.pose(times)
    return _Figure(posed.rotations, posed.centres + motion.com(times)[:, None])


def _torques(motion: Motion, times: FloatArray, dynamics: InverseDynamics | None) -> FloatArray:
    if dynamics is None:
        return np.zeros((len(times), 0))
    torques = np.abs(motion_inverse_dynamics(dynamics, motion, times).torques)
    joints = motion.transcription.character.joints[1:]
    slices = [slice(j.first - 3, j.dofs.stop - 3) for j in joints]
    return np.stack([torques[:, part].max(axis=1, initial=0.0) for part in slices], axis=1)


def _points(motion: Motion, figure: _Figure) -> FloatArray:
    """(T, C, 3) m of the points that may touch."""
    points = motion.transcription.points
    bodies = [point.body for point in points]
    local = np.array([point.place for point in points]).reshape(-1, 3)
    turned = np.einsum("tcij,cj->tci", figure.rotations[:, bodies], local)
    return np.asarray(figure.centres[:, bodies] + turned)


def _tails(character: Character, figure: _Figure) -> FloatArray:
    tips = np.stack([body.tip for body in character.bodies])
    return np.asarray(figure.centres + np.einsum("tbij,bj->tbi", figure.rotations, tips))


def _solids(character: Character, figure: _Figure, changes: ShapeChanges) -> dict[str, Any]:
    """What traces hold of the body's solid shapes."""
    shapes = Capsules.of(capsules(character, changes))
    turns, centres = figure.rotations[:, shapes.bodies], figure.centres[:, shapes.bodies]
    start, end = (
        centres + np.einsum("tsij,sj->tsi", turns, local) for local in (shapes.start, shapes.end)
    )
    names = tuple(character.bodies[body].name for body in shapes.bodies)
    return {
        "solids": names,
        "solid_starts": start,
        "solid_ends": end,
        "solid_radii": shapes.radius,
    }


def _momentum(
    character: Character, before: _Figure, after: _Figure, spent: FloatArray
) -> FloatArray:
    """(T, 3) N·m·s about the centre of mass, from the figure a little before and after."""
    local = np.stack([body.com for body in character.bodies])
    masses = np.array([body.mass for body in character.bodies])[:, None]
    inertias = np.stack([body.inertia for body in character.bodies])
    coms = [f.centres + np.einsum("tbij,bj->tbi", f.rotations, local) for f in (before, after)]
    arms = [c - (masses * c).sum(axis=1, keepdims=True) / masses.sum() for c in coms]
    arm, speed = 0.5 * (arms[0] + arms[1]), (arms[1] - arms[0]) / spent[:, None, None]
    turned = after.rotations @ np.swapaxes(before.rotations, -1, -2)
    skew = 0.5 * (turned - np.swapaxes(turned, -1, -2)) / spent[:, None, None, None]
    spin = np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)
    R = after.rotations
    whirl = np.einsum("tbij,bjk,tblk,tbl->tbi", R, inertias, R, spin, optimize=True)
    return np.asarray((masses * np.cross(arm, speed) + whirl).sum(axis=1))


def _flight(motion: Motion, phase: Phase, first: float, per_second: float) -> FlightParabola:
    times = np.linspace(phase.start, min(phase.end, motion.duration), PARABOLA_POINTS)
    ends = (first + per_second * phase.start, first + per_second * phase.end)
    return FlightParabola(phase.name, *ends, motion.com(times))
