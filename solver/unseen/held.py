"""Whether something holds a body that no contact is known to carry: told by places alone, for where
it falls or does not is told by the clock, which may be wrong."""

import numpy as np

from ..arrays import FloatArray

KEPT = 0.003  # of the height, within which what holds on stays: 5 mm; joints in flights leave it
GOES = 0.1  # of the height, by which the centre of mass goes meanwhile; those then move by 0.015
FEWEST = 3  # frames, likewise; in two a hand that swings may be at one place by chance
# Frames, and of all; at the ends of a flight a body is the fastest, and moves by 0.02 in so many.
STILL, STILL_SHARE = 6, 0.1


def is_held(parts: FloatArray, com: FloatArray, height: float) -> bool:
    """Whether a part keeps its place while the body goes on, or all stand still at the first or the
    last frames. parts: (T, P, 3) m, joints and tips. com: (T, 3) m. height: m, of the figure."""
    if len(com) < STILL:
        return False
    count = max(STILL, round(STILL_SHARE * len(com)))
    ends = parts[:count], parts[-count:]
    if any(np.linalg.norm(np.ptp(end, axis=0), axis=1).max() < KEPT * height for end in ends):
        return True
    since = np.zeros(parts.shape[1], int)  # when each came to where it is
    for frame in range(len(com)):
        places = parts[since, np.arange(len(since))]
        since[np.linalg.norm(parts[frame] - places, axis=1) > KEPT * height] = frame
        first = int(since.min())
        goes = float(np.linalg.norm(com[frame] - com[first])) > GOES * height
        if goes and frame - first >= FEWEST - 1:
            return True
    return False
