"""What a written action has in each other that its fit has not: judged by MuJoCo's distances.

The solver tells which solids there are and which of them may not meet; where they are is read from
the bones, and how deep they are in each other is MuJoCo's word.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.data.recording import Recording
from ...solver.solid.shapes import Capsule, capsules, floor_balls, meeting_pairs
from ...solver.solid.solid_world import floor_heights
from ...solver.stages.implicit import Adaptation
from ...solver.transcription.motion import Motion
from .mujoco_shapes import Poses, capsule_depths, floor_depths


class Keeper(Enum):
    """What solids are kept out of."""

    FLOOR = "floor"
    BODY = "own body"


@dataclass(frozen=True)
class Penetration:
    """The deepest of one keeper: mm deeper than in the fit, what in what, and the scene frame."""

    keeper: Keeper
    deeper_mm: float
    what: str
    frame: float


@dataclass(frozen=True, eq=False)
class Solids:
    """A figure's solids. names: of its bodies. pairs: (P, 2) of its limbs that may not meet.

    balls: what must stay above the floor.
    """

    names: tuple[str, ...]
    limbs: tuple[Capsule, ...]
    pairs: IntArray
    balls: tuple[Capsule, ...]

    @staticmethod
    def of(motion: Motion, pairs: IntArray) -> "Solids":
        """Of a motion's figure."""
        t = motion.transcription
        return Solids(
            tuple(body.name for body in t.character.bodies),
            tuple(capsules(t.character)),
            pairs,
            tuple(floor_balls(t.character, t.points)),
        )

    def depths(self, poses: Poses, floor: FloatArray) -> Mapping[Keeper, FloatArray]:
        """(T, items) m of each keeper. floor: (T,) m, its height."""
        return {
            Keeper.FLOOR: floor_depths(self.balls, floor, poses),
            Keeper.BODY: capsule_depths(self.limbs, self.pairs, poses),
        }

    def what(self, keeper: Keeper, item: int) -> str:
        """An item in words."""
        if keeper is Keeper.FLOOR:
            return f"{self.names[self.balls[item].body]} in the floor"
        one, other = (self.names[self.limbs[i].body] for i in self.pairs[item])
        return f"{one} in {other}"


@dataclass(frozen=True, eq=False)
class SolidCheck:
    """A figure's solids at the frames of its action, and how deep its fit has them in each other.

    bones: of the bodies. scale: lengths of the figure over those of the armature. floor: (T,) m,
    its height. allowed: (T, items) m.
    """

    solids: Solids
    bones: tuple[str, ...]
    scale: float
    floor: FloatArray
    allowed: Mapping[Keeper, FloatArray]

    def worst(self, shown: Recording) -> tuple[Penetration, ...]:
        """The deepest of each keeper over every frame of what Blender shows."""
        bones = [shown.index(bone) for bone in self.bones]
        rest = np.stack([shown.bones[bone].rotation for bone in bones])
        turns = shown.rotations[:, bones] @ np.swapaxes(rest, 1, 2)
        depths = self.solids.depths(Poses(turns, self.scale * shown.heads[:, bones]), self.floor)
        return tuple(self._deepest(keeper, depth, shown) for keeper, depth in depths.items())

    def _deepest(self, keeper: Keeper, depth: FloatArray, shown: Recording) -> Penetration:
        deeper = depth - self.allowed[keeper]
        if deeper.max(initial=0.0) <= 0.0:
            return Penetration(keeper, 0.0, "", float(shown.frames[0]))
        frame, item = np.unravel_index(int(deeper.argmax()), deeper.shape)
        what = self.solids.what(keeper, int(item))
        return Penetration(keeper, 1000.0 * float(deeper.max()), what, float(shown.frames[frame]))


def solid_check(adaptation: Adaptation, times: FloatArray, scale: float = 1.0) -> SolidCheck:
    """Of an adaptation whose action has frames at (T,) s. scale: see SolidCheck."""
    setup, fitted = adaptation.setup, adaptation.fit
    figure, reference = fitted.motion.transcription.character, setup.context.reference
    pairs = meeting_pairs(figure, capsules(figure))
    old = np.clip(setup.context.timeline.to_old(times), 0.0, fitted.motion.duration)
    pose = fitted.motion.pose(old)
    before = Poses(pose.rotations, pose.centres + fitted.motion.com(old)[:, None])
    floor = floor_heights(fitted.schedule, fitted.places)(old)
    return SolidCheck(
        Solids.of(reference, pairs),
        tuple(body.bone for body in reference.transcription.character.bodies),
        scale,
        floor_heights(setup.schedule, setup.target_places)(times),
        Solids.of(fitted.motion, pairs).depths(before, floor),
    )
