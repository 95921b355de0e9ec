"""Rotation matrices and rotation vectors, vectorised over leading axes. Angles in rad.

Results must not depend on where in memory arrays happen to lie, or two processes end in different
motions: iterations make a millimetre of a last bit. So sines, arctan2 and the like are taken of
samples that lie side by side. For samples with gaps between them (a column, an entry of every
matrix) numpy 1 has, on processors with AVX-512, two versions that round differently, and takes the
slow one where input and output seem to overlap: also where the output merely begins within a gap's
length of the input's end.
"""

import numpy as np

from ..arrays import FloatArray


def axis_rotation(axis: int, angle: FloatArray | float) -> FloatArray:
    """(..., 3, 3) elementary rotations by `angle` (...), rad, about coordinate axis 0, 1 or 2."""
    angle = np.array(angle, dtype=float, order="C")  # side by side: see above
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.zeros((*angle.shape, 3, 3))
    R[..., axis, axis] = 1.0
    R[..., i, i] = c
    R[..., j, j] = c
    R[..., i, j] = -s
    R[..., j, i] = s
    return R


def rotation_vector(R: FloatArray) -> FloatArray:
    """(..., 3) rotation vectors, rad, of (..., 3, 3) rotations: the logarithm, angle in [0, pi]."""
    return _logarithm(quaternion(R))


def turns_between(first: FloatArray, second: FloatArray) -> FloatArray:
    """(..., 3) rotation vectors, rad, of first^T second: from one unit quaternion (..., 4) to
    another, in the first's frame, angle in [0, pi]."""
    (w, v), (to_w, to_v) = ((q[..., :1], q[..., 1:]) for q in (first, second))
    cosine = w * to_w + np.sum(v * to_v, axis=-1, keepdims=True)
    turned = np.concatenate([cosine, w * to_v - to_w * v - np.cross(v, to_v)], axis=-1)
    return _logarithm(np.where(cosine < 0, -turned, turned))


def _logarithm(q: FloatArray) -> FloatArray:
    """(..., 3) rotation vectors, rad, of unit quaternions (..., 4), w not below 0."""
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2 * np.arctan2(sine, q[..., :1])
    scale = np.where(sine > 1e-9, angle / np.maximum(sine, 1e-12), 2.0)
    return np.asarray(scale * q[..., 1:])


def quaternion(R: FloatArray) -> FloatArray:
    """(..., 4) unit quaternions w, x, y, z of (..., 3, 3) rotations, w not below 0.

    From the largest component (Shepperd 1978).
    """
    # The largest component keeps this safe at every angle, pi included.
    trace = np.trace(R, axis1=-2, axis2=-1)
    diagonal = np.diagonal(R, axis1=-2, axis2=-1)
    q = np.empty((*R.shape[:-2], 4, 4))
    q[..., 0, 0] = 1 + trace
    skew = np.stack(
        [R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]],
        axis=-1,
    )
    q[..., 0, 1:] = skew
    q[..., 1:, 0] = skew
    q[..., 1:, 1:] = R + np.swapaxes(R, -1, -2)
    for i in range(3):
        q[..., i + 1, i + 1] = 1 - trace + 2 * diagonal[..., i]
    best = np.argmax(np.diagonal(q, axis1=-2, axis2=-1), axis=-1)
    quat = np.take_along_axis(q, best[..., None, None], axis=-2)[..., 0, :]
    quat = quat / np.linalg.norm(quat, axis=-1, keepdims=True)
    return np.where(quat[..., :1] < 0, -quat, quat)


def angles_between(first: FloatArray, second: FloatArray) -> FloatArray:
    """(...) rad, from one rotation (..., 3, 3) to another."""
    # The chord of a turn by a is 2 sin(a / 2), and a matrix's norm is that times sqrt(2).
    chords = np.linalg.norm(first - second, axis=(-2, -1)) / np.sqrt(8.0)
    return np.asarray(2.0 * np.arcsin(np.minimum(chords, 1.0)))


def rotation_matrix(vector: FloatArray) -> FloatArray:
    """(..., 3, 3) rotations of (..., 3) rotation vectors, rad: the exponential (Rodrigues)."""
    vector = np.asarray(vector, dtype=float)
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    K = cross_matrix(vector)
    a = np.sinc(angle / np.pi)
    b = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    return np.asarray(np.eye(3) + a * K + b * (K @ K))


def shortest_rotation(start: FloatArray, end: FloatArray) -> FloatArray:
    """(3, 3) the shortest rotation between two unit vectors (3,) that are not opposite."""
    axis = np.cross(start, end)
    angle = np.arctan2(np.linalg.norm(axis), start @ end)
    return rotation_matrix(axis * angle / max(float(np.linalg.norm(axis)), 1e-9))


def cross_matrix(v: FloatArray) -> FloatArray:
    """(..., 3, 3) skew-symmetric matrices of v (..., 3): cross_matrix(v) @ w = v x w."""
    v = np.asarray(v, dtype=float)
    K = np.zeros((*v.shape[:-1], 3, 3))
    K[..., 0, 1], K[..., 0, 2] = -v[..., 2], v[..., 1]
    K[..., 1, 0], K[..., 1, 2] = v[..., 2], -v[..., 0]
    K[..., 2, 0], K[..., 2, 1] = -v[..., 1], v[..., 0]
    return K


def mean_rotation(R: FloatArray) -> FloatArray:
    """(3, 3) chordal mean of (T, 3, 3) rotations: the projection of their average onto SO(3)."""
    u, _, vt = np.linalg.svd(R.mean(axis=0))
    return np.asarray(u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt)


def planar_turn(a: FloatArray, b: FloatArray) -> FloatArray:
    """(...) rad, the turn about the vertical that takes points a (..., N, 3), about their middle,
    nearest to b (..., N, 3), about theirs: planar Kabsch."""
    across = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    along = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]
    return np.asarray(np.arctan2(across.sum(axis=-1), along.sum(axis=-1)))


def unit(v: FloatArray) -> FloatArray:
    """(..., 3) vectors normalised to length 1; NaN for zero."""
    return np.asarray(v / np.linalg.norm(v, axis=-1, keepdims=True))


def perpendicular(v: FloatArray) -> FloatArray:
    """(3,) a unit vector orthogonal to the unit vector v (3,)."""
    other = np.eye(3)[int(np.argmin(np.abs(v)))]
    return unit(np.cross(v, other))
