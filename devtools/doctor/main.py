"""The doctor: python3 dev.py doctor CLIP, or doctor --table [FOLDER] [--out DIR] [--quick].

The first says what is wrong with a clip (operators/headless). The table damages clean clips in
known ways, has them diagnosed and repaired, and ends with 1 where a limit is missed; with --fits
instead of --table they are fitted, too. Over the clips of examples/recordings, and not quick, it
writes docs/doctor.md or docs/fits.md anew.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

from ...operators.headless.cli import main as told
from ...solver.data.recording import Recording
from ...solver.skeleton.bind_pose import bind_frames
from ..environment.virtual_environment import ROOT
from ..figures.limits import WorstFigure
from ..recordings import HELD, read
from ..reports import report_options
from .combined import ALONE_AND_COMBINED
from .fits import LONGEST, FittedClip, fits, one_of_each_kind
from .limits import figures, fit_figures
from .measure import Examined, examine, examine_clean, without_own_faults
from .table import fits_page, page, text

PAGE, FITS_PAGE = ROOT / "docs" / "doctor.md", ROOT / "docs" / "fits.md"
READ = (".bvh", ".amc", ".fbx")
QUICK = ("forward_jump_116cm", "run_3")


def main(argv: list[str]) -> int:
    if "--table" not in argv and "--fits" not in argv:
        return told(["doctor", *argv])
    parser = argparse.ArgumentParser(prog="dev.py doctor", description=__doc__)
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--table", action="store_true")
    which.add_argument("--fits", action="store_true")
    parser.add_argument("folder", nargs="?", type=Path, default=HELD, metavar="FOLDER")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--quick", action="store_true", help="two clips only")
    options = report_options(parser, argv)
    chosen = [clip for clip in clips(options.folder) if not options.quick or clip[0] in QUICK]
    if not chosen:
        parser.error(f"there is no clip to look at in {options.folder}")
    whole = options.folder == HELD and not options.quick
    made = fits_table if options.fits else table
    return made(chosen, options.out, write_page=whole)


def table(chosen: Iterable[tuple[str, Recording]], out: Path, *, write_page: bool) -> int:
    """Clips damaged, diagnosed and repaired."""
    began = time.perf_counter()
    examined = [each for clip in chosen for each in examine_all(*clip)]
    minutes = (time.perf_counter() - began) / 60.0
    found = figures(examined)
    rows = [{**asdict(e), "kind": e.kind and e.kind.value} for e in examined]
    write_json(out / "figures.json", found, rows)
    if write_page:
        PAGE.write_text(page(examined, found, minutes), encoding="utf-8")
    return tell(found, f"{len(examined)} examinations in {minutes:.1f} minutes; all in {out}")


def fits_table(chosen: Iterable[tuple[str, Recording]], out: Path, *, write_page: bool) -> int:
    """Clips damaged, repaired and fitted."""
    began = time.perf_counter()
    fitted: list[FittedClip] = []
    for name, recording in chosen:
        whole = without_own_faults(name, recording)
        mine = list(fits(name, first_part(name, recording), whole, one_of_each_kind()))
        failed = ", ".join(each.damage for each in mine if not each.valid) or "nothing"
        print(f"{name}: not fitted {failed}", flush=True)
        fitted += mine
    minutes = (time.perf_counter() - began) / 60.0
    found = fit_figures(fitted)
    write_json(out / "fits.json", found, [asdict(each) for each in fitted])
    if write_page:
        FITS_PAGE.write_text(fits_page(fitted, found, minutes), encoding="utf-8")
    return tell(found, f"{len(fitted)} fits in {minutes:.1f} minutes; all in {out}")


def write_json(path: Path, found: Sequence[WorstFigure], clips: list[dict[str, object]]) -> None:
    """The figures and what they are made of."""
    content = {"figures": [{**asdict(f), "ok": f.ok} for f in found], "clips": clips}
    words = json.dumps(content, indent=1, ensure_ascii=False)
    path.write_text(words + "\n", encoding="utf-8")


def tell(found: Sequence[WorstFigure], how_many: str) -> int:
    """Prints the figures; 1 where one is missed."""
    print(text(found))
    print(how_many)
    return 1 if any(f.missed for f in found) else 0


def clips(folder: Path) -> Iterator[tuple[str, Recording]]:
    """The clips of a folder, and of those in it, without rest poses at their beginning."""
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() in READ:
            recording = imported(path) if path.suffix.lower() == ".fbx" else read(path)
            kept = recording.part(slice(bind_frames(recording), None))
            yield path.stem, kept.window(kept.frames[0], kept.frames[-1])


def imported(path: Path) -> Recording:
    """A clip as Blender reads it."""
    import bpy

    from ...bridge.armature.read import read_recording
    from ...bridge.files.import_clip import import_clip

    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    return read_recording(import_clip(path).armature)


def first_part(name: str, recording: Recording) -> Recording:
    """What of a clip is damaged, without faults of its own."""
    last = recording.frames[0] + LONGEST * recording.rate
    return without_own_faults(name, recording.window(recording.frames[0], last))


def examine_all(name: str, recording: Recording) -> list[Examined]:
    """A clip as it is, and, without faults of its own, with each damage."""
    part = first_part(name, recording)
    damages = [each for each in ALONE_AND_COMBINED if each.possible(part)]
    found = [examine_clean(name, recording), *(examine(name, part, each) for each in damages)]
    missed = ", ".join(each.damage for each in found if not each.found) or "nothing"
    print(f"{name}: missed {missed}", flush=True)
    return found
