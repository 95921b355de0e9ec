"""Model reduction: variance, rotations and sources as the libraries find them; legs that mirror."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.solver.analysis.performance import Performance, perform
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import Character, build_character
from hangtime.solver.body.joint_axes import JointAxes
from hangtime.solver.body.kinematics import forward_kinematics
from hangtime.solver.data.faults import (
    BadDimensions,
    DependentRows,
    UnknownReductionBone,
    WrongWeights,
)
from hangtime.solver.data.solver_options import Reduction, ReductionKind
from hangtime.solver.numerics.rotations import rotation_matrix
from hangtime.solver.optimisation.reduction import (
    LEG,
    ReducedSpace,
    fast_ica,
    oblimin,
    orthomax,
    principal_components,
    reduce,
    turning_axes,
)
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.toy_problems import figure
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.decomposition import PCA, FactorAnalysis, FastICA
from statsmodels.multivariate.factor_rotation import rotate_factors

JUMP = "forward_jump_116cm.bvh"
STATISTICAL = tuple(
    kind for kind in ReductionKind if kind not in (ReductionKind.MIRROR_LEGS, ReductionKind.MATRIX)
)
ROTATED = tuple(kind for kind in STATISTICAL if kind is not ReductionKind.PCA)
ACROSS = np.diag([-1.0, 1.0, 1.0])  # the toys' and the recordings' sagittal plane: left is +x

seeds = st.integers(0, 2**31)


@cache
def jump() -> Performance:
    recording = load_recording(JUMP).window(60.0, 330.0)
    return perform(recording, build_character(recording))


def reduced(
    kind: ReductionKind, dimensions: int | None = None, explained: float = 0.999
) -> ReducedSpace:
    request = Reduction(kind, dimensions, explained)
    return reduce(request, jump().character, jump().angles)


def samples(seed: int, n: int = 9, count: int = 400) -> np.ndarray:
    """(count, n) of three groups of three that go together, and some noise."""
    random = np.random.default_rng(seed)
    causes = random.normal(size=(count, 3)) * [3.0, 2.0, 1.5]
    mixing = np.kron(np.eye(3), np.array([[1.0, 0.8, -0.6]])) + 0.15 * random.normal(size=(3, n))
    return causes @ mixing + 0.1 * random.normal(size=(count, n))


def matched(found: np.ndarray, expected: np.ndarray) -> np.ndarray:
    """The columns of `found` in the order and with the signs of those of `expected`."""
    alike = found.T @ expected
    order = np.abs(alike).argmax(axis=0)
    assert sorted(order) == list(range(len(order)))
    return found[:, order] * np.sign(alike[order, np.arange(len(order))])


def varimax_criterion(L: np.ndarray) -> float:
    return float(np.var(L**2, axis=0).sum())


def off_span(basis: np.ndarray, within: np.ndarray) -> float:
    """Largest part of unit columns that lies outside the span of orthonormal ones."""
    return float(np.abs(basis - within @ (within.T @ basis)).max())


def test_eigenvalues_fall_and_sum_to_the_variance() -> None:
    space = reduced(ReductionKind.PCA)
    joints = jump().angles[:, 3:]
    assert (np.diff(space.eigenvalues) <= 0.0).all()
    assert space.eigenvalues[-1] >= 0.0
    assert space.eigenvalues.sum() == pytest.approx(joints.var(axis=0, ddof=1).sum())
    assert space.explained[-1] == pytest.approx(1.0)
    assert space.eigenvalues[5] < 0.05 * space.eigenvalues[0]  # a jump is of few movements


def test_components_are_those_of_scikit_learn() -> None:
    data = samples(1)
    values, vectors = principal_components(data)
    known = PCA().fit(data)
    assert values == pytest.approx(known.explained_variance_)
    assert matched(vectors, known.components_.T) == pytest.approx(known.components_.T, abs=1e-6)


@pytest.mark.parametrize("explained", [0.5, 0.95, 0.999])
def test_the_dimension_is_the_least_that_explains_enough(explained: float) -> None:
    space = reduced(ReductionKind.PCA, explained=explained)
    kept = space.basis.shape[1]
    joints = jump().angles[:, 3:] - jump().angles[:, 3:].mean(axis=0)
    lost = joints - joints @ space.basis @ space.basis.T
    assert 1.0 - (lost**2).sum() / (joints**2).sum() >= explained - 1e-9
    assert space.explained[kept - 1] >= explained > (space.explained[kept - 2] if kept > 1 else 0)


@pytest.mark.parametrize("kind", STATISTICAL)
def test_a_chosen_dimension_is_kept_and_spans_the_principal_components(
    kind: ReductionKind,
) -> None:
    space = reduced(kind, 12)
    assert space.kind is kind
    assert space.basis.shape == (jump().character.n_angles - 3, 12)
    assert np.linalg.matrix_rank(space.basis) == 12
    assert np.linalg.norm(space.basis, axis=0) == pytest.approx(np.ones(12))
    assert off_span(space.basis, reduced(ReductionKind.PCA, 12).basis) < 1e-9


@pytest.mark.parametrize("kind", STATISTICAL)
def test_full_rank_spans_everything(kind: ReductionKind) -> None:
    n = jump().character.n_angles - 3
    space = reduced(kind, n)
    assert space.eigenvalues[-1] < 1e-12  # although some joints of this jump never move
    change = np.random.default_rng(2).normal(size=n)
    z = np.linalg.solve(space.basis, change)
    assert space.basis @ z == pytest.approx(change, abs=1e-8)


@pytest.mark.parametrize(
    "kind", [ReductionKind.VARIMAX, ReductionKind.QUARTIMAX, ReductionKind.OBLIQUE]
)
def test_a_full_rotation_ends_at_the_joints_own_angles(kind: ReductionKind) -> None:
    """The thesis's trivial example (5.4.1)."""
    n = jump().character.n_angles - 3
    basis = reduced(kind, n).basis
    assert basis[np.argsort(basis.argmax(axis=1))] == pytest.approx(np.eye(n), abs=1e-6)


