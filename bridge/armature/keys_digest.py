"""Whether an action's curves are what they were."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set
from dataclasses import dataclass
from time import perf_counter
from zlib import crc32

import bpy
import numpy as np

from ..action_slots import all_curves
from .fcurves import column
from .incremental import SLICE_S

_BEZIER = 2  # of Blender's enum; what is above are named easings, such as Elastic
_HANDLES = ("handle_left", "handle_right")
_EASINGS = ("easing", "amplitude", "back", "period")
_NOT_STORED = {"rna_type", "is_valid", "active", "show_expanded"}


def keys_digest(action: bpy.types.Action) -> str:
    """A number for all that shapes an action's curves: keys, the handles and easings that count
    between them, modifiers, and how curves go on beyond their keys; another where something
    differs."""
    return str(_added(_NOTHING, all_curves(action)).digest)


@dataclass(frozen=True)
class _Found:
    """Of an action's first curves: how many, how many modifiers they have, and their digest."""

    curves: int
    modifiers: int
    digest: int


_NOTHING = _Found(0, 0, 0)


class KeptDigests:
    """Digests of actions' keys that are found once, in parts; by the actions' numbers in this
    session.

    Whoever keeps them for longer than nothing can change forgets them when keys may be others. Of
    new modifiers Blender tells nobody: what is found looks how many there are.
    """

    def __init__(self) -> None:
        self._found: dict[int, _Found] = {}
        self._part: tuple[int, _Found] = (0, _NOTHING)  # of which action, of its first curves
        self._as_found: set[int] = set()  # which have as many modifiers, in what is under way
        self._under_way = False

    def of(self, action: bpy.types.Action) -> str:
        """The digest of an action's keys, which is found now where it is not known."""
        uid = action.session_uid
        if uid not in self._found:
            self._found[uid] = _added(_NOTHING, all_curves(action))
        return str(self._found[uid].digest)

    def find(self, actions: Iterable[bpy.types.Action]) -> bool:
        """Go on with the digests of actions, for a slice's time; whether all are known."""
        until = perf_counter() + SLICE_S
        self._under_way = not all(self._is_found(action, until) for action in actions)
        if not self._under_way:
            self._as_found.clear()
        return not self._under_way

    def _is_found(self, action: bpy.types.Action, until: float) -> bool:
        """Whether an action's digest is known, and it is before an instant, s, of Python's
        performance counter; at least one curve is added."""
        uid = action.session_uid
        if uid in self._as_found:
            return True
        curves = all_curves(action)
        if uid not in self._found or self._found[uid].modifiers != _modifiers(curves):
            self._found.pop(uid, None)
            of, before = self._part
            part = _added(before if of == uid else _NOTHING, curves, until)
            if part.curves < len(curves):
                self._part = uid, part
                return False
            self._part, self._found[uid] = (0, _NOTHING), part
        self._as_found.add(uid)
        return perf_counter() < until

    def forget(self) -> bool:
        """Keys may be others now. Returns whether their digests were being found."""
        self._found.clear()
        self._as_found.clear()
        self._part = 0, _NOTHING
        under_way, self._under_way = self._under_way, False
        return under_way


def _added(before: _Found, curves: Sequence[bpy.types.FCurve], until: float = np.inf) -> _Found:
    """With more of an action's curves, at least one, until an instant, s; or with all."""
    done, modifiers, digest = before.curves, before.modifiers, before.digest
    for curve in curves[done:]:
        done, modifiers = done + 1, modifiers + len(curve.modifiers)
        digest = curve_digest(curve, digest)
        if perf_counter() > until:
            break
    return _Found(done, modifiers, digest)


def _modifiers(curves: Iterable[bpy.types.FCurve]) -> int:
    return sum(len(curve.modifiers) for curve in curves)


def curve_digest(curve: bpy.types.FCurve, found: int = 0) -> int:
    """The same of one curve. found: of others, which it is added to."""
    found = crc32(f"{curve.data_path}[{curve.array_index}]{curve.mute}".encode(), found)
    found = _keys(curve, found)
    found = crc32(curve.extrapolation.encode(), found)
    for modifier in curve.modifiers:
        found = crc32(repr(stored(modifier)).encode(), found)
    return found


def _keys(curve: bpy.types.FCurve, found: int) -> int:
    """Of its keys; columns that do not count are not read, which takes longest."""
    found = crc32(column(curve, "co").tobytes(), found)
    interpolation = column(curve, "interpolation")[:, 0]
    found = crc32(interpolation.tobytes(), found)
    bent = interpolation == _BEZIER
    after_bent = np.concatenate([[False], bent[:-1]]) if len(bent) else bent
    for name, used in zip(_HANDLES, (after_bent, bent), strict=True):
        if used.any():
            found = crc32(column(curve, name)[used].tobytes(), found)
    eased = interpolation > _BEZIER
    for name in _EASINGS if eased.any() else ():
        found = crc32(column(curve, name)[eased].tobytes(), found)
    return found


def stored(thing: bpy.types.bpy_struct, but: Set[str] = frozenset()) -> list[object]:
    """What something holds, and the rows of its lists, such as a modifier and the points of its
    envelope; of other things their names. but: for these properties."""
    found: list[object] = []
    for each in thing.bl_rna.properties:
        if each.identifier in _NOT_STORED or each.identifier in but:
            continue
        value = getattr(thing, each.identifier)
        if each.type == "COLLECTION":
            found += [stored(row) for row in value]
        elif each.type == "POINTER":
            found.append(getattr(value, "name", None))
        else:
            found.append(tuple(value) if getattr(each, "is_array", False) else value)
    return found
