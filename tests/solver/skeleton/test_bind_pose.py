"""A T pose before the motion is found, and what only resembles one is let be."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.recordings import JUMP
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.local_poses import LocalPoses
from hangtime.solver.numerics.rotations import rotation_matrix
from hangtime.solver.skeleton.bind_pose import bind_frames, last_bind_frames
from hangtime.tests.helpers.clips import load_recording


def begun_at_rest(recording: Recording, frames: int) -> Recording:
    """The same with the rest pose on its first frames."""
    rotations, heads = recording.rotations.copy(), recording.heads.copy()
    rotations[:frames] = np.stack([bone.rotation for bone in recording.bones])
    heads[:frames] = np.stack([bone.head for bone in recording.bones])
    return replace(recording, rotations=rotations, heads=heads)


def clip() -> Recording:
    return load_recording(JUMP).window(100, 200)


def test_a_bind_pose_is_found_on_one_frame_and_on_several() -> None:
    assert [bind_frames(begun_at_rest(clip(), n)) for n in (1, 5)] == [1, 5]


def test_a_bind_pose_after_the_motion_is_found_likewise() -> None:
    backwards = replace(clip(), rotations=clip().rotations[::-1], heads=clip().heads[::-1])
    for frames in (1, 5):
        begun = begun_at_rest(backwards, frames)
        ended = replace(begun, rotations=begun.rotations[::-1], heads=begun.heads[::-1])
        assert (bind_frames(ended), last_bind_frames(ended)) == (0, frames)


def test_a_recording_has_none() -> None:
    assert (bind_frames(clip()), last_bind_frames(clip())) == (0, 0)


def test_a_recording_that_is_all_at_rest_has_none() -> None:
    recording = clip()
    assert bind_frames(begun_at_rest(recording, len(recording.frames))) == 0


@pytest.mark.parametrize("every", [1, 4])
def test_who_begins_in_a_rest_pose_and_moves_on_smoothly_is_let_be(every: int) -> None:
    """The rest skeleton is the first frame's own."""
    recording = clip().part(slice(40, None, every))
    bones = tuple(
        replace(bone, rotation=recording.rotations[0, i], head=recording.heads[0, i])
        for i, bone in enumerate(recording.bones)
    )
    assert bind_frames(replace(recording, bones=bones)) == 0


def with_legs_apart(recording: Recording) -> Recording:
    """The first frame with 17° at both thighs and 5° at both arms, as CMU's BVH files have it."""
    local = LocalPoses.of(recording)
    for name, degrees in (("LeftUpLeg", 17), ("RightUpLeg", -17), ("LeftArm", 5), ("RightArm", -5)):
        turn = rotation_matrix(np.radians([0.0, 0.0, degrees]))
        bone = recording.index(name)
        local.rotations[0, bone] = local.rotations[0, bone] @ turn
    return local.posed(recording)


def test_a_bind_pose_with_legs_apart_is_found() -> None:
    assert bind_frames(with_legs_apart(begun_at_rest(clip(), 1))) == 1


ARMS = {"LeftArm": -80.0, "RightArm": 80.0}


def turned(recording: Recording, frames: slice, degrees: dict[str, float]) -> Recording:
    """With bones turned about their x in these frames."""
    local = LocalPoses.of(recording)
    for name, angle in degrees.items():
        bone, turn = recording.index(name), rotation_matrix(np.radians([angle, 0.0, 0.0]))
        local.rotations[frames, bone] = local.rotations[frames, bone] @ turn
    return local.posed(recording)


def begun_at(degrees: dict[str, float], frames: int = 1) -> Recording:
    """The rest pose, but for these bones, on the first frames."""
    return turned(begun_at_rest(clip(), frames), slice(frames), degrees)


@pytest.mark.parametrize("frames", [1, 4])
@pytest.mark.parametrize(
    "more",
    [{}, {"LeftHand": 5.0, "RightHand": -5.0}, {"Head": 3.0}, {"LeftArm": -77.0}],
    ids=["arms", "and wrists", "and the head", "one arm less"],
)
def test_a_bind_pose_with_arms_elsewhere_than_at_rest_is_found_and_no_frame_more(
    more: dict[str, float], frames: int
) -> None:
    """A T pose where the rest hangs them, a bind pose either way."""
    assert bind_frames(begun_at(ARMS | more, frames)) == frames


@pytest.mark.parametrize(
    "pose",
    [{"LeftArm": -80.0, "LeftForeArm": 40.0}, ARMS | {"LeftForeArm": 100.0}],
    ids=["one raised and bent", "both raised, one bent"],
)
def test_who_stands_at_rest_with_arms_that_are_not_alike_is_let_be(pose: dict[str, float]) -> None:
    assert bind_frames(begun_at(pose)) == 0


def test_who_sits_at_first_is_let_be() -> None:
    """Hips, knees, arms, elbows and hands are turned, alike on both sides, and the rest leaps."""
    bent = {"UpLeg": 90.0, "Leg": 80.0, "Arm": 70.0, "ForeArm": 60.0, "Hand": 50.0, "Foot": 40.0}
    both = {side + bone: angle for bone, angle in bent.items() for side in ("Left", "Right")}
    assert bind_frames(begun_at(both)) == 0


def test_arms_alone_that_are_keyed_in_steps_are_let_be() -> None:
    """All else stays at rest."""
    still = begun_at_rest(clip(), len(clip().frames))
    for first in range(0, len(still.frames), 4):
        raised = 60.0 if first % 8 else 90.0
        still = turned(still, slice(first, first + 4), {"LeftArm": -raised, "RightArm": raised})
    assert (bind_frames(still), last_bind_frames(still)) == (0, 0)


def test_who_stands_at_rest_with_arms_raised_and_throws_them_up_is_let_be() -> None:
    still = turned(begun_at_rest(clip(), len(clip().frames)), slice(None), ARMS)
    for frame in range(10, len(still.frames)):
        thrown = min(21.0 * (frame - 9), 90.0)
        still = turned(still, slice(frame, frame + 1), {"LeftArm": -thrown, "RightArm": thrown})
    assert bind_frames(still) == 0


def test_who_stands_at_rest_with_arms_raised_and_keeps_one_of_them_there_is_let_be() -> None:
    """All else leaps."""
    stood = begun_at(ARMS, 10)
    local, arm = LocalPoses.of(stood), stood.index("LeftArm")
    local.rotations[10:, arm] = local.rotations[9, arm]
    assert bind_frames(local.posed(stood)) == 0


def test_who_stands_with_legs_apart_and_raises_an_arm_at_once_is_let_be() -> None:
    """All but the arm move on smoothly: the rest skeleton is the second frame's own."""
    recording = clip()
    bones = tuple(
        replace(bone, rotation=recording.rotations[1, i], head=recording.heads[1, i])
        for i, bone in enumerate(recording.bones)
    )
    stood = with_legs_apart(replace(recording, bones=bones))
    arm = stood.index("LeftForeArm")
    rotations = stood.rotations.copy()
    rotations[1:, arm] = rotations[1:, arm] @ rotation_matrix(np.radians([40.0, 0.0, 0.0]))
    assert bind_frames(replace(stood, rotations=rotations)) == 0
