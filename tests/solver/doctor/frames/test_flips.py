"""Joints turned by half a turn are turned back, about whichever Euler axis it was."""

import numpy as np
import pytest
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.local_poses import LocalPoses
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.helpers.doctored import jump, of_poses

BONES = ["Hips", "LeftUpLeg", "LeftLeg", "LeftArm", "LeftForeArm"]


def flipped(name: str, frames: slice, channel: int) -> Recording:
    """With half a turn more on a channel (0 to 2: Z, X, Y) of a bone's Euler angles."""
    local, bone = LocalPoses.of(jump()), jump().index(name)
    inside = local.rotations[frames, bone]
    z = axis_rotation(2, np.arctan2(-inside[:, 0, 1], inside[:, 1, 1]))
    before = [np.eye(3), z, inside][channel]  # turns after the channel's axis, seen from the parent
    half = axis_rotation((2, 0, 1)[channel], np.pi)
    local.rotations[frames, bone] = before @ half @ np.swapaxes(before, -1, -2) @ inside
    return local.posed(jump())


def mended(damaged: Recording) -> Recording:
    """By the remedy of all that is found, which is a flip."""
    (found,) = of_poses(damaged)
    assert found.kind is FindingKind.FLIP
    return repaired(damaged, found.remedy or Repairs())


@pytest.mark.parametrize("name", BONES)
@pytest.mark.parametrize(("channel", "cm"), [(0, 0.1), (1, 0.5), (2, 0.1)])
def test_a_flip_of_any_euler_angle_is_turned_back(name: str, channel: int, cm: float) -> None:
    damaged = flipped(name, slice(110, 130), channel)
    assert apart(damaged, jump()) > 0.01
    assert 100.0 * apart(mended(damaged), jump()) < cm


@pytest.mark.parametrize("frames", [slice(0, 40), slice(200, None)], ids=["first", "last"])
@pytest.mark.parametrize("channel", [0, 2])
@pytest.mark.parametrize("name", ["LeftLeg", "LeftForeArm"])
def test_a_flip_up_to_an_end_bends_the_limb_as_it_bends_elsewhere(
    name: str, channel: int, frames: slice
) -> None:
    """Its one edge does not tell about whose axis it was."""
    damaged = flipped(name, frames, channel)
    assert 100.0 * apart(mended(damaged), jump()) < 0.5


@pytest.mark.parametrize("channel", [0, 2])
def test_flips_that_a_single_frame_parts_are_turned_back(channel: int) -> None:
    """At their edges the frame before last is flipped as well, and tells no way to go on."""
    local, name = LocalPoses.of(jump()), "LeftUpLeg"
    bone, frames = jump().index(name), [60, 61, 62, 64, 66, 67]
    whole = LocalPoses.of(flipped(name, slice(None), channel))
    local.rotations[frames, bone] = whole.rotations[frames, bone]
    damaged = local.posed(jump())
    assert apart(damaged, jump()) > 0.03
    assert 100.0 * apart(mended(damaged), jump()) < 1.0
