"""What would carry a body that something unseen carries, as an analysis tells it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from ..data.faults import Fault, OffBalance, UnseenSupport
from ..data.problem import AddedContact
from ..data.requests import PointRequest
from ..data.scene import SupportBox


@dataclass(frozen=True)
class OfferedSupport:
    """Boxes under the feet, contacts, and points at which hands hold on; each once."""

    boxes: tuple[SupportBox, ...] = ()
    contacts: tuple[AddedContact, ...] = ()
    holds: tuple[PointRequest, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.boxes or self.contacts or self.holds)

    @staticmethod
    def of(unseen: Sequence[Fault], points: Collection[PointRequest] = ()) -> OfferedSupport:
        """What analyses' hints offer. points: that are asked for; where one pushes back, the same
        bone needs none meanwhile."""
        carried = [each for each in unseen if isinstance(each, UnseenSupport)]
        off = [each for each in unseen if isinstance(each, UnseenSupport | OffBalance)]
        contacts = dict.fromkeys(contact for each in off for contact in each.hands)
        contacts |= dict.fromkeys(contact for each in carried for contact in each.walls)
        holds = dict.fromkeys(hold for each in off for hold in each.holds)
        return OfferedSupport(
            tuple(box for each in carried for box in each.boxes),
            tuple(contacts),
            tuple(hold for hold in holds if not any(_carries(p, hold) for p in points)),
        )


def _carries(point: PointRequest, hold: PointRequest) -> bool:
    """Whether a point carries the body where a hold would; of one whose frames its phase tells, any
    of its bone."""
    if not point.environment or point.bone != hold.bone:
        return False
    one, other = point.when.frames, hold.when.frames
    return one is None or other is None or (one[0] <= other[1] and other[0] <= one[1])
