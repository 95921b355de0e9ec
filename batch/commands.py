"""The commands of a batch, and their options."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from pathlib import Path

from ..operators.headless.explained import CANCELLED, WRONG_INPUT, explained
from ..operators.terminal.interrupts import ended_by_signals
from ..operators.terminal.outlasting import outlasting
from ..solver.data.faults import Fault
from ..solver.numerics.parallel import cores
from .collect.collecting import collect
from .collect.gathering import GatheredBatch
from .farm.commands import FARM_ACTS, add_farm_commands
from .planning.blender_need import needs_blender, require_blender
from .planning.plan import Asked, Planned, plan, refreshed
from .records.faults import BatchFault
from .records.locks import batch_lock
from .records.manifest import BatchSettings, CellPlan, Manifest, Output, write_manifest
from .records.result import WORSE, State
from .running.progress import Progress
from .running.reasons import counted, told_together
from .running.runner import CELL_LIMIT_S, LocalRun
from .running.workers import worker_command

RUN = "run"
MOST_TOLD = 20  # lines of cells that are not done, at the end
MOST_SPOILT = 5  # cells whose files are missing, by name, at the start
# What a batch ends with: the first of these that a cell of it has.
WORST = (State.FAILED, State.WRONG_INPUT, State.NO_SOLUTION)


@outlasting
def run(argv: Sequence[str]) -> int:
    """Parses and runs; the exit code."""
    commands = parser()
    try:
        options, rest = commands.parse_known_args(_with_command(argv))
        if rest:
            commands.error(_left_over(rest, options))
    except SystemExit as end:  # argparse has said why
        return WRONG_INPUT if end.code else 0
    act: Callable[[argparse.Namespace], int] = options.act
    try:
        return act(options)
    except Fault as fault:
        print(explained(fault, None), file=sys.stderr)
    except BatchFault as fault:
        print(fault, file=sys.stderr)
        return fault.exit_code
    except KeyboardInterrupt:
        print("\nInterrupted; the same command again goes on from here.", file=sys.stderr)
        return CANCELLED
    return WRONG_INPUT


def _left_over(words: list[str], options: argparse.Namespace) -> str:
    """What to say of words that belong to no option."""
    known = [output.value for output in Output]
    if all(word.strip(",").lower() in known for word in words):
        asked = [*(output.value for output in getattr(options, "outputs", ())), *words]
        return f"write --outputs {','.join(word.strip(',').lower() for word in asked)}"
    return f"unrecognized arguments: {' '.join(words)}"


def _with_command(argv: Sequence[str]) -> list[str]:
    """Clips right away mean a run."""
    first = next(iter(argv), "--help")
    plain = first in ACTS or first in ("-h", "--help")
    return list(argv or ["--help"]) if plain else [RUN, *argv]


def parser() -> argparse.ArgumentParser:
    """The commands and their options."""
    top = argparse.ArgumentParser(
        prog="batch", description="Many clips with many recipes. Clips right away mean 'run'."
    )
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    for name, words in (
        (RUN, "plan, and solve what is not solved yet"),
        ("plan", "only write the manifest"),
    ):
        _add_planning(commands.add_parser(name, help=words), name)
    cell = commands.add_parser("cell", help="solve one cell of a batch")
    cell.set_defaults(act=ACTS["cell"])
    cell.add_argument("folder", type=Path, metavar="DIR", help="the batch's folder")
    cell.add_argument("cell", metavar="CELL", help="its name in the manifest")
    add_farm_commands(commands, _count)
    collecting = commands.add_parser("collect", help="make table, contact sheet and page anew")
    collecting.set_defaults(act=ACTS["collect"])
    collecting.add_argument("folder", type=Path, metavar="DIR", help="the batch's folder")
    return top


def _add_planning(each: argparse.ArgumentParser, name: str) -> None:
    each.set_defaults(act=ACTS[name])
    each.add_argument(
        "clips", nargs="*", metavar="CLIP", help="files, folders, patterns; or those of the recipes"
    )
    each.add_argument(
        "--recipes", nargs="+", default=[], metavar="RECIPE", help="files, folders, patterns"
    )
    each.add_argument(
        "--table", type=Path, metavar="FILE", help="CSV or TOML that names the pairs instead"
    )
    each.add_argument("--out", type=Path, required=True, metavar="DIR", help="the batch's folder")
    each.add_argument("--check", action="store_true", help="only diagnose and fit")
    each.add_argument(
        "--outputs",
        type=_outputs,
        default=(Output.NPZ,),
        metavar="LIST",
        help=f"beside the report, of {', '.join(o.value for o in Output)} (default: npz)",
    )
    each.add_argument("--unit", type=_positive, metavar="M", help="metres per unit of the clips")
    each.add_argument("--up", choices=("Y", "Z"), type=str.upper, help="axis that points up")
    each.add_argument(
        "--rate", type=_positive, metavar="HZ", help="AMC and BVH files' frames a second"
    )
    each.add_argument("--take", metavar="NAME", help="which, of FBX files that hold several")
    each.add_argument("--armature", metavar="NAME", help="whose motion, of such files")
    each.add_argument(
        "--jobs", type=_count, default=cores(), metavar="N", help="at once (default: the cores)"
    )
    each.add_argument(
        "--cell-limit",
        type=_positive,
        default=CELL_LIMIT_S,
        metavar="S",
        help=f"seconds after which a cell has failed (default: {CELL_LIMIT_S:g}; not with --dask)",
    )
    each.add_argument(
        "--dask", metavar="ADDRESS", help="a Dask scheduler, or its file, whose workers solve"
    )
    each.add_argument(
        "--no-sharing",
        action="store_true",
        help="send all through the scheduler, though Dask's workers see the folder",
    )


def _outputs(text: str) -> tuple[Output, ...]:
    known = {output.value: output for output in Output}
    words = [word.strip().lower() for word in text.split(",") if word.strip()]
    for word in words:
        if word not in known:
            raise argparse.ArgumentTypeError(f"unknown output {word!r}; known: {', '.join(known)}")
    return tuple(output for word, output in known.items() if word in words)


def _positive(text: str) -> float:
    try:
        number = float(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r} is no number") from error
    if not 0.0 < number < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return number


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"“{text}” is no such number; write 1 or more")
    return int(text)


# ---------------------------------------------------------------- the commands


def run_batch(options: argparse.Namespace) -> int:
    """Plans, and solves what is not solved yet. Raises Fault, BatchFault."""
    folder: Path = options.out
    with batch_lock(folder), ended_by_signals():
        planned = _planned(options)
        manifest = planned.manifest
        progress = Progress(sys.stdout, len(manifest.cells), _done(manifest))
        try:
            _solve(options, manifest, progress)
        finally:
            with suppress(BatchFault):  # that of the run is the one to be told
                manifest = replace(manifest, cells=refreshed(folder, manifest.cells))
                write_manifest(folder, manifest)
        batch = collect(folder)
    return _told_end(batch)


def _solve(options: argparse.Namespace, manifest: Manifest, progress: Progress) -> None:
    """What is not solved yet, by Dask's workers or by processes of this machine."""
    folder: Path = options.out
    if options.dask is None:
        outputs = manifest.settings.outputs
        in_blender = [c.clip for c in manifest.cells if needs_blender(c.clip, outputs)]
        if in_blender:
            require_blender(in_blender[0])  # told before anything is solved
        command = worker_command(blender=bool(in_blender))
        LocalRun(
            folder, manifest, options.jobs, command, progress, cell_limit=options.cell_limit
        ).run()
        return
    try:
        from .cluster.dispatch import run_on_dask
    except ImportError as error:
        raise BatchFault(
            f"Dask is not beside this Hangtime ({error}); run the batch by the wheel's "
            "`hangtime-batch`, installed with Dask: docs/manual/farm.md tells how."
        ) from error
    plans = {plan.cell: plan for plan in manifest.cells}
    run_on_dask(
        folder,
        options.dask,
        progress.note,
        lambda result: progress.ended(plans[result.cell], result),
        share=not options.no_sharing,
    )


