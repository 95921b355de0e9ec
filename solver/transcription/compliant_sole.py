"""Compliant sole: a touching point sinks to its place at a landing, and rises at its lift-off.

A foot cannot stop in no time, and need not: heel pads, shoes and floors give by millimetres while
they are loaded (`SOLE_COMPLIANCE`, analysis/grounding.py). The point's height above its place is a
parabola that ends at rest.
"""

import numpy as np

from ..data.contacts import Contact
from .contact_pins import PlaceTrajectory

SINKING_TIME = 0.03  # s
MAX_SINKING_SHARE = 0.4  # of the contact
SAMPLES = 8  # intervals of each parabola


def sole_trajectory(contact: Contact) -> PlaceTrajectory | None:
    """The trajectory of a contact's place as its sole gives; None where it does not."""
    if not any(contact.rise):
        return None
    sinking = min(SINKING_TIME, MAX_SINKING_SHARE * (contact.end - contact.start))
    passed = np.linspace(0.0, 1.0 + 1.0 / SAMPLES, SAMPLES + 2)  # two samples at rest: no overshoot
    times = [contact.start + sinking * passed, contact.end - sinking * passed[::-1]]
    left = np.maximum(1.0 - passed, 0.0) ** 2
    height = np.concatenate([contact.rise[0] * left, contact.rise[1] * left[::-1]])
    return PlaceTrajectory(np.concatenate(times), height[:, None] * np.array([0.0, 0.0, 1.0]))
