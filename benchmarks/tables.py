"""Tables of measurements: as text, as Markdown and as JSON."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

Value = str | int | float | bool | None
Row = Mapping[str, Value]
SECONDS = "(s)"  # ends the names of columns that say more of the machine than of the method


@dataclass(frozen=True)
class Table:
    """caption: what was measured, in a sentence or two. rows: their values by column, alike in all;
    None where there is none."""

    title: str
    caption: str
    rows: Sequence[Row]

    def without_seconds(self) -> "Table":
        """The columns that mean the same on any machine."""
        rows = [{k: v for k, v in row.items() if not k.endswith(SECONDS)} for row in self.rows]
        return Table(self.title, self.caption, rows)

    def cells(self) -> list[list[str]]:
        """The columns' names and every row, as they are shown."""
        return [list(self.rows[0]), *([shown(v) for v in row.values()] for row in self.rows)]

    def text(self) -> str:
        cells = self.cells()
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        return "\n".join([self.title, self.caption, "", *(_line(row, widths) for row in cells)])

    def markdown(self) -> str:
        head, *body = ("| " + " | ".join(row) + " |" for row in self.cells())
        rule = "|" + "---|" * len(self.rows[0])
        return "\n".join([f"## {self.title}", "", self.caption, "", head, rule, *body])


def with_ratios(rows: Sequence[Row], ratios: Mapping[str, str]) -> list[Row]:
    """The rows with more columns: after each that `ratios` names, its values over the first row's
    under the new name given there."""
    found = []
    for row in rows:
        wider: dict[str, Value] = {}
        for column, value in row.items():
            wider[column] = value
            if column in ratios:
                wider[ratios[column]] = value / rows[0][column]
        found.append(wider)
    return found


def shown(value: Value) -> str:
    """A value to three digits; yes and no; a dash for nothing."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.3g}" if abs(value) < 1e5 else f"{value:.1e}"
    return str(value)


def _line(row: Sequence[str], widths: Sequence[int]) -> str:
    first = row[0].ljust(widths[0])
    rest = (cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True))
    return "  ".join([first, *rest]).rstrip()


def write_json(tables: Sequence[Table], path: Path) -> None:
    """Every table with full digits."""
    found = [{**asdict(t), "columns": list(t.rows[0])} for t in tables]
    path.write_text(json.dumps(found, indent=1, ensure_ascii=False))
