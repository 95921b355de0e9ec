"""Whether an action's curves are what they were."""

from __future__ import annotations

from collections.abc import Iterable, Set
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
    found = 0
    for curve in all_curves(action):
        found = curve_digest(curve, found)
    return str(found)


class KeptDigests:
    """Digests of actions' keys that are found once, in parts; by the actions' numbers in this
    session.

    Whoever keeps them for longer than nothing can change forgets them when keys may be others.
    """

    def __init__(self) -> None:
        self._found: dict[int, str] = {}
        self._part: tuple[int, int, int] = (0, 0, 0)  # of which action, how many curves, digest
        self._under_way = False

    def of(self, action: bpy.types.Action) -> str:
        """The digest of an action's keys, which is found now where it is not known."""
        uid = action.session_uid
        if uid not in self._found:
            self._found[uid] = keys_digest(action)
        return self._found[uid]

    def find(self, actions: Iterable[bpy.types.Action]) -> bool:
        """Go on with the digests of actions, for a slice's time; whether all are known."""
        until = perf_counter() + SLICE_S
        self._under_way = not all(self._is_found(action, until) for action in actions)
        return not self._under_way

    def _is_found(self, action: bpy.types.Action, until: float) -> bool:
        """Whether an action's digest is known by an instant, s, of Python's performance counter; at
        least one curve is added."""
        uid = action.session_uid
        if uid in self._found:
            return True
        of, done, found = self._part
        if of != uid:
            done = found = 0
        curves = all_curves(action)
        for curve in curves[done:]:
            done, found = done + 1, curve_digest(curve, found)
            if perf_counter() > until:
                break
        self._part = uid, done, found
        if done >= len(curves):
            self._found[uid] = str(found)
        return done >= len(curves)

    def forget(self) -> bool:
        """Keys may be others now. Returns whether their digests were being found."""
        self._found.clear()
        self._part = 0, 0, 0
        under_way, self._under_way = self._under_way, False
        return under_way


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
