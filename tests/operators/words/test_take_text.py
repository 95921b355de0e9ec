"""What is said of the take around the adapted frames."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hangtime.bridge.controls.missed.aimed import Aimed
from hangtime.bridge.controls.missed.kept import KeptByControls
from hangtime.bridge.takes.span import ResultSpan, WrittenTake
from hangtime.bridge.takes.take_time import TakeTime
from hangtime.operators.words.take_text import aimed_line, apart_lines, take_lines, take_record
from hangtime.solver.data.reports.keys import BodyMiss
from hangtime.solver.data.requests import ALWAYS, PoseRequest
from hangtime.solver.data.stance_move import StanceMove

SPAN = ResultSpan(140.0, 333.0, 1.0, 900.0, 30.0, 30.0)
SAME, LATER = (TakeTime(np.array([140.0, 333.0]), np.array([140.0, end])) for end in (333.0, 334.0))
MOVED = StanceMove("ground 2", (0.0, 0.0, 0.0), -0.5 * pi, (0.3, 0.4, 0.2))


def test_adapted_frames_alone_need_no_words() -> None:
    assert take_lines(None) == []


def test_a_take_that_goes_on_as_it_was_says_so_in_a_line() -> None:
    written = WrittenTake(SPAN, None, None, SAME)
    assert take_lines(written) == [
        "Take: frames 140 to 333 are adapted",
        "Blended in over 30 frames and out over 30 frames",
    ]


def test_a_take_that_ends_within_the_blend_tells_what_it_keeps() -> None:
    written = WrittenTake(replace(SPAN, end=339.0), None, None, SAME)
    assert take_lines(written)[1:] == [
        "Blended in over 30 frames and out over 6 frames",
        "  The take ends within its blend of 30 frames: its last frame keeps 94% of what the "
        "adapted ones are off the take",
    ]
    assert take_record(written)["kept_at_end"] == pytest.approx(0.942, abs=1e-3)


def test_of_what_controls_miss_only_what_is_beyond_the_promise_is_told() -> None:
    hand = BodyMiss("hand", 12.9, 31.0, 0.04, 32.0)
    arm, spine = BodyMiss("arm", 0.3, 2.0, 8.5, 31.0), BodyMiss("spine", 0.2, 2.0, 0.1, 2.0)
    kept = KeptByControls(12.9, "hand", 31.0, 8.5, "arm", 31.0, 22, (hand, arm, spine))
    assert take_lines(WrittenTake(SPAN, None, None, SAME, controls=kept))[2:] == [
        "22 controls have keys, and miss the solution by more than 1 mm or 0.2°:",
        "  hand by 12.9 mm (frame 31)",
        "  arm by 8.5° (frame 31)",
    ]


def test_how_far_feet_slide_on_the_way_back_is_on_record() -> None:
    written = WrittenTake(SPAN, MOVED, 339.0, SAME, slide=0.0617)
    assert take_record(written)["slide_on_way_back_m"] == 0.0617


def test_what_follows_is_told_as_the_artist_calls_the_stance() -> None:
    written = WrittenTake(SPAN, MOVED, None, SAME)
    assert "What follows is carried along with Landing 1:" in take_lines(
        written, {"ground 2": "Landing 1"}
    )


def test_what_follows_is_told() -> None:
    written = WrittenTake(SPAN, MOVED, 450.0, LATER, ("LeftArm",), ("pelvis",))
    assert take_lines(written)[2:] == [
        "What follows comes 1 frame later",
        "What follows is carried along with ground 2:",
        "  0.500 m along the ground, 0.200 m up, 90.0° to the right",
        "  It is back where it was at frame 450",
        "Held still, for they moved joints within the body: pelvis",
        "Curves with modifiers, or muted, are plain keys now: LeftArm",
    ]
    record = take_record(written)
    assert record["take_frames"] == [1.0, 900.0]
    assert record["carried_turn_deg"] == -90.0
    assert record["later_frames"] == 1
    assert record["bones_held"] == ["pelvis"]


@pytest.mark.parametrize(
    ("constraints", "drivers", "told"),
    [
        (("Damped Track", "IK"), False, "Left to constraints (Damped Track, IK), as in"),
        ((), True, "Left to drivers, as in"),
        (("Damped Track",), True, "Left to constraints (Damped Track) and drivers, as in"),
    ],
)
def test_all_that_aims_a_head_is_named(
    constraints: tuple[str, ...], drivers: bool, told: str
) -> None:
    aimed = Aimed(("Head",), constraints, drivers, 12.0, 140.0, 1.0)
    assert aimed_line(aimed).startswith(told)


def test_a_pose_tells_what_it_leaves_out() -> None:
    poses = (
        PoseRequest("Tuck", ALWAYS, apart=("Head", "Hat")),
        PoseRequest("Arm", ALWAYS, ("Arm", "Neck"), weight=1.0, apart=("Neck", "Head")),
        PoseRequest("Knee", ALWAYS, ("Knee",)),
    )
    assert apart_lines(poses, ("Hips", "Arm", "Knee", "Neck", "Head")) == [
        "The pose “Tuck” is about the rest of the body: Head stays aimed",
        "The pose “Arm” is about the rest of the body: Neck stays aimed",
    ]
    assert apart_lines(poses[:1], ("Hips", "Arm")) == []  # a head that is one with the bone below
