"""The page on failures has every message, in the words that are said."""

import re
from pathlib import Path

import pytest
from hangtime.operators.words.templates import AT_ITS_END, MISSED, OUTCOMES, TEMPLATES
from hangtime.solver.data.faults import NoSolution
from hangtime.solver.data.status import Status

PAGE = Path(__file__).resolve().parents[2] / "docs/manual/when-a-solve-fails.md"
BEGIN, END = "## The messages", "## A motion that is solved but looks wrong"
WARNINGS = "### What is hardly meant"  # these are no faults, nor are
OTHERS = {
    "The feet stand on a floor that slopes by …°",
    "… shares the action, and has bones of the old names",
    "Stopped, because the scene changed meanwhile",
}
GAP = "\0"  # what a message fills in, and what the page leaves out
FILLED = re.compile(r"“?\{[^}]*\}”?")
LEFT_OUT = re.compile(r"“[^”]*”|…")


def quotes(text: str) -> list[str]:
    """What stands in italics in the first column of the page's tables."""
    cells = [line.split(" | ")[0] for line in text.splitlines() if line.startswith("| ")]
    return [quote for cell in cells for quote in re.findall(r"\*([^*]+)\*", cell)]


def pattern(quote: str) -> str:
    """A quote begins where a message does, or after what that fills in."""
    first, *rest = (part.strip(" .,;") for part in LEFT_OUT.sub(GAP, quote).split(GAP))
    begin = rf"(?:^|{GAP}\S* ){re.escape(first)}" if first else ""
    return ".*".join([begin, *map(re.escape, rest)])


def templates() -> list[str]:
    """Of all that is said; a failure's first words are those of its outcome."""
    told = [words for kind, words in TEMPLATES.items() if kind is not NoSolution]
    single = [each for words in told for each in ([words] if isinstance(words, str) else words)]
    return [*single, *(words for status, words in OUTCOMES.items() if status is not Status.SOLVED)]


SECTIONS = PAGE.read_text(encoding="utf-8").partition(BEGIN)[2].partition(END)[0].split("\n### ")
FAULTS = [
    q for each in SECTIONS if not WARNINGS.endswith(each.splitlines()[0]) for q in quotes(each)
]


@pytest.mark.parametrize("template", templates(), ids=lambda template: template[:40])
def test_every_message_is_on_the_page(template: str) -> None:
    said = FILLED.sub(GAP, template)
    assert any(re.search(pattern(quote), said) for quote in FAULTS)


@pytest.mark.parametrize("quote", [quote for quote in FAULTS if quote not in OTHERS])
def test_every_quote_is_of_a_message(quote: str) -> None:
    failure = TEMPLATES[NoSolution]
    said = [*templates(), *failure, *MISSED.values(), AT_ITS_END]
    assert any(re.search(pattern(quote), FILLED.sub(GAP, each)) for each in said)
