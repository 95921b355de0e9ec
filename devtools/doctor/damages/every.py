"""Each way in which clips are damaged for the table."""

from __future__ import annotations

from ....solver.body.anatomy import Part
from ....solver.data.problem import Mend
from ....solver.doctor.repairs import UpAxis
from .clock import converted, dropped, frozen, gap, held, ramped, slowed
from .damage import FAST_RATE, VIDEO_RATE
from .poses import (
    begun_at_rest,
    burst,
    ended_at_rest,
    exchanged,
    flipped,
    noisy,
    ragged,
    spiked,
    stretched,
    wrapped,
)
from .whole_body import (
    floating,
    in_place,
    joined,
    lain,
    leapt,
    levelled,
    raised,
    rising,
    sized,
    sliding,
    sunk,
    swaying,
    tilted,
)

DAMAGES = (
    *map(slowed, (0.5, 0.8, 1.25, 2.0)),
    *map(ramped, (1.5, 1 / 1.5)),
    sized(1.6, "size × 1.6"),
    sized(2.54, "centimetres as inches"),
    sized(1 / 2.54, "inches as centimetres"),
    sized(0.01, "metres as centimetres"),
    *map(lain, (UpAxis.Y, UpAxis.X)),
    lain(UpAxis.X, rest=False),
    *map(begun_at_rest, (1, 5)),
    begun_at_rest(1, 80.0),
    ended_at_rest(5),
    *map(spiked, (20.0, 45.0, 120.0)),
    *map(burst, (2, 5)),
    leapt(0.13, 2),
    *map(joined, (0.1, 0.4)),
    ragged(8),
    *(exchanged(frames, limbs) for limbs in (Mend.LEGS, Mend.ARMS) for frames in (5, 15, 30)),
    exchanged(30, Mend.LEGS, last=True),
    exchanged(30, Mend.LEGS, angles=True),
    exchanged(30, Mend.LEGS, Mend.ARMS),
    *map(flipped, (2, 12)),
    flipped(12, of_parent=True),
    *(wrapped(part, n) for part in (Part.PELVIS, Part.THIGH) for n in (2, 6)),
    *map(held, (1, 6)),
    *(frozen(0.3, repeated=each) for each in (False, True)),
    converted(24.0, VIDEO_RATE),
    *map(dropped, (1, 4)),
    *map(gap, (3, 6)),
    gap(2, 2),
    *map(sliding, (0.05, 0.1, 0.2, 0.5)),
    *map(tilted, (-1.5, 3.0, 12.0)),
    rising(0.1),
    floating(0.05, 2.0),
    floating(0.15, 3.0),
    swaying(0.1, 3.0),
    *(sunk(0.1, seconds) for seconds in (0.2, 0.4)),
    *map(raised, (-0.2, -0.05, 0.1, 0.5)),
    levelled(),
    in_place(),
    noisy(3.0, 1.0),
    noisy(3.0, 1.0, FAST_RATE),
    noisy(6.0, 2.0),
    *map(stretched, (0.05, 0.15)),
)
