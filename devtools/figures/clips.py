"""Clips that the figures are measured on, the part of each that is used, and the edits."""

from dataclasses import dataclass
from pathlib import Path

from ...solver.data.problem import MotionProblem, Pin
from ..recordings import HOPS, JUMP, find

RATE = 120.0  # Hz, of every clip here


@dataclass(frozen=True)
class Clip:
    """A jump in a recording: its file's name, and the first and last second that are used."""

    name: str
    file: str
    start: float
    end: float

    @property
    def path(self) -> Path:
        """Raises SetUpError where there is none."""
        return find(self.file)

    @property
    def frames(self) -> tuple[float, float]:
        """First and last scene frame; the file's first frame is scene frame 1."""
        return 1 + round(self.start * RATE), 1 + round(self.end * RATE)

    def problem(self, edit: str) -> MotionProblem:
        """The edit's problem on this clip."""
        pin = Pin("landing", "ground 2", offset=EDITS[edit])
        return MotionProblem(frames=self.frames, pins=(pin,))


CLIPS = (
    # The whole jump from standing upright to standing upright; before 0.6 s the subject waits.
    Clip("broad jump 116 cm", JUMP, 0.6, 2.7),
    Clip("broad jump 114 cm", "forward_jump_114cm.bvh", 1.1, 3.2),
    # The first, the fourth and the ninth hop, between the landings of their neighbours.
    Clip("hop 1", HOPS, 0.99, 3.19),
    Clip("hop 4", HOPS, 5.69, 7.89),
    Clip("hop 9", HOPS, 19.49, 21.39),
)
EDITS = {
    "+0.3 m forward": (0.3, 0.0, 0.0),
    "+0.2 m up": (0.0, 0.0, 0.2),
    "+0.3 m forward, +0.2 m up": (0.3, 0.0, 0.2),
}
