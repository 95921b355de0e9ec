"""Keys fitted in windows: nearer to samples than before, on frames, and as Blender draws them."""

import numpy as np
import pytest
from hangtime.bridge.keys.bezier import AFTER, BEFORE, BezierKeys, curves
from hangtime.bridge.keys.hermite import fitted
from hangtime.bridge.keys.local_fits import FARTHEST, NEAREST, LocalFits
from hypothesis import given, settings
from hypothesis import strategies as st

FRAMES = np.arange(41.0)
AT = np.array([0.0, 9.0, 26.0, 40.0])


def keys(seed: int) -> BezierKeys:
    random = np.random.default_rng(seed)
    even = BezierKeys.even(AT, *random.normal(0.0, [[[1.0]], [[0.1]]], (2, 4, 3)))
    reach = random.uniform(NEAREST, FARTHEST, (4, 3, 2))
    return BezierKeys(AT, np.concatenate([even.parameters[..., :2], reach], axis=2))


def fits(start: BezierKeys, samples: np.ndarray) -> LocalFits:
    inner = np.array([[False, True, True, False]])
    free = np.repeat(inner[:, :, None], 4, axis=2)
    free[:, 0, AFTER] = free[:, -1, BEFORE] = True
    return LocalFits(
        start.frames[None],
        np.swapaxes(start.parameters, 0, 1)[None],
        free,
        inner,
        FRAMES[None],
        samples.T[None],
        np.full((1, samples.shape[1], len(FRAMES)), 100.0),
    )


@settings(max_examples=20)
@given(st.integers(0, 10_000))
def test_derivatives_are_those_of_the_curves(seed: int) -> None:
    own, step = keys(seed), 1e-6
    between = np.setdiff1d(FRAMES, AT)[None]
    parameters = np.swapaxes(own.parameters, 0, 1)[None]
    shown = curves(AT[None], parameters, between)
    by_keys, by_frames = shown.derivatives()
    for key in range(4):
        column = 4 * (key - shown.spans[0])
        near = (column == 0) | (column == 4)
        for each in range(4):
            ahead, back = parameters.copy(), parameters.copy()
            ahead[:, :, key, each] += step
            back[:, :, key, each] -= step
            change = [curves(AT[None], p, between).values for p in (ahead, back)]
            told = by_keys[column[near] + each, 0, :, np.flatnonzero(near)].T
            found = (change[0] - change[1])[0][:, near] / (2.0 * step)
            np.testing.assert_allclose(told, found, atol=1e-6)
        moved = [
            curves((AT + s * step * np.eye(4)[key])[None], parameters, between) for s in (1, -1)
        ]
        told = by_frames[column[near] // 4, 0, :, np.flatnonzero(near)].T
        found = (moved[0].values - moved[1].values)[0][:, near] / (2.0 * step)
        np.testing.assert_allclose(told, found, atol=1e-6)


@settings(max_examples=20)
@given(st.integers(0, 10_000))
def test_fits_are_nearer_than_with_handles_at_a_third(seed: int) -> None:
    samples = keys(seed).at(FRAMES)
    even = fitted(samples, FRAMES, AT)
    start = fits(even, samples)
    found = start.held(handles=False).improved(20)
    errors = [((each.shown.values - samples.T) ** 2).sum() for each in (start, found)]
    assert errors[1] <= errors[0]
    np.testing.assert_array_equal(found.at, start.at)
    reach = found.parameters[..., [BEFORE, AFTER]]
    assert (reach >= NEAREST).all()
    assert (reach <= FARTHEST).all()


def test_a_key_goes_to_where_a_motion_changes() -> None:
    jump = np.interp(FRAMES, [0.0, 13.0, 26.0, 40.0], [0.0, 0.0, 2.0, 2.0])[:, None]
    start = fits(fitted(jump, FRAMES, AT), jump)
    found = start.improved(20).on(FRAMES, start.at)
    assert abs(found.at[0, 1] - 13.0) < abs(AT[1] - 13.0)
    assert found.at[0, 1] in FRAMES
    assert found.at[0, [0, 3]].tolist() == [0.0, 40.0]


def test_keys_that_would_be_on_one_frame_stay_where_they_were() -> None:
    start = fits(keys(0), np.zeros((41, 3)))
    near = LocalFits(
        np.array([[0.0, 9.1, 9.2, 40.0]]),
        start.parameters,
        start.free,
        start.moves,
        start.frames,
        start.samples,
        start.weights,
    )
    assert near.on(FRAMES, AT[None]).at[0].tolist() == AT.tolist()


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_handles_at_a_third_let_time_run_evenly(share: float) -> None:
    line = BezierKeys.even(np.array([2.0, 8.0]), np.array([[1.0], [4.0]]), np.full((2, 1), 0.5))
    assert line.at(np.array([2.0 + 6.0 * share]))[0, 0] == pytest.approx(1.0 + 3.0 * share)
