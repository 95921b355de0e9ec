"""What is asked of neck and head where constraints or drivers aim them."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.bridge.rows.aimed_requests import apart_from_aimed, require_unaimed
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
    TorqueLimit,
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
        Requests(torques=(TorqueLimit("it", ("chest", "head"), 0.0),)),
        Requests(poses=(PoseRequest("it", ALWAYS, ("chest", "head")),)),
        Requests(poses=(PoseRequest("it", ALWAYS, ("head",), weight=1.0),)),
    ],
    ids=["point", "angle", "cone", "twist", "orientation", "torque", "held pose", "preferred pose"],
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


@pytest.mark.parametrize(
    "pose",
    [
        PoseRequest("it", ALWAYS),
        PoseRequest("it", ALWAYS, weight=1.0),
        PoseRequest("it", ALWAYS, ("chest", "head"), weight=1.0),
    ],
    ids=["held", "preferred", "preferred of some"],
)
def test_a_pose_of_other_bones_too_is_of_those_alone(pose: PoseRequest) -> None:
    asked = Requests(poses=(pose,))
    require_unaimed(asked, ("head",), BONES)
    (left,) = apart_from_aimed(asked, ("head",), BONES).poses
    assert left == replace(pose, apart=("head", "hat"))
    assert apart_from_aimed(asked, (), BONES) == asked


def test_a_pose_of_no_aimed_bone_stays() -> None:
    asked = Requests(poses=(PoseRequest("it", ALWAYS, ("chest",)),))
    assert apart_from_aimed(asked, ("head",), BONES) == asked
