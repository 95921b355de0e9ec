"""A figure that hangs by its hands, swings, lets go and lands."""

from dataclasses import replace

import numpy as np
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.recording import Recording
from hangtime.tests.helpers.clips import JUMP, load_recording

BAR = 2.4  # m, how high the hands are
RELEASE, LANDING = 0.9, 1.3  # s
ASIDE = 0.25  # m, of the hands from the middle
RADIUS = 0.3  # m, of the circle in which the body swings around


def hung(*, high_hands: bool = True) -> Recording:
    """Who swings around below a bar, lets go and falls onto the feet, in one pose but for the
    hands, which keep their places on the bar. high_hands: else they go with the body."""
    stands = load_recording(JUMP).window(1.0, 240.0)
    heads = np.repeat(stands.heads[:1], len(stands.times), axis=0)
    rotations = np.repeat(stands.rotations[:1], len(stands.times), axis=0)
    bar = np.array([*heads[0, 0, :2], BAR])
    heads += _path(stands.times)[:, None]
    if high_hands:
        held = stands.times <= RELEASE
        for side, aside in (("Left", ASIDE), ("Right", -ASIDE)):
            heads[held, stands.index(f"{side}Hand")] = bar + np.array([aside, 0.0, 0.0])
    return replace(stands, heads=heads, rotations=rotations)


def _path(times: FloatArray) -> FloatArray:
    """(T, 3) m, of the whole body from where it stands: once around, and on along a parabola."""
    turned = 2.0 * np.pi * np.minimum(times, RELEASE) / RELEASE
    flown = np.clip(times - RELEASE, 0.0, LANDING - RELEASE)
    aside = RADIUS * (np.sin(turned) + 2.0 * np.pi * flown / RELEASE)
    high = 0.5 * STANDARD_GRAVITY * ((LANDING - RELEASE) ** 2 - flown**2)
    return np.stack([aside, RADIUS * (1.0 - np.cos(turned)), high], axis=1)
