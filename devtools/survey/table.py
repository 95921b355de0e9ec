"""The survey in a terminal: a line an edit, a row a kind."""

from collections.abc import Sequence

from .result import EditEnding, EditResult, KindOfEdit, kinds

LONGEST = 150  # letters of what was said


def line(result: EditResult) -> str:
    """One edit."""
    said = result.said if len(result.said) <= LONGEST else f"{result.said[:LONGEST]}..."
    ending = "" if result.ending is EditEnding.SOLVED else f"{result.ending.value}: "
    cost = f"{result.seconds:7.2f} s {result.steps:4d} steps"
    return f"{result.where:32} {result.edit:28}{cost}  {ending}{said}"


def table(results: Sequence[EditResult]) -> str:
    """Each kind, and all of them together."""
    endings = "".join(f"{ending.value:>17}" for ending in EditEnding)
    head = f"{'edit':28}{endings}{'median s':>10}{'worst s':>9}{'steps':>7}{'most':>6}  slowest"
    rows = [_row(kind) for kind in kinds(results)]
    return "\n".join([head, *rows, _row(KindOfEdit("all", results))])


def _row(kind: KindOfEdit) -> str:
    counts = "".join(f"{kind.count(ending):17d}" for ending in EditEnding)
    slowest, steps = kind.slowest, f"{kind.steps:7g}{kind.most_steps:6d}"
    times = f"{kind.seconds:10.2f}{slowest.seconds:9.2f}"
    return f"{kind.name:28}{counts}{times}{steps}  {slowest.where}"
