"""Where a limb ends whose last bone nothing follows: tails of last bones often lie.

Importers give such bones any length and direction. So a bone's own tail counts where it leads on as
a body does; of the bones below it, fingers or a marked tip, the heads count, but no tails.

How long a hand is no bone tells: rigs end at the knuckles, or at any joint of the fingers. They
tell where it leads, the stature how far, so that the same performer has the same hands on every
rig. Lengths as shares of a stature by Drillis and Contini (1966): hand .108, foot .152; the head
from its joint to the top about .13. Toes are some .28 of a foot, and from ankle to ball it is some
.77 of the rest.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from ..arrays import FloatArray
from ..data.recording import Bone
from ..numerics.rotations import unit
from .parts import Part

USUAL = {Part.HEAD: 0.13, Part.HAND: 0.108, Part.FOOT: 0.115}
BOUNDS: Mapping[Part, tuple[float, float]] = {
    Part.HEAD: (0.09, 0.16),
    Part.TOE: (0.03, 0.07),
    Part.FOOT: (0.10, 0.16),
}  # on the length, shares of the stature: what files tell of it is often wrong
ENDS = {*USUAL, *BOUNDS}
TOES = 0.28 / (1.0 - 0.28) / 0.77  # of the level distance from ankle to ball
ALIKE = 0.1  # of the usual length: an end that is told no further from the usual one is that one
ASTRAY = np.cos(np.radians(60.0))  # what leads off further is no end of the body


def end_span(
    bones: Sequence[Bone], bone: int, part: Part, onwards: FloatArray, height: float
) -> FloatArray:
    """(3,) m, from a last bone's head to where its part ends, at rest.

    onwards: (3,) where the part would lead by those before it, 0 where they do not tell; of toes as
    long as level from ankle to ball.
    height: m, of the figure. Of no length where the bone of another part has none.
    """
    head, tail = bones[bone].head, bones[bone].tail
    below = [end - head for end in _heads_below(bones, bone)]
    if part not in ENDS or not np.linalg.norm(onwards) > 0.0:
        return max([tail - head, *below], key=_length)
    ahead = unit(onwards)
    usual = TOES * _length(onwards) if part is Part.TOE else USUAL[part] * height
    low, high = (share * height for share in BOUNDS.get(part, (0.0, np.inf)))
    usual = float(np.clip(usual, low, high))
    if part is Part.HEAD:  # eyes, jaw and nose lie before it: how high they are counts
        below = [(span @ ahead) * ahead for span in below]
    spans = [span for span in (tail - head, *below) if _leads(span, ahead)]
    longest = max(spans, key=_length, default=np.zeros(3))
    length = _length(longest)
    if length == 0.0 or (length < low and not _leads(tail - head, ahead)):
        return np.asarray(usual * ahead)
    told = part in BOUNDS and length >= low  # a stub has a direction at most
    span = longest / length * (min(length, high) if told else usual)
    alike = _length(span - usual * ahead) < ALIKE * usual
    return np.asarray(usual * ahead if alike else span)


def _length(span: FloatArray) -> float:
    return float(np.linalg.norm(span))


def _leads(span: FloatArray, ahead: FloatArray) -> bool:
    """Whether a span (3,) leads on, along the unit vector (3,), as a body does."""
    return bool(span @ ahead >= ASTRAY * np.linalg.norm(span) > 0.0)


def _heads_below(bones: Sequence[Bone], bone: int) -> list[FloatArray]:
    """(3,) each, of all bones below one."""
    below = {bone}
    for i, other in enumerate(bones):
        if other.parent in below:
            below.add(i)
    return [bones[i].head for i in below - {bone}]
