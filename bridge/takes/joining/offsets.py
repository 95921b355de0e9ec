"""Offsets of a motion from the take around it, which fade without a bend.

Outside of the adapted frames the take is shown with what its pose and speed lack at the seam, and
this fades ("inertialization", Bollo, GDC 2018). The adapted frames stay as they were solved, with
every pin.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....solver.arrays import BoolArray, FloatArray
from ....solver.data.recording import PoseTrack
from ....solver.data.reports.keys import BlendReport
from ....solver.numerics.rotations import rotation_matrix, rotation_vector

# Over which the speed at a seam is taken: short against a step, and of 120 Hz seven frames, so that
# one that jumps in the recording does not throw the blend.
_SEAM_S = 0.05


@dataclass(frozen=True)
class SeamOffset:
    """Offset of a motion from a take at a seam, and its change a frame away from the seam.

    place, place_rate: (3,) m of the pelvis, world. turns, turn_rates: (B, 3) rad by bone, world.
    """

    place: FloatArray
    place_rate: FloatArray
    turns: FloatArray
    turn_rates: FloatArray


def seam_offset(motion: PoseTrack, take: PoseTrack) -> SeamOffset:
    """Offset at the first of some frames (T,), T >= 1, the seam's; the next ones lead away from it
    into the motion. Rates are those that lead out of it."""
    count = min(len(motion.frames), len(take.frames))
    motion, take = rows(motion, slice(count)), rows(take, slice(count))
    places = motion.root_head - take.root_head
    turns = rotation_vector(motion.rotations @ np.swapaxes(take.rotations, -1, -2))
    away = np.abs(motion.frames - motion.frames[0])
    return SeamOffset(places[0], -_rate(places, away), turns[0], -_rate(turns, away))


def _rate(values: FloatArray, away: FloatArray) -> FloatArray:
    """Change a frame at the first of values (T, ...), `away` (T,) frames from it: of the parabola
    that is nearest to them."""
    if len(values) == 1:
        return np.zeros_like(values[0])
    powers = np.vander(away, min(len(away), 3), increasing=True)
    flat = values.reshape(len(values), -1)
    return np.asarray((np.linalg.pinv(powers)[1] @ flat).reshape(values.shape[1:]))


def faded(take: PoseTrack, seam: SeamOffset, away: FloatArray, length: float) -> PoseTrack:
    """The take at frames (T,) that are `away` (T,) frames from the seam, with what is left of the
    offset there; nothing after `length` frames."""
    keep, rate = _fading(away, length)
    place = keep[:, None] * seam.place + rate[:, None] * seam.place_rate
    turn = keep[:, None, None] * seam.turns + rate[:, None, None] * seam.turn_rates
    return PoseTrack(
        take.frames,
        take.bones,
        rotation_matrix(turn) @ take.rotations,
        take.root_head + place,
    )


def _fading(away: FloatArray, length: float) -> tuple[FloatArray, FloatArray]:
    """Shares (T,) of an offset and frames (T,) of its rate that are left: the quintic polynomials
    with value and slope 1 at the seam and neither value, slope nor bend at the end."""
    s = np.clip(away / length, 0.0, 1.0)
    rate = length * (s - 6.0 * s**3 + 8.0 * s**4 - 3.0 * s**5)
    return remaining(away, length), rate


def remaining(away: FloatArray, length: float) -> FloatArray:
    """Shares (T,) that are left `away` (T,) frames from a seam of what fades over `length`."""
    s = np.clip(away / length, 0.0, 1.0)
    return np.asarray(1.0 - s**3 * (10.0 - 15.0 * s + 6.0 * s**2))


def blend_report(shown: PoseTrack, take: PoseTrack, *, into: bool, rate: float) -> BlendReport:
    """How a blend moves the hips, at its frames and the seam's (T,), T >= 2; the same of the take.
    rate: frames a second."""
    speeds = [
        np.linalg.norm(np.diff(track.root_head, axis=0), axis=1) * rate / np.diff(track.frames)
        for track in (shown, take)
    ]
    fastest, seam = int(speeds[0].argmax()), -1 if into else 0
    return BlendReport(
        into=into,
        first_frame=float(shown.frames[0]),
        last_frame=float(shown.frames[-1]),
        off_m=float(np.linalg.norm(shown.root_head[seam] - take.root_head[seam])),
        speed_m_s=float(speeds[0][fastest]),
        frame=float(shown.frames[fastest]),
        take_speed_m_s=float(speeds[1].max()),
    )


def rows(track: PoseTrack, keep: BoolArray | slice) -> PoseTrack:
    """Some of a track's frames (T,)."""
    return replace(
        track,
        frames=track.frames[keep],
        rotations=track.rotations[keep],
        root_head=track.root_head[keep],
    )


def frames_from(track: PoseTrack, frame: float) -> PoseTrack:
    """The frames from one on."""
    return rows(track, track.frames >= frame)


def frames_until(track: PoseTrack, frame: float) -> PoseTrack:
    """The frames until one, it included."""
    return rows(track, track.frames <= frame)


def beginning(track: PoseTrack, rate: float) -> PoseTrack:
    """The first frames, of which the speed at a seam is taken; three at least. rate: frames/s."""
    return rows(track, slice(max(3, 1 + round(rate * _SEAM_S))))


def backwards(track: PoseTrack, rate: float) -> PoseTrack:
    """The last frames, the last one first."""
    return beginning(rows(track, slice(None, None, -1)), rate)


def joined(tracks: list[PoseTrack]) -> PoseTrack:
    """Tracks of the same bones, one after the other."""
    return PoseTrack(
        np.concatenate([track.frames for track in tracks]),
        tracks[0].bones,
        np.concatenate([track.rotations for track in tracks]),
        np.concatenate([track.root_head for track in tracks]),
    )
