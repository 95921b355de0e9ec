"""Draws docs/images/layers.svg from the import contracts: python3 devtools/layers_picture.py

Each band is a layer, each row in it is packages that may import those in the rows below. Standard
library only.
"""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Iterator
from html import escape
from itertools import pairwise
from pathlib import Path
from textwrap import shorten, wrap

ROOT = Path(__file__).resolve().parents[1]
PICTURE = ROOT / "docs" / "images" / "layers.svg"
WIDTH, LEFT, MARGIN = 900, 250, 12
BOX, ROW, GAP = 24, 30, 22  # heights of a package's box, of a row, and between layers
COLOURS = ("#eeeeee", "#eeeeee", "#fde8d7", "#f3e3f3", "#fdf3cf", "#dff0d8", "#d9e8f6")
STYLE = (
    "text{font:13px sans-serif;fill:#222} .layer{font-weight:bold;font-size:16px}"
    " .what{font-size:11px;fill:#555} .box{fill:#fff;stroke:#999}"
)
ARROW = (
    '<marker id="arrow" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" '
    'orient="auto"><path d="M0 0L8 4L0 8z" fill="#555"/></marker>'
)


def main() -> None:
    PICTURE.write_text(draw(ROOT), encoding="utf-8")
    print(PICTURE.relative_to(ROOT))


def draw(root: Path) -> str:
    """The picture as SVG."""
    orders = contract_layers(root)
    layers = [name for row in orders["hangtime"] for name in row]
    parts: list[str] = []
    edges: list[tuple[int, int]] = []
    top = MARGIN
    for layer, colour in zip(layers, COLOURS, strict=True):
        rows = orders.get(f"hangtime.{layer}", [])
        lines = wrap(summary(root / layer), 40)
        bottom = top + MARGIN + max(ROW * len(rows), 18 + 13 * len(lines))
        parts += background(layer, lines, top, bottom, colour)
        parts += boxes(root / layer, rows, top)
        edges.append((top, bottom))
        top = bottom + GAP
    x = LEFT / 2
    for (_, end), (start, _) in pairwise(edges):
        parts.append(
            f'<path d="M{x} {end}V{start}" stroke="#555" marker-end="url(#arrow)" fill="none"/>'
        )
    body = "\n".join(parts)
    size = f'width="{WIDTH}" height="{top}" viewBox="0 0 {WIDTH} {top}"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n<style>{STYLE}</style>\n'
        f'<defs>{ARROW}</defs>\n<rect width="100%" height="100%" fill="#fff"/>\n{body}\n</svg>\n'
    )


def contract_layers(root: Path) -> dict[str, list[list[str]]]:
    """Rows of siblings, from the top, by the package whose contract lists them."""
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))
    return {
        contract["containers"][0]: [row.split(" | ") for row in contract["layers"]]
        for contract in project["tool"]["importlinter"]["contracts"]
        if contract["type"] == "layers"
    }


def background(layer: str, lines: list[str], top: int, bottom: int, colour: str) -> Iterator[str]:
    """A layer's rectangle, name and purpose."""
    size = f'width="{WIDTH - 2 * MARGIN}" height="{bottom - top}"'
    yield f'<rect x="{MARGIN}" y="{top}" {size} rx="6" fill="{colour}"/>'
    yield f'<text x="{2 * MARGIN}" y="{top + 20}" class="layer">{layer}</text>'
    for y, line in enumerate(lines):
        yield f'<text x="{2 * MARGIN}" y="{top + 36 + 13 * y}" class="what">{escape(line)}</text>'


def boxes(layer: Path, rows: list[list[str]], top: int) -> Iterator[str]:
    """A layer's packages."""
    for number, row in enumerate(rows):
        y = top + MARGIN // 2 + ROW * number + (ROW - BOX) // 2
        step = (WIDTH - 2 * MARGIN - LEFT) / len(row)
        for column, name in enumerate(row):
            x = round(LEFT + MARGIN + step * column)
            purpose = summary(layer / name)
            beside = shorten(purpose, 78, placeholder=" …") if len(row) == 1 else ""
            yield f"<g><title>{escape(purpose)}</title>"
            yield f'<rect x="{x}" y="{y}" width="{step - 8:.0f}" height="{BOX}" class="box"/>'
            yield f'<text x="{x + 10}" y="{y + 17}">{name}</text>'
            yield f'<text x="{x + 140}" y="{y + 16}" class="what">{escape(beside)}</text></g>'


def summary(path: Path) -> str:
    """First line of the docstring of a package or module, without its full stop."""
    file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    text = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""
    return text.partition("\n")[0].rstrip(".")


if __name__ == "__main__":
    main()
