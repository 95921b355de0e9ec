"""Reduced keys of adapted jumps: python3 dev.py keys --out DIR.

Each jump is adapted, written with a key on every frame and then with reduced keys; Blender
evaluates both at every frame.
"""

import argparse
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...bridge.armature import fcurves
from ...bridge.armature.incremental import complete
from ...bridge.armature.read import record
from ...bridge.armature.write import write_action
from ...bridge.keys.events import events_of
from ...bridge.keys.written import KeyedAction, choose_keys
from ...bridge.recipe.keys import KeyOptions
from ...bridge.rows.choices import KeyChoice
from ...solver.arrays import FloatArray
from ...solver.data.recording import Recording
from ...solver.worker.pipeline import measure, solve
from ...solver.worker.stage_clock import StageClock
from ..figures.blender import drift, open_clip
from ..figures.clips import CLIPS, Clip
from ..figures.limits import Figure, figure, table, write
from ..reports import report_options
from .limits import LIMITS, RATE, missed

EDITS = {
    CLIPS[0]: "+0.3 m forward",
    CLIPS[1]: "+0.3 m forward",
    CLIPS[2]: "+0.2 m up",
    CLIPS[3]: "+0.3 m forward",
    CLIPS[4]: "+0.3 m forward, +0.2 m up",
}


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py keys", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--clip", metavar="WORD", help="only clips with this in their name")
    options = report_options(parser, argv)
    found: list[Figure] = []
    for clip, edit in EDITS.items():
        if options.clip is None or options.clip in clip.name:
            for name, value in measured(clip, edit):
                found.append(figure(name, value, clip.name, edit, LIMITS))
            print(f"{clip.name}, {edit}: measured", flush=True)
    write(found, options.out / "figures.json")
    print(table(found, LIMITS))
    return 1 if missed(found) else 0


def measured(clip: Clip, edit: str) -> Iterator[tuple[str, float]]:
    """Every figure of one adapted jump."""
    armature, recording = open_clip(clip)
    result = solve(measure(recording, clip.problem(edit)), StageClock())
    track = result.track
    take = fcurves.holder(armature)
    action = write_action(armature, track, name=clip.name)
    exact = record(armature, track.frames)
    slot = fcurves.slot_identifier(armature)
    keyed = KeyedAction(action, slot, track.bones, track.frames, take)
    events = events_of(result.schedule, float(track.frames[0]), recording.rate)
    began = time.process_time()
    reduced = KeyOptions(KeyChoice.REDUCED)
    report = complete(choose_keys(armature, keyed, reduced, events))
    yield "time", time.process_time() - began
    yield RATE, report.rate  # of the channels that the result has of its own
    apart, turned = off(exact, shown := record(armature, track.frames), track.bones)
    assert report.largest_error_mm <= 1000.0 * reduced.distance
    yield "joint centres off, every frame", 1000.0 * float(apart.max())
    yield "bones turned, every frame", float(np.degrees(turned.max()))
    yield "pinned point's drift", 1000.0 * drift(result.adaptation.motion, shown).held


def off(
    exact: Recording, shown: Recording, bones: tuple[str, ...]
) -> tuple[FloatArray, FloatArray]:
    """Distances (T, B) m and angles (T, B) rad of bones from where they should be."""
    own = [exact.index(bone) for bone in bones]
    apart = np.linalg.norm((shown.heads - exact.heads)[:, own], axis=2)
    chords = np.linalg.norm((shown.rotations - exact.rotations)[:, own], axis=(2, 3)) / np.sqrt(8.0)
    return apart, 2.0 * np.arcsin(chords)
