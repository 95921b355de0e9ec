"""Results on a rig that is posed through controls: Rigify's generated human."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.bridge.accessors import current_action, present
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import record
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import write_result
from hangtime.devtools.rigs.actor import actor
from hangtime.devtools.rigs.generated import carried, generated_human, perform
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.numerics.rotations import axis_rotation

LEGS = ("thigh", "shin", "foot", "toe")
NECK = ("DEF-spine.004", "DEF-spine.006")


def test_bones_of_a_generated_rig_follow_a_result_and_only_controls_get_keys() -> None:
    whole = actor()
    part = slice(150, 166)
    performer = replace(
        whole, frames=whole.frames[part], heads=whole.heads[part], turns=whole.turns[part]
    )
    rig = generated_human(performer, arms=1.0, legs=1.0)
    bodies = carried(rig, performer).bones
    perform(rig, performer)
    take = present(current_action(rig))
    before = {(c.data_path, c.array_index): fcurves.keys(c) for c in fcurves.all_curves(take)}
    shown = record(rig, performer.frames[4:12])
    columns = [shown.index(bone) for bone in bodies]
    turn = axis_rotation(2, np.radians(20.0))
    place = shown.heads[:, columns[0]] @ turn.T + [0.1, 0.2, 0.05]
    wanted = PoseTrack(shown.frames, bodies, turn @ shown.rotations[:, columns], place)
    span = (float(shown.frames[0]), float(shown.frames[-1]))
    options = ResultOptions(blend_in=2.0, blend_out=2.0)
    motion = AdaptedMotion(wanted, TimeMap(span, span), None, options)
    result, written = write_result(rig, motion, name="moved")
    assert written is not None
    assert written.controls is not None
    now = record(rig, shown.frames)
    legs = [shown.index(b) for b in bodies if any(word in b for word in LEGS)]
    moved = place[:, None] + (shown.heads[:, legs] - shown.heads[:, columns[:1]]) @ turn.T
    assert np.linalg.norm(now.heads[:, legs] - moved, axis=2).max() < 1e-3
    # The neck's bones stretch between its control and the head's: what is left there is told.
    assert written.controls.kept or written.controls.far_bone in NECK
    off = now.rotations[:, columns] - wanted.rotations
    told = np.radians(written.controls.degrees)
    assert np.linalg.norm(off, axis=(2, 3)).max() / np.sqrt(2.0) < told + 1e-3
    keyed = {fcurves.bone_of(curve.data_path) for curve in fcurves.all_curves(result)}
    assert not [bone for bone in keyed if bone is not None and bone.startswith(("DEF-", "ORG-"))]
    assert "torso" in keyed
    for curve in fcurves.all_curves(take):
        assert np.array_equal(fcurves.keys(curve), before[curve.data_path, curve.array_index])
    for curve in fcurves.all_curves(result):
        old, new = before[curve.data_path, curve.array_index], fcurves.keys(curve)
        for rows in (slice(0, 2), slice(-2, None)):
            assert new[rows] == pytest.approx(old[rows], abs=0.0)
