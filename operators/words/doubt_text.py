"""Wording of what is legal but hardly meant, told before a fit takes its seconds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from ...solver.analysis.leaps import Leap
from ...solver.arrays import FloatArray
from ...solver.data.contacts import Phase
from ...solver.data.problem import MotionProblem
from ...solver.data.reports.recording import ChosenTake, Origin
from ...solver.doctor.finding import Finding
from ...solver.doctor.repairs import UpAxis
from .doctor_text import finding_sentence
from .messages import length
from .request_doubt_text import A_FRAME, beyond_doubts, highest, quoted, request_doubts, there

if TYPE_CHECKING:  # which Blender's own module is needed for, and batches do without
    from ...bridge.scene.moving_empties import LeftEmpty

# Body mass over squared stature, kg/m². Adults above 40 have obesity of the third class; of healthy
# children the leanest have 13 (WHO).
LEANEST, HEAVIEST = 12.0, 45.0
MOST_AWAY = 30.0  # m; the longest triple jumps go 18
MOST_BELOW = 0.5  # m, of a point below the ground
MOST_DAMAGES = 4
MOST_TAKES = 8  # by name, of a file that may hold a hundred
MOST_DRIFT = 0.5  # m/s, upwards
SOLES = 0.1  # m, that the highest platform shoes put between foot and floor


def doubts_of(
    problem: MotionProblem,
    height: float,
    frames: FloatArray,
    phases: Sequence[Phase] = (),
    leaps: Sequence[Leap] = (),
) -> list[str]:
    """A line for each amount that nobody means; none where all is as one would expect.

    height: m, as recorded. frames: (T,) that the clip has of those asked for; none where these do
    not tell. phases, leaps: of the recording, the latter in true lengths.
    """
    masses = dict.fromkeys((problem.mass, problem.requests.body.mass or problem.mass))
    return [
        *frame_doubts(problem.frames or (None, None), frames),
        *(line for mass in masses for line in _of_build(mass, problem.height or height)),
        *beyond_doubts(problem, frames),
        *request_doubts(problem, phases, leaps),
    ]


def frame_doubts(
    asked: tuple[float, float] | tuple[None, None], there: Sequence[float] | FloatArray
) -> list[str]:
    """A line for each end of a range of frames that is beyond those (T,) that a recording has."""
    first, last = asked
    told: list[str] = []
    if first is None or last is None or not len(there):
        return told
    if isfinite(first) and first < there[0] - A_FRAME:
        told.append(f"Frame {first:.9g} was asked for, but the recording begins at {there[0]:g}")
    if isfinite(last) and last > there[-1] + A_FRAME:
        told.append(f"Frame {last:.9g} was asked for, but the recording ends at {there[-1]:g}")
    return told


def range_words(
    asked: tuple[float, float] | tuple[None, None],
    there: tuple[float, float],
    cycle: tuple[float, float],
) -> str:
    """Words that follow what was found: on frames that were chosen and are not there, and on a
    range that was moved to a whole cycle.

    asked: as the artist chose it, if so. there: what of it was recorded. cycle: what was analysed.
    """
    told = frame_doubts(asked, there)
    if cycle != there:
        first, last = cycle
        told.append(
            f"A whole cycle is frames {first:g} to {last:g}: the range begins "
            f"{first - there[0]:+g} and ends {last - there[1]:+g} frames from where it did"
        )
    return "".join(f". {line}" for line in told)


def distance_doubts(problem: MotionProblem, heads: FloatArray) -> list[str]:
    """Lines where pins or points are further from the recording, or higher, than anybody means.

    heads: (T, bones, 3) m, world; of the recording, in the lengths that the problem is in.
    """
    asked = (
        *((pin.name, pin.place, pin.offset) for pin in problem.pins),
        *((point.name, point.place, point.relative) for point in problem.requests.points),
    )
    off = {name: _away(place, shift, heads) for name, place, shift in asked}
    far = {name: metres for name, metres in off.items() if metres > MOST_AWAY}
    return [*_of_far(far), *_of_high(problem, heads), *_of_low(problem, heads)]


def empty_doubts(left: Sequence[LeftEmpty]) -> list[str]:
    """A line where empties go on while the contacts that they place stand."""
    if not left:
        return []
    most = max(left, key=lambda each: each.away)
    return [
        f"{quoted(each.contact for each in left)}: placed by empties that move on while the "
        f"contact stands (“{most.empty}” by {length(most.away)} from frame {most.first:.0f} to "
        f"{most.last:.0f}); it stays where its empty is first. To have it ride, add what the empty "
        "hangs on to the surfaces of World, and choose it as the contact's On"
    ]


def file_doubts(origin: Origin) -> list[str]:
    """A line where a file holds more frames than its header announces, or than one armature and one
    take, or says nothing of a bone of its skeleton."""
    return [*_of_count(origin), *_of_unmoved(origin), *_of_choice(origin.clip, origin.chosen)]


def _of_count(origin: Origin) -> Iterator[str]:
    if origin.miscount is not None:
        announced, held = origin.miscount
        yield (
            f"The header of {origin.clip} announces {announced} frames, but {held} lines of motion "
            f"follow, and all are read. Mend “Frames:” in the file, or leave out the last by "
            f"“trim_end = {held - announced}” under “[recording]” in the recipe"
        )


def _of_unmoved(origin: Origin) -> Iterator[str]:
    if origin.unmoved:
        yield (
            f"{origin.clip} has no line of {_first_quoted(origin.unmoved)}, which its skeleton's "
            "file lets move: held as at rest. Export it again where that is not meant"
        )


def _of_choice(clip: str, chosen: ChosenTake | None) -> Iterator[str]:
    if chosen is None:
        return
    if others := chosen.armatures:
        yield (
            f"{clip} holds {1 + len(others)} armatures that move: “{chosen.armature}” is read, and "
            f"not {_first_quoted(others)} (else say --armature)"
        )
    if others := chosen.takes:
        yield (
            f"{clip} holds {1 + len(others)} takes of “{chosen.armature}”: “{chosen.take}” is "
            f"read, and not {_first_quoted(others)} (else say --take)"
        )


def _first_quoted(names: Sequence[str]) -> str:
    more = len(names) - MOST_TAKES
    return quoted(names[:MOST_TAKES]) + (f" and {more} more" if more > 0 else "")


def damage_doubts(found: Sequence[Finding]) -> list[str]:
    """A line for each damage of the recording, the first few, and where the remedies are told."""
    if not found:
        return []
    told = [f"The recording: {finding_sentence(each)}" for each in found[:MOST_DAMAGES]]
    more = len(found) - len(told)
    rest = f"{more} more; the" if more else "The"
    return [*told, f"{rest} command “doctor” tells the remedies, and “--write-recipe” uses them"]


def up_doubts(up: UpAxis, *, lies: bool) -> list[str]:
    """A line where a figure lies, or stands on its head, that was to be turned upright. up: what
    became Z; Z says nothing."""
    if up is UpAxis.Z or not lies:
        return []
    advice = "State the axis that points from feet to head as it was read, or none"
    return [f"With “up = {up.value}” the figure does not stand upright. {advice}"]


def floor_doubts(stated: float, feet: float, *, on_objects: bool) -> list[str]:
    """A line where a recording was put on a floor on which its feet do not stand.

    stated: m, the height that became 0; 0 says nothing. feet: m, at which they stand after that.
    on_objects: whether they stand on objects of the scene, which may be anywhere.
    """
    if stated == 0.0 or on_objects or abs(feet) <= SOLES:
        return []
    there = f"they stand at {stated + feet:.2f} m"
    return [f"“floor = {stated:g}” is not where the feet are: {there}. State that height, or none"]


def rise_doubts(rise: float) -> list[str]:
    """A line where a recording is taken upwards or downwards faster than capture drifts, m/s."""
    if abs(rise) <= MOST_DRIFT:
        return []
    return [f"“rise = {rise:g}” is more m/s than capture drifts upwards, and takes the feet off"]


def _of_far(far: Mapping[str, float]) -> list[str]:
    """far: m, by name."""
    if not far:
        return []
    names, most = quoted(far), max(far.values())
    return [
        f"{names}: {most:.0f} m away from the recording, further than anybody jumps; lengths "
        "are in metres, and a whole scene is moved with its armature"
    ]


def _of_high(problem: MotionProblem, heads: FloatArray) -> Iterator[str]:
    """Points that are higher above the recording than a body can rise."""
    gravity, top = problem.requests.body.gravity, float(heads[..., 2].max())
    for point in problem.requests.points:
        above = -np.inf if point.place is None else point.place[2] - top
        if above > highest(gravity):
            yield (
                f"“{point.name}” is {length(above)} above all that was recorded, and nobody"
                f"{there(gravity)} jumps higher than {length(highest(gravity))}"
            )


def _of_low(problem: MotionProblem, heads: FloatArray) -> Iterator[str]:
    """Points far below the recording's ground, where nothing is asked to stand lower."""
    if problem.pins:
        return
    for point in problem.requests.points:
        below = -np.inf if point.place is None else float(heads[..., 2].min()) - point.place[2]
        if below > MOST_BELOW and not point.environment:
            yield f"“{point.name}” is {length(below)} below all that was recorded, in the ground"


def _of_build(mass: float, height: float) -> Iterator[str]:
    """mass: kg. height: m."""
    usual = LEANEST * height**2, HEAVIEST * height**2
    if not usual[0] <= mass <= usual[1]:
        yield (
            f"{mass:g} kg is a mass that nobody of {length(height)} has; people's build gives "
            f"{_masses(*usual)}. State the performer's mass, or the height"
        )


def _masses(least: float, most: float) -> str:
    """A range of masses, kg, in the unit that suits it: "17 to 65 kg", "120 to 450 g"."""
    unit, factor = ("kg", 1.0) if most >= 1.0 else ("g", 1000.0)
    low, high = (
        f"{mass:.0f}" if mass >= 10.0 else f"{mass:.2g}" for mass in (factor * least, factor * most)
    )
    return f"{low} to {high} {unit}"


def _away(place: Sequence[float] | None, shift: Sequence[float], heads: FloatArray) -> float:
    """How far, m, what is shifted off its place, else off the recording, is from the latter."""
    if place is None:
        return float(np.linalg.norm(shift))
    return float(np.linalg.norm(heads - np.add(place, shift), axis=2).min())
