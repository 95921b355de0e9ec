"""Rotations of a traced figure's bodies, from the positions of its joints: numpy only.

Traces know bones' ends but not how the bones are turned. A body that joins three or more joints
is turned as these are; one that joins two is taken not to twist against its parent. Limits that
are given in a parent's rest frame need that.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ....bridge.shapes.vectors import unit
from ....solver.arrays import FloatArray
from ....solver.body.human_limits import MIN_BEND_SINE

FLAT = 0.15  # joints whose second extent is a smaller share of the first lie on a line


@dataclass(frozen=True)
class TracedFigure:
    """A motion of a figure in its armature's space. B bodies, parents first, -1 for the root.

    frames: (T,). rest: (B, 3) heads in the rest pose. heads, tails: (T, B, 3).
    turns: (T, B, 3, 3) from rest to then.
    """

    frames: FloatArray
    bones: tuple[str, ...]
    parents: tuple[int, ...]
    rest: FloatArray
    heads: FloatArray
    tails: FloatArray
    turns: FloatArray

    def at(self, frame: float) -> int:
        """The instant nearest to a frame."""
        return int(np.abs(self.frames - frame).argmin())

    def during(self, first: float, last: float) -> slice:
        """The instants from frame to frame, at least one."""
        start = int(np.searchsorted(self.frames, first - 0.5))
        start = min(start, len(self.frames) - 1)
        return slice(start, max(int(np.searchsorted(self.frames, last + 0.5)), start + 1))

    @cached_property
    def along(self) -> FloatArray:
        """(B, 3) unit vectors along the bodies in the rest pose."""
        ahead = unit(self.tails - self.heads)
        return unit(np.einsum("tbji,tbj->bi", self.turns, ahead))

    @cached_property
    def leans(self) -> FloatArray:
        """(T, B, 3) unit vectors along the bodies in their parents' rest frames."""
        above = self.turns[:, [max(parent, 0) for parent in self.parents]]
        return np.asarray(np.einsum("tbji,tbj->tbi", above, unit(self.tails - self.heads)))

    def lean(self, body: int, first: float, last: float) -> FloatArray:
        """(3,) a body's mean direction from frame to frame in its parent's rest frame."""
        return unit(self.leans[self.during(first, last), body].mean(axis=0))

    @cached_property
    def flexion(self) -> FloatArray:
        """(B, 3) the ways joints bend, at right angles to their parents, in these' rest frames.

        NaN where a joint hardly bends.
        """
        straight = self.along[[max(parent, 0) for parent in self.parents]]
        ahead = unit(self.leans.mean(axis=0))
        bent = ahead - straight * (ahead * straight).sum(axis=1, keepdims=True)
        tells = np.linalg.norm(bent, axis=1, keepdims=True) > MIN_BEND_SINE
        return np.where(tells, unit(bent), np.nan)

    @cached_property
    def sideways(self) -> FloatArray:
        """(3,) from hip to hip in the rest pose: where the root's joints are farthest apart."""
        joints = self.rest[[i for i, parent in enumerate(self.parents) if parent == 0]]
        if len(joints) < 2:
            return np.array([1.0, 0.0, 0.0])
        apart = joints[:, None] - joints[None]
        return unit(apart.reshape(-1, 3)[np.linalg.norm(apart, axis=2).argmax()])

    def resting(self) -> TracedFigure:
        """The same figure in its rest pose, for one instant."""
        # a body without joints of its own is not known to turn: it lies along its parent's turn
        tips = self.along * np.linalg.norm(self.tails[0] - self.heads[0], axis=1, keepdims=True)
        turns = np.broadcast_to(np.eye(3), (1, len(self.bones), 3, 3))
        one = self.frames[:1], self.bones, self.parents, self.rest
        return TracedFigure(*one, self.rest[None], (self.rest + tips)[None], turns)


def body_turns(parents: tuple[int, ...], rest: FloatArray, heads: FloatArray) -> FloatArray:
    """(T, B, 3, 3) each body's rotation from the rest pose; see the module.

    rest: (B, 3) heads at rest. heads: (T, B, 3).
    """
    turns = np.empty((*heads.shape[:2], 3, 3))
    for body, parent in enumerate(parents):
        before = turns[:, parent] if parent >= 0 else np.broadcast_to(np.eye(3), (len(heads), 3, 3))
        joined = [i for i, up in enumerate(parents) if up == body]
        if not joined:
            turns[:, body] = before
            continue
        arms, now = rest[joined] - rest[body], heads[:, joined] - heads[:, [body]]
        if _spread(arms):
            turns[:, body] = _fitted(arms, now)
        else:
            farthest = int(np.linalg.norm(arms, axis=1).argmax())
            turns[:, body] = _swung(before, arms[farthest], now[:, farthest])
    return turns


def _spread(arms: FloatArray) -> bool:
    extents = np.linalg.svd(arms, compute_uv=False)
    return len(extents) > 1 and bool(extents[1] > FLAT * extents[0])


def _fitted(arms: FloatArray, now: FloatArray) -> FloatArray:
    """(T, 3, 3) the rotations that bring arms (K, 3) nearest to (T, K, 3) (Kabsch 1976)."""
    u, _, vt = np.linalg.svd(np.einsum("tki,kj->tij", now, arms))
    mirrored = np.linalg.det(u @ vt) < 0.0
    u[mirrored, :, 2] *= -1.0
    return np.asarray(u @ vt)


def _swung(before: FloatArray, arm: FloatArray, now: FloatArray) -> FloatArray:
    """(T, 3, 3) turns (T, 3, 3) followed by the shortest that brings an arm (3,) to (T, 3)."""
    a, b = unit(before @ arm), unit(now)
    return shortest(a, b) @ before


def shortest(a: FloatArray, b: FloatArray) -> FloatArray:
    """(..., 3, 3) the smallest rotations from unit vectors (..., 3) to others."""
    axis, dot = np.cross(a, b), np.einsum("...i,...i->...", a, b)
    skew = np.zeros((*axis.shape[:-1], 3, 3))
    skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0] = np.moveaxis(axis, -1, 0)
    skew -= np.swapaxes(skew, -1, -2)
    # opposite vectors have no smallest rotation; half a turn about anything across is as good
    near = np.maximum(1.0 + dot, 1e-9)[..., None, None]
    return np.asarray(np.eye(3) + skew + skew @ skew / near)


def posed(
    source: TracedFigure, instant: int, target: TracedFigure, then: int, chosen: tuple[int, ...]
) -> tuple[FloatArray, FloatArray]:
    """Heads and tails (N, 3) of bodies posed as the source is, hung where the target is.

    A body hangs on its parent: on the target's own where that is not among those chosen.
    """
    heads, tails = [], []
    tops: dict[int, int] = {}
    for body in chosen:
        parent = source.parents[body]
        tops[body] = tops.get(parent, body)
        top = tops[body]
        frame = max(source.parents[top], 0)
        turn = target.turns[then, frame] @ source.turns[instant, frame].T
        hook, from_ = target.heads[then, top], source.heads[instant, top]
        heads.append(hook + turn @ (source.heads[instant, body] - from_))
        tails.append(hook + turn @ (source.tails[instant, body] - from_))
    return np.array(heads).reshape(-1, 3), np.array(tails).reshape(-1, 3)
