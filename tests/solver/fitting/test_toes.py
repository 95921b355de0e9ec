"""Toes come back from a push-off more slowly than the cost alone would have them."""

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.body.anatomy import Part
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.fitting.fit import fit
from hangtime.tests.helpers.clips import load_recording

STEP = 1 / 240  # s
FASTEST = 1000.0  # °/s against the foot; 1315 where they were as quick as limbs


@pytest.mark.slow
def test_toes_do_not_snap_back_after_a_push_off() -> None:
    analysis = analyse(load_recording("run_2.bvh"), MotionProblem())
    motion = fit(analysis.performance, analysis.schedule).motion
    rotations = motion.pose(np.arange(0.0, motion.duration, STEP)).rotations
    character = motion.transcription.character
    toes = [i for i, body in enumerate(character.bodies) if body.part is Part.TOE]
    assert len(toes) == 2
    for toe in toes:
        foot = character.joints[toe].parent
        bent = np.swapaxes(rotations[:, foot], 1, 2) @ rotations[:, toe]
        turns = np.trace(np.swapaxes(bent[:-1], 1, 2) @ bent[1:], axis1=1, axis2=2)
        speeds = np.degrees(np.arccos(np.clip(0.5 * (turns - 1.0), -1.0, 1.0))) / STEP
        assert speeds.max() < FASTEST
