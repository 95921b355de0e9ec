"""Controls such that bodies are where they should be, frame by frame: Levenberg-Marquardt on what
the rig does, measured by trying, so that whatever lies between controls and bodies counts.

Controls may do the same by each other's opposite turns, and a straight limb needs nothing of its
pole. So what controls are beside the take counts a little (Tikhonov's regularisation, with the take
as the reference: Engl, Hanke and Neubauer, Regularization of Inverse Problems, 1996, chapter 5).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.numerics.rotations import rotation_vector
from ..armature.channels import proper
from .followed import FAINT, Influences
from .leading import led_by, moved_by, movers, ranks
from .needed import LEVER
from .offsets import SIZE, changed, difference, offsets_of, places_of, with_offsets
from .posing import Posed, Posing
from .responses import Columns, Freedom, Responses, apart, measured
from .targets import Targets, move_of_pelvis, moved_bases

STEPS = 30
NEAR = 2e-6  # m, beside LEVER times rad: steps that gain less end a frame, as do
# Likewise those that gain a smaller share of an error that is left, as it cannot be met: the most
# that they would still gain is hundredths of a mm, and a tenth of that takes thrice as many looks.
LITTLE = 0.01
STILL = 2e-5  # m, beside LEVER times rad, that a body must be to move by in a step
# Share of the error that a step may leave, and steps in a row that leave more, after which the rig
# is tried anew: each step tells what the rig does as well, in its own direction.
SLOW, SLOW_STEPS = 0.25, 3
# Of the squares of a dof's effect; Nielsen, Damping Parameter in Marquardt's Method (1999).
DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-4, 1e-5, 1.0
LESS, MORE = 5.0, 6.0  # by which damping goes down after a gain, and up after none
LONGEST, MOST = 0.5, 0.1  # rad of one step, and change of size
# m of error above which a frame is solved from other starts as well: above the first too, where it
# is as many times what the frame before was left with, for what a rig cannot do it cannot for long.
SUSPECT, LOST = 0.002, 0.005
MORE_LEFT = 1.5
SAME, AGREEING = 1e-3, 2  # share of the cost, and other starts that lead there: it is the least
# m of error up to which what was tried before is good enough to end by: it is off by the share by
# which the rig answers otherwise here, some hundredths, of an error that is small itself.
SLIGHT = 0.002
HARDLY, IDLE_STEPS = 0.03, 2  # share of such an error, and steps that gain less, to end by
FAR = 0.1  # m of error at the first guess, above which controls are put beside their bodies
# m of error that a control's turn by 1 rad, or shift by 1 m, beside the take counts: what bodies
# need of it they get within some hundredths of a mm, and what they do not need is left.
BESIDE = 0.002
FINE = 2e-4  # m of error; what bodies gain below, and controls then, counts as beside so much
SIZES = 0.002  # m of error that a doubled size counts: where a limb is straight it does nothing


@dataclass(frozen=True)
class Inverted:
    """Pose bases (C, 4, 4) of controls at a frame, and what is left: by body m and rad (B,)."""

    bases: FloatArray
    off: FloatArray
    turned: FloatArray


@dataclass(frozen=True)
class _Look:
    """What controls do at pose bases (C, 4, 4). error: (6 B + 7 C,): heads in m and turns
    times LEVER that bodies lack, in the armature's axes; then what controls lack of the reference,
    weighted."""

    bases: FloatArray
    posed: Posed
    error: FloatArray

    @property
    def cost(self) -> float:
        """Size of all of the error, m: what is least at the solution."""
        return float(np.linalg.norm(self.error))

    @property
    def size(self) -> float:
        """Of what bodies lack, m."""
        return float(np.linalg.norm(self.error[: 6 * len(self.posed.bodies)]))

    @property
    def by_body(self) -> FloatArray:
        """(2, B) m, of the error: by how much heads and turns are off, these times LEVER."""
        lacks = self.error[: 6 * len(self.posed.bodies)].reshape(2, -1, 3)
        return np.asarray(np.linalg.norm(lacks, axis=2))


def _enough(beside: float) -> float:
    """Error, m, that a frame may be left with beside one that was left with so much."""
    return min(max(SUSPECT, MORE_LEFT * beside), LOST)


def _inverted(found: _Look) -> Inverted:
    off, turned = found.by_body
    return Inverted(found.bases, off, turned / LEVER)


class Inverse:
    """Solves frames one after the other; each begins with what the one before needed."""

    def __init__(
        self,
        posing: Posing,
        responses: Responses,
        targets: Targets,
        carriers: Collection[str],
        moving: Mapping[bytes, BoolArray],
    ) -> None:
        self._posing, self._targets = posing, targets
        self._carries = np.array([name in carriers for name in posing.controls])
        self._every, self._moving = responses, moving
        self._use(responses, responses)
        self._offsets = np.zeros((len(posing.controls), 7))
        self._change = np.zeros_like(self._offsets)  # of the offsets at the last frame
        self._influences = Influences(posing.armature)
        self._acted: BoolArray | None = None
        self._felt = np.ones(len(posing.controls), dtype=bool)
        self._met: Posed | None = None  # at the last frame that was met
        self._left = 0.0  # m of error, at the last frame
        # Offsets and m of error at each frame, by index; what is seen there would be much more.
        self._needed: dict[int, tuple[FloatArray, float]] = {}
        self._reference = np.zeros_like(self._offsets)
        self._weights = np.zeros_like(self._offsets)
        self._as_taken = False  # whether the bodies but go along with the pelvis at a frame
        self.tries = 0

    def _use(self, known: Responses, now: Responses) -> None:
        """Controls that are used from here on: what they may move, and what they do."""
        self._groups, self._ranks = apart(known), ranks(known)
        self._responses = now

    def solve(self, t: int) -> Inverted:
        """Solve the frame of index t: from what the one before needed, or from that changed once
        more as it was changed there, whichever is nearer, and where both are far off with controls
        beside their bodies as they were there; where that leads nowhere, from others."""
        animated = self._begun(t)
        starts = [self._offsets, changed(self._offsets, self._change)]
        starts += [self._reference] * self._as_taken
        looks = [self._look(animated, start, t) for start in starts]
        nearest = int(np.argmin([look.cost for look in looks]))
        start, look = starts[nearest], looks[nearest]
        if look.size > FAR and self._met is not None:
            every = np.ones(len(self._met.bodies), dtype=bool)
            beside = self._beside(animated, start, t, every, self._met)
            then = self._look(animated, beside, t)
            start, look = (beside, then) if then.cost < look.cost else (start, look)
        offsets, best = self._solved(animated, start, look, t)
        enough, agreeing = _enough(self._left), 0
        for start in self._other_starts(animated, offsets, best, t):
            if best.size <= enough or agreeing == AGREEING:
                break
            other = self._solved(animated, start, self._look(animated, start, t), t)
            agree = abs(other[1].cost - best.cost) < SAME * best.cost
            agreeing = agreeing + 1 if agree else agreeing * (other[1].cost > best.cost)
            if other[1].cost < best.cost:
                offsets, best = other
        met = best.size < LOST
        self._change = difference(self._offsets, offsets) if met else np.zeros_like(offsets)
        self._met, self._left = best.posed if met else self._met, best.size
        self._offsets = offsets
        self._needed[t] = offsets, best.size
        return _inverted(best)

    def _begun(self, t: int) -> FloatArray:
        """The bases (C, 4, 4) of the take at the frame of index t, which is shown then: the
        reference, but for the carriers, which go along with the pelvis."""
        self._posing.go_to(float(self._targets.frames[t]))
        animated, shown = self._posing.bases(), self._posing.look()
        felt = self._try_where_switched(animated)
        move = move_of_pelvis(shown, self._targets, t)
        moved = move @ shown.bodies
        lacks = self._lacks(moved[:, :3, 3], proper(moved[:, :3, :3]), t)
        self._as_taken = bool(np.linalg.norm(lacks) < SUSPECT)
        carried = offsets_of(animated, moved_bases(shown, move))
        self._reference = np.where((self._carries & felt)[:, None], carried, 0.0)
        self._weights = np.zeros_like(self._reference)
        lengths = {Freedom.SHIFT: self._targets.unit[t], Freedom.SIZE: SIZES / BESIDE}
        each = np.array([lengths.get(dof.freedom, 1.0) for dof in self._responses.dofs])
        places = places_of(self._responses.dofs)
        self._weights[places] = BESIDE * each
        return animated

    def unmet(self) -> list[int]:
        """Indices of the frames that were left with more than the next one, the last one first."""
        left = {t: size for t, (_, size) in self._needed.items()}
        lost = (t for t in left if t + 1 in left and left[t] > _enough(left[t + 1]))
        return sorted(lost, reverse=True)

    def solve_again(self, t: int) -> Inverted | None:
        """Solve the frame of index t, which was not met, once more from what the next one needed,
        and from there with all controls beside their bodies as then: where a limb is straight, what
        was before does not tell which way it bends afterwards. None where that is no nearer, or
        where that one is left with about as much."""
        after, left = self._needed[t + 1]
        if self._needed[t][1] <= MORE_LEFT * left:
            return None
        self._posing.go_to(float(self._targets.frames[t + 1]))
        then = self._look(self._posing.bases(), after, t + 1).posed
        animated = self._begun(t)
        after = np.where(self._felt[:, None], after, 0.0)
        every = np.ones(len(then.bodies), dtype=bool)
        starts = after, self._beside(animated, after, t, every, then)
        looks = [self._look(animated, start, t) for start in starts]
        found = [self._solved(animated, *each, t) for each in zip(starts, looks, strict=True)]
        offsets, best = min(found, key=lambda each: each[1].cost)
        if best.size >= self._needed[t][1]:
            return None
        self._needed[t] = offsets, best.size
        return _inverted(best)

    def _other_starts(
        self, animated: FloatArray, offsets: FloatArray, found: _Look, t: int
    ) -> Iterator[FloatArray]:
        """Offsets to begin with where those (C, 7) that were found miss: with the controls that
        move what is off beside their bodies, as at the last frame that was met; with all controls
        beside their bodies, as in the take, and as then; and none."""
        off, take = found.by_body.max(axis=0) > SUSPECT, np.zeros_like(offsets)
        taken, every = self._look(animated, take, t).posed, np.ones_like(off)
        met = self._met or taken
        yield self._beside(animated, offsets, t, off, met)
        yield self._beside(animated, self._offsets, t, every, taken)
        if found.size > LOST:
            yield self._beside(animated, self._offsets, t, every, met)
            yield take

    def _beside(
        self, animated: FloatArray, offsets: FloatArray, t: int, bodies: BoolArray, seen: Posed
    ) -> FloatArray:
        """Offsets with each control which can be shifted, and moves one of the bodies (B,), beside
        the body that it leads, as it is seen there: a straight limb says of no small change which
        way its pole is to go, nor, where its end is out of reach, that this is to come nearer."""
        wanted, offsets = self._targets, offsets.copy()
        dofs = self._responses.dofs
        for rank in self._ranks:
            moving = [c for c in rank if (moved_by(self._responses, c) & bodies).any()]
            led = [(c, led_by(self._responses, c)) for c in moving]
            posed = self._look(animated, offsets, t).posed if led else seen
            for control, body in led:
                if body is None:
                    continue
                frame = posed.frames[control]
                turn = wanted.rotations[t, body] @ proper(seen.bodies[body, :3, :3]).T
                arm = seen.controls[control, :3, 3] - seen.bodies[body, :3, 3]
                there = np.append(wanted.heads[t, body] + turn @ arm, 1.0)
                place = np.linalg.solve(posed.places[control], there)
                offsets[control, 3:6] = place[:3] - animated[control, :3, 3]
                if any(dof.control == control and dof.freedom is Freedom.TURN for dof in dofs):
                    turned = proper(frame[:3, :3]).T @ turn @ proper(seen.controls[control, :3, :3])
                    offsets[control, :3] = rotation_vector(
                        proper(animated[control, :3, :3]).T @ turned
                    )
        return offsets

    def _try_where_switched(self, animated: FloatArray) -> BoolArray:
        """At the first frame, and where other constraints act than before and so other controls do:
        try them anew, and leave to the take those that do nothing as long as these act, here or
        where the rig was looked at. (C,) which do something."""
        acts = self._influences.now() > FAINT
        if self._acted is None or (acts != self._acted).any():
            groups = apart(self._every)
            now = measured(self._posing, animated, groups)
            self.tries += len(groups)
            felt = movers(now) | self._moving.get(acts.tobytes(), False)
            # Where none does anything, such as while a rig follows another, all are solved for:
            # they stay as they are, and what bodies lack is told.
            used = felt if felt.any() else np.ones_like(felt)
            self._use(self._every.of_controls(used), now.of_controls(used))
            self._offsets[~felt] = 0.0
            self._change = np.zeros_like(self._offsets)
            self._felt = felt
        self._acted = acts
        return self._felt

    def _solved(
        self, animated: FloatArray, offsets: FloatArray, best: _Look, t: int
    ) -> tuple[FloatArray, _Look]:
        """Offsets from the animated bases, from a first guess, and what they do. best: what that
        does."""
        fresh, damping, slow, idle = False, DAMPING, 0, 0
        for _ in range(STEPS):
            size = max(best.size, FINE)
            columns = self._responses.columns(best.posed, best.bases)
            moved, step, reach = self._stepped(offsets, best.error, columns, t, damping)
            if (fresh or best.size < SLIGHT) and reach < STILL:
                break
            after = self._look(animated, moved, t)
            self._responses = self._responses.corrected(columns, best.posed, step, after.posed)
            left = after.size
            gained = (best.cost**2 - after.cost**2) / (2.0 * size)
            nearer = gained > 0.0
            if nearer:
                offsets, best = moved, after
            done = gained < max(NEAR, LITTLE * size) if nearer else damping > MOST_DAMPING
            slight = best.size < SLIGHT
            idle = idle + 1 if gained < HARDLY * size else 0
            ended = done or left < NEAR
            if (fresh and ended) or (slight and (ended or idle >= IDLE_STEPS)):
                break
            slow = slow + 1 if left > SLOW * size else 0
            anew = (slow >= SLOW_STEPS or done) and not slight and (nearer or not fresh)
            damping = max(damping / LESS, LEAST_DAMPING) if nearer else MORE * damping
            if anew:
                slow, self._responses = 0, measured(self._posing, best.bases, self._groups)
                self.tries += len(self._groups)
            fresh = anew or (fresh and not nearer)
        return offsets, best

    def _look(self, animated: FloatArray, offsets: FloatArray, t: int) -> _Look:
        bases = with_offsets(animated, offsets)
        for index, basis in enumerate(bases):
            self._posing.pose(index, basis)
        self.tries += 1
        posed = self._posing.look()
        beside = self._weights * difference(offsets, self._reference)
        lacks = self._lacks(posed.bodies[:, :3, 3], posed.body_turns, t)
        return _Look(bases, posed, np.append(lacks, beside))

    def _lacks(self, heads: FloatArray, turns: FloatArray, t: int) -> FloatArray:
        """(6 B,) m, of bodies with heads (B, 3) and turns (B, 3, 3): heads, then turns times
        LEVER."""
        wanted = self._targets
        off = wanted.unit[t] * (wanted.heads[t] - heads)
        turned = LEVER * rotation_vector(wanted.rotations[t] @ np.swapaxes(turns, 1, 2))
        return np.concatenate([off.ravel(), turned.ravel()])

    def _stepped(
        self, offsets: FloatArray, error: FloatArray, columns: Columns, t: int, damping: float
    ) -> tuple[FloatArray, FloatArray, float]:
        """Offsets after a damped least-squares step; the step; and how far it moves any body.
        columns: of the dofs there; error: as of a look."""
        count = len(columns.turns)
        shifts = self._targets.unit[t] * columns.shifts.reshape(count, -1)
        places = places_of(self._responses.dofs)
        pull = np.zeros((count, *offsets.shape))
        pull[np.arange(count), *places] = self._weights[places]
        turns = LEVER * columns.turns.reshape(count, -1)
        every = np.concatenate([shifts, turns, pull.reshape(count, -1)], axis=1)
        sizes = np.linalg.norm(every, axis=1)
        weighted = every / np.where(sizes > 0.0, sizes, 1.0)[:, None]
        normal = weighted @ weighted.T + damping * np.eye(count)
        step = np.linalg.solve(normal, weighted @ error) / np.where(sizes > 0.0, sizes, np.inf)
        changes = np.zeros_like(offsets)
        changes[places] = step
        turned = np.linalg.norm(changes[:, :3], axis=1, keepdims=True)
        changes[:, :3] *= np.minimum(1.0, LONGEST / np.maximum(turned, 1e-12))
        changes[:, SIZE] = np.clip(changes[:, SIZE], -MOST, MOST)
        return changed(offsets, changes), changes[places], float(np.abs(step @ every).max())
