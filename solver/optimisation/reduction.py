"""Model reduction: joint angles in a subspace, the root's in full (thesis 5).

An adaptation q differs from its fit by what a few coordinates z can do: q = q_fit + basis z. The
root keeps its angles. The basis comes from the performance (principal components, rotated so that
each moves few joints, or independent components) or from the artist (both legs alike, a matrix).
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..body.anatomy import Part, Side
from ..body.character import Character, Joint
from ..data.faults import BadDimensions, DependentRows, UnknownReductionBone, WrongWeights
from ..data.solver_options import Reduction, ReductionKind
from ..numerics.rotations import axis_rotation, unit

LEG = (Part.THIGH, Part.SHANK, Part.FOOT, Part.TOE)
MIN_VARIANCE_SHARE = 1e-8  # of the largest; directions of less have no sources to part
MAX_ROTATION_ITERATIONS = 1000
ROTATION_TOLERANCE = 1e-9


@dataclass(frozen=True)
class ReducedSpace:
    """Reduced coordinates: changes of the non-root angles are basis @ z.

    basis: (n_angles - 3, k), of full rank k. eigenvalues: (n_angles - 3,) rad², of the samples'
    covariance, falling. explained: (n_angles - 3,) share of the variance that the first so many
    principal components keep.
    """

    kind: ReductionKind
    basis: FloatArray
    eigenvalues: FloatArray
    explained: FloatArray


def reduce(reduction: Reduction, character: Character, angles: FloatArray) -> ReducedSpace:
    """Reduced space of a request, from samples (T, n_angles) rad of the performance (thesis 5).

    Legs tied and the artist's matrix have the dimensions that they have, whatever is asked.
    Raises BadDimensions, UnknownReductionBone, WrongWeights, DependentRows.
    """
    samples = angles[:, character.joints[0].dofs.stop :]
    eigenvalues, vectors = principal_components(samples)
    total = float(eigenvalues.sum())
    explained = np.cumsum(eigenvalues) / total if total > 0.0 else np.ones(len(eigenvalues))
    match reduction.kind:
        case ReductionKind.MIRROR_LEGS:
            basis = mirrored_legs(character, angles)
        case ReductionKind.MATRIX:
            basis = written_matrix(reduction, character)
        case _:
            count = _dimensions(reduction, explained)
            basis = _statistical(reduction.kind, samples, eigenvalues[:count], vectors[:, :count])
    return ReducedSpace(reduction.kind, basis, eigenvalues, explained)


def _dimensions(reduction: Reduction, explained: FloatArray) -> int:
    """As asked, or as the explained variance asks for. Raises BadDimensions."""
    most = len(explained)
    if reduction.dimensions is None:
        return min(int(np.searchsorted(explained, reduction.explained)) + 1, most)
    if not 1 <= reduction.dimensions <= most:
        raise BadDimensions(reduction.dimensions, most)
    return reduction.dimensions


def _statistical(
    kind: ReductionKind, samples: FloatArray, eigenvalues: FloatArray, vectors: FloatArray
) -> FloatArray:
    """(n, k) unit columns that span the eigenvectors (n, k), their largest entry positive.

    The eigenvectors themselves are rotated, not scaled by their deviations as a factor analyst
    would: only then does a full rotation end at the joints' own angles, as the thesis says (5.4.1).
    """
    match kind:
        case ReductionKind.VARIMAX:
            basis = orthomax(vectors, 1.0)
        case ReductionKind.QUARTIMAX:
            basis = orthomax(vectors, 0.0)
        case ReductionKind.OBLIQUE:
            basis = oblimin(orthomax(vectors, 1.0))
        case ReductionKind.ICA:
            basis = _independent(samples, eigenvalues, vectors)
        case _:
            basis = vectors
    largest = np.abs(basis).argmax(axis=0)
    return np.asarray(unit(basis.T).T * np.sign(basis[largest, np.arange(basis.shape[1])]))


def principal_components(samples: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Eigenvalues (n,), falling, and eigenvectors (n, n), columns, of the covariance of (T, n)."""
    about_mean = samples - samples.mean(axis=0)
    covariance = about_mean.T @ about_mean / max(len(samples) - 1, 1)
    values, vectors = np.linalg.eigh(covariance)
    return np.maximum(values[::-1], 0.0), vectors[:, ::-1]


