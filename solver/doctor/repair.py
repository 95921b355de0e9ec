"""Repairs of a recording: from a recording to a recording, frame by frame the same instants."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..data.recording import Recording
from ..data.scaling import scaled_recording
from .figure import Figure, figure_of
from .lengths import kept_lengths
from .local_poses import LocalPoses
from .noise import smoothed
from .repairs import Mend, Repairs
from .single_frames import held_frames, unflipped, unsound_spikes
from .upright import turn_upright


def repaired(
    recording: Recording, repairs: Repairs, chosen: Mapping[str, str] | None = None
) -> Recording:
    """The recording with all repairs. chosen: bones by parts of the body, as in a problem.

    Raises MissingPart.
    """
    return placed(mended(trimmed(turned(recording, repairs), repairs), repairs, chosen), repairs)


def turned(recording: Recording, repairs: Repairs) -> Recording:
    """With the axis that is up along Z."""
    turn = turn_upright(repairs.up)
    bones = tuple(
        replace(b, head=turn @ b.head, tail=turn @ b.tail, rotation=turn @ b.rotation)
        for b in recording.bones
    )
    heads, rotations = recording.heads @ turn.T, turn @ recording.rotations
    return replace(recording, bones=bones, heads=heads, rotations=rotations)


def trimmed(recording: Recording, repairs: Repairs) -> Recording:
    """Without the frames at the beginning that are left out."""
    kept = recording.part(slice(repairs.trim, None))
    return replace(kept, times=kept.times - kept.times[:1])


def mended(
    recording: Recording, repairs: Repairs, chosen: Mapping[str, str] | None = None
) -> Recording:
    """With its poses mended; frames, clock and lengths stay. Raises MissingPart."""
    if not repairs.mend:
        return recording
    figure = figure_of(recording, chosen)
    for mend in Mend:
        if mend in repairs.mend:
            recording = _with(mend, recording, figure)
    return recording


def _with(mend: Mend, recording: Recording, figure: Figure) -> Recording:
    match mend:
        case Mend.FLIPS:
            return unflipped(recording, figure)
        case Mend.SPIKES:
            unsound = unsound_spikes(recording, figure)
        case Mend.HELD_FRAMES:
            held = held_frames(recording)
            unsound = np.broadcast_to(held[:, None], recording.heads.shape[:2])
        case Mend.BONE_LENGTHS:
            return kept_lengths(recording, figure)
        case Mend.NOISE:
            return smoothed(recording, figure)
    return LocalPoses.of(recording).filled(unsound).posed(recording)


def placed(recording: Recording, repairs: Repairs) -> Recording:
    """At the scales of time and size, without drift, on the floor at 0."""
    scaled = scaled_recording(recording, repairs.scale)
    times = repairs.time_scale * scaled.times
    drift = np.array([*repairs.drift, 0.0])
    away: FloatArray = times[:, None] * drift + np.array([0.0, 0.0, repairs.floor])
    bones = tuple(
        replace(b, head=b.head - (0.0, 0.0, repairs.floor), tail=b.tail - (0.0, 0.0, repairs.floor))
        for b in scaled.bones
    )
    return replace(scaled, bones=bones, times=times, heads=scaled.heads - away[:, None])
