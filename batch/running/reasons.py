"""Cells that are not done, and why, in lines."""

from __future__ import annotations

from collections.abc import Iterable

from ..records.manifest import CellPlan
from ..records.result import CellResult


def told(plan: CellPlan, result: CellResult) -> str:
    """One cell in a line, by its number and names that no other has."""
    values = ", ".join(f"{name} = {value}" for name, value in plan.values.items())
    which = " + ".join(word for word in plan.names if word) + (f" ({values})" if values else "")
    return f"{result.state.value}: {plan.number} {which}: {result.sentence}"


def told_together(ended: Iterable[tuple[CellPlan, CellResult]]) -> list[tuple[str, int]]:
    """Lines, and of how many cells each tells: those of a clip with one reason share one, for a
    clip that is broken is so with every recipe."""
    alike: dict[tuple[str, str, str], list[tuple[CellPlan, CellResult]]] = {}
    for plan, result in ended:
        reason = plan.clip, result.state.value, result.sentence
        alike.setdefault(reason, []).append((plan, result))
    return [(_told_alike(cells), len(cells)) for cells in alike.values()]


def _told_alike(cells: list[tuple[CellPlan, CellResult]]) -> str:
    plan, result = cells[0]
    if len(cells) == 1:
        return told(plan, result)
    which = f"{plan.names[0]} ({counted(len(cells), 'cell')}, such as {plan.number})"
    return f"{result.state.value}: {which}: {result.sentence}"


def counted(count: int, word: str) -> str:
    """Such as "1 cell", "2 cells"."""
    return f"{count} {word}" + ("" if count == 1 else "s")
