"""Positions, Jacobians and speeds against finite differences and against the recording."""

from functools import cache

import numpy as np
import pytest
from hangtime.solver.analysis.performance import Performance, perform
from hangtime.solver.body.character import Character, build_character
from hangtime.solver.body.kinematics import BodyPoint, forward_kinematics
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.toy_problems import figure


@cache
def performance() -> Performance:
    recording = load_recording("forward_jump_116cm.bvh")
    first = float(recording.frames[0])
    recording = recording.window(first + 180, first + 230)
    return perform(recording, build_character(recording))


def points_on(character: Character, count: int = 6) -> tuple[BodyPoint, ...]:
    random = np.random.default_rng(3)
    bodies = random.integers(0, len(character.bodies), count)
    return tuple(BodyPoint(int(b), 0.3 * random.normal(size=3)) for b in bodies)


def human() -> Character:
    return performance().character


@pytest.mark.parametrize("make", [figure, human])
def test_point_jacobians(make: type) -> None:
    character = make()
    points = points_on(character)
    random = np.random.default_rng(8)
    q, d = random.normal(size=(2, 4, character.n_angles))
    step = 1e-6
    ahead, behind = (
        forward_kinematics(character, q + s * step * d).points(points) for s in (1.0, -1.0)
    )
    posed = forward_kinematics(character, q)
    ours = np.einsum("npij,nj->npi", posed.point_jacobian(points), d)
    assert ours == pytest.approx((ahead - behind) / (2.0 * step), abs=1e-7)
    assert posed.point_rates(points, d) == pytest.approx(ours, abs=1e-12)


@pytest.mark.parametrize("make", [figure, human])
def test_everything_is_relative_to_the_centre_of_mass(make: type) -> None:
    character = make()
    q = np.random.default_rng(9).normal(size=(5, character.n_angles))
    masses = np.array([b.mass for b in character.bodies])
    centre = np.einsum("b,nbi->ni", masses, forward_kinematics(character, q).body_coms)
    assert centre == pytest.approx(np.zeros((5, 3)), abs=1e-10)


@pytest.mark.parametrize("make", [figure, human])
def test_rotations_are_proper_and_bones_keep_their_lengths(make: type) -> None:
    character = make()
    posed = forward_kinematics(
        character, np.random.default_rng(10).normal(size=(5, character.n_angles))
    )
    R = posed.rotations
    unity = np.broadcast_to(np.eye(3), R.shape)
    assert R @ np.swapaxes(R, -1, -2) == pytest.approx(unity, abs=1e-12)
    for i, joint in enumerate(character.joints):
        if joint.parent >= 0:
            apart = posed.centres[:, i] - posed.centres[:, joint.parent]
            length = np.linalg.norm(joint.offset)
            assert np.linalg.norm(apart, axis=1) == pytest.approx(length, abs=1e-12)


def test_the_figure_follows_its_recording() -> None:
    seen = performance()
    posed = forward_kinematics(seen.character, seen.angles)
    off = np.linalg.norm(posed.centres + seen.com[:, None] - seen.centres, axis=-1)
    assert np.sqrt((off**2).mean()) < 0.01
    masses = np.array([b.mass for b in seen.character.bodies])
    local = np.stack([b.com for b in seen.character.bodies])
    coms = seen.centres + np.einsum("tbij,bj->tbi", seen.rotations, local)
    assert seen.com == pytest.approx(np.einsum("b,tbi->ti", masses / masses.sum(), coms))
