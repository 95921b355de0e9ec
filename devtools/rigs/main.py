"""Measures rigs: python3 dev.py rigs [NAMES...] [--out DIR] [--quick].

One recorded jump on the skeleton of each convention: is it mapped with no hand work, and does the
same edit give the same motion? And on rigs that are posed through controls: do their bones end
where the solution has them? A run of all writes docs/rigs.md anew. Ends with 1 where a limit is
missed.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from pathlib import Path

from ..environment.virtual_environment import ROOT
from ..processes import run_module, undump
from ..reports import report_options
from .actor import JOINTS
from .controlled import ControlResult, control_figures, control_line
from .layout import layouts
from .limits import figures
from .measure import EDITED, RESULT
from .result import Edited, RigResult, compared
from .table import line, page, text

PAGE = ROOT / "docs" / "rigs.md"
MEASURE = "devtools.rigs.measure"
MEASURE_CONTROLS = "devtools.rigs.controls.measure"
CONTROLS = ("rigify_fk", "rigify_ik", "arp_fk", "arp_ik")
REFERENCE = "cmu"  # the rig that has the recording's own skeleton
QUICK = (REFERENCE, "unreal", "rigify_ik")  # whose edits are compared; all are mapped
LONGEST = 600.0  # s, that one rig may take, on a busy machine too


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py rigs", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="rigs to edit; default: all")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--quick", action="store_true", help="the edit on three rigs only")
    options = report_options(parser, argv)
    keys = [layout.key for layout in layouts()]
    unknown = [name for name in options.names if name not in (*keys, *CONTROLS)]
    if unknown:
        print(f"No rig '{unknown[0]}'; there are: {', '.join((*keys, *CONTROLS))}.")
        return 2
    every = (*keys, *CONTROLS)
    wanted = {REFERENCE, *(options.names or (QUICK if options.quick else every))}
    began = time.perf_counter()
    results, controlled = [], []
    for result in measured(keys, wanted):
        print(line(result), flush=True)
        results.append(result)
    for key in (key for key in CONTROLS if key in wanted):
        controlled.append(measured_controls(key))
        print(control_line(controlled[-1]), flush=True)
    minutes = (time.perf_counter() - began) / 60.0
    whole = not options.names and not options.quick
    return tell(results, controlled, options.out, minutes, write_page=whole)


def measured(keys: Sequence[str], wanted: set[str]) -> Iterator[RigResult]:
    """Each rig in a process of its own, the reference first. wanted: those to edit."""
    reference: Edited | None = None
    for key in sorted(keys, key=lambda key: key != REFERENCE):
        with tempfile.TemporaryDirectory() as folder:
            words = [folder, key, *([] if key in wanted else ["--map"])]
            said = run_module(MEASURE, words, LONGEST)
            path = Path(folder) / RESULT
            if not path.is_file():
                yield RigResult(key, key, False, 0, failed=said or "no result")
                continue
            result: RigResult = undump(path)
            edited = Path(folder) / EDITED
            if edited.is_file():
                mine: Edited = undump(edited)
                reference = mine if key == REFERENCE else reference
                result = replace(result, solved=mine.solved, files=mine.files)
                if reference is not None:  # else its failure is told, and nothing is compared
                    worst, joint, frame = compared(mine, reference, JOINTS)
                    result = replace(result, difference_mm=worst, joint=joint, frame=frame)
            yield replace(result, failed=result.failed or said or "")


def measured_controls(key: str) -> ControlResult:
    """A rig that is posed through controls, in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        said = run_module(MEASURE_CONTROLS, [folder, key], LONGEST)
        path = Path(folder) / RESULT
        if not path.is_file():
            return ControlResult(key, key, 0, False, refused=said or "no result")
        found: ControlResult = undump(path)
        return found


def tell(
    results: Sequence[RigResult],
    controlled: Sequence[ControlResult],
    out: Path,
    minutes: float,
    *,
    write_page: bool,
) -> int:
    """Prints the figures; writes figures.json and, where asked, the page.

    1 where one is missed.
    """
    found = [*figures(results), *control_figures(controlled)]
    content = {
        "figures": [{**asdict(f), "ok": f.ok} for f in found],
        "rigs": [*map(asdict, results)],
        "control rigs": [*map(asdict, controlled)],
    }
    words = json.dumps(content, indent=1, ensure_ascii=False)
    (out / "figures.json").write_text(words + "\n", encoding="utf-8")
    if write_page:
        PAGE.write_text(page(results, controlled, found, minutes), encoding="utf-8")
    print(text(found))
    count = len(results) + len(controlled)
    print(f"{count} rigs in {minutes:.1f} minutes; all in {out / 'figures.json'}")
    return 0 if all(f.ok for f in found) else 1
