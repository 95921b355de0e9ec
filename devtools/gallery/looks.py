"""Visible defects of a motion: limbs through each other, knees bent backwards, jerking limbs.

Limbs are the solver's capsules, but how far they are apart is measured here at points along them.
Pictures are looked at, too; this looks at every instant.
"""

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.numerics.rotations import unit
from ...solver.solid.shapes import Capsules, capsules, meeting_pairs
from ...solver.stages.implicit import Adaptation
from ...solver.transcription.motion import Motion
from .jobs import Json

RATE = 120.0  # Hz
POINTS = 7  # on a capsule's axis


def looks(adaptation: Adaptation) -> Json:
    """The worst of each over the motion, beside the fit's own."""
    motion, fitted = adaptation.motion, adaptation.fit.motion
    times = np.arange(0.0, motion.duration, 1.0 / RATE)
    old = np.arange(0.0, fitted.duration, 1.0 / RATE)
    same = adaptation.setup.context.timeline.to_old(times)
    deep, where = _overlap(motion, fitted, times, same)
    under, lowest = _below_floor(adaptation, times)
    jerk, limb = _jerk(motion, times)
    return {
        "overlap_cm": 100.0 * deep,
        "overlap_at": where,
        "below_floor_cm": 100.0 * under,
        "below_floor_at": lowest,
        "least_knee_deg": _least_bend(motion, fitted, times),
        "jerk": jerk / _jerk(fitted, old)[0],
        "jerk_at": limb,
    }


def _overlap(
    motion: Motion, fitted: Motion, times: FloatArray, old: FloatArray
) -> tuple[float, str]:
    """Deepest overlap of two limbs that must not meet, m, beyond the fit's; which and when."""
    character = fitted.transcription.character
    pairs = meeting_pairs(character, capsules(character))
    deeper = _depths(motion, pairs, times) - np.maximum(_depths(fitted, pairs, old), 0.0)
    at, pair = np.unravel_index(int(deeper.argmax()), deeper.shape)
    shapes = capsules(character)
    names = [character.bodies[shapes[k].body].bone for k in pairs[pair]]
    return max(float(deeper.max()), 0.0), f"{names[0]}, {names[1]} at {times[at]:.2f} s"


def _depths(motion: Motion, pairs: IntArray, times: FloatArray) -> FloatArray:
    """(T, P) m that the capsules of pairs (P, 2) are in each other."""
    shapes = Capsules.of(capsules(motion.transcription.character))
    heads, tails = shapes.ends(motion.pose(times))
    apart = [_apart(heads[:, i], tails[:, i], heads[:, j], tails[:, j]) for i, j in pairs]
    return np.asarray(shapes.radius[pairs].sum(axis=1) - np.stack(apart, axis=1))


def _below_floor(adaptation: Adaptation, times: FloatArray) -> tuple[float, str]:
    """Deepest place of a joint or limb's end under the floor or lowest contact, m; which, when."""
    motion = adaptation.motion
    heads, tails = _rods(motion, times)
    lowest = motion.com(times)[:, 2:] + np.minimum(heads, tails)[:, :, 2]
    floor = min(adaptation.fit.schedule.floor_m, float(adaptation.places[:, 2].min(initial=np.inf)))
    at, limb = np.unravel_index(int(lowest.argmin()), lowest.shape)
    bone = motion.transcription.character.bodies[int(limb)].bone
    return max(floor - float(lowest.min()), 0.0), f"{bone} at {times[at]:.2f} s"


def _rods(motion: Motion, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(T, B, 3) m, both ends of every limb."""
    posed = motion.pose(times)
    tips = np.array([body.tip for body in motion.transcription.character.bodies])
    return posed.centres, posed.centres + np.einsum("tbij,bj->tbi", posed.rotations, tips)


def _apart(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    """(T,) least distance of points on the rods a-b from the rods c-d, each (T, 3)."""
    share = np.linspace(0.0, 1.0, POINTS)[:, None, None]
    points = a + share * (b - a)
    along = d - c
    t = np.einsum("kti,ti->kt", points - c, along) / np.maximum((along**2).sum(axis=1), 1e-9)
    nearest = c + np.clip(t, 0.0, 1.0)[..., None] * along
    return np.asarray(np.linalg.norm(points - nearest, axis=2).min(axis=0))


def _least_bend(motion: Motion, fitted: Motion, times: FloatArray) -> float:
    """The least bend of a knee, degrees; below zero it is bent against the fit's way."""
    character = motion.transcription.character
    least = np.inf
    for i, body in enumerate(character.bodies):
        if body.part.value == "shank":
            old = np.linspace(0.0, fitted.duration, 200)
            way = _across(fitted, i, old).mean(axis=0)
            across = _across(motion, i, times)
            sine = np.linalg.norm(across, axis=1) * np.sign(across @ way)
            least = min(least, float(np.degrees(np.arcsin(np.clip(sine, -1.0, 1.0))).min()))
    return least


def _across(motion: Motion, body: int, times: FloatArray) -> FloatArray:
    """(T, 3) the cross product of the parent's and a body's directions, in the parent's frame."""
    character = motion.transcription.character
    parent = character.joints[body].parent
    turns = motion.pose(times).rotations
    local = np.swapaxes(turns[:, parent], 1, 2) @ turns[:, body]
    own = local @ unit(character.bodies[body].tip)
    return np.asarray(np.cross(unit(character.bodies[parent].tip), own))


def _jerk(motion: Motion, times: FloatArray) -> tuple[float, str]:
    """The largest acceleration of a joint about the pelvis, m/s², smoothed over three frames."""
    posed = motion.pose(times)
    centres = posed.centres - posed.centres[:, :1]
    second = np.diff(centres, n=2, axis=0) * RATE**2
    smooth = (second[:-2] + second[1:-1] + second[2:]) / 3.0
    size = np.linalg.norm(smooth, axis=2).max(axis=0)
    return float(size.max()), motion.transcription.character.bodies[int(size.argmax())].bone
