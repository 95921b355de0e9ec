"""Memory that Linux's control groups leave a process: a container's or a scheduler's job's limit.

Files as the kernel's documentation tells them: cgroup-v2.rst, and cgroup-v1/memory.rst.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class _Files:
    """What a version of control groups calls its files, and the line that tells the cache which
    the kernel gives back before it lets a process die."""

    limit: str
    used: str
    cache: str


_V1 = _Files("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
_V2 = _Files("memory.max", "memory.current", "inactive_file")


def free_in_groups(
    own: Path = Path("/proc/self/cgroup"), mounted: Path = Path("/sys/fs/cgroup")
) -> int | None:
    """Bytes that the tightest of this process's groups leaves; None where none has a limit.

    own: the file that names the groups. mounted: where they are.
    """
    told = (_free(folder, files) for folder, files in _groups(own, mounted))
    return min((free for free in told if free is not None), default=None)


def _groups(own: Path, mounted: Path) -> Iterator[tuple[Path, _Files]]:
    """Each group that has a part in the memory of this process, and those around it."""
    try:
        lines = own.read_text().splitlines()
    except OSError:  # no Linux
        return
    for line in lines:
        number, controllers, path = line.split(":", 2)
        if number == "0" and not controllers:
            root, files = mounted, _V2
        elif "memory" in controllers.split(","):
            root, files = mounted / "memory", _V1
        else:
            continue
        # A container may see its own group as the root, though it is told the host's path.
        group = Path(path.lstrip("/"))
        for folder in (group, *group.parents):
            yield root / folder, files


def _free(group: Path, files: _Files) -> int | None:
    try:
        limit = (group / files.limit).read_text().strip()
        used = int((group / files.used).read_text())
        told = (group / "memory.stat").read_text().split()
    except OSError:  # the root has no limit; of others the files may not be seen
        return None
    if not limit.isdecimal():  # "max"
        return None
    cache = dict(zip(told[::2], told[1::2], strict=False)).get(files.cache, "0")
    return max(0, int(limit) - used + int(cache))
