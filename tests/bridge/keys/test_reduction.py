"""Reduced keys of figures: what they leave, how many they are, and what always gets one."""

import numpy as np
import pytest
from hangtime.bridge.keys.bezier import BezierKeys
from hangtime.bridge.keys.figure import KeyedBone, KeyedFigure
from hangtime.bridge.keys.reduction import errors_of, reduced, shared_columns
from hypothesis import given, settings
from hypothesis import strategies as st

FRAMES = np.arange(100.0)
LINK = 0.4  # m
ANGLE, DISTANCE = np.radians(0.2), 0.002


def chain(seed: int, bones: int = 3, fixed: tuple[float, ...] = ()) -> KeyedFigure:
    """A chain of links that turn about an axis across it, in a plane; its first one travels."""
    random = np.random.default_rng(seed)
    rates, phases = random.uniform(0.02, 0.15, (2, bones, 3))
    waves = 0.3 * np.sin(FRAMES[:, None, None] * rates + 40.0 * phases).sum(axis=2)
    turned = np.cumsum(waves, axis=1)
    links = LINK * np.stack([np.cos(turned), np.sin(turned), 0.0 * turned], axis=2)
    ends = np.cumsum(links, axis=1)
    heads = np.concatenate([np.zeros((len(FRAMES), 1, 3)), ends[:, :-1]], axis=1)
    turns = np.zeros((len(FRAMES), 3, 1))
    turns[:, 2] = 1.0
    return KeyedFigure(
        FRAMES,
        tuple(
            KeyedBone(f"{i}", waves[:, i : i + 1], turns, 0.0 * turns, heads[:, i], fixed)
            for i in range(bones)
        ),
        np.triu(np.ones((bones, bones), bool)),
        np.concatenate([heads, ends[:, -1:]], axis=1),
        np.array([*range(bones), bones - 1]),
        np.full((len(FRAMES), bones + 1), DISTANCE),
        ANGLE,
    )


def keys_of(figure: KeyedFigure) -> list[BezierKeys]:
    slices = reduced(figure)
    while True:
        try:
            next(slices)
        except StopIteration as end:
            return end.value


@settings(max_examples=4)
@given(st.integers(0, 10_000))
def test_the_error_is_kept_by_the_whole_chain_at_every_frame(seed: int) -> None:
    figure = chain(seed)
    keys = keys_of(figure)
    assert figure.worst(errors_of(figure, keys)).max() <= 1.0 + 1e-9
    # Not to first order only: the chain's end, and its last link's turn, as the channels have them.
    turned = np.cumsum(np.column_stack([own.at(FRAMES) for own in keys]), axis=1)
    ends = LINK * np.stack([np.cos(turned), np.sin(turned)], axis=2).sum(axis=1)
    apart = np.linalg.norm(ends - figure.points[:, -1, :2], axis=1)
    assert apart.max() <= 1.01 * DISTANCE
    exact = np.cumsum(np.column_stack([b.samples for b in figure.bones]), axis=1)
    assert np.abs(turned - exact).max() <= 1.001 * ANGLE


@settings(max_examples=3)
@given(st.integers(0, 10_000))
def test_keys_are_few_and_no_bone_has_more_than_the_shared_columns(seed: int) -> None:
    figure = chain(seed)
    most = len(shared_columns(figure))
    counts = [len(own.frames) for own in keys_of(figure)]
    assert max(counts) <= most < len(FRAMES) / 2
    assert min(counts) >= 2


def test_what_stands_still_has_two_keys() -> None:
    figure = chain(0)
    still = KeyedBone("still", 0.0 * FRAMES[:, None], *_of(figure))
    figure = KeyedFigure(
        FRAMES,
        (still,),
        np.ones((1, 1), bool),
        figure.points[:, :1],
        np.zeros(1, int),
        figure.distances[:, :1],
        ANGLE,
    )
    assert keys_of(figure)[0].frames.tolist() == [0.0, 99.0]


def _of(figure: KeyedFigure) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    first = figure.bones[0]
    return first.turns, first.shifts, first.head


@pytest.mark.parametrize("frame", [31.0, 57.0])
def test_fixed_frames_keep_their_keys(frame: float) -> None:
    assert all(frame in own.frames for own in keys_of(chain(1, fixed=(frame,))))


def test_a_point_that_may_move_less_gets_more_keys() -> None:
    figure = chain(2)
    strict = KeyedFigure(
        figure.frames,
        figure.bones,
        figure.carries,
        figure.points,
        figure.owners,
        0.1 * figure.distances,
        figure.angle,
    )
    keys = keys_of(strict)
    assert strict.worst(errors_of(strict, keys)).max() <= 1.0 + 1e-9
    assert sum(len(k.frames) for k in keys) > sum(len(k.frames) for k in keys_of(figure))
