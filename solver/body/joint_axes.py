"""Gimbal-free joint axes: search for the axis pair that keeps the clip from gimbal lock.

Every joint turns by R = A Rx(a) Ry(b) Rz(c) B (fewer factors with fewer DOFs), with constant
frames A and B. Let u be the joint's first axis (fixed in the parent, A's first column) and w its
last (fixed in the child, B's third row). Then sin b = u . R w for every pose, so how near a clip
comes to gimbal lock depends on the two directions u and w alone, and the best pair can simply be
searched for. A somersault with twist, for example, finds u across the body's path and w along
the spine.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..numerics.rotations import (
    axis_rotation,
    mean_rotation,
    perpendicular,
    rotation_matrix,
    rotation_vector,
    unit,
)

MAX_MIDDLE_SINE = np.sin(
    np.radians(45.0)
)  # the preferred axes stand if the middle angle stays below
PRIOR_TURNS = (0.1, 0.05, -0.1, -0.05)  # rad, of the two expected axes in turn
CLEARLY = 0.9  # of the error of one pair of axes: another is no better than that by rounding
PRIOR_NOISE = 1e-6  # rad², likewise where both errors are nothing
MAX_ALTERNATIONS = 50
SETTLED = 1e-10  # rad, by which an axis still moves
ROUNDING = 1e-9  # of a sine, which computed otherwise is another


@dataclass(frozen=True)
class JointAxes:
    """Joint parametrisation R = before @ Rx(a) Ry(b) Rz(c) @ after, with `dofs` of the factors.

    before, after: (3, 3) constant rotations: joint frame to parent, child to joint frame.
    """

    dofs: int
    before: FloatArray
    after: FloatArray

    def rotation(self, angles: FloatArray) -> FloatArray:
        """(..., 3, 3) rotations, child to parent, of (..., dofs) joint angles in rad."""
        R = np.broadcast_to(self.before, (*angles.shape[:-1], 3, 3))
        for i in range(self.dofs):
            R = R @ axis_rotation(i, angles[..., i])
        return np.asarray(R @ self.after)

    def angles(self, R: FloatArray) -> FloatArray:
        """(T, dofs) joint angles, rad, of (T, 3, 3) rotations, unwrapped over time.

        What the joint cannot follow (with one or two DOFs) is left out.
        """
        # (3, 3, T): each entry's samples side by side, see rotations.py
        E = np.ascontiguousarray(np.moveaxis(self.before.T @ R @ self.after.T, 0, -1))
        if self.dofs == 3:
            a = np.arctan2(-E[1, 2], E[2, 2])
            b = np.arcsin(np.clip(E[0, 2], -1.0, 1.0))
            c = np.arctan2(-E[0, 1], E[0, 0])
            columns = [a, b, c]
        elif self.dofs == 2:
            b = np.arctan2(E[0, 2], E[0, 0])
            columns = [np.arctan2(E[2, 1], E[1, 1]), b]
        else:
            columns = [np.arctan2(E[2, 1] - E[1, 2], E[1, 1] + E[2, 2])]
        return np.unwrap(np.stack(columns, axis=1), axis=0)


def middle_sine(R: FloatArray, u: FloatArray, w: FloatArray) -> float:
    """Largest |sin| of the middle angle over (T, 3, 3) rotations; 1 is gimbal lock.

    u: (3,) first axis, in the parent. w: (3,) last axis, in the child.
    """
    return float(np.abs((R @ w) @ u).max())


def ball_axes(
    R: FloatArray,
    preferred: tuple[FloatArray, FloatArray] | None = None,
    frames: tuple[FloatArray, FloatArray] = (np.eye(3), np.eye(3)),
) -> JointAxes:
    """Ball joint: the axes farthest from gimbal lock over (T, 3, 3) rotations, child to parent.

    preferred: (u, w), taken if the middle angle stays below 45 degrees with it. frames: (3, 3)
    the figure's own directions as columns, as parent and child have them, so that the choice
    depends neither on where it faces nor on how it rests.
    """
    if preferred is not None and middle_sine(R, *preferred) < MAX_MIDDLE_SINE:
        u, w = preferred
    else:
        u, w = _search(R, *frames)
    mean = mean_rotation(R)
    along = mean @ w
    third = along - u * (u @ along)
    third = unit(third) if np.linalg.norm(third) > 1e-6 else perpendicular(u)
    before = np.stack([u, np.cross(third, u), third], axis=1)
    middle = axis_rotation(1, np.arcsin(np.clip(u @ along, -1.0, 1.0)))
    return JointAxes(3, before, (before @ middle).T @ mean)


def _search(R: FloatArray, parent: FloatArray, child: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The pair (u, w) of smallest `middle_sine`, by exhaustion over directions in two frames.

    A pair that some of the samples leave worse than all of them leave another is not looked at
    further.
    """
    sample = R[:: max(1, len(R) // 80)]
    first, last = (half_sphere(180) @ frame.T for frame in (parent, child))
    turned = np.einsum("tij,wj->twi", sample, last)
    some = np.zeros(len(sample), dtype=bool)
    some[::5] = True
    least = _middle_sines(first, turned[some])
    i, j = np.unravel_index(int(np.argmin(least)), least.shape)
    beyond = least > float(np.abs(turned[:, j] @ first[i]).max()) + ROUNDING
    rows, columns = (np.flatnonzero(~beyond.all(axis=axis)) for axis in (1, 0))
    rest = _middle_sines(first[rows], turned[~some][:, columns])
    worst = np.maximum(least[np.ix_(rows, columns)], rest)
    i, j = np.unravel_index(int(np.argmin(worst)), worst.shape)
    return first[rows[i]], last[columns[j]]


def _middle_sines(first: FloatArray, turned: FloatArray) -> FloatArray:
    """(U, W) `middle_sine` of first axes (U, 3) and last ones turned at T samples (T, W, 3)."""
    worst = np.zeros((len(first), turned.shape[1]))
    for block in turned:
        np.maximum(worst, np.abs(first @ block.T), out=worst)
    return worst


def half_sphere(count: int) -> FloatArray:
    """(count, 3) directions spread evenly over a half sphere (a Fibonacci spiral), poles first."""
    k = np.arange(count) + 0.5
    z = 1 - k / count
    turn = k * np.pi * (3 - np.sqrt(5))
    r = np.sqrt(1 - z**2)
    return np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)


def hinge_axes(R: FloatArray, expected: FloatArray) -> JointAxes:
    """Hinge joint about the principal axis of (T, 3, 3) rotations, child to parent.

    expected: (3,) the anatomical axis in the child's frame; it decides where the clip hardly bends.
    """
    mean = mean_rotation(R)
    turns = rotation_vector(np.swapaxes(mean[None], -1, -2) @ R)
    spread = turns.T @ turns / len(turns) + 0.05**2 * np.outer(expected, expected)
    axis = np.linalg.eigh(spread)[1][:, -1]
    axis = _towards(expected, axis)
    second = perpendicular(axis)
    after = np.stack([axis, second, np.cross(axis, second)])
    return JointAxes(1, mean @ after.T, after)


def universal_axes(R: FloatArray, expected: tuple[FloatArray, FloatArray]) -> JointAxes:
    """Universal joint (u fixed in the parent, v in the child) that best fits (T, 3, 3) rotations.

    R = A Rx Ry B holds exactly if u . R v = 0; the pair minimising the sum of squares is found by
    alternating eigenvectors. expected: the two anatomical axes in the child's frame, the one that
    turns further first, which decide where the clip hardly moves.
    """
    mean = mean_rotation(R)
    turns = np.array([s * axis for axis, s in zip(expected * 2, PRIOR_TURNS, strict=True)])
    prior = mean @ rotation_matrix(turns)
    poses = np.concatenate([R, prior])
    weight = np.concatenate([np.full(len(R), 1 / len(R)), np.full(len(prior), 0.1 / len(prior))])
    # The sum of squares is a form of u u' and v v'.
    form = np.einsum("t,tik,tjl->ijkl", weight, poses, poses, optimize=True).reshape(9, 9)
    best: tuple[float, FloatArray, FloatArray] | None = None
    for fixed, carried in (expected, expected[::-1]):
        u, v = mean @ fixed, carried
        for _ in range(MAX_ALTERNATIONS):
            was = v
            u = _smallest(form @ np.outer(v, v).ravel())
            v = _smallest(np.outer(u, u).ravel() @ form)
            if np.abs(_towards(was, v) - was).max() < SETTLED:
                break
        error = float(weight @ ((poses @ v) @ u) ** 2)
        if best is None or error < CLEARLY * best[0] - PRIOR_NOISE:
            best = (error, _towards(mean @ fixed, u), _towards(carried, v))
    assert best is not None
    _, u, v = best
    v_parent = mean @ v
    second = unit(v_parent - u * (u @ v_parent))
    before = np.stack([u, second, np.cross(u, second)], axis=1)
    E = before.T @ mean
    first_row = E[0] - v * (E[0] @ v)
    row = unit(first_row)
    after = np.stack([row, v, np.cross(row, v)])
    return JointAxes(2, before, after)


def _towards(expected: FloatArray, axis: FloatArray) -> FloatArray:
    """An axis (3,) in that of its two senses which is nearer to the expected one."""
    return axis if axis @ expected >= 0 else -axis


def _smallest(form: FloatArray) -> FloatArray:
    """(3,) eigenvector of the smallest eigenvalue of a symmetric form (9,)."""
    return np.asarray(np.linalg.eigh(form.reshape(3, 3))[1][:, 0])


def residual_angle(axes: JointAxes, R: FloatArray) -> float:
    """RMS angle, rad, between (T, 3, 3) rotations and the joint's nearest ones."""
    missed = np.swapaxes(axes.rotation(axes.angles(R)), -1, -2) @ R
    return float(np.sqrt((rotation_vector(missed) ** 2).sum(axis=-1).mean()))
