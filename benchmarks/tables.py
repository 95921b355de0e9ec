"""Tables of measurements: as text, as Markdown and as JSON."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

Value = str | int | float | bool | None
SECONDS = "(s)"  # ends the names of columns that say more of the machine than of the method


@dataclass(frozen=True)
class Table:
    """caption: what was measured, in a sentence or two. rows: one value a column; None where
    there is none."""

    title: str
    caption: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Value, ...], ...]

    def without_seconds(self) -> "Table":
        """The columns that mean the same on any machine."""
        kept = [i for i, name in enumerate(self.columns) if not name.endswith(SECONDS)]
        rows = tuple(tuple(row[i] for i in kept) for row in self.rows)
        return Table(self.title, self.caption, tuple(self.columns[i] for i in kept), rows)

    def text(self) -> str:
        cells = [self.columns, *([shown(v) for v in row] for row in self.rows)]
        widths = [max(len(row[i]) for row in cells) for i in range(len(self.columns))]
        lines = [_line(row, widths) for row in cells]
        return "\n".join([f"{self.title}", self.caption, "", *lines])

    def markdown(self) -> str:
        head = "| " + " | ".join(self.columns) + " |"
        rule = "|" + "---|" * len(self.columns)
        body = ["| " + " | ".join(shown(v) for v in row) + " |" for row in self.rows]
        return "\n".join([f"## {self.title}", "", self.caption, "", head, rule, *body])


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
    found = [
        {**asdict(t), "rows": [dict(zip(t.columns, row, strict=True)) for row in t.rows]}
        for t in tables
    ]
    path.write_text(json.dumps(found, indent=1, ensure_ascii=False))
