"""An angle whose leap by 360° was interpolated is told as a full turn, and turned on over."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.damage import at_rate
from hangtime.devtools.doctor.damages.poses import flipped, wrapped
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.body.anatomy import Part
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.frames.full_turns import find_full_turns
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.numerics.rotations import rotation_matrix
from hangtime.tests.helpers.doctored import figure, jump


@pytest.mark.slow
@pytest.mark.parametrize("rate", [30.0, 60.0, 120.0])
@pytest.mark.parametrize("frames", [2, 3, 4, 6])
@pytest.mark.parametrize("part", [Part.PELVIS, Part.THIGH, Part.FOREARM])
def test_a_full_turn_is_told_with_its_bone_and_frames(part: Part, frames: int, rate: float) -> None:
    for channel in range(3):
        damaged = wrapped(part, frames, channel, rate).of(jump())
        found = find_full_turns(damaged.recording, figure())
        assert found is not None
        assert found.part == jump().bones[figure().of(part)[0]].name
        ((first, last),) = found.frames
        assert last - first + 1 == frames
        mended = repaired(damaged.recording, found.remedy or Repairs())
        assert apart(mended, damaged.original) < 0.005


@pytest.mark.slow
@pytest.mark.parametrize("part", [Part.PELVIS, Part.THIGH])
def test_nothing_else_is_told_of_it_and_nothing_cut(part: Part) -> None:
    """It was told as a jump, half of the clip to be left out, and of the hips as exchanged legs."""
    diagnosis = diagnose(wrapped(part, 4).of(jump()).recording)
    assert [finding.kind for finding in diagnosis.findings] == [FindingKind.FULL_TURN]
    assert not diagnosis.repairs.trims


@pytest.mark.parametrize("frames", [1, 2, 3, 5])
def test_half_a_turn_there_and_back_is_no_full_turn(frames: int) -> None:
    damaged = flipped(frames).of(jump()).recording
    assert find_full_turns(damaged, figure()) is None


@pytest.mark.slow
@pytest.mark.parametrize("rate", [24.0, 30.0, 60.0, 120.0])
@pytest.mark.parametrize("seconds", [0.3, 0.4, 0.7])
@pytest.mark.parametrize("axis", np.eye(3), ids="xyz")
def test_who_turns_once_around_is_no_damage(axis: np.ndarray, seconds: float, rate: float) -> None:
    """A somersault or a twist as fast as any, of the whole body."""
    u = np.clip((jump().times - 0.8) / seconds, 0.0, 1.0)
    turn = rotation_matrix(2.0 * np.pi * (u * u * (3.0 - 2.0 * u))[:, None] * axis)
    middle = jump().heads.mean(axis=1, keepdims=True)
    heads = middle + np.einsum("tij,tbj->tbi", turn, jump().heads - middle)
    turning = replace(jump(), heads=heads, rotations=turn[:, None] @ jump().rotations)
    assert find_full_turns(at_rate(turning, rate), figure()) is None
