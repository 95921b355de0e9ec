"""Memory of this process and of the machine, bytes."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

from .cgroups import free_in_groups

_RESERVE = 256 << 20  # left to the system and to who works at the machine
_FIRST = 700 << 20  # that a cell takes, before any has told
_UNKNOWN = 1 << 62


def used() -> dict[str, int]:
    """What this process holds now ("rss") and the most it has held ("peak"); 0 where the system
    does not tell."""
    if sys.platform == "win32":
        return {"rss": 0, "peak": 0}
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    peak = unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return {"rss": pages * os.sysconf("SC_PAGE_SIZE"), "peak": peak}
    except OSError:
        return {"rss": peak, "peak": peak}


def available() -> int:
    """What processes may still take without swapping, or by the limit of their container; as good
    as endless where the system does not tell."""
    limited = free_in_groups()
    return _of_machine() if limited is None else min(limited, _of_machine())


def _of_machine() -> int:
    try:
        for line in Path("/proc/meminfo").read_text().splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass
    return _UNKNOWN


class MemoryWatch:
    """Whether one more cell fits, from what cells have taken so far. free: as `available`."""

    def __init__(self, free: Callable[[], int] = available) -> None:
        self._free = free
        self._largest = 0

    def told(self, peak: int) -> None:
        """A worker's peak after a cell."""
        self._largest = max(self._largest, peak)

    def fits(self, rss: int) -> bool:
        """Whether a worker that holds so much now may begin a cell beside others that work."""
        need = max(0, (self._largest or _FIRST) - rss)
        return self._free() >= need + _RESERVE
