"""Frames that are missing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...data.recording import Recording
from ..finding import Finding, FindingKind
from ..local_poses import spans
from ..repairs import MissingFrames, Repairs
from ..slack import SPARSE

# Missing frames of steps side by side.
SINGLE = tuple((count,) for count in range(1, 11))
COUNTS = (
    *SINGLE,
    *product((1, 2, 3), repeat=2),
    *product((1, 2), repeat=3),
)
BESIDE = 2  # steps on each side of these
ROUNDING = 1e-7  # m, of places in single precision; what is nearer to a cubic is on it
ALIKE = 0.4  # of a step, by which it may differ from its neighbours' way
TOO_FAR = 1.4  # times its usual step, which a joint makes twice and more where frames are missing
BODY = 0.5  # of the joints, that step too far; of one limb that whips round, or flips, fewer do


@dataclass(frozen=True)
class _Clear:
    """How clearly steps must lack frames. moving: m, their least; nearer: times, to a cubic with
    these frames; stands_out: times the median of how far those around are from one."""

    moving: float
    nearer: float
    stands_out: float


# Two that are missing, two apart, are 2.7 times nearer and more. In the mean of all joints their
# noise averages out: by half of that honest steps, also in noise, begin to seem to lack some.
OF_JOINTS = _Clear(moving=1e-3, nearer=2.2, stands_out=2.5)
OF_THEIR_MEAN = _Clear(moving=0.02, nearer=1.8, stands_out=1.8)
AS_FAR = 0.35  # of a step, by which it may differ from what lacks so many frames


def find_dropped(recording: Recording) -> Finding | None:
    """Steps of the whole body, one to three side by side, in which frames are missing. None is told
    of sparse frames."""
    if recording.rate < SPARSE:
        return None
    moves = np.diff(recording.heads.reshape(len(recording.frames), -1), axis=0)
    counts = np.zeros(len(recording.frames), int)  # before each frame
    for _, at, lacking in (  # the clearest first, and what noise hides from single joints last
        *_lacking(moves, COUNTS, OF_JOINTS),
        *_lacking_of_mean(moves),
    ):
        if not counts[at - 1 : at + len(lacking) + 1].any():  # nor are the steps beside too long
            counts[at : at + len(lacking)] = lacking
    after = np.flatnonzero(counts)
    if len(after) == 0:
        return None
    missing = tuple(MissingFrames(round(recording.frames[t - 1]), int(counts[t])) for t in after)
    return Finding(
        FindingKind.DROPPED_FRAMES,
        float(counts.sum()),
        "frames",
        spans(recording, counts > 0),
        remedy=Repairs(missing=missing),
    )


def _lacking(
    moves: FloatArray, counts: tuple[tuple[int, ...], ...], clear: _Clear
) -> list[tuple[float, int, tuple[int, ...]]]:
    """Where steps side by side may lack frames, the clearest first: how many times nearer to a
    cubic, the first frame after one, and the counts. moves: (T - 1, D) m, from a frame to the
    next."""
    sizes = {size for size in map(len, counts) if len(moves) >= _steps_of(size)}
    looked = {size: _Windows.of(moves, size, clear.moving) for size in sizes}
    found = (
        each
        for lacking in counts
        if len(lacking) in looked
        for each in looked[len(lacking)].lacking(lacking, clear)
    )
    return sorted(found, reverse=True)


def _lacking_of_mean(moves: FloatArray) -> list[tuple[float, int, tuple[int, ...]]]:
    """Likewise by the mean of all joints, where poses about it lack these frames rather than none,
    as they do in most jumps along the body's way."""
    by_joint = moves.reshape(len(moves), -1, 3)
    mean = by_joint.mean(axis=1)
    found = _lacking(mean, SINGLE, OF_THEIR_MEAN)
    if not found:
        return []
    poses = _Windows.of((by_joint - mean[:, None]).reshape(len(moves), -1), 1, 0.0)
    return [
        (nearer, at, (count,))
        for nearer, at, (count,) in found
        if poses.nearer((count,))[at - BESIDE - 1] > 1.0 and _goes_as_far(mean, at, count)
    ]


def _goes_as_far(mean: FloatArray, at: int, count: int) -> bool:
    """Whether the step to a frame is as long as one that lacks so many; noise may be nearest to a
    cubic with a gap of any length. mean: (T - 1, 3) m, of all joints."""
    usual = 0.5 * (mean[at - 2] + mean[at])
    times = float(mean[at - 1] @ usual / (usual @ usual))
    return abs(times / (count + 1) - 1.0) < AS_FAR