def _done(manifest: Manifest) -> Counter[State]:
    """Cells by the states that stay."""
    still = (State.PLANNED, State.FAILED)
    return Counter(cell.state for cell in manifest.cells if cell.state not in still)


def _told_end(batch: GatheredBatch) -> int:
    """Says how it ended, with what is not done by name; the exit code."""
    counts = Counter(batch.states)
    summary = ", ".join(f"{count} {state.value}" for state, count in counts.items())
    cells, held = counted(len(batch.plans), "cell"), _told_held(batch)
    print(f"{cells}: {summary}.{held} Look at them in {batch.folder / 'index.html'}.")
    ended = ((c, r) for c, r in zip(batch.plans, batch.results, strict=True) if r is not None)
    lines = told_together((c, r) for c, r in ended if r.state is not State.DONE)
    for line, _ in lines[:MOST_TOLD]:
        print(f"  {line}")
    if more := sum(count for _, count in lines[MOST_TOLD:]):
        print(f"  … and {more} more, which the manifest tells by their state.")
    return next((state.exit_code for state in WORST if counts[state]), 0)


def _told_held(batch: GatheredBatch) -> str:
    """How many of the done the certificate has nothing against that is the batch's doing; empty
    where there is no certificate, as after --check."""
    done = (each for each in batch.results if each is not None and each.state is State.DONE)
    worse = [each.figures[WORSE] for each in done if WORSE in each.figures]
    if not worse:
        return ""
    which = f"{worse.count(0.0)} of the {len(worse)} done"
    return f" In {which} no line of the certificate fails, or only as in the recording."


