"""When the body rests on something unseen that stays where it was."""

from collections.abc import Sequence

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.contacts import ContactSchedule

MOVED = 1e-3  # m; a contact that goes less far stays where it was


def resting(schedule: ContactSchedule, moved: Sequence[bool], times: FloatArray) -> BoolArray:
    """(T,) whether at instants (T,) s something unseen carries and a contact touches that stays.

    Where all that touches goes elsewhere, what carries unseen goes with it. moved: of each contact.
    """
    carried, stays = np.zeros((2, len(times)), dtype=bool)
    for gap in schedule.unseen:
        carried |= (times >= gap.start) & (times <= gap.end)
    for contact, goes in zip(schedule.contacts, moved, strict=True):
        if not goes:
            stays |= (times >= contact.start) & (times <= contact.end)
    return np.asarray(carried & stays)
