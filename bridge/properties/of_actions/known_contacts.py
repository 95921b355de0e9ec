"""Contacts of results, which are known and so need not be found in what is made from them."""

from __future__ import annotations

import json
from dataclasses import astuple, dataclass
from typing import Any

import bpy
import numpy as np

from ....solver.arrays import FloatArray
from ....solver.data.contacts import ContactSchedule, KnownContacts
from ....solver.data.scene import SceneObject
from ...accessors import ATTRIBUTE
from ...hidden_texts import HiddenText, listed, number, word
from ...played_strips import StripTime
from ..action import action_settings

Known = tuple[KnownContacts, ...]


@dataclass(frozen=True)
class SolvedContacts:
    """What a motion touches. frames: (T,) its scene frames, `rate` a second. scene: its own."""

    schedule: ContactSchedule
    frames: FloatArray
    rate: float
    scene: tuple[SceneObject, ...]

    @property
    def known(self) -> Known:
        """None where some are on what moves: points do not keep their places then."""
        moving = {thing.name for thing in self.scene if thing.moves}
        if any(contact.on in moving for contact in self.schedule.contacts):
            return ()
        first = float(self.frames[0])
        last = first + self.schedule.duration * self.rate
        contacts = (
            (c.point, first + c.start * self.rate, first + c.end * self.rate)
            for c in self.schedule.contacts
        )
        return (KnownContacts(first, last, tuple(contacts)),)


def keep_contacts(
    action: bpy.types.Action, solved: SolvedContacts, before: Known = (), later: float = 0.0
) -> None:
    """Keeps with a result its contacts, and beside them those known before in the frames of what it
    was made from. later: frames by which what follows is."""
    first, last = solved.frames[[0, -1]].tolist()
    every = [*(_cut(each, -np.inf, first) for each in before), *solved.known]
    every += [_cut(_mapped(each, later), last, np.inf) for each in before]
    some = [astuple(each) for each in every if each.first < each.last]
    action_settings(action).known_contacts = json.dumps(some)


def _cut(known: KnownContacts, first: float, last: float) -> KnownContacts:
    """What lies between two frames; nothing does where it ends before it begins."""
    cut = ((p, max(a, first), min(b, last)) for p, a, b in known.contacts)
    contacts = tuple((p, a, b) for p, a, b in cut if a < b)
    return KnownContacts(max(known.first, first), min(known.last, last), contacts)


def known_contacts(action: bpy.types.Action) -> Known:
    """What is known of an action, in its own frames."""
    kept = getattr(action, ATTRIBUTE, None)  # none without registration
    return KNOWN.of(kept.known_contacts if kept is not None else "")


def known_at(action: bpy.types.Action, ends: tuple[float, float], time: StripTime | None) -> Known:
    """What is known of an action between two scene frames, in all cycles of one that repeats.

    time: of the strip that plays it; its cycles are the strip's.
    """
    known = known_contacts(action)
    if time is not None:
        start, scale = float(time.to_scene(np.zeros(1))[0]), time.scale
        return tuple(_mapped(each, start, scale) for each in known)
    period = action.frame_end - action.frame_start
    if not known or not (action.use_frame_range and action.use_cyclic) or period <= 0.0:
        return known
    first = int(np.floor((ends[0] - known[-1].last) / period))
    last = int(np.ceil((ends[1] - known[0].first) / period))
    return tuple(_mapped(each, k * period) for k in range(first, last + 1) for each in known)


def _mapped(known: KnownContacts, later: float, scale: float = 1.0) -> KnownContacts:
    """The same at other frames."""
    contacts = ((p, later + scale * a, later + scale * b) for p, a, b in known.contacts)
    first, last = later + scale * known.first, later + scale * known.last
    return KnownContacts(first, last, tuple(contacts))


def _read(content: Any) -> Known:
    return tuple(_read_one(*listed(each)) for each in listed(content))


def _read_one(first: Any, last: Any, contacts: Any) -> KnownContacts:
    told = ((word(p), number(a), number(b)) for p, a, b in map(listed, listed(contacts)))
    return KnownContacts(number(first), number(last), tuple(told))


KNOWN: HiddenText[Known] = HiddenText("known_contacts", _read, ())
