"""The table of a campaign: how the cases of each family ended."""

from collections import Counter
from collections.abc import Sequence

from .protocol.case import CaseOutcome, Ending, Family

COLUMNS = {
    "successes": Ending.SUCCESS,
    "named faults": Ending.NAMED_FAULT,
    "crashes": Ending.CRASH,
    "hangs": Ending.HANG,
    "changed": Ending.CHANGED,
    "leftovers": Ending.LEFTOVER,
}


def table(outcomes: Sequence[CaseOutcome], families: Sequence[Family], seed: int) -> str:
    """A page in Markdown."""
    lines = [
        "# The hostile campaign",
        "",
        f"Made by `python3 dev.py campaign --cases {len(outcomes)} --seed {seed}`. A case is drawn",
        "from the seed and its number; `--case K` does it again. It ends as it should by a success",
        "or by a fault that is said in words, within the family's bound, with recording, other",
        "actions and selection as before and nothing left behind. Taken on: what the first gate",
        "let through, to be read, analysed or solved. Seconds: of the family, and of its longest",
        "case.",
        "",
        f"| family | cases | taken on | {' | '.join(COLUMNS)} | kinds of faults | s | longest |",
        f"|---|{'---:|' * (len(COLUMNS) + 5)}",
    ]
    for name in (*(family.name for family in families), "all"):
        own = [o for o in outcomes if name in (o.family, "all")]
        if own:
            lines.append(_row(name, own))
    return "\n".join([*lines, ""])


def _row(name: str, own: Sequence[CaseOutcome]) -> str:
    count = Counter(outcome.ending for outcome in own)
    named = [o for o in own if o.ending is Ending.NAMED_FAULT]
    kinds = len({outcome.detail.partition(":")[0] for outcome in named})
    seconds = [outcome.seconds for outcome in own]
    taken_on = sum(outcome.taken_on for outcome in own)
    cells = [name, len(own), taken_on, *(count[ending] for ending in COLUMNS.values()), kinds]
    cells += [f"{sum(seconds):.0f}", f"{max(seconds, default=0.0):.1f}"]
    return f"| {' | '.join(map(str, cells))} |"
