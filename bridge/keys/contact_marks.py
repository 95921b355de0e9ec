"""What stands when, for people and engines: markers, and a property of the armature for each limb.

A limb's points (heel, toe) count as one. Frames are whole ones of the result.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ...solver.data.contacts import ContactSchedule
from ..accessors import current_scene
from ..armature.fcurves import CurveHolder, ensured, joined, linear_keys, put, table
from ..rows.choices import ContactMarkers

_FOOT = ("heel", "toe")
_CONSTANT = 0  # of Blender's enum of interpolations
DOWN, UP = "{} down", "{} up"


@dataclass(frozen=True)
class LimbContacts:
    """When a limb touches: name such as "Left foot"; first and last frame of each interval."""

    limb: str
    spans: tuple[tuple[int, int], ...]

    @property
    def property(self) -> str:
        """The armature's property that tells it, 1 while it touches and else 0."""
        return f"contact_{self.limb.lower().replace(' ', '_')}"


def limb_contacts(
    schedule: ContactSchedule, first_frame: float, rate: float
) -> tuple[LimbContacts, ...]:
    """Contacts limb by limb. first_frame: scene frame of the schedule's start; rate: frames a s."""
    found: dict[str, list[tuple[int, int]]] = {}
    for contact in sorted(schedule.contacts, key=lambda each: each.start):
        start, end = (round(first_frame + rate * t) for t in (contact.start, contact.end))
        spans = found.setdefault(_limb(contact.point), [])
        if spans and start <= spans[-1][1] + 1:
            spans[-1] = spans[-1][0], max(spans[-1][1], end)
        else:
            spans.append((start, end))
    return tuple(LimbContacts(limb, tuple(spans)) for limb, spans in sorted(found.items()))


def _limb(point: str) -> str:
    side, _, part = point.partition(" ")
    return f"{side} foot" if part in _FOOT else point


def write_contact_channels(
    armature: bpy.types.Object,
    curves: CurveHolder,
    contacts: tuple[LimbContacts, ...],
    between: tuple[int, int],
) -> None:
    """Key each limb's property, constant from key to key, on the first and last frame and wherever
    it changes between them. Keys outside stay."""
    first, last = between
    for limb in contacts:
        if armature.get(limb.property) is None:
            armature[limb.property] = 0.0
            armature.update_tag()
        frames = np.arange(first, last + 1)
        touches = np.zeros(len(frames))
        for start, end in limb.spans:
            touches[(frames >= start) & (frames <= end)] = 1.0
        changes = np.concatenate([[True], np.diff(touches) != 0.0])
        curve = ensured(curves, f'["{limb.property}"]', 0, "Contacts")
        own = table(curve)
        at = own["co"][:, 0]
        outside = {name: column[(at < first) | (at > last)] for name, column in own.items()}
        made = linear_keys(own, frames[changes].astype(float), touches[changes])
        made["interpolation"][:] = _CONSTANT
        put(curve, joined(outside, made))


def write_markers(
    action: bpy.types.Action,
    contacts: tuple[LimbContacts, ...],
    between: tuple[int, int],
    where: ContactMarkers,
) -> None:
    """Mark where each limb comes down and goes up, on the action or on the scene's timeline; those
    that were marked between these frames before go."""
    if where is ContactMarkers.NONE:
        return
    names = {text.format(limb.limb) for limb in contacts for text in (DOWN, UP)}
    markers: Any = current_scene().timeline_markers
    if where is ContactMarkers.ACTION:
        markers = action.pose_markers
    for marker in [m for m in markers if m.name in names and between[0] <= m.frame <= between[1]]:
        markers.remove(marker)
    for name, frame in _events(contacts, between):
        markers.new(name).frame = frame


def _events(
    contacts: tuple[LimbContacts, ...], between: tuple[int, int]
) -> Iterator[tuple[str, int]]:
    """What happens within the frames: contacts that they cut off neither begin nor end there."""
    for limb in contacts:
        for start, end in limb.spans:
            if start > between[0]:
                yield DOWN.format(limb.limb), start
            if end < between[1]:
                yield UP.format(limb.limb), end
