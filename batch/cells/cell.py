"""One cell of a batch: a clip with a recipe, solved into a folder of its own."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import TextIO

from ...operators.files.outbox import Outbox
from ...operators.headless.explained import explained
from ...operators.terminal.stages import Stages
from ...solver.data.faults import Fault, NoSolution, OutputNotWritable
from ...solver.worker.pipeline import ADAPTING, FITTING
from ..records.faults import BatchFault, unusable
from ..records.manifest import BatchSettings, CellPlan, read_plan
from ..records.result import RESULT, CellResult, State, lasting_result, written_cell
from .fits import SharedFits
from .work import MEASURING, Done, InputChanged, adapt_cell, check_cell

LOG = "log.txt"
Work = Callable[[BatchSettings, CellPlan, SharedFits, Outbox, Stages], Done]


@dataclass(frozen=True)
class _Ended:
    """How the work on a cell ended."""

    state: State
    sentence: str = ""
    done: Done = field(default_factory=Done)


def run_cell(
    folder: Path, cell: str, fits: SharedFits | None = None, work: Work | None = None
) -> CellResult:
    """Solves a cell of a batch, or returns its result where that is there already; one that failed
    by no fault of what was asked is solved again.

    fits: kept from cell to cell by who solves several. work: in place of the solve, in tests.
    Raises WrongManifest where the manifest has no such cell, FolderGone.
    """
    found = lasting_result(folder, cell)
    if found is not None:
        return found
    settings, plan = read_plan(folder, cell)
    act = work or (check_cell if settings.check else adapt_cell)
    with written_cell(folder, cell) as aside:
        result = _written(settings, plan, fits or SharedFits(folder), aside, act)
    return lasting_result(folder, cell) or result  # another process may have been quicker


def _written(
    settings: BatchSettings, plan: CellPlan, fits: SharedFits, aside: Path, act: Work
) -> CellResult:
    """Does the work and writes all of the cell's files. Raises OSError, FolderGone."""
    began = perf_counter()
    with (aside / LOG).open("w", encoding="utf-8") as log:
        stages = Stages(log)
        with Outbox(aside) as outbox:
            ended = _ended(settings, plan, fits, outbox, stages, act)
            outbox.deliver()
        _tell(ended, log)
    told = {"fit": FITTING, "solve": ADAPTING, "report": MEASURING}
    seconds = {
        word: sum(s.seconds for s in stages.done if s.name == stage) for word, stage in told.items()
    }
    seconds["total"] = perf_counter() - began
    sizes = {path.name: path.stat().st_size for path in sorted(aside.iterdir())}
    result = _result(settings, plan, ended, seconds, sizes)
    (aside / RESULT).write_text(result.as_json(), encoding="utf-8")
    return result


def _ended(
    settings: BatchSettings,
    plan: CellPlan,
    fits: SharedFits,
    outbox: Outbox,
    stages: Stages,
    act: Work,
) -> _Ended:
    recipe = Path(plan.recipe) if plan.recipe else None
    try:
        done = act(settings, plan, fits, outbox, stages)
    except OutputNotWritable as fault:
        raise unusable(fault.path, fault.problem) from fault  # the folder's fault, not the cell's
    except InputChanged as fault:  # no end of what was planned: it may come back
        return _Ended(State.FAILED, str(fault))
    except Fault as fault:
        return _Ended(_state(fault), explained(fault, recipe))
    except (OSError, MemoryError, BatchFault):
        raise
    except Exception as error:  # noqa: BLE001  # one cell's crash is not the batch's
        stages.out.write(traceback.format_exc())
        kind = type(error).__name__
        return _Ended(State.FAILED, f"A fault of Hangtime's ({kind}); send its {LOG} to us.")
    if done.fault is not None:
        return _Ended(_state(done.fault), explained(done.fault, recipe), done)
    return _Ended(State.DONE, "", done)


def _state(fault: Fault) -> State:
    return State.NO_SOLUTION if isinstance(fault, NoSolution) else State.WRONG_INPUT


def _tell(ended: _Ended, log: TextIO) -> None:
    for line in (ended.sentence, *ended.done.headline):
        if line:
            log.write(f"{line}\n")


def _result(
    settings: BatchSettings,
    plan: CellPlan,
    ended: _Ended,
    seconds: dict[str, float],
    sizes: dict[str, int],
) -> CellResult:
    clip, recipe = plan.names
    return CellResult(
        cell=plan.cell,
        state=ended.state,
        clip=clip,
        recipe=recipe,
        version=settings.version,
        sentence=ended.sentence,
        headline=ended.done.headline,
        seconds=seconds,
        figures=ended.done.figures,
        values=plan.values,
        files=tuple(sizes),
        sizes=sizes,
    )