def orthomax(loadings: FloatArray, gamma: float) -> FloatArray:
    """Orthomax rotation of (n, k) loadings: each column gets few large entries.

    gamma: 1 varimax (Kaiser 1958), 0 quartimax (Neuhaus & Wrigley 1954). Maximises
    sum L⁴ - gamma / n sum_j (sum_i L²)² by projecting its gradient (Jennrich 2001).
    """
    turn = np.eye(loadings.shape[1])
    for _ in range(MAX_ROTATION_ITERATIONS):
        L = loadings @ turn
        gradient = L**3 - gamma / len(L) * L * (L**2).sum(axis=0)
        u, _, vt = np.linalg.svd(loadings.T @ gradient)
        moved = np.abs(u @ vt - turn).max()
        turn = u @ vt
        if moved < ROTATION_TOLERANCE:
            break
    return np.asarray(loadings @ turn)


def oblimin(loadings: FloatArray) -> FloatArray:
    """Direct oblimin with delta 0, an oblique rotation (Jennrich & Sampson 1966): pattern (n, k).

    Minimises sum_{j != l} sum_i L_ij² L_il² over L = A T^-T with columns of T of length 1, by
    gradient projection (Jennrich 2002; Bernaards & Jennrich 2005).
    """
    T, step = np.eye(loadings.shape[1]), 1.0
    value, gradient, L = _overlap(loadings, T)
    for _ in range(MAX_ROTATION_ITERATIONS):
        along = gradient - T * (T * gradient).sum(axis=0)
        size = float((along**2).sum())
        if size < ROTATION_TOLERANCE**2:
            break
        step *= 2.0
        while True:
            X = T - step * along
            trial = X / np.linalg.norm(X, axis=0)
            new = _overlap(loadings, trial)
            if new[0] <= value - 0.5 * step * size or step < ROTATION_TOLERANCE:
                break
            step *= 0.5
        if new[0] >= value:
            break  # what is left is rounding
        T, (value, gradient, L) = trial, new
    return L


def _overlap(loadings: FloatArray, T: FloatArray) -> tuple[float, FloatArray, FloatArray]:
    """A quarter of the oblimin criterion, its derivative by T (k, k), and L (n, k)."""
    inverse = np.linalg.inv(T)
    L = loadings @ inverse.T
    others = (L**2).sum(axis=1, keepdims=True) - L**2
    return 0.25 * float((L**2 * others).sum()), -(L.T @ (L * others) @ inverse).T, L


def _independent(samples: FloatArray, eigenvalues: FloatArray, vectors: FloatArray) -> FloatArray:
    """Independent components: (n, k) mixing of the scores' sources on (n, k) eigenvectors.

    Directions in which the samples hardly vary have no sources; they stay as they are.
    """
    moving = (eigenvalues > MIN_VARIANCE_SHARE * eigenvalues[0]) & (eigenvalues > 0.0)
    deviations = np.sqrt(eigenvalues[moving])
    scores = (samples - samples.mean(axis=0)) @ vectors[:, moving] / deviations
    mixing = deviations[:, None] * fast_ica(scores).T
    return np.concatenate([vectors[:, moving] @ mixing, vectors[:, ~moving]], axis=1)


def fast_ica(white: FloatArray) -> FloatArray:
    """FastICA: orthogonal W (k, k); the sources of whitened scores (T, k) are white @ W.T.

    Symmetric fixed point with log cosh (Hyvärinen 1999). Where sources are too nearly Gaussian to
    be told apart it stops after a while: every orthogonal W spans the same.
    """
    count = white.shape[1]
    W = _orthogonal(np.random.default_rng(0).normal(size=(count, count)))
    for _ in range(MAX_ROTATION_ITERATIONS):
        g = np.tanh(white @ W.T)
        new = _orthogonal(g.T @ white / len(white) - (1.0 - g**2).mean(axis=0)[:, None] * W)
        moved = np.abs(np.abs((new * W).sum(axis=1)) - 1.0).max(initial=0.0)
        W = new
        if moved < ROTATION_TOLERANCE:
            break
    return W


