"""Ground of the scene on which a recording stands is its floor, and what rides on it is still."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.whole_body import raised, rising, sliding
from hangtime.solver.analysis.performance import perform
from hangtime.solver.body.character import build_character
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.scene import SceneObject
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.ground import as_stood
from hangtime.solver.doctor.examination.repair import turned
from hangtime.solver.doctor.figure import figure_of
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.doctor.stance.feet import find_feet
from hangtime.solver.doctor.upright import turn_upright
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.moving import keyed

HEIGHT = -0.4  # m
SPEED, SPIN = 2.0, 1.0  # m/s, rad/s


@cache
def jump() -> Recording:
    return load_recording(JUMP).window(73, 325)


def platform(velocity: np.ndarray, spin: float = 0.0) -> SceneObject:
    """Ground about the origin that moves as long as the jump lasts."""
    frames = jump().frames
    way = float(frames[0]), jump().rate, float(frames[-1])
    return keyed(lambda t: (t * velocity, axis_rotation(2, spin * t)), way)


def ridden(velocity: np.ndarray, spin: float = 0.0) -> Recording:
    """The jump on that ground."""
    recording, ground = jump(), platform(velocity, spin)
    turn, shift = ground.rotations, ground.positions
    heads = np.einsum("tij,tbj->tbi", turn, recording.heads) + shift[:, None]
    return replace(recording, heads=heads, rotations=turn[:, None] @ recording.rotations)


def told(recording: Recording, *scene: SceneObject) -> list[str]:
    return [finding.kind.value for finding in diagnose(recording, scene=scene).findings]


@pytest.mark.slow
def test_a_ramp_of_the_scene_is_no_camera_that_was_not_level() -> None:
    slope = Repairs(tilt=(0.0, 1.5))
    level = platform(np.zeros(3))
    ramp = replace(level, frames=level.frames[:1], positions=level.positions[:1])
    ramp = replace(ramp, rotations=turn_upright(slope)[None])
    assert "tilted floor" in told(turned(jump(), slope), level)
    hips = figure_of(jump()).bones[0]
    down = np.tan(np.radians(1.5)) * jump().heads[:, hips, 1]
    heads = jump().heads - down[:, None, None] * np.array([0.0, 0.0, 1.0])
    assert "tilted floor" not in told(replace(jump(), heads=heads), ramp)


@pytest.mark.slow
def test_the_floor_is_where_the_ground_is() -> None:
    low = raised(HEIGHT).of(jump()).recording
    floor = replace(platform(np.zeros(3)), positions=np.array([[0.0, 0.0, HEIGHT]]))
    floor = replace(floor, frames=floor.frames[:1], rotations=floor.rotations[:1])
    assert told(low) == ["floor"]
    assert told(low, floor) == []
    performance = perform(low, build_character(low))
    assert find_feet(performance)
    assert not find_feet(as_stood(performance, [floor]))
    assert told(jump(), floor) == []  # it does not stand on it
    assert told(raised(0.1).of(jump()).recording, floor) == ["floor"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("velocity", "spin", "alone"),
    [
        ((SPEED, 0.0, 0.0), 0.0, "sliding"),
        ((0.0, 0.0, 0.3), 0.0, "rising"),
        ((0.0, 0.0, 0.0), SPIN, "skidding"),
    ],
)
def test_what_rides_does_not_drift(velocity, spin: float, alone: str) -> None:
    way = np.array(velocity)
    assert alone in told(ridden(way, spin))
    assert told(ridden(way, spin), platform(way, spin)) == []


@pytest.mark.slow
def test_what_drifts_on_ground_still_does() -> None:
    way = np.array([SPEED, 0.0, 0.0])
    for damage in (sliding(0.5), rising(0.1)):
        assert damage.kind.value in told(damage.of(ridden(way)).recording, platform(way))
    assert told(jump(), platform(way)) == []  # nor does it ride on all that is beneath
