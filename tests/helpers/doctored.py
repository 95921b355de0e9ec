"""A jump, what its poses tell, and ways in which it is spoilt."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache, partial

import numpy as np
from hangtime.solver.analysis.performance import perform
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.character import Character, build_character
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.figure import Figure, figure_of
from hangtime.solver.doctor.finding import Finding
from hangtime.solver.doctor.frames.exchanges import LIMBS, find_exchange
from hangtime.solver.doctor.frames.flips import find_flips
from hangtime.solver.doctor.frames.full_turns import find_full_turns
from hangtime.solver.doctor.frames.holds import find_held, find_repeated
from hangtime.solver.doctor.frames.jumps import find_jumps
from hangtime.solver.doctor.frames.missing import find_dropped
from hangtime.solver.doctor.frames.rate_conversion import find_conversion
from hangtime.solver.doctor.frames.spikes import find_spikes
from hangtime.solver.doctor.lengths import find_lengths
from hangtime.solver.doctor.noise import find_noise
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.numerics.rotations import rotation_matrix
from hangtime.tests.helpers.clips import JUMP, load_recording

STANDING = 73, 325  # frames, from standing to standing
FLIGHT = 0.34, 0.43  # of its way: where that begins, and its length


@cache
def jump() -> Recording:
    return load_recording(JUMP).window(*STANDING)


@cache
def figure() -> Figure:
    return figure_of(jump())


@cache
def character() -> Character:
    return build_character(jump())


def of_poses(recording: Recording) -> list[Finding]:
    """What the poses alone tell, each as the remedies before leave them."""
    found = []
    for find in (
        partial(find_full_turns, figure=figure()),
        *(find_conversion, find_held, find_repeated),
        *(partial(find_exchange, figure=figure(), limbs=each) for each in LIMBS),
        *(partial(each, figure=figure()) for each in (find_flips, find_spikes)),
        find_dropped,
        partial(find_jumps, figure=figure()),
        *(partial(each, figure=figure()) for each in (find_lengths, find_noise)),
    ):
        if (finding := find(recording)) is not None:
            found.append(finding)
            recording = repaired(recording, finding.remedy or Repairs())
    return found


def sparse(recording: Recording, every: int, first: int = 0) -> Recording:
    """Every so many frames of it."""
    part = recording.part(slice(first, None, every))
    count = np.arange(len(part.frames))
    return replace(part, frames=1.0 + count, times=count * every / recording.rate)


def moved_from(*at: int) -> Recording:
    """The jump, elsewhere by 0.3 m from each of these indices of frames on."""
    heads = jump().heads.copy()
    for index in at:
        heads[index:] += [0.24, 0.18, 0.0]
    return replace(jump(), heads=heads)


def climbed(
    recording: Recording, metres: float, at: Sequence[float], over: float = 0.05
) -> Recording:
    """Steps of such a height in its way, from these shares of it on, each over such a share."""
    hips = recording.heads[:, figure_of(recording).bones[0], :2]
    way = (hips - hips[0]) @ (hips[-1] - hips[0]) / np.sum((hips[-1] - hips[0]) ** 2)
    ramps: list[FloatArray] = [np.clip((way - share) / over, 0.0, 1.0) for share in at]
    up = metres * np.sum(ramps, axis=0)[:, None, None] * np.array([0.0, 0.0, 1.0])
    return replace(recording, heads=recording.heads + up)


def onto(metres: float) -> Recording:
    """The jump, onto something of such a height; from something of it, where that is below 0."""
    start, length = FLIGHT
    return climbed(jump(), metres, [start], length)


def spun(
    recording: Recording,
    axis: FloatArray,
    start: float,
    end: float,
    off: Sequence[float] = (0, 0, 0),
) -> Recording:
    """Turned once more about an axis (3,) from an instant, s, to another, at one speed, about a
    point that is off the centre of mass by so many m, (3,)."""
    about = perform(recording, build_character(recording)).com[:, None] + np.asarray(off, float)
    share = np.clip((recording.times - start) / (end - start), 0.0, 1.0)
    turn = rotation_matrix(2.0 * np.pi * share[:, None] * axis)
    heads = about + np.einsum("tij,tbj->tbi", turn, recording.heads - about)
    return replace(recording, heads=heads, rotations=turn[:, None] @ recording.rotations)
