"""What is edited: windows of recordings, each with a jump in its middle, and its edits."""

import tomllib
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from string import Template

import numpy as np

from ...bridge.recipe.problem import parse_recipe
from ...solver.body.anatomy import Part, Side
from ...solver.data.contacts import ContactSchedule, Phase, PhaseKind
from ...solver.data.problem import MotionProblem
from ...solver.data.recording import Recording
from ...solver.skeleton.parts import label_of
from ...solver.worker.pipeline import Subject, measure
from ..recordings import HELD, HOPS

EDITS = Path(__file__).with_name("edits.toml")
READ = (".bvh", ".amc")  # suffixes of what is read without Blender
QUICK = ("forward_jump_114cm",)  # in CI, without the edits that take longest
LONGEST_EDITS = ("limp_leg", "limp_legs_at_take_off")
AROUND = 1.0  # s of the ground on either side of a flight
LEAST_FLIGHT = 0.12  # s; shorter ones are none that an artist edits
MOST = 4  # windows of a recording, spread over it
LONGER = 1.25  # times a flight
RAISED = 0.25  # m
BONES = {
    "hand": (Part.HAND, Side.RIGHT),
    "head": (Part.HEAD, Side.MIDDLE),
    "hip": (Part.THIGH, Side.RIGHT),
    "knee": (Part.SHANK, Side.RIGHT),
    "ankle": (Part.FOOT, Side.RIGHT),
    "other_hip": (Part.THIGH, Side.LEFT),
    "other_knee": (Part.SHANK, Side.LEFT),
    "other_ankle": (Part.FOOT, Side.LEFT),
}
ABOVE = {Part.TOE: (Part.FOOT,), Part.HAND: (Part.FOREARM,), Part.HEAD: (Part.NECK,)}


class LacksPart(Exception):
    """A figure lacks the part of the body that an edit is about; the message says which."""


def held() -> dict[str, str]:
    """Files by the recordings' names: those of examples/recordings, and the hops."""
    files = {path.stem: path.name for path in recordings(HELD).values()}
    return files | {Path(HOPS).stem: HOPS}


def recordings(folder: Path) -> dict[str, Path]:
    """Those of a folder, by name."""
    found = (path for path in sorted(folder.iterdir()) if path.suffix.lower() in READ)
    return {path.stem: path for path in found}


@cache
def edits() -> dict[str, str]:
    """Recipes by the edits' names."""
    found: dict[str, str] = tomllib.loads(EDITS.read_text(encoding="utf-8"))["edits"]
    return found


@dataclass(frozen=True)
class Window:
    """Frames of a recording around a flight. before, after: the ground phases beside it."""

    subject: Subject
    before: Phase
    flight: Phase
    after: Phase

    @property
    def frames(self) -> tuple[float, float]:
        """First and last scene frame."""
        first, last = self.subject.recording.frames[[0, -1]]
        return float(first), float(last)

    def problem(self, edit: str) -> MotionProblem:
        """Of an edit's recipe. Raises BadRecipe, LacksPart."""
        recipe = Template(edits()[edit])
        text = recipe.substitute({word: self._word(word) for word in recipe.get_identifiers()})
        first, last = self.frames
        return parse_recipe(f"frames = [{first:g}, {last:g}]\n{text}").problem

    def _word(self, word: str) -> str:
        """What a word of the recipes stands for. Raises LacksPart."""
        if word in BONES:
            return self._bone(*BONES[word])
        recording, flight = self.subject.recording, self.flight
        middle = int(np.argmin(np.abs(recording.times - 0.5 * (flight.start + flight.end))))
        match word:
            case "before" | "flight" | "after":
                phase: Phase = getattr(self, word)
                return phase.name
            case "middle":
                return f"{recording.frames[middle]:g}"
            case "longer":
                return f"{LONGER * (flight.end - flight.start):.3f}"
            case "raised":
                hand = recording.heads[middle, recording.index(self._bone(*BONES["hand"])), 2]
                return f"{float(hand) - self.subject.schedule.floor_m + RAISED:.3f}"
            case "left_sole":
                sole = [self._bone(part, Side.LEFT) for part in (Part.FOOT, Part.TOE)]
                return str([*dict.fromkeys(sole)])
        raise KeyError(word)

    def _bone(self, part: Part, side: Side) -> str:
        """Of a part of the body; of the one above it where there is none, as toes and hands.
        Raises LacksPart."""
        character = self.subject.analysis.performance.character
        for each in (part, *ABOVE.get(part, ())):
            body = character.body(each, side)
            if body is not None:
                return character.bodies[body].bone
        raise LacksPart(f"The figure has no {label_of((part, side))} that moves by itself.")


def jumps(recording: Recording) -> list[tuple[float, float]]:
    """Frames around flights of a recording. Raises what `measure` does."""
    whole = measure(recording, MotionProblem()).schedule
    seconds = [(start - AROUND, end + AROUND) for start, end in spread(whole)]
    frames = np.interp(seconds, recording.times, recording.frames).round()
    return [(float(first), float(last)) for first, last in frames.reshape(-1, 2)]


def window(recording: Recording, frames: tuple[float, float]) -> Window | None:
    """Frames of a recording; None where by themselves they have no jump. Raises what `measure`
    does."""
    subject = measure(recording, MotionProblem(frames=frames))
    phases = subject.schedule.phases
    found = [
        Window(subject, before, flight, after)
        for (before, flight), after in zip(pairwise(phases), phases[2:], strict=False)
        if flight.kind is PhaseKind.FLIGHT
    ]
    return max(found, key=lambda each: each.flight.end - each.flight.start, default=None)


def spread(schedule: ContactSchedule) -> list[tuple[float, float]]:
    """Flights, s, that lie so far apart that windows do not overlap; at most MOST."""
    chosen: list[tuple[float, float]] = []
    for flight in schedule.flights:
        long_enough = flight.end - flight.start > LEAST_FLIGHT
        if long_enough and (not chosen or flight.start - chosen[-1][1] >= 2.0 * AROUND):
            chosen.append((flight.start, flight.end))
    few = np.unique(np.linspace(0, len(chosen) - 1, min(MOST, len(chosen))).round().astype(int))
    return [chosen[i] for i in few]
