"""Checks of a result's constraints on what Blender shows: without our solver.

Bones point along their own axis from head to tail; a pose is what the armature evaluates to.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.data.recording import Recording
from ...solver.numerics.rotations import unit
from ...solver.stages.implicit import Adaptation
from ...solver.transcription import constraint_functions, joint_measures
from ...solver.transcription.constraint import Constraint

SLACK = 1e-6  # s


@dataclass(frozen=True)
class Span:
    """When a check holds, s."""

    name: str
    start: float
    end: float

    def during(self, times: FloatArray) -> IntArray:
        """The instants in which it holds; the nearest one where none falls into them."""
        inside = np.flatnonzero((times > self.start - SLACK) & (times < self.end + SLACK))
        nearest = np.abs(times - 0.5 * (self.start + self.end)).argmin()
        return inside if len(inside) else np.array([nearest])


@dataclass(frozen=True)
class PointCheck(Span):
    """bone, offset (3,) in its axes: the point. place (T, 3) m at `times`; the columns of axes
    (3, k) are what lower and upper (k,) bound."""

    bone: str
    offset: FloatArray
    times: FloatArray
    place: FloatArray
    axes: FloatArray
    lower: FloatArray
    upper: FloatArray

    kind = "point"
    unit = "mm"

    def worst(self, shown: Recording) -> float:
        """Largest distance of the point from its bounds over all frames, mm."""
        at = self.during(shown.times)
        bone = shown.index(self.bone)
        point = shown.heads[at, bone] + shown.rotations[at, bone] @ self.offset
        place = np.stack([np.interp(shown.times[at], self.times, p) for p in self.place.T], axis=1)
        off = (point - place) @ self.axes
        out = np.maximum(off - self.upper, 0.0) + np.maximum(self.lower - off, 0.0)
        return 1000.0 * float(np.linalg.norm(out, axis=1).max(initial=0.0))


@dataclass(frozen=True)
class BendCheck(Span):
    """A bone's angle from its parent's direction, rad, positive about normal (3,) in the parent's
    rest frame, world axes."""

    bone: str
    parent: str
    normal: FloatArray
    lower: float
    upper: float

    kind = "bend"
    unit = "degrees"

    def worst(self, shown: Recording) -> float:
        at = self.during(shown.times)
        one, other = (directions(shown, b)[at] for b in (self.parent, self.bone))
        normal = turns(shown, self.parent)[at] @ self.normal
        side = np.sign(np.einsum("ti,ti->t", np.cross(one, other), normal))
        bend = side * np.arccos(np.clip(np.einsum("ti,ti->t", one, other), -1.0, 1.0))
        out = np.maximum(bend - self.upper, self.lower - bend)
        return float(np.degrees(out.max(initial=0.0)))


@dataclass(frozen=True)
class ConeCheck(Span):
    """A bone's angle from an axis, rad; frame (3, 3): rows the axis and two cross directions in
    the parent's rest frame, world axes, of which the edge is stretch (2,) times as far."""

    bone: str
    parent: str
    frame: FloatArray
    stretch: FloatArray
    half_angle: float

    kind = "cone"
    unit = "degrees"

    def worst(self, shown: Recording) -> float:
        at = self.during(shown.times)
        back = np.swapaxes(turns(shown, self.parent)[at], 1, 2)
        local = np.einsum("ij,tjk,tk->ti", self.frame, back, directions(shown, self.bone)[at])
        across = np.linalg.norm(local[:, 1:], axis=1)
        narrow = np.linalg.norm(local[:, 1:] / self.stretch, axis=1) / np.maximum(across, 1e-12)
        edge = np.arctan2(np.sin(self.half_angle), narrow * np.cos(self.half_angle))
        out = np.arctan2(across, local[:, 0]) - edge
        return float(np.degrees(out.max(initial=0.0)))


Check = PointCheck | BendCheck | ConeCheck


def directions(shown: Recording, bone: str) -> FloatArray:
    """(T, 3) unit vectors from a bone's head towards its tail."""
    b = shown.index(bone)
    rest = shown.bones[b]
    return np.asarray(shown.rotations[:, b] @ (rest.rotation.T @ unit(rest.tail - rest.head)))


def turns(shown: Recording, bone: str) -> FloatArray:
    """(T, 3, 3) how a bone is turned from its rest pose, world axes."""
    b = shown.index(bone)
    return np.asarray(shown.rotations[:, b] @ shown.bones[b].rotation.T)


# ---------------------------------------------------------------- from a result


def checks(adaptation: Adaptation) -> list[Check]:
    """Of every contact, and of every condition on points, bends and cones."""
    conditions = adaptation.motion.transcription.constraints
    return [
        *_contacts(adaptation),
        *(c for each in conditions for c in _condition(each, adaptation)),
    ]


def _contacts(adaptation: Adaptation) -> Iterator[PointCheck]:
    """Contacts while they are pinned, at their places; along what is held of them."""
    contacts = adaptation.motion.transcription.contacts
    for contact, place in zip(contacts, adaptation.places, strict=True):
        axes = np.eye(3) if contact.held is None else contact.held.T
        span = contact.contact
        times = np.linspace(span.start, span.end, 500)
        places = contact.holds(times).of(place)
        edges = np.zeros(axes.shape[1])
        when = span.name, span.start, span.end
        yield PointCheck(*when, span.bone, span.offset, times, places, axes, edges, edges)


def _condition(condition: Constraint, adaptation: Adaptation) -> Iterator[Check]:
    character = adaptation.motion.transcription.character
    span = (condition.name, condition.start, condition.end)
    lower, upper = condition.bounds.lower, condition.bounds.upper
    match condition.function:
        case constraint_functions.PointPosition() as place:
            body = character.bodies[place.point.body]
            recording = adaptation.setup.recording
            turn = recording.bones[recording.index(body.bone)].rotation
            times = np.linspace(condition.start, condition.end, 500)
            offset = turn.T @ place.point.place
            where = place.place(times)
            yield PointCheck(*span, body.bone, offset, times, where, place.axes, lower, upper)
        case joint_measures.BendAngle() as bend:
            normal = np.cross(bend.straight, bend.flexion)
            bones = _bones(bend.joint.first, adaptation)
            yield BendCheck(*span, *bones, normal, float(lower[0]), float(upper[0]))
        case joint_measures.ConeAngle() as cone:
            bones = _bones(cone.joint.first, adaptation)
            yield ConeCheck(*span, *bones, cone.frame, cone.stretch, float(upper[0]))


def _bones(first_angle: int, adaptation: Adaptation) -> tuple[str, str]:
    """The bone whose joint has this angle first, and its parent's."""
    character = adaptation.motion.transcription.character
    body = next(i for i, j in enumerate(character.joints) if j.first == first_angle)
    bodies = character.bodies
    return bodies[body].bone, bodies[character.joints[body].parent].bone