@pytest.mark.parametrize("kind", ROTATED)
def test_a_reduction_does_not_depend_on_chance(kind: ReductionKind) -> None:
    assert np.array_equal(reduced(kind, 8).basis, reduced(kind, 8).basis)


@pytest.mark.parametrize(
    "kind", [ReductionKind.VARIMAX, ReductionKind.QUARTIMAX, ReductionKind.OBLIQUE]
)
def test_rotated_coordinates_move_fewer_joints(kind: ReductionKind) -> None:
    def still(basis: np.ndarray) -> float:
        return float((np.abs(basis) < 0.05).mean())

    assert still(reduced(kind).basis) > 1.25 * still(reduced(ReductionKind.PCA).basis)


def test_varimax_raises_its_criterion_and_is_orthogonal() -> None:
    plain, turned = (reduced(k, 10).basis for k in (ReductionKind.PCA, ReductionKind.VARIMAX))
    assert varimax_criterion(turned) > 1.5 * varimax_criterion(plain)
    assert turned.T @ turned == pytest.approx(np.eye(10), abs=1e-9)


@settings(max_examples=15)
@given(seeds, st.sampled_from([0.0, 1.0]))
def test_orthomax_is_a_maximum(seed: int, gamma: float) -> None:
    random = np.random.default_rng(seed)
    L = orthomax(principal_components(samples(seed))[1][:, :3], gamma)

    def criterion(X: np.ndarray) -> float:
        return float((X**4).sum() - gamma / len(X) * ((X**2).sum(axis=0) ** 2).sum())

    for size in (1e-3, 0.05):
        turned = L @ rotation_matrix(size * random.normal(size=3))
        assert criterion(turned) < criterion(L) + 1e-12


