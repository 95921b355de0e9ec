"""What a joint does in a frame's time: single frames are told by limits that know the rate."""

from __future__ import annotations

from ..body.anatomy import Part

# From so many frames a second on the limits hold; what bends a smooth path from a frame to the next
# goes as the square of the frame's time. A wrist turns by 80° in 1/30 s, and stops.
FULL_RATE, HAND_RATE = 30.0, 40.0  # Hz
SPARSE = 20.0  # Hz; with fewer a hop is one long step, and a hand turns half a turn in one


def slack(rate: float, part: Part | None = None) -> float:
    """What a limit is multiplied by at so many frames a second. part: None for the whole body."""
    full = HAND_RATE if part is Part.HAND else FULL_RATE
    return max(1.0, full / rate) ** 2
