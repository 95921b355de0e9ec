"""What is asked of neck and head where constraints or drivers aim them."""

import numpy as np
import pytest
from hangtime.bridge.rows.aimed_requests import require_unaimed
from hangtime.solver.data.faults import AimedBone
from hangtime.solver.data.recording import Bone
from hangtime.solver.data.requests import (
    ALWAYS,
    AngleLimit,
    ConeLimit,
    OrientationRequest,
    PointRequest,
    PoseRequest,
    Requests,
    TwistLimit,
)

BONES = tuple(
    Bone(name, parent, np.zeros(3), np.array([0.0, 0.0, 0.1]), np.eye(3))
    for parent, name in enumerate(("chest", "neck", "head", "hat"), start=-1)
)


@pytest.mark.parametrize(
    "asked",
    [
        Requests(points=(PointRequest("it", "head", ALWAYS),)),
        Requests(angles=(AngleLimit("it", "head", 0.0, 1.0),)),
        Requests(cones=(ConeLimit("it", "head", 0.3),)),
        Requests(twists=(TwistLimit("it", "head", 0.0, 1.0),)),
        Requests(orientations=(OrientationRequest("it", "head", ALWAYS),)),
        Requests(poses=(PoseRequest("it", ALWAYS, ("chest", "head")),)),
    ],
    ids=lambda asked: next(name for name, value in vars(asked).items() if value),
)
def test_it_is_refused_by_its_name(asked: Requests) -> None:
    with pytest.raises(AimedBone) as caught:
        require_unaimed(asked, ("neck", "head"), BONES)
    assert (caught.value.request, caught.value.bone) == ("it", "head")
    require_unaimed(asked, (), BONES)


def test_what_hangs_on_an_aimed_bone_is_refused_and_what_carries_it_is_not() -> None:
    def point(bone: str) -> Requests:
        return Requests(points=(PointRequest("it", bone, ALWAYS),))

    with pytest.raises(AimedBone):
        require_unaimed(point("hat"), ("head",), BONES)
    require_unaimed(point("neck"), ("head",), BONES)


def test_a_pose_of_the_whole_body_names_no_bone() -> None:
    require_unaimed(Requests(poses=(PoseRequest("it", ALWAYS),)), ("head",), BONES)
