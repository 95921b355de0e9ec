"""Measures every figure that the project promises: python3 dev.py figures --out DIR.

Each clip goes through Blender (import, read), the solver (contacts, fit, adaptation) and back
(action, FBX); the physics is judged by MuJoCo, speed beside IPOPT in the same process.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, TypeVar

from ..environment.problem import SetUpError
from ..environment.virtual_environment import ROOT
from .limits import Figure, figure, table, write

if TYPE_CHECKING:
    import bpy

    from ...solver.data.recording import Recording
    from ...solver.stages.fit import Fit
    from ...solver.stages.implicit import Adaptation
    from ...solver.transcription.motion import Motion
    from .clips import Clip

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
RUNS = 7  # adaptations timed; the median counts
Result = TypeVar("Result")


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py figures", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--clip", metavar="WORD", help="only clips with this in their name")
    parser.add_argument("--no-peer", action="store_true", help="leave out IPOPT, which is slow")
    options = parser.parse_args(argv)
    if any(os.environ.get(name) != "1" for name in ONE_THREAD):
        return _in_one_thread(argv)
    from .clips import CLIPS

    chosen = [clip for clip in CLIPS if options.clip is None or options.clip in clip.name]
    if not chosen:
        print(f"No clip has '{options.clip}' in its name.")
        return 2
    try:
        _ = [clip.path for clip in chosen]  # what must be fetched is, before anything is measured
    except SetUpError as problem:
        print(problem, file=sys.stderr)
        return 2
    figures: list[Figure] = []
    for clip in chosen:
        for found in measure(clip, peer=not options.no_peer):
            figures.append(found)
    options.out.mkdir(parents=True, exist_ok=True)
    write(figures, options.out / "figures.json")
    print(table(figures))
    missed = [f for f in figures if not f.ok]
    print(f"{len(figures)} figures in {options.out / 'figures.json'}; {len(missed)} missed.")
    for f in missed:
        print(f"missed: {f.name}: {f.value:.4g} {f.unit} (must {f.must:g}); {f.clip}, {f.edit}")
    return 1 if missed else 0


def _in_one_thread(argv: list[str]) -> int:
    """The same in a process whose linear algebra keeps to one thread: set before numpy loads."""
    launcher = ROOT / "devtools" / "package.py"
    command = [sys.executable, str(launcher), "devtools.figures", *argv]
    return subprocess.call(command, env={**os.environ, **ONE_THREAD})


def measure(clip: "Clip", *, peer: bool) -> Iterator[Figure]:
    """Every figure of one clip."""
    from ...solver.analysis.analyse import analyse
    from ...solver.stages.fit import fit
    from .blender import open_clip
    from .clips import EDITS

    armature, recording = open_clip(clip)
    problem = clip.problem(next(iter(EDITS)))
    analysis = analyse(recording, problem)
    busy = time.process_time()
    fitted, seconds = timed(lambda: fit(analysis.performance, analysis.schedule))
    busy = time.process_time() - busy
    _say(clip.name, f"fitted in {seconds:.2f} s")
    yield figure("fit", seconds, clip.name, "fit")
    yield figure("fit, processor's time", busy, clip.name, "fit")
    for part in (
        closeness(fitted),
        physics(fitted.motion),
        still(armature, recording, fitted.motion),
    ):
        for name, value in part:
            yield figure(name, value, clip.name, "fit")
    for edit in EDITS:
        for name, value in measure_edit(clip, edit, fitted, armature, recording, peer=peer):
            yield figure(name, value, clip.name, edit)


def measure_edit(
    clip: "Clip",
    edit: str,
    fitted: "Fit",
    armature: "bpy.types.Object",
    recording: "Recording",
    *,
    peer: bool,
) -> Iterator[tuple[str, float]]:
    """Every figure of one edit of a fitted clip."""
    from ...solver.stages.implicit import adapt

    problem = clip.problem(edit)
    _ = fitted.metric  # part of the stored fit
    busy = time.process_time()
    runs = [timed(lambda: adapt(fitted, problem)) for _ in range(RUNS)]
    busy = (time.process_time() - busy) / RUNS
    adaptation, seconds = runs[0][0], median(seconds for _, seconds in runs)
    _say(clip.name, f"{edit}: adapted in {seconds:.2f} s")
    yield "solved", float(adaptation.solved)
    yield "adaptation from the stored fit", seconds
    yield "adaptation from the stored fit, processor's time", busy
    yield "steps of the adaptation", sum(len(o.steps) for o in adaptation.outcomes)
    yield from physics(adaptation.motion)
    yield from still(armature, recording, adaptation.motion)
    if peer:
        yield from beside_ipopt(clip, edit, fitted, adaptation, seconds)


def timed(work: Callable[[], Result]) -> tuple[Result, float]:
    """What `work` gives, and the seconds that it took."""
    begun = time.perf_counter()
    return work(), time.perf_counter() - begun


def closeness(fitted: "Fit") -> Iterator[tuple[str, float]]:
    """How near the fit is to the recording: joint centres at every frame, and the apex."""
    import numpy as np

    performance, flights = fitted.performance, fitted.schedule.flights
    times = performance.times
    centres = fitted.motion.joint_centres(times)
    apart = np.linalg.norm(centres - performance.centres, axis=2)
    yield "fit to recording: joint centres, rms", 100 * float(np.sqrt((apart**2).mean()))
    flying = np.any([(times >= f.start) & (times <= f.end) for f in flights], axis=0)
    apexes = [heights[flying, 0, 2].max() for heights in (centres, performance.centres)]
    yield "fit to recording: pelvis at the apex", 100 * abs(apexes[0] - apexes[1])


def physics(motion: "Motion") -> Iterator[tuple[str, float]]:
    """What no force explains, by MuJoCo on a dense grid and by the arrays that anybody gets."""
    import numpy as np

    from ...solver.results.npz_export import save
    from ..checks.mujoco_check import check_motion, check_npz

    residual, torques = check_motion(motion)
    for where, flying in (("flight", True), ("ground", False)):
        for part in ("force", "moment"):
            name = f"{where}: root {part} not explained"
            yield f"{name}, rms", residual.rms(part, flying)
            yield f"{name}, max", residual.worst(part, flying)
    yield "largest joint torque", float(np.abs(torques).max())
    with tempfile.TemporaryDirectory() as folder:
        save(motion, Path(folder) / "trajectory.npz")
        residual = check_npz(Path(folder) / "trajectory.npz")
    for where, flying in (("flight", True), ("ground", False)):
        for part in ("force", "moment"):
            yield f"npz: {where}: root {part} not explained, rms", residual.rms(part, flying)


def still(
    armature: "bpy.types.Object", recording: "Recording", motion: "Motion"
) -> Iterator[tuple[str, float]]:
    """How far pinned points wander in Blender."""
    from .blender import drifts

    with tempfile.TemporaryDirectory() as folder:
        written, back = drifts(armature, recording, motion, Path(folder) / "measured.fbx")
    for where, drift in (("in Blender", written), ("after FBX", back)):
        yield f"pinned point's drift {where}", 1000 * drift.held
        yield f"pinned point's drift {where}, first and last 30 ms", 1000 * drift.ends


def beside_ipopt(
    clip: "Clip", edit: str, fitted: "Fit", adaptation: "Adaptation", seconds: float
) -> Iterator[tuple[str, float]]:
    """The same problem by IPOPT; a peer that fails or runs out of time has no ratio worth much,
    which its violation tells."""
    from ..peers.ipopt_peer import distance, solve_by_ipopt

    problem = clip.problem(edit)
    peer = solve_by_ipopt(fitted, problem)
    _say(clip.name, f"{edit}: IPOPT {peer.status} in {peer.seconds:.1f} s")
    yield "IPOPT peer", peer.seconds
    yield "IPOPT peer: iterations", peer.iterations
    yield "IPOPT peer: worst violation over tolerance", peer.violation
    ours = distance(fitted, problem, adaptation.outcomes[0].x)
    yield "IPOPT peer: distance over ours", peer.distance / ours
    yield "times faster than the IPOPT peer", peer.seconds / seconds


def _say(clip: str, words: str) -> None:
    print(f"{clip}: {words}", flush=True)
