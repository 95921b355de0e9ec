"""The order in which cells are solved: those of a clip together, where possible by one worker."""

from __future__ import annotations

from collections import Counter, OrderedDict, deque
from collections.abc import Iterable

from ..records.manifest import CellPlan

Group = tuple[str, str]  # clip and recipe: their cells share a fit


class CellQueue:
    """Cells that wait.

    A worker goes on with the clip whose fit it remembers; a new one begins with a clip that nobody
    is fitting, so that none waits for another's fit while there is other work.
    """

    def __init__(self, cells: Iterable[CellPlan]) -> None:
        self._waiting: OrderedDict[Group, deque[str]] = OrderedDict()
        self._group: dict[str, Group] = {}
        self._running: Counter[Group] = Counter()
        self._fitted: set[Group] = set()
        for cell in cells:
            self._group[cell.cell] = group = (cell.clip_sha256, cell.recipe)
            self._waiting.setdefault(group, deque()).append(cell.cell)

    def __len__(self) -> int:
        return sum(map(len, self._waiting.values()))

    def __bool__(self) -> bool:
        return bool(self._waiting)

    def take(self, last: str | None) -> str:
        """The next cell for a worker. last: that it solved before. Raises LookupError on none."""
        group = self._group.get(last or "")
        if group not in self._waiting:
            free = (g for g in self._waiting if g in self._fitted or not self._running[g])
            group = next(free, None) or next(iter(self._waiting), None)
        if group is None:
            raise LookupError("no cell waits")
        cell = self._waiting[group].popleft()
        if not self._waiting[group]:
            del self._waiting[group]
        self._running[group] += 1
        return cell

    def ended(self, cell: str) -> None:
        """A cell has its result."""
        group = self._group[cell]
        self._running[group] -= 1
        self._fitted.add(group)

    def back(self, cell: str) -> None:
        """A cell that was taken waits again, before all others."""
        group = self._group[cell]
        self._running[group] -= 1
        self._waiting.setdefault(group, deque()).appendleft(cell)
        self._waiting.move_to_end(group, last=False)
