"""Context in which requests are evaluated: the fit, and the timeline of the result."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..analysis.timeline import Timeline, active_interval
from ..arrays import FloatArray
from ..body.character import Character
from ..body.kinematics import BodyPoint
from ..data.contacts import Contact, ContactSchedule, Phase
from ..data.faults import RootHasNoJoint
from ..data.recording import Recording
from ..data.requests import When
from ..transcription.motion import Motion

APEX_SAMPLING_RATE = 240.0  # Hz


@dataclass(frozen=True)
class EvaluationContext:
    """Context in which requests are evaluated: the fit, and the timeline of the result.

    fitted: the fit, which gives peaks; reference: the same with the body as it is asked for,
    which gives places and poses. phases: the recording's, on the new time, by which requests name
    them; schedule: contacts and phases of the result. travel: (3, 3) columns forward, left, up at
    an instant.
    """

    recording: Recording
    fitted: Motion
    reference: Motion
    phases: tuple[Phase, ...]
    schedule: ContactSchedule
    timeline: Timeline
    travel: Callable[[float], FloatArray]

    @property
    def character(self) -> Character:
        return self.reference.transcription.character

    @cached_property
    def apex(self) -> FloatArray:
        """(T, 2) instants, s, and heights of the centre of mass, m."""
        duration = self.timeline.duration
        times = np.linspace(0.0, duration, int(duration * APEX_SAMPLING_RATE) + 2)
        heights = self.reference.com(self.reference_times(times))[:, 2]
        return np.stack([times, heights], axis=1)

    def interval(self, name: str, when: When) -> tuple[float, float]:
        """Start and end, s, on the new time. Raises UnknownPhaseIn, BadTiming."""
        return active_interval(name, when, self.timeline, self.phases, self.apex)

    def body(self, name: str, bone: str) -> int:
        """Index of a bone's body. Raises StillBone."""
        return self.character.moved_by(name, bone)

    def jointed(self, name: str, bone: str) -> int:
        """Index of a body with a joint to a parent. Raises StillBone, RootHasNoJoint."""
        body = self.body(name, bone)
        if self.character.joints[body].parent < 0:
            raise RootHasNoJoint(name, bone)
        return body

    def point(self, body: int, offset: tuple[float, float, float] | None) -> BodyPoint:
        """A body's point at offset (3,) m from its bone's head, bone's axes; None its middle."""
        if offset is None:
            return BodyPoint(body, 0.5 * self.character.bodies[body].tip)
        bone = self.recording.bones[self.recording.index(self.character.bodies[body].bone)]
        return BodyPoint(body, bone.rotation @ np.array(offset))

    def reference_times(self, times: FloatArray) -> FloatArray:
        """The fit's instants (T,) s of the new motion's."""
        return self.timeline.to_old(times)


def touches(names: Sequence[str], contact: Contact) -> bool:
    """Whether a contact is named, by contact, point or bone; no names mean all."""
    return not names or bool({contact.name, contact.point, contact.bone} & set(names))
