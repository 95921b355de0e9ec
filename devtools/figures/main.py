"""Measures every figure that the project promises: python3 dev.py figures --out DIR.

Each clip goes through Blender (import, read), the solver (contacts, fit, adaptation) and back
(action, FBX); the physics is judged by MuJoCo, speed beside IPOPT in the same process.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from statistics import median

import bpy
import numpy as np

from ...solver.data.recording import Recording
from ...solver.fitting.fit import Fit
from ...solver.results.npz_export import save
from ...solver.stages.implicit import Adaptation
from ...solver.transcription.motion import Motion
from ...solver.worker.pipeline import Subject, adapt_fit, fit_subject, measure
from ...solver.worker.stage_clock import StageClock
from ..checks.mujoco_check import check_motion, check_npz
from ..environment.problem import SetUpError
from ..peers import ipopt_peer
from ..peers.task import Task
from ..reports import report_options
from .blender import drifts, open_clip
from .clips import CLIPS, EDITS, Clip
from .limits import Figure, figure, table, write

RUNS = 7  # adaptations timed; the median counts
PEER_LIMIT = 60.0  # s
RESIDUALS = [
    (f"{where}: root {part} not explained", part, flying)
    for where, flying in (("flight", True), ("ground", False))
    for part in ("force", "moment")
]


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py figures", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--clip", metavar="WORD", help="only clips with this in their name")
    parser.add_argument("--no-peer", action="store_true", help="leave out IPOPT, which is slow")
    options = report_options(parser, argv)
    chosen = [clip for clip in CLIPS if options.clip is None or options.clip in clip.name]
    if not chosen:
        print(f"No clip has '{options.clip}' in its name.")
        return 2
    try:
        _ = [clip.path for clip in chosen]  # what must be fetched is, before anything is measured
    except SetUpError as problem:
        print(problem, file=sys.stderr)
        return 2
    figures = [f for clip in chosen for f in measure_clip(clip, peer=not options.no_peer)]
    write(figures, options.out / "figures.json")
    print(table(figures))
    missed = [f for f in figures if not f.ok]
    print(f"{len(figures)} figures in {options.out / 'figures.json'}; {len(missed)} missed.")
    for f in missed:
        print(f"missed: {f.name}: {f.value:.4g} {f.unit} (must {f.must:g}); {f.clip}, {f.edit}")
    return 1 if missed else 0


def measure_clip(clip: Clip, *, peer: bool) -> Iterator[Figure]:
    """Every figure of one clip."""
    armature, recording = open_clip(clip)
    subject = measure(recording, clip.problem(next(iter(EDITS))))
    busy, clock = time.process_time(), StageClock()
    fitted = fit_subject(subject, clock)
    seconds = clock.done[-1].seconds
    busy = time.process_time() - busy
    _say(clip.name, f"fitted in {seconds:.2f} s")
    yield figure("fit", seconds, clip.name, "fit")
    yield figure("fit, processor's time", busy, clip.name, "fit")
    parts = (
        closeness(fitted),
        physics(fitted.motion),
        still(armature, subject.recording, fitted.motion),
    )
    for name, value in chain(*parts):
        yield figure(name, value, clip.name, "fit")
    for edit in EDITS:
        for name, value in measure_edit(clip, edit, subject, fitted, armature, peer=peer):
            yield figure(name, value, clip.name, edit)


def measure_edit(
    clip: Clip, edit: str, subject: Subject, fitted: Fit, armature: bpy.types.Object, *, peer: bool
) -> Iterator[tuple[str, float]]:
    """Every figure of one edit of a fitted clip."""
    asked = subject.asked(clip.problem(edit))
    _ = fitted.metric  # part of the stored fit
    busy, clock = time.process_time(), StageClock()
    runs = [adapt_fit(asked, fitted, clock) for _ in range(RUNS)]
    busy = (time.process_time() - busy) / RUNS
    adaptation, seconds = runs[0].adaptation, median(stage.seconds for stage in clock.done)
    _say(clip.name, f"{edit}: adapted in {seconds:.2f} s")
    yield "solved", float(adaptation.solved)
    yield "adaptation from the stored fit", seconds
    yield "adaptation from the stored fit, processor's time", busy
    yield "steps of the adaptation", sum(len(o.steps) for o in adaptation.outcomes)
    yield from physics(adaptation.motion)
    yield from still(armature, subject.recording, adaptation.motion)
    if peer:
        yield from beside_ipopt(clip, edit, fitted, adaptation, seconds)


def closeness(fitted: Fit) -> Iterator[tuple[str, float]]:
    """Distance of the fit from the recording: joint centres at every frame, and the apex."""
    performance, flights = fitted.performance, fitted.schedule.flights
    times = performance.times
    centres = fitted.motion.joint_centres(times)
    apart = np.linalg.norm(centres - performance.centres, axis=2)
    yield "fit to recording: joint centres, rms", 100 * float(np.sqrt((apart**2).mean()))
    flying = np.any([(times >= f.start) & (times <= f.end) for f in flights], axis=0)
    apexes = [heights[flying, 0, 2].max() for heights in (centres, performance.centres)]
    yield "fit to recording: pelvis at the apex", 100 * abs(apexes[0] - apexes[1])


def physics(motion: Motion) -> Iterator[tuple[str, float]]:
    """Dynamics residual by MuJoCo on a dense grid and by the arrays that anybody gets."""
    residual, torques = check_motion(motion)
    for name, part, flying in RESIDUALS:
        yield f"{name}, rms", residual.rms(part, flying)
        yield f"{name}, max", residual.worst(part, flying)
    yield "largest joint torque", float(np.abs(torques).max())
    with tempfile.TemporaryDirectory() as folder:
        save(motion, Path(folder) / "trajectory.npz")
        residual = check_npz(Path(folder) / "trajectory.npz")
    for name, part, flying in RESIDUALS:
        yield f"npz: {name}, rms", residual.rms(part, flying)


def still(
    armature: bpy.types.Object, recording: Recording, motion: Motion
) -> Iterator[tuple[str, float]]:
    """Drift of pinned points in Blender."""
    with tempfile.TemporaryDirectory() as folder:
        written, back = drifts(armature, recording, motion, Path(folder) / "measured.fbx")
    for where, drift in (("in Blender", written), ("after FBX", back)):
        yield f"pinned point's drift {where}", 1000 * drift.held
        yield f"pinned point above its place {where}", 1000 * drift.above


def beside_ipopt(
    clip: Clip, edit: str, fitted: Fit, adaptation: Adaptation, seconds: float
) -> Iterator[tuple[str, float]]:
    """The same problem by IPOPT; a peer that fails or runs out of time has no ratio worth much,
    which its violation tells."""
    task = Task.of(fitted, clip.problem(edit))
    peer = ipopt_peer.solve(task, PEER_LIMIT)
    _say(clip.name, f"{edit}: IPOPT {peer.status} in {peer.seconds:.1f} s")
    yield "IPOPT peer", peer.seconds
    yield "IPOPT peer: iterations", peer.iterations
    yield "IPOPT peer: worst violation over tolerance", peer.violation
    ours = task.distance(adaptation.outcomes[0].x)
    yield "IPOPT peer: distance over ours", peer.distance / ours
    yield "times faster than the IPOPT peer", peer.seconds / seconds


def _say(clip: str, words: str) -> None:
    print(f"{clip}: {words}", flush=True)
