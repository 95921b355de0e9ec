"""The trials' figures in tables, for the terminal and for docs/validation.md."""

from collections.abc import Sequence
from dataclasses import dataclass

from .columns import TABLES
from .limits import ValidationFigure
from .result import TrialResult


@dataclass(frozen=True)
class Table:
    """A heading, a note below it, the columns' names, and rows of as many words."""

    title: str
    note: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    @property
    def text(self) -> str:
        """For a terminal: columns of equal width, numbers to the right."""
        lines = [self.columns, *self.rows]
        columns = [self._aligned(column) for column in zip(*lines, strict=True)]
        return "\n".join([self.title, *("  ".join(x).rstrip() for x in zip(*columns, strict=True))])

    @staticmethod
    def _aligned(column: tuple[str, ...]) -> list[str]:
        width = max(map(len, column))
        words = any(cell[:1].isalpha() for cell in column[1:])
        return [cell.ljust(width) if words else cell.rjust(width) for cell in column]

    @property
    def markdown(self) -> str:
        lines = [self.columns, ("---",) * len(self.columns), *self.rows]
        parts = [f"## {self.title}", *([self.note] if self.note else [])]
        return "\n\n".join([*parts, "\n".join(f"| {' | '.join(line)} |" for line in lines)])


def tables(results: Sequence[TrialResult], found: Sequence[ValidationFigure]) -> list[Table]:
    """All of them: the limits, and a row for each trial that was solved."""
    parts = [_limits(found)]
    parts += [
        Table(
            title,
            note,
            ("trial", *(name for name, _ in columns)),
            tuple((r.trial, *(of(r.measured) for _, of in columns)) for r in results if r.measured),
        )
        for title, note, columns in TABLES
        if any(r.measured for r in results)
    ]
    refused = tuple((r.trial, r.refused) for r in results if r.refused)
    if refused:
        parts.append(Table("Refused", "", ("trial", "because"), refused))
    return parts


def _limits(found: Sequence[ValidationFigure]) -> Table:
    return Table(
        "Limits",
        "",
        ("figure", "found", "unit", "must", "aim", "", "where"),
        tuple(
            (f.name, f"{f.value:.3g}", f.unit, _or(f.must), _or(f.aim), _verdict(f), f.trial)
            for f in found
        ),
    )


def _or(value: float | None) -> str:
    return "" if value is None else f"{value:g}"


def _verdict(found: ValidationFigure) -> str:
    if found.must is None:
        return "told"
    if not found.ok:
        return "MISSED"
    return "aim" if found.aim is None or found.value <= found.aim else "must"