def _steps_of(several: int) -> int:
    """Steps of a window: several side by side, and those beside them."""
    return several + 2 * BESIDE


@dataclass(frozen=True)
class _Windows:
    """All windows, N, of joints' moves in which several steps side by side may lack frames.

    products: (S, S, N) m², of the moves of each window's steps with each other, over all joints.
    off: (N,) m, how far each is from a cubic as it is. alike: (N,) whether all of these steps go
    the way of those before and after them.
    """

    products: FloatArray
    off: FloatArray
    alike: BoolArray

    @staticmethod
    def of(moves: FloatArray, several: int, moving: float) -> _Windows:
        """moves: (T - 1, D) m, from a frame to the next. moving: m, least of the farthest of
        these."""
        steps = _steps_of(several)
        count = len(moves) - steps + 1
        products = np.empty((steps, steps, count))
        for apart in range(steps):  # the same two moves are in several windows
            own = np.einsum("td,td->t", moves[: len(moves) - apart], moves[apart:])
            for k in range(steps - apart):
                products[k, k + apart] = products[k + apart, k] = own[k : k + count]
        off = off_cubic(products, np.arange(steps + 1.0))
        return _Windows(products, off, _is_alike(moves, several, moving, count))

    def nearer(self, counts: tuple[int, ...]) -> FloatArray:
        """(N,) how many times nearer to a cubic joints are if the steps lack so many frames."""
        beside = np.ones(BESIDE)
        true = np.concatenate([[0.0], beside, np.array(counts) + 1.0, beside]).cumsum()
        return np.asarray(self.off / np.maximum(off_cubic(self.products, true), ROUNDING))

    def lacking(
        self, counts: tuple[int, ...], clear: _Clear
    ) -> Iterator[tuple[float, int, tuple[int, ...]]]:
        """Where joints are nearer to a cubic if the steps lack so many frames: how many times
        nearer, the first frame after one, and the counts."""
        ratio, size = self.nearer(counts), len(self.products) + 1
        for at in np.flatnonzero((ratio > clear.nearer) & self.alike).tolist():
            around = self.off[max(at - 2 * size, 0) : at + 2 * size + 1]  # most have none of these
            if self.off[at] > clear.stands_out * np.median(around):
                yield float(ratio[at]), at + BESIDE + 1, counts


def off_cubic(products: FloatArray, instants: FloatArray) -> FloatArray:
    """(N,) m, how far the places at instants (S + 1,) are from the nearest cubic, whose moves have
    these products (S, S, N): what is left is linear in the places, and no constant changes it."""
    basis, _ = np.linalg.qr(np.vander(instants - instants.mean(), 4), mode="complete")
    # Of a place all moves before it are a part: weights of moves are sums of those of places.
    weights = np.cumsum(basis[::-1, 4:], axis=0)[-2::-1]
    square = np.einsum("ij,ijn->n", weights @ weights.T, products)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)))


def _is_alike(moves: FloatArray, several: int, moving: float, count: int) -> BoolArray:
    """(count,) whether all of several steps, side by side after BESIDE others, go the way of those
    before and after them, as no jump does, these move, and most joints go too far by themselves.
    moves: (T - 1, D) m. moving: m, the least of the farthest coordinate."""
    by_joint = moves.reshape(len(moves), -1, 3)
    before, after = (by_joint[k : k + count] for k in (BESIDE - 1, BESIDE + several))
    alike = np.ones(count, bool)
    for k in range(several):
        own, share = by_joint[BESIDE + k : BESIDE + k + count], (k + 1) / (several + 1)
        usual = before + share * (after - before)
        squares, along = (np.einsum("tji,tji->tj", step, usual) for step in (usual, own))
        times = along.sum(axis=1) / np.maximum(squares.sum(axis=1), 1e-12)
        rest = np.linalg.norm(own - times[:, None, None] * usual, axis=(1, 2))
        alike &= rest < ALIKE * np.linalg.norm(own, axis=(1, 2))
        alike &= np.abs(usual).max(axis=(1, 2)) > moving
        alike &= (along > TOO_FAR * squares).mean(axis=1) >= BODY
    return alike