def _orthogonal(W: FloatArray) -> FloatArray:
    """Nearest orthogonal matrix (polar factor) (W W^T)^-1/2 W of W (k, k)."""
    u, _, vt = np.linalg.svd(W)
    return np.asarray(u @ vt)


def mirrored_legs(character: Character, angles: FloatArray) -> FloatArray:
    """Basis (n_angles - 3, k) of legs mirrored in the sagittal plane; the rest is free.

    The joints' axes were chosen side by side from the clip, so which angle of the other leg does
    the same is found from where the axes point: a turn w (a rotation vector in the parent's frame)
    mirrors into 2 n (n . w) - w with the plane's normal n, and each joint of one leg follows the
    other's by least squares over the samples (T, n_angles). The joint with fewer angles leads.
    Taken for granted: at rest, one leg is the other's mirror image.
    """
    normal = _across(character)
    mirror = 2.0 * np.outer(normal, normal) - np.eye(3)
    basis = np.eye(character.n_angles)
    following: list[int] = []
    for part in LEG:
        pair = [character.body(part, side) for side in (Side.LEFT, Side.RIGHT)]
        joints = [character.joints[body] for body in pair if body is not None]
        if len(joints) < 2:
            continue
        lead, follow = sorted(joints, key=lambda joint: joint.axes.dofs)
        wanted = (mirror @ turning_axes(lead, angles)).reshape(-1, lead.axes.dofs)
        own = turning_axes(follow, angles).reshape(-1, follow.axes.dofs)
        basis[follow.dofs, lead.dofs] = np.linalg.lstsq(own, wanted, rcond=None)[0]
        following += range(follow.dofs.start, follow.dofs.stop)
    root = character.joints[0].dofs.stop
    return np.delete(basis, following, axis=1)[root:, root:]


def _across(character: Character) -> FloatArray:
    """(3,) normal of the sagittal plane: from the right hip to the left one at rest."""
    hips = []
    for side in (Side.LEFT, Side.RIGHT):
        thigh = character.body(Part.THIGH, side)
        assert thigh is not None  # no figure is built without thighs
        linearised = character.ancestors(thigh)  # at rest, every body's frame is the world's
        hips.append(np.sum([character.joints[body].offset for body in linearised], axis=0))
    return unit(hips[0] - hips[1])


def turning_axes(joint: Joint, angles: FloatArray) -> FloatArray:
    """(T, 3, dofs) rotation axes of a joint's angles, parent's frame; angles (T, n_angles) rad."""
    own = angles[:, joint.dofs]
    turn = np.broadcast_to(joint.axes.before, (len(own), 3, 3))
    columns = []
    for k in range(joint.axes.dofs):
        columns.append(turn[:, :, k])
        turn = turn @ axis_rotation(k, own[:, k])
    return np.stack(columns, axis=2)


def written_matrix(reduction: Reduction, character: Character) -> FloatArray:
    """Basis (n_angles - 3, k) with a column per row of the artist's matrix; other bones stay free.

    Raises UnknownReductionBone (the root's too: it stays full), WrongWeights, DependentRows.
    """
    joints = {
        body.bone: joint
        for body, joint in zip(character.bodies[1:], character.joints[1:], strict=True)
    }
    combined = np.zeros((character.n_angles, len(reduction.matrix)))
    free = np.ones(character.n_angles, dtype=bool)
    for i, row in enumerate(reduction.matrix):
        for bone, weights in row:
            if bone not in joints:
                raise UnknownReductionBone(i + 1, bone, tuple(joints))
            joint = joints[bone]
            if len(weights) != joint.axes.dofs:
                raise WrongWeights(i + 1, bone, len(weights), joint.axes.dofs)
            combined[joint.dofs, i] = weights
            free[joint.dofs] = False
    rank = int(np.linalg.matrix_rank(combined)) if len(reduction.matrix) else 0
    if rank < len(reduction.matrix):
        raise DependentRows(len(reduction.matrix), rank)
    root = character.joints[0].dofs.stop
    free[:root] = False
    return np.concatenate([combined, np.eye(character.n_angles)[:, free]], axis=1)[root:]