@pytest.mark.parametrize(("name", "gamma"), [("varimax", 1.0), ("quartimax", 0.0)])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_orthogonal_rotations_are_those_of_scikit_learn(name: str, gamma: float, seed: int) -> None:
    data = samples(seed)
    loadings = FactorAnalysis(3, random_state=0).fit(data).components_.T
    expected = FactorAnalysis(3, random_state=0, rotation=name).fit(data).components_.T
    found = orthomax(loadings, gamma)
    assert np.abs(found - loadings).max() > 0.1  # there was something to turn
    assert matched(found, expected) == pytest.approx(expected, abs=2e-3)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_oblique_rotation_is_that_of_statsmodels(seed: int) -> None:
    loadings = orthomax(FactorAnalysis(3, random_state=0).fit(samples(seed)).components_.T, 1.0)
    expected, _ = rotate_factors(loadings, "oblimin", 0.0, "oblique")
    found = oblimin(loadings)
    assert np.abs(found - loadings).max() > 0.02
    assert matched(found, expected) == pytest.approx(expected, abs=2e-3)


def test_oblique_overlaps_less_than_any_orthogonal_rotation() -> None:
    def overlap(L: np.ndarray) -> float:
        shared = (L**2).T @ L**2
        return float(shared.sum() - np.trace(shared))

    plain = reduced(ReductionKind.PCA, 10).basis
    turned = orthomax(plain, 0.0)  # quartimax: the least that orthogonal columns can overlap
    skewed = oblimin(turned)
    assert overlap(turned) < 0.9 * overlap(plain)
    assert overlap(skewed) < 0.99 * overlap(turned)
    assert np.abs(skewed.T @ skewed - np.eye(10)).max() > 0.02  # no longer orthogonal


def mixed_sources() -> tuple[np.ndarray, np.ndarray]:
    """Two sources of unit variance (T, 2) and how they move the toy's six joint angles (6, 2)."""
    t = np.linspace(0.0, 60.0, 3000)
    sources = np.stack([np.sin(7.0 * t), np.sign(np.sin(11.0 * t + 0.3))], axis=1)
    sources = (sources - sources.mean(axis=0)) / sources.std(axis=0)
    mixing = np.array([[0.5, 0.1], [0.2, -0.4], [0.3, 0.3], [-0.1, 0.5], [0.0, 0.2], [0.4, 0.0]])
    return sources, mixing


def test_independent_components_part_mixed_sources() -> None:
    sources, mixing = mixed_sources()
    angles = np.concatenate([np.zeros((3000, 3)), sources @ mixing.T], axis=1)
    expected = mixing / np.linalg.norm(mixing, axis=0)
    basis = reduce(Reduction(ReductionKind.ICA, 2), figure(), angles).basis
    assert matched(basis, expected) == pytest.approx(expected, abs=0.02)
    components = reduce(Reduction(ReductionKind.PCA, 2), figure(), angles).basis
    assert np.abs(components.T @ expected).max() < 0.98  # which principal components do not


def test_independent_components_are_those_of_scikit_learn() -> None:
    white = PCA(3, whiten=True).fit_transform(samples(4) ** 3)
    known = FastICA(whiten=False, w_init=np.eye(3), tol=1e-12, max_iter=1000).fit(white)
    W = fast_ica(white)
    square = W @ W.T
    assert square == pytest.approx(np.eye(3), abs=1e-12)
    assert matched(W.T, known.components_.T) == pytest.approx(known.components_.T, abs=1e-4)


def mirrored_figure(turns: tuple[int, ...]) -> Character:
    """The toy with three angles at the hip and two at the knee, exactly mirrored.

    The right side's axes are turned about by half turns, so that other signs do the same:
    turns: of each joint, the axis (0, 1, 2) of the half turn, 3 none.
    """
    toy = figure()
    random = np.random.default_rng(11)
    joints, first = [toy.joints[0]], 3
    frames = rotation_matrix(random.normal(size=(4, 3)))
    for i, joint in enumerate(toy.joints[1:]):
        knee, right = i % 2, i >= 2
        before, after = frames[2 * knee], frames[2 * knee + 1]
        if right:
            half = rotation_matrix(np.pi * np.eye(4, 3)[turns[knee]])
            before, after = ACROSS @ before @ ACROSS @ half, half.T @ ACROSS @ after @ ACROSS
        dofs = 2 if knee else 3
        joints.append(replace(joint, axes=JointAxes(dofs, before, after), first=first))
        first += dofs
    return Character(toy.bodies, tuple(joints), toy.height)


