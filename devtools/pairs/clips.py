"""The jumps that are set in pairs: where each lies in its recording, and the recording itself."""

import re
from dataclasses import dataclass
from itertools import permutations
from pathlib import Path

from ...solver.data.problem import MotionProblem
from ...solver.data.recording import Recording
from ..environment.problem import SetUpError
from ..recordings import HOPS, find, read

RATE = 120.0  # Hz, of the recordings held here; frame 1 is their first
AROUND = 0.9  # s of the ground that a hop keeps on either side: no window reaches a neighbour
# Flights of the ten hops, s, as the contacts tell them.
HOP_FLIGHTS = (
    (1.89, 2.27),
    (3.56, 3.90),
    (4.96, 5.34),
    (6.53, 6.94),
    (10.73, 11.12),
    (12.90, 13.27),
    (14.81, 15.22),
    (18.45, 18.83),
    (20.27, 20.67),
    (21.93, 22.35),
)
BROAD_JUMPS = {  # from standing upright to standing upright, s
    "forward_jump_114cm.bvh": (1.1, 3.2),
    "forward_jump_116cm.bvh": (0.6, 2.7),
}


@dataclass(frozen=True)
class Jump:
    """One jump: its recording's file name, or path, and the scene frames that are used."""

    name: str
    clip: str
    frames: tuple[float, float]

    @property
    def problem(self) -> MotionProblem:
        """No request at all: the fit."""
        return MotionProblem(frames=self.frames)

    def recording(self) -> Recording:
        """The whole recording, in metres, Z up. Raises SetUpError, UnreadableClip."""
        path = Path(self.clip)
        return read(path if path.is_file() else find(self.clip))


def parse(text: str) -> Jump:
    """A jump given as CLIP:FIRST-LAST. Raises SetUpError."""
    found = re.fullmatch(r"(.+):(\d+)-(\d+)", text)
    if found is None:
        raise SetUpError(f"'{text}' is no jump; write CLIP:FIRST-LAST, the frames that are used.")
    clip, first, last = found.groups()
    return Jump(f"{Path(clip).stem} {first}-{last}", clip, (float(first), float(last)))


def hops() -> list[Jump]:
    """The ten hops, each with `AROUND` of ground before its take-off and after its landing."""
    return [
        Jump(f"hop {i}", HOPS, _frames(start - AROUND, end + AROUND))
        for i, (start, end) in enumerate(HOP_FLIGHTS, start=1)
    ]


def broad_jumps() -> list[Jump]:
    """The two broad jumps."""
    stems = {clip: Path(clip).stem.removeprefix("forward_jump_") for clip in BROAD_JUMPS}
    return [Jump(f"broad {stems[c]}", c, _frames(*span)) for c, span in BROAD_JUMPS.items()]


def default_pairs(count: int | None = None) -> list[tuple[Jump, Jump]]:
    """(source, target): the broad jumps both ways, then every two hops both ways.

    count: how many; fewer than all are spread over the hops. None takes all.
    """
    first, rest = list(permutations(broad_jumps(), 2)), list(permutations(hops(), 2))
    if count is None or count >= len(first) + len(rest):
        return first + rest
    spread = max(0, count - len(first))
    return first[:count] + [rest[i * len(rest) // spread] for i in range(spread)]


def _frames(start: float, end: float) -> tuple[float, float]:
    return 1.0 + round(start * RATE), 1.0 + round(end * RATE)
