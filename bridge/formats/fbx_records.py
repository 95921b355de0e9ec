"""Whether the records of a binary FBX file hang together, before Blender's importer reads it.

The importer believes every count: a byte that is off has it ask for all memory, or read for hours.
Layout as of parse_fbx.py of Blender's add-on io_scene_fbx: a head; records, each with the place of
its end, the number and length of its properties, its name, the properties and the records in it; an
empty record ends each list of them.
"""

from __future__ import annotations

import mmap
from pathlib import Path
from struct import Struct

from ...solver.data.faults import UnreadableClip

HEAD = 1024  # bytes, in the first line of which a text says that it is an FBX
MAGIC = b"Kaydara FBX Binary  \0\x1a\0"
WIDE = 7500  # the version from which counts have 8 bytes
MOST_PACKED = 1032  # times, by which zlib can make data shorter
PLAIN = {"Z": 1, "Y": 2, "B": 1, "C": 1, "I": 4, "F": 4, "D": 8, "L": 8}  # bytes of a value
ARRAYS = {"b": 1, "c": 1, "i": 4, "l": 8, "f": 4, "d": 8}  # bytes of an element
SIZED = "RS"
DEEPEST = 64  # records in records; Maya's and Blender's have 6

_VERSION, _NARROW, _WIDE = Struct("<I"), Struct("<3IB"), Struct("<3QB")
_LENGTH, _ARRAY = Struct("<I"), Struct("<3I")


def require_sound(path: Path) -> None:
    """Raises UnreadableClip where a binary FBX is damaged, or a file is no FBX at all; a text
    that is one is the importer's affair."""
    with path.open("rb") as file:
        head = file.read(HEAD)
        if not head.startswith(MAGIC):
            _require_text(path, head)
            return
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            fault = _Records(data).fault()
    if fault is not None:
        raise UnreadableClip(str(path), None, f"its {fault}: the file is damaged")


def _require_text(path: Path, head: bytes) -> None:
    """head: the first bytes of a file. Raises UnreadableClip where they are no FBX's in text."""
    if not head.strip():
        raise UnreadableClip(str(path), None, "it is empty")
    if head.lstrip().startswith(b"HIERARCHY"):
        raise UnreadableClip(str(path), None, "it is a BVH file, which must end with .bvh")
    if b"FBX" not in head:
        raise UnreadableClip(str(path), None, "it is no FBX file, whatever its name says")


class _Records:
    """The records of a file's bytes."""

    def __init__(self, data: mmap.mmap) -> None:
        self._data = data
        first = len(MAGIC) + _VERSION.size
        version = _VERSION.unpack_from(data, len(MAGIC))[0] if len(data) >= first else 0
        self._first, self._head = first, _WIDE if version >= WIDE else _NARROW

    def fault(self) -> str | None:
        """What is wrong with them, and where; None where nothing is."""
        end: int | str = self._list(self._first, len(self._data), 0)
        return end if isinstance(end, str) else None

    def _list(self, at: int, end: int, depth: int) -> int | str:
        """Where records that begin at a place and end before another do end, or what is wrong."""
        while at + self._head.size <= end:
            stop, count, length, name = self._head.unpack_from(self._data, at)
            if stop == 0:
                return int(at + self._head.size)
            first = at + self._head.size + name
            if not first + length <= stop <= end:
                return f"record at byte {at} ends where it cannot"
            if not self._are_values(first, first + length, count):
                return f"values at byte {first} cannot be as they are counted"
            if first + length < stop:
                inner = self._list(first + length, stop, depth + 1) if depth < DEEPEST else stop + 1
                if isinstance(inner, str):
                    return inner
                if inner != stop:
                    return f"record at byte {at} holds more than it says"
            at = stop
        return f"records break off at byte {at}"

    def _are_values(self, at: int, end: int, count: int) -> bool:
        """Whether as many values as counted lie between two places, and fill them."""
        for _ in range(count):
            if at >= end:
                return False
            kind, at = chr(self._data[at]), at + 1
            if kind in PLAIN:
                at += PLAIN[kind]
            elif kind in SIZED and at + _LENGTH.size <= end:
                at += _LENGTH.size + _LENGTH.unpack_from(self._data, at)[0]
            elif kind in ARRAYS and at + _ARRAY.size <= end:
                elements, packed, size = _ARRAY.unpack_from(self._data, at)
                bytes_told = elements * ARRAYS[kind]
                if bytes_told > size * MOST_PACKED if packed else bytes_told != size:
                    return False
                at += _ARRAY.size + size
            else:
                return False
        return at == end
