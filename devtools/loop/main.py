"""Loops of recorded runs: python3 dev.py loop --out DIR.

Each is solved as periodic, written as an action that repeats, and measured as Blender plays it; the
motion is played twice under MuJoCo.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np

from ...bridge.accessors import current_action, present
from ...bridge.armature import fcurves
from ...bridge.armature.incremental import complete
from ...bridge.armature.read import read_recording
from ...bridge.files.import_clip import import_clip
from ...bridge.loops.write_loop import Loop, write_loop
from ...bridge.properties.attached_groups import ensure_groups
from ...bridge.rows.choices import LoopRoot
from ...solver.data.recording import BEYOND
from ...solver.loops.loop_report import loop_report
from ...solver.worker.pipeline import AdaptationResult, measure, solve
from ...solver.worker.stage_clock import StageClock
from ..figures.limits import Figure, figure, table, write
from ..recordings import find
from ..reports import report_options
from .clips import RUNS, Run
from .curves import picture
from .limits import LIMITS
from .played import Played
from .twice import played_twice


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py loop", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--clip", metavar="WORD", help="only clips with this in their name")
    options = report_options(parser, argv)
    found: list[Figure] = []
    for run in RUNS:
        if options.clip is None or options.clip in run.name:
            result, played = solved(run)
            for name, value in measured(result, played):
                found.append(figure(name, value, run.name, run.cut, LIMITS))
            drawn = options.out / f"{run.name.replace(' ', '_')}.svg"
            drawn.write_text(picture(run.name, result, played), encoding="utf-8")
            print(f"{run.name}, cut {run.cut}: measured", flush=True)
    write(found, options.out / "figures.json")
    print(table(found, LIMITS))
    return 0 if all(each.ok for each in found) else 1


def solved(run: Run) -> tuple[AdaptationResult, Played]:
    """The solved cycle, and an armature in an empty scene that plays it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    ensure_groups()
    armature = import_clip(find(run.file)).armature
    recording = read_recording(armature, first=run.first, last=run.last, beyond=BEYOND)
    result = solve(measure(recording, run.problem), StageClock())
    loop = Loop.of(armature, result.track, LoopRoot.HIPS)
    take, slot = present(current_action(armature)), fcurves.slot_identifier(armature)
    action, _ = complete(write_loop(armature, loop, take, slot, name=run.name))
    fcurves.assign(armature, action, slot)
    first, last = result.track.frames[[0, -1]].tolist()
    return result, Played(armature, (first, last), recording.rate, result.track.bones)


def measured(result: AdaptationResult, played: Played) -> Iterator[tuple[str, float]]:
    """Every figure of one loop."""
    motion, cycle = result.adaptation.motion, present(result.subject.cycle)
    loop = loop_report(motion, cycle, result.subject.analysis.performance.com)
    yield "solved", float(result.fault is None)
    yield "seam, as Blender plays it: pose", 1000.0 * played.seam_pose()
    yield "seam, as Blender plays it: velocity", 1000.0 * played.seam_velocity()
    yield "seam, as solved: velocity", loop.seam_velocity_mm_s
    yield "seam, as solved: force of a point", loop.seam_force_bw
    needed = played.needed_force(motion)
    yield "seam: force that the played motion needs, against the solved", needed
    yield "second cycle against the first", 1000.0 * played.second_cycle()
    twice = played_twice(motion)
    for phase, flying in (("flight", True), ("ground", False)):
        for part in ("force", "moment"):
            rms = twice.residual.rms(part, flying)
            yield f"{phase}: root {part} not explained, rms", rms
    for part in ("force", "moment"):
        yield f"beside the seam: root {part} not explained, max", twice.beside(part)
    performance = result.subject.analysis.performance
    off = motion.joint_centres(performance.times) - performance.centres
    yield "joint centres off the recording, rms", 100.0 * float(np.sqrt((off**2).sum(2).mean()))
    yield "frames by which the artist's end moves", abs(cycle.frames[1] - cycle.asked[1])