def plan_batch(options: argparse.Namespace) -> int:
    """Only plans. Raises Fault, BatchFault."""
    with batch_lock(options.out):
        _planned(options)
    return 0


def _planned(options: argparse.Namespace) -> Planned:
    settings = BatchSettings(
        options.outputs,
        options.check,
        options.unit,
        options.up,
        options.rate,
        options.armature,
        options.take,
    )
    asked = Asked(settings, options.clips, options.recipes, options.table)
    planned = plan(asked, options.out)
    cells = planned.manifest.cells
    before = ", ".join(f"{n} {state.value}" for state, n in _done(planned.manifest).items())
    print(_told_size(cells) + (f"; before: {before}" if before else "") + ".")
    if planned.spoilt:
        print(_told_spoilt(planned.spoilt))
    if planned.twice:
        print(f"Left out, as the same as others: {counted(planned.twice, 'pair')}.")
    if planned.strays:
        print(
            f"{counted(len(planned.strays), 'folder')} of an earlier plan left as found in "
            f"{options.out / 'cells'}, such as {planned.strays[0]}."
        )
    return planned


def _told_size(cells: Sequence[CellPlan]) -> str:
    """Such as "6 cells: 3 clips, 2 recipes", by which a clip that is missing is seen."""
    clips, recipes = ({cell.clip for cell in cells}, {cell.recipe for cell in cells} - {""})
    parts = [counted(len(clips), "clip"), *([counted(len(recipes), "recipe")] if recipes else [])]
    return f"{counted(len(cells), 'cell')}: {', '.join(parts)}"


def _told_spoilt(spoilt: Mapping[str, tuple[str, ...]]) -> str:
    """Cells whose results somebody has taken files of, in a line."""
    named = [f"{cell} ({', '.join(files)})" for cell, files in islice(spoilt.items(), MOST_SPOILT)]
    more = [f"and {len(spoilt) - len(named)} more"] if len(spoilt) > len(named) else []
    many = len(spoilt) > 1
    return (
        f"{counted(len(spoilt), 'cell')} whose files are missing or changed "
        f"{'are' if many else 'is'} solved again: {', '.join([*named, *more])}."
    )


def collect_batch(options: argparse.Namespace) -> int:
    """Table, contact sheet and page of what there is so far. Raises BatchFault."""
    collect(options.folder)
    return 0


def cell_of_batch(options: argparse.Namespace) -> int:
    """Solves one cell. Raises BatchFault."""
    from .cells.cell import run_cell  # loads the solver, for which a batch would wait

    result = run_cell(options.folder, options.cell)
    for line in (result.sentence, *result.headline):
        if line:
            print(line, file=sys.stderr if line is result.sentence else sys.stdout)
    return result.exit_code


ACTS: dict[str, Callable[[argparse.Namespace], int]] = {
    RUN: run_batch,
    "plan": plan_batch,
    "cell": cell_of_batch,
    "collect": collect_batch,
    **FARM_ACTS,
}