def from_pelvis(character: Character, angles: np.ndarray) -> np.ndarray:
    """(B, 2, 3) joint centres and tips as the pelvis sees them."""
    posed = forward_kinematics(character, angles[None])
    tips = np.stack([body.tip for body in character.bodies])
    ends = posed.centres[0] + np.einsum("bij,bj->bi", posed.rotations[0], tips)
    places = np.stack([posed.centres[0], ends], axis=1) - posed.centres[0, 0]
    return places @ posed.rotations[0, 0]


@settings(max_examples=20)
@given(seeds, st.tuples(st.integers(0, 3), st.integers(0, 3)))
def test_mirrored_legs_move_as_mirror_images(seed: int, turns: tuple[int, int]) -> None:
    """Large changes too: here each right angle is a left one, but for its sign."""
    character = mirrored_figure(turns)
    straight = np.zeros((1, character.n_angles))
    basis = reduce(Reduction(ReductionKind.MIRROR_LEGS), character, straight).basis
    assert basis.shape == (10, 5)
    straight[0, 3:] = basis @ np.random.default_rng(seed).uniform(-1.5, 1.5, size=5)
    places = from_pelvis(character, straight[0])
    assert places[3:] == pytest.approx(places[1:3] @ ACROSS, abs=1e-9)


def test_mirrored_legs_of_a_recorded_figure_at_rest() -> None:
    """Its axes are the clip's, left and right chosen apart, so the images are not quite exact."""
    character = jump().character
    rest = np.concatenate([j.axes.angles(np.eye(3)[None]) for j in character.joints], axis=1)
    space = reduce(Reduction(ReductionKind.MIRROR_LEGS), character, rest)
    legs = [[character.body(part, side) for part in LEG] for side in (Side.LEFT, Side.RIGHT)]
    left = [k for body in legs[0] for k in range(*dofs_of(character, body))]
    assert space.basis.shape == (character.n_angles - 3, character.n_angles - 3 - len(left))
    random = np.random.default_rng(5)
    for _ in range(10):
        change = np.zeros(character.n_angles)
        change[left] = 0.03 * random.normal(size=len(left))
        z = np.linalg.lstsq(space.basis[np.array(left) - 3], change[left], rcond=None)[0]
        change[3:] = space.basis @ z
        moved = from_pelvis(character, rest[0] + change) - from_pelvis(character, rest[0])
        missed = moved[legs[1]] - moved[legs[0]] @ ACROSS
        assert np.linalg.norm(missed) < 0.15 * np.linalg.norm(moved[legs[0]])


def dofs_of(character: Character, body: int | None) -> tuple[int, int]:
    assert body is not None
    dofs = character.joints[body].dofs
    return dofs.start, dofs.stop


def test_mirrored_legs_turn_alike_over_a_clip() -> None:
    """Per joint, with every other joint free and as it was."""
    character, angles = jump().character, jump().angles
    basis = reduce(Reduction(ReductionKind.MIRROR_LEGS), character, angles).basis
    tied = np.abs(basis).sum(axis=0) > 1.0 + 1e-9
    for part in LEG:
        left, right = (character.body(part, side) for side in (Side.LEFT, Side.RIGHT))
        assert left is not None
        assert right is not None
        here, there = character.joints[left], character.joints[right]
        columns = np.abs(basis[here.first - 3 : here.dofs.stop - 3]).max(axis=0) > 0
        turned = turning_axes(here, angles) @ basis[here.first - 3 : here.dofs.stop - 3, columns]
        other = turning_axes(there, angles) @ basis[there.first - 3 : there.dofs.stop - 3, columns]
        assert columns.sum() == here.axes.dofs
        missed = np.linalg.norm(other + turned * np.diag(ACROSS)[:, None])
        assert missed < 0.5 * np.linalg.norm(turned)  # the wrong sign would be 2, no tie 1
    free = basis[:, ~tied]
    assert (np.abs(free).sum(axis=0) == 1.0).all()


