"""The doctor: python3 dev.py doctor CLIP, or doctor --table [FOLDER] [--out DIR] [--quick].

The first says what is wrong with a clip (operators/headless). The table damages clean clips in
known ways, has them diagnosed and repaired, and ends with 1 where a limit is missed. Over the clips
of examples/recordings, and not quick, it writes docs/doctor.md anew.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from ...operators.headless.cli import main as told
from ...solver.data.recording import Recording
from ...solver.skeleton.bind_pose import bind_frames
from ..environment.virtual_environment import ROOT
from ..recordings import HELD, read
from .damages import DAMAGES
from .limits import figures
from .measure import Examined, examine, examine_clean, without_own_faults
from .table import page, text

PAGE = ROOT / "docs" / "doctor.md"
READ = (".bvh", ".amc", ".fbx")
QUICK = ("forward_jump_116cm", "run_3")
LONGEST = 5.0  # s, of a clip that is damaged; all of it is looked at undamaged


def main(argv: list[str]) -> int:
    if "--table" not in argv:
        return told(["doctor", *argv])
    parser = argparse.ArgumentParser(prog="dev.py doctor", description=__doc__)
    parser.add_argument("--table", action="store_true")
    parser.add_argument("folder", nargs="?", type=Path, default=HELD, metavar="FOLDER")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--quick", action="store_true", help="two clips only")
    options = parser.parse_args(argv)
    began = time.perf_counter()
    examined: list[Examined] = []
    for name, recording in clips(options.folder):
        if not options.quick or name in QUICK:
            examined += examine_all(name, recording)
    minutes = (time.perf_counter() - began) / 60.0
    found = figures(examined)
    options.out.mkdir(parents=True, exist_ok=True)
    content = {
        "figures": [{**asdict(f), "ok": f.ok} for f in found],
        "clips": [{**asdict(e), "kind": e.kind and e.kind.value} for e in examined],
    }
    words = json.dumps(content, indent=1, ensure_ascii=False)
    (options.out / "figures.json").write_text(words + "\n", encoding="utf-8")
    if options.folder == HELD and not options.quick:
        PAGE.write_text(page(examined, found, minutes), encoding="utf-8")
    print(text(found))
    print(f"{len(examined)} examinations in {minutes:.1f} minutes; all in {options.out}")
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


def examine_all(name: str, recording: Recording) -> list[Examined]:
    """A clip as it is, and, without faults of its own, with each damage."""
    last = recording.frames[0] + LONGEST * recording.rate
    part = without_own_faults(name, recording.window(recording.frames[0], last))
    found = [examine_clean(name, recording), *(examine(name, part, each) for each in DAMAGES)]
    missed = ", ".join(each.damage for each in found if not each.found) or "nothing"
    print(f"{name}: missed {missed}", flush=True)
    return found
