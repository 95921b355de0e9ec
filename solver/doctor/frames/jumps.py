"""Jumps: from a frame to the next the body is elsewhere, or in another pose, and stays so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ...body.anatomy import Part
from ...data.recording import Recording
from ...numerics.runs import runs
from ..falls import Spans
from ..figure import Figure
from ..finding import Finding, FindingKind
from ..local_poses import LocalPoses
from ..slack import slack
from ..stretch import longest_stretch
from .ragged import ragged_ends
from .steps import around, moved_steps, turned_steps

# Beyond the mean of the steps beside it. In honest recordings of 30 Hz and more the root's are
# 1.7 cm off, and a joint's 24°, but for those that strike: feet, toes and hands.
PLACE = 0.05  # m
TURN = 35.0  # °
STRIKE = (Part.FOOT, Part.TOE, Part.HAND)
STANDS_OUT = 4.0  # times what the steps around are off
FEWEST = 5  # frames


def find_jumps(recording: Recording, figure: Figure, known: Spans = ()) -> Finding | None:
    """Where two takes were joined, capture mistook something, or many frames are missing; and the
    clip's ends where a bone jumps about. known: places where something else is why."""
    if len(recording.frames) < FEWEST:
        return None
    local, root = LocalPoses.of(recording), figure.bones[0]
    moved, wider = moved_steps(local, root), slack(recording.rate)
    places = [(float(100.0 * moved[t]), "", t) for t in _jumps(moved, PLACE * wider)]
    turns = []
    for bone in (b for b, part in figure.parts if part not in STRIKE and b != root):
        turned, name = np.degrees(turned_steps(local, bone)), recording.bones[bone].name
        first, last = ragged_ends(local, bone, wider, recording.rate)
        ragged = [*range(first), *range(len(turned) - last, len(turned))]
        turns += [(float(turned[t]), name, t) for t in [*_jumps(turned, TURN * wider), *ragged]]
    places, turns = (
        [each for each in told if not _is_in(known, recording.frames[each[2] : each[2] + 2])]
        for told in (places, turns)
    )
    if not places and not turns:
        return None
    amount, part, _ = max(places or turns)  # of the whole body where it jumps, else of a bone
    steps = np.isin(np.arange(len(moved)), [t for *_, t in places + turns])
    frames = tuple(
        (float(recording.frames[a]), float(recording.frames[b + 1])) for a, b in runs(steps)
    )
    return Finding(FindingKind.JUMP, amount, "cm" if places else "°", frames, part)


def with_those_left(
    found: Finding, recording: Recording, figure: Figure, known: Spans = ()
) -> Finding:
    """With the jumps of what is kept without those found: where a clip is cut its new first and
    last steps are compared with others."""
    kept = longest_stretch(recording.ends, [found])
    if kept[1] <= kept[0]:
        return found
    left = find_jumps(recording.window(*kept), figure, known)
    if left is None:
        return found
    every = replace(found, frames=tuple(sorted({*found.frames, *left.frames})))
    return with_those_left(every, recording, figure, known)


def _is_in(known: Spans, step: FloatArray) -> bool:
    """Whether a step from one frame to another (2,) is at one of some places."""
    return any(step[0] <= last and first <= step[1] for first, last in known)


def _jumps(uneven: FloatArray, limit: float) -> list[int]:
    """Steps (S,) that are far off and stand out."""
    far = np.flatnonzero(uneven > limit).tolist()
    return [t for t in far if uneven[t] > STANDS_OUT * around(uneven, t, t)]