def test_a_foot_with_more_angles_follows_the_other() -> None:
    toy = figure()
    knee = replace(toy.joints[2], axes=replace(toy.joints[2].axes, dofs=2))
    later = [replace(joint, first=joint.first + 1) for joint in toy.joints[3:]]
    character = Character(toy.bodies, (*toy.joints[:2], knee, *later), toy.height)
    straight = np.zeros((1, character.n_angles))
    basis = reduce(Reduction(ReductionKind.MIRROR_LEGS), character, straight).basis
    assert basis.shape == (7, 3)
    [column] = np.flatnonzero(basis[6])  # the right knee leads: its angle is the coordinate
    assert basis[6, column] == 1.0
    mirrored = -ACROSS @ toy.joints[4].axes.before[:, 0]
    own = knee.axes.before[:, :2]
    assert own @ basis[2:4, column] == pytest.approx(own @ own.T @ mirrored)


MATRIX = (
    (("left thigh", (1.0, 0.0)), ("right thigh", (-1.0, 0.0))),
    (("left thigh", (0.0, 1.0)), ("left shank", (0.5,))),
)


def written(*rows: tuple[tuple[str, tuple[float, ...]], ...]) -> ReducedSpace:
    request = Reduction(ReductionKind.MATRIX, matrix=rows)
    return reduce(request, figure(), np.random.default_rng(1).normal(size=(20, 9)))


def test_a_written_matrix_ties_what_it_names() -> None:
    basis = written(*MATRIX).basis
    assert basis.shape == (6, 3)
    assert basis[:, 0] == pytest.approx([1.0, 0.0, 0.0, -1.0, 0.0, 0.0])
    assert basis[:, 1] == pytest.approx([0.0, 1.0, 0.5, 0.0, 0.0, 0.0])
    assert basis[:, 2] == pytest.approx([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])  # right shank, unnamed


def test_an_empty_matrix_leaves_everything_free() -> None:
    assert np.array_equal(written().basis, np.eye(6))


@pytest.mark.parametrize("bone", ["tail", "trunk"])
def test_a_matrix_of_unknown_bones_is_refused(bone: str) -> None:
    """The trunk is the root here, which stays full."""
    with pytest.raises(UnknownReductionBone) as caught:
        written(MATRIX[0], ((bone, (1.0, 0.0, 0.0)),))
    assert (caught.value.row, caught.value.bone) == (2, bone)
    assert caught.value.known == ("left thigh", "left shank", "right thigh", "right shank")


def test_a_matrix_with_the_wrong_count_of_weights_is_refused() -> None:
    with pytest.raises(WrongWeights) as caught:
        written((("left shank", (1.0, 2.0)),))
    assert caught.value == WrongWeights(1, "left shank", 2, 1)


@pytest.mark.parametrize("extra", [MATRIX[0], (("right shank", (0.0,)),), ()])
def test_rows_that_add_nothing_are_refused(
    extra: tuple[tuple[str, tuple[float, ...]], ...],
) -> None:
    with pytest.raises(DependentRows) as caught:
        written(*MATRIX, extra)
    assert (caught.value.rows, caught.value.rank) == (3, 2)


@pytest.mark.parametrize("dimensions", [0, -1, 7])
def test_impossible_dimensions_are_refused(dimensions: int) -> None:
    angles = np.random.default_rng(1).normal(size=(20, 9))
    with pytest.raises(BadDimensions) as caught:
        reduce(Reduction(ReductionKind.PCA, dimensions), figure(), angles)
    assert caught.value == BadDimensions(dimensions, 6)


@pytest.mark.parametrize("kind", STATISTICAL)
def test_a_figure_that_stands_still_can_be_reduced(kind: ReductionKind) -> None:
    space = reduce(Reduction(kind), figure(), np.ones((5, 9)))
    assert np.isfinite(space.basis).all()
    assert space.basis.shape == (6, 1)


def test_the_legs_tied_are_all_of_a_leg() -> None:
    assert set(LEG) == {Part.THIGH, Part.SHANK, Part.FOOT, Part.TOE}
