"""Rotation matrices over time to the channels of Blender's rotation modes.

Every function takes proper rotations (T, 3, 3) and returns channels (T, n) that vary continuously,
so that interpolating between two frames never takes the long way round. Angles in rad.
"""

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.numerics.rotations import axis_rotation, rotation_matrix

EULER_ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")
_LOCKED = 1e-6  # cosine of the middle angle under which the outer two are told apart by noise only
_SHEARED = 1e-5  # above this a matrix is further from a rotation than by rounding


def proper(matrices: FloatArray) -> FloatArray:
    """Nearest proper rotation of each matrix (..., 3, 3): no scale, shear or mirroring."""
    size = np.linalg.norm(matrices, axis=(-2, -1), keepdims=True) / np.sqrt(3.0)
    unit = matrices / np.where(size > 0.0, size, 1.0)
    gram = np.swapaxes(unit, -1, -2) @ unit
    result: FloatArray = (
        1.5 * unit - 0.5 * unit @ gram
    )  # one step towards the nearest orthogonal matrix
    odd = (np.abs(gram - np.eye(3)).max((-1, -2)) > _SHEARED) | (np.linalg.det(unit) <= 0.0)
    if odd.any():
        u, _, vt = np.linalg.svd(unit[odd])
        u[..., -1] *= np.sign(np.linalg.det(u @ vt))[..., None]
        result[odd] = u @ vt
    return result


def channels(rotations: FloatArray, mode: str, near: FloatArray | None = None) -> FloatArray:
    """Channels of `rotations` (T, 3, 3) in Blender's rotation mode `mode`.

    near: the values that the first frame had before; the equivalent nearest to them is chosen.
    Returns (T, 4) quaternions wxyz, (T, 4) angle and axis, or (T, 3) Euler angles about X, Y, Z.
    """
    if mode == "QUATERNION":
        return quaternions(rotations, near)
    if mode == "AXIS_ANGLE":
        return axis_angles(rotations, near)
    return eulers(rotations, mode, near)


def rotations_of(values: FloatArray, mode: str) -> FloatArray:
    """Rotations (T, 3, 3) of channels (T, n) in Blender's rotation mode `mode`, as Blender reads
    them: quaternions and axes may have any length but zero."""
    if mode in EULER_ORDERS:
        first, second, third = (
            axis_rotation(axis, values[:, axis]) for axis in ("XYZ".index(c) for c in mode)
        )
        return np.asarray(third @ second @ first)
    if mode == "QUATERNION":
        q = _unit(values)
        return rotation_matrix(2.0 * np.arctan2(_length(q[:, 1:]), q[:, :1]) * _unit(q[:, 1:]))
    return rotation_matrix(values[:, :1] * _unit(values[:, 1:]))


def quaternions(rotations: FloatArray, near: FloatArray | None = None) -> FloatArray:
    """Unit quaternions wxyz (T, 4); neighbours never point apart."""
    m = rotations
    trace = np.trace(m, axis1=1, axis2=2)
    # k = 4 q qᵀ: any column is q up to scale; that of q's largest entry loses no digits.
    k = np.empty((len(m), 4, 4))
    k[:, 0, 0] = 1.0 + trace
    for i in range(3):
        j, n = (i + 1) % 3, (i + 2) % 3
        k[:, 0, i + 1] = k[:, i + 1, 0] = m[:, n, j] - m[:, j, n]
        k[:, i + 1, i + 1] = 1.0 + 2.0 * m[:, i, i] - trace
        k[:, i + 1, j + 1] = k[:, j + 1, i + 1] = m[:, j, i] + m[:, i, j]
    best = np.argmax(np.diagonal(k, axis1=1, axis2=2), axis=1)
    q = k[np.arange(len(m)), :, best]
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    return q * _running_sign(q, near)[:, None]


