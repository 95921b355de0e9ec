"""Persistence of motion traces in the .blend: a recording's with its armature, an adapted one's
with its action. What is drawn follows the armature wherever the artist moves it."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import lru_cache
from io import BytesIO
from typing import Any
from zipfile import BadZipFile

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ...solver.data.traces import FlightParabola, Traces

CONTENT = "hangtime_traces"
_KEY = "hangtime_traces_key"
_KEYS = (CONTENT, _KEY)
_WAITING = ("hangtime_waiting_traces", "hangtime_waiting_traces_key")
_ARRAYS = tuple(f.name for f in fields(Traces) if f.type == "FloatArray")
_NAMES = ("bones", "contacts", "joints", "solids")
_STOOD, _WEIGHT, _FLIGHTS = "stood", "weight", "flights"
_REMEMBERED = 8
# What reading raises of bytes that a script or another version left there.
_OTHERWISE = (
    ValueError,
    TypeError,
    LookupError,
    OSError,
    EOFError,
    BadZipFile,
    struct.error,
    zlib.error,
)


@dataclass(frozen=True)
class StoredTraces:
    """Traces as stored. stood: the armature's world matrix then; key: another for other traces."""

    traces: Traces
    stood: Matrix
    key: str

    def moved(self, armature: bpy.types.Object) -> Matrix:
        """From where the motion was (world) to where it is now that the armature stands here."""
        return armature.matrix_world @ self.stood.inverted_safe()


def keep(owner: bpy.types.ID, traces: Traces, stood: Matrix) -> None:
    """Store traces with an armature or an action, in place of earlier ones."""
    packed: dict[str, Any] = {n: np.asarray(getattr(traces, n), np.float32) for n in _ARRAYS}
    packed |= {n: np.array(getattr(traces, n), dtype=np.str_) for n in _NAMES}
    packed |= {_WEIGHT: traces.weight, _STOOD: np.array(stood)}
    packed[_FLIGHTS] = np.array([flight.name for flight in traces.flights], dtype=np.str_)
    for i, flight in enumerate(traces.flights):
        packed[f"parabola {i}"] = np.asarray(flight.parabola, np.float32)
        packed[f"span {i}"] = np.array([flight.start, flight.end])
    stream = BytesIO()
    np.savez(stream, **packed)
    forget(owner)  # Blender would cut bytes that replace others off at the first zero
    owner[CONTENT] = stream.getvalue()
    owner[_KEY] = str(zlib.crc32(stream.getbuffer()))


def forget(owner: bpy.types.ID) -> None:
    """Remove what `keep` stored."""
    for name in (CONTENT, _KEY):
        if owner.get(name) is not None:
            del owner[name]


def put_by(armature: bpy.types.ID, take: bpy.types.ID) -> None:
    """Let a recording's traces, which an armature has, wait with a take."""
    _move_content(armature, _KEYS, take, _WAITING)


def take_up(armature: bpy.types.ID, take: bpy.types.ID) -> None:
    """Let an armature have the recording's traces that wait with a take; none where none do."""
    _move_content(take, _WAITING, armature, _KEYS)


def _move_content(
    source: bpy.types.ID, names: tuple[str, str], target: bpy.types.ID, called: tuple[str, str]
) -> None:
    for name, other in zip(names, called, strict=True):
        if target.get(other) is not None:  # see `keep`
            del target[other]
        if source.get(name) is not None:
            target[other] = source[name]


def kept(owner: bpy.types.ID | None) -> StoredTraces | None:
    """Traces that `keep` stored with an owner; cheap when asked again and again. None where what is
    there is something else, which `is_ours` tells."""
    if owner is None or (key := owner.get(_KEY)) is None:
        return None
    try:
        return _unpacked(_Stored(key, owner))
    except _OTHERWISE:
        return None


def is_ours(owner: bpy.types.ID) -> bool:
    """Whether an owner has traces that can be read, or none."""
    return owner.get(_KEY) is None or kept(owner) is not None


@dataclass(frozen=True)
class _Stored:
    """Location of stored traces; equal where the traces are."""

    key: str
    owner: bpy.types.ID = field(compare=False)


def _flight(packed: Mapping[str, NDArray[Any]], i: int, name: str) -> FlightParabola:
    start, end = packed[f"span {i}"].tolist()
    return FlightParabola(name, start, end, packed[f"parabola {i}"].astype(float))


@lru_cache(maxsize=_REMEMBERED)
def _unpacked(stored: _Stored) -> StoredTraces:
    with np.load(BytesIO(stored.owner[CONTENT]), allow_pickle=False) as packed:
        # Files of earlier versions lack what traces did not have then.
        arrays = {n: packed[n].astype(float) for n in _ARRAYS if n in packed}
        names: dict[str, Any] = {n: tuple(packed[n].tolist()) for n in _NAMES if n in packed}
        flights = tuple(_flight(packed, i, n) for i, n in enumerate(packed[_FLIGHTS].tolist()))
        weight, stood = float(packed[_WEIGHT]), Matrix(packed[_STOOD].tolist())
    traces = Traces(**arrays, **names, weight=weight, flights=flights)
    return StoredTraces(traces, stood, stored.key)
