"""Documents name files that are there."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
LAYERS = ("bridge", "devtools", "docs", "examples", "operators", "solver", "tests", "ui")
SOURCE = re.compile(r"`([\w./-]*\w\.py)`")
NAMED = re.compile(rf"`((?:{'|'.join(LAYERS)})/[\w./-]*)`")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_file_that_a_page_names_is_there(page: Path) -> None:
    named = NAMED.findall(page.read_text(encoding="utf-8"))
    assert [name for name in named if not (ROOT / name).exists()] == []


def test_files_that_are_named_by_the_end_of_their_paths_are_there() -> None:
    """In pages for developers; the manual names files of the artist's, too."""
    there = [f"/{path.relative_to(ROOT)}" for path in ROOT.glob("*.py")]
    for layer in (*LAYERS, "batch", "benchmarks", "farm"):
        there += [f"/{path.relative_to(ROOT)}" for path in (ROOT / layer).rglob("*.py")]
    pages = [page for page in PAGES if page.parent in (ROOT, ROOT / "docs")]
    named = {name for page in pages for name in SOURCE.findall(page.read_text(encoding="utf-8"))}
    assert len(named) > 100
    assert [name for name in named if not any(path.endswith(f"/{name}") for path in there)] == []


def test_the_glossary_names_files() -> None:
    text = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    assert len(NAMED.findall(text)) > 40