def axis_angles(rotations: FloatArray, near: FloatArray | None = None) -> FloatArray:
    """Angle and unit axis (T, 4), Blender's order; the axis holds where there is no rotation."""
    q = quaternions(rotations)
    length = np.linalg.norm(q[:, 1:], axis=1)
    turning = np.flatnonzero(length > _LOCKED)
    if len(turning) == 0:
        axis = np.array([0.0, 1.0, 0.0]) if near is None else _unit(near[1:])
        return np.column_stack([np.zeros(len(q)), np.tile(axis, (len(q), 1))])
    last_turning = np.searchsorted(turning, np.arange(len(q)), side="right") - 1
    axis = _unit(q[:, 1:])[turning[np.maximum(last_turning, 0)]]
    axis *= _running_sign(axis, None if near is None else near[1:])[:, None]
    angle = np.unwrap(2.0 * np.arctan2(np.einsum("ti,ti->t", q[:, 1:], axis), q[:, 0]))
    return np.column_stack([angle + _turns(angle[0], None if near is None else near[0]), axis])


def eulers(rotations: FloatArray, order: str, near: FloatArray | None = None) -> FloatArray:
    """Euler angles (T, 3) about X, Y, Z, applied in `order` (Blender's: the first letter first)."""
    i, j, k = ("XYZ".index(letter) for letter in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    middle = np.arcsin(np.clip(-sign * rotations[:, k, i], -1.0, 1.0))
    outer = np.stack(
        [
            np.arctan2(sign * rotations[:, k, j], rotations[:, k, k]),
            np.arctan2(sign * rotations[:, j, i], rotations[:, i, i]),
        ],
        axis=1,
    )
    wanted = None if near is None else near[[i, j, k]]
    innermost = _innermost(outer[:, 0], middle, outer[:, 1], wanted)
    # With the innermost angle given the other two follow without loss, locked or not.
    rest = rotations @ np.swapaxes(axis_rotation(i, innermost), 1, 2)
    angles = np.empty((len(rotations), 3))
    angles[:, i] = innermost
    angles[:, j] = np.unwrap(np.arctan2(-sign * rest[:, k, i], rest[:, k, k]))
    angles[:, k] = np.unwrap(np.arctan2(-sign * rest[:, i, j], rest[:, j, j]))
    return angles if near is None else angles + _turns(angles[0], near)


def _innermost(
    a: FloatArray, b: FloatArray, c: FloatArray, wanted: FloatArray | None
) -> FloatArray:
    """The innermost angle over time, of whichever of the two equivalent triples moves least.

    (a, b, c) and (a + π, π - b, c + π) turn alike. Which is nearer to its predecessor does not
    depend on which the predecessor took, so the choices are a running sum of changes.
    """
    free = np.flatnonzero(np.cos(b) > _LOCKED)
    if len(free) == 0:
        return np.full(len(a), 0.0 if wanted is None else wanted[0])
    first = np.column_stack([a, b, c])[free]
    second = np.column_stack([a + np.pi, np.pi - b, c + np.pi])[free]
    before = np.vstack([first[:1] if wanted is None else wanted[None], first[:-1]])
    changes = _distance(second, before) < _distance(first, before)
    angle = np.where(np.cumsum(changes) % 2, second[:, 0], first[:, 0])
    return np.interp(np.arange(len(a)), free, np.unwrap(angle))


def _distance(angles: FloatArray, others: FloatArray) -> FloatArray:
    return np.asarray(np.abs((angles - others + np.pi) % (2.0 * np.pi) - np.pi).sum(axis=1))


def _turns(angle: FloatArray, near: FloatArray | None) -> FloatArray | float:
    """The whole turns that bring `angle` nearest to `near`."""
    return 0.0 if near is None else 2.0 * np.pi * np.round((near - angle) / (2.0 * np.pi))


def _running_sign(vectors: FloatArray, near: FloatArray | None) -> FloatArray:
    """Signs (T,) that make each vector point along the one before (the first along `near`)."""
    before = np.vstack([vectors[:1] if near is None else near[None], vectors[:-1]])
    return np.cumprod(np.where(np.einsum("ti,ti->t", vectors, before) < 0.0, -1.0, 1.0))


def _length(vectors: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(vectors, axis=-1, keepdims=True))


def _unit(vectors: FloatArray) -> FloatArray:
    norms = _length(vectors)
    return np.asarray(vectors / np.where(norms > 0.0, norms, 1.0))
