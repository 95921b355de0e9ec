"""What makes a motion look wrong: limbs through each other, knees bent backwards, jerking limbs.

Limbs are rods from joint to tip as thick as their boxes are at the least. Pictures are looked at,
too; this looks at every instant.
"""

from itertools import combinations

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.body.character import Character
from ...solver.numerics.rotations import unit
from ...solver.stages.implicit import Adaptation
from ...solver.transcription.motion import Motion
from .jobs import Json

RATE = 120.0  # Hz
SOFT = 0.8  # flesh gives: the share of a box's half width that is hard
POINTS = 7  # on a rod
MOVING = ("upper arm", "forearm", "hand", "thigh", "shank", "foot", "toe")


def looks(adaptation: Adaptation) -> Json:
    """The worst of each over the motion, beside the fit's own."""
    motion, fitted = adaptation.motion, adaptation.fit.motion
    times = np.arange(0.0, motion.duration, 1.0 / RATE)
    old = np.arange(0.0, fitted.duration, 1.0 / RATE)
    deep, where = _overlap(motion, times)
    before, _ = _overlap(fitted, old)
    under, lowest = _below_floor(adaptation, times)
    jerk, limb = _jerk(motion, times)
    return {
        "overlap_cm": 100.0 * deep,
        "overlap_at": where,
        "overlap_of_fit_cm": 100.0 * before,
        "below_floor_cm": 100.0 * under,
        "below_floor_at": lowest,
        "least_knee_deg": _least_bend(motion, fitted, times),
        "jerk": jerk / _jerk(fitted, old)[0],
        "jerk_at": limb,
    }


def _overlap(motion: Motion, times: FloatArray) -> tuple[float, str]:
    """How deep two limbs that are no neighbours are in each other at worst, m; which and when."""
    character = motion.transcription.character
    heads, tails = _rods(motion, times)
    radius = np.array([SOFT * 0.5 * float(np.min(b.box_size[:2])) for b in character.bodies])
    worst, where = 0.0, ""
    for i, j in combinations(range(len(character.bodies)), 2):
        if not _may_meet(character, i, j):
            continue
        apart = _apart(heads[:, i], tails[:, i], heads[:, j], tails[:, j])
        deep = radius[i] + radius[j] - apart
        at = int(deep.argmax())
        if deep[at] > worst:
            names = (character.bodies[i].bone, character.bodies[j].bone)
            worst, where = float(deep[at]), f"{names[0]}, {names[1]} at {times[at]:.2f} s"
    return worst, where


def _below_floor(adaptation: Adaptation, times: FloatArray) -> tuple[float, str]:
    """How far a joint or a limb's end is under the floor or the lowest contact, m; which, when."""
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


def _may_meet(character: Character, i: int, j: int) -> bool:
    """Whether one is of a limb and they have two joints between them at least."""
    parts = {character.bodies[k].part.value for k in (i, j)}
    apart = set(character.ancestors(i)) ^ set(character.ancestors(j))
    return bool(parts & set(MOVING)) and len(apart) > 2


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
