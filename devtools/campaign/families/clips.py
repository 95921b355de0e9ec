"""Motion files and meshes, damaged: read, analysed, mended and fitted, or the fault is named."""

from functools import cache
from pathlib import Path

import numpy as np

from ....bridge.formats.acclaim import find_asf, read_acclaim
from ....bridge.formats.bvh import read_bvh
from ....bridge.formats.guess import guess_unit, guess_up
from ....bridge.formats.motion_clip import MotionClip, to_recording
from ....bridge.formats.obj import UnreadableMesh, read_obj
from ....solver.data.problem import MotionProblem
from ....solver.data.recording import Recording, digest
from ....solver.doctor.examination.diagnose import diagnose
from ....solver.doctor.examination.repair import repaired
from ....solver.worker.pipeline import fit_possible, measure
from ...environment.virtual_environment import ROOT
from ...recordings import HELD, HOPS, JUMP, find
from ..protocol.case import Changed, Family, HostileCase, Said
from ..protocol.damage import write_damaged
from ..protocol.patience import at_most

FRAMES = 5  # of a file that is only read
ANALYSED = 60  # of one that is also analysed
EXAMINED = 120  # of one that the doctor looks at
ENOUGH = 1.5  # s of this process that a fit may take


def bvh(case: HostileCase) -> None:
    """A few frames of the jump's BVH."""
    path = case.folder / "clip.bvh"
    write_damaged(case, path, short_bvh(FRAMES))
    _check(case, _recording(read_bvh(path)))


def acclaim(case: HostileCase) -> None:
    """A few frames of a hop, with its skeleton; one of the two is damaged."""
    asf, amc = case.folder / "01.asf", case.folder / "01_01.amc"
    texts = [_text(find_asf(find(HOPS))), short_amc(FRAMES)]
    hurt = int(case.rng.integers(2))
    for i, path in enumerate((asf, amc)):
        if i == hurt:
            write_damaged(case, path, texts[i])
        else:
            path.write_text(texts[i], encoding="utf-8")
    _check(case, _recording(read_acclaim(find_asf(amc), amc)))


def obj(case: HostileCase) -> None:
    """The examples' meshes."""
    path = case.folder / "mesh.obj"
    meshes = sorted((ROOT / "examples" / "world").glob("*.obj"))
    write_damaged(case, path, _text(case.pick(meshes)))
    try:
        vertices, triangles = read_obj(path)
    except (UnreadableMesh, UnicodeDecodeError) as fault:  # as the recipe's reader expects
        raise Said(type(fault).__name__) from fault
    if not np.isfinite(vertices).all():
        raise ValueError("a vertex is not finite")
    assert triangles.min(initial=0) >= 0
    assert triangles.max(initial=-1) < len(vertices)
    case.taken_on = True


def analysed(case: HostileCase) -> None:
    """A damaged piece of the jump, analysed, and now and then fitted."""
    subject = measure(_damaged_jump(case, ANALYSED), MotionProblem())
    case.taken_on = True
    if case.chance(0.3):
        with at_most(ENOUGH) as clock:
            fit_possible(subject, clock)


def examined(case: HostileCase) -> None:
    """The doctor looks at it, and again once all remedies are taken."""
    recording = _damaged_jump(case, EXAMINED)
    before = digest(recording)
    diagnosis = diagnose(recording, mass=case.pick((None, 70.0, 1e-6, 1e9)))
    mended = repaired(recording, diagnosis.repairs)
    _check(case, mended)
    if any(not np.isfinite(finding.amount) for finding in diagnosis.findings):
        raise ValueError(f"a finding is no number: {diagnosis.findings}")
    diagnose(mended)
    if digest(recording) != before:
        raise Changed("the recording")


def _damaged_jump(case: HostileCase, frames: int) -> Recording:
    path = case.folder / "clip.bvh"
    write_damaged(case, path, short_bvh(frames))
    return _recording(read_bvh(path))


@cache
def short_bvh(frames: int) -> str:
    """The jump's BVH, from its middle on."""
    head, _, motion = _text(HELD / JUMP).partition("MOTION")
    _, time, *rows = motion.strip().splitlines()
    kept = rows[160 : 160 + frames]
    return "\n".join([f"{head}MOTION", f"Frames: {len(kept)}", time, *kept, ""])


@cache
def short_amc(frames: int) -> str:
    """The first frames of the hops."""
    lines = _text(find(HOPS)).splitlines()
    return "\n".join(lines[: lines.index(str(frames + 1))])


@cache
def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def _recording(clip: MotionClip) -> Recording:
    up = guess_up(clip)
    return to_recording(clip, clip.unit or guess_unit(clip), up)


def _check(case: HostileCase, recording: Recording) -> None:
    for part in (recording.times, recording.heads, recording.rotations):
        if not np.isfinite(part).all():
            raise ValueError("a pose is not finite")
    case.taken_on = True


FAMILIES = (
    Family("BVH files", 20.0, 10.0, bvh),
    Family("ASF/AMC files", 10.0, 10.0, acclaim),
    Family("OBJ files", 5.0, 10.0, obj),
    Family("damaged clips, analysed", 3.0, 30.0, analysed),
    Family("damaged clips, examined", 3.0, 30.0, examined),
)
