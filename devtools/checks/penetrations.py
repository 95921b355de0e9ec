"""What a written action has in each other that its fit has not, and how it stands on the scene: by
MuJoCo's distances.

The solver tells which solids there are and which of them may not meet; where they are is read from
the bones, and how deep they are in each other is MuJoCo's word.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...solver.analysis.pins.pinned_places import chosen_contacts, phase_of
from ...solver.arrays import FloatArray, IntArray
from ...solver.data.problem import MotionProblem
from ...solver.data.recording import Recording
from ...solver.solid.mesh_surface import scene_shapes
from ...solver.solid.shape_changes import ShapeChanges
from ...solver.solid.shapes import Capsule, capsules, floor_balls, meeting_pairs
from ...solver.solid.solid_world import floor_heights
from ...solver.stages.implicit import Adaptation
from ...solver.stages.surroundings import floor_of
from ...solver.transcription.motion import Motion
from .mujoco_shapes import Poses, capsule_depths, floor_depths
from .scenery import PlacedObject, distances_to, placed_object, scene_depths

SETTLING = 0.04  # s at a contact's ends, in which its sole gives


class Keeper(Enum):
    """What solids are kept out of."""

    FLOOR = "floor"
    BODY = "own body"
    SCENE = "scene"


@dataclass(frozen=True)
class Penetration:
    """The deepest of one keeper: mm deeper than in the fit, what in what, and the scene frame."""

    keeper: Keeper
    deeper_mm: float
    what: str
    frame: float


@dataclass(frozen=True)
class Standing:
    """How far, mm, a contact's point is from the faces of the object that it stands on, at worst,
    but for its first and last instants, in which soles give."""

    contact: str
    object: str
    off_mm: float


@dataclass(frozen=True, eq=False)
class Solids:
    """A figure's solids. names: of its bodies. pairs: (P, 2) of its limbs that may not meet.

    balls: what must stay above the floor. whole: what must stay out of the scene.
    """

    names: tuple[str, ...]
    limbs: tuple[Capsule, ...]
    pairs: IntArray
    balls: tuple[Capsule, ...]
    whole: tuple[Capsule, ...]

    @staticmethod
    def of(motion: Motion, pairs: IntArray, changes: ShapeChanges) -> "Solids":
        """Of a motion's figure."""
        t = motion.transcription
        return Solids(
            tuple(body.name for body in t.character.bodies),
            tuple(capsules(t.character, changes)),
            pairs,
            tuple(floor_balls(t.character, t.points, changes)),
            tuple(scene_shapes(t.character, t.points, changes)),
        )

    def depths(self, poses: Poses, floor: FloatArray) -> Mapping[Keeper, FloatArray]:
        """(T, items) m of each keeper. floor: (T,) m, its height."""
        return {
            Keeper.FLOOR: floor_depths(self.balls, floor, poses),
            Keeper.BODY: capsule_depths(self.limbs, self.pairs, poses),
        }

    def what(self, keeper: Keeper, item: int, scene: Sequence[PlacedObject]) -> str:
        """An item in words."""
        if keeper is Keeper.SCENE:
            thing, shape = divmod(item, len(self.whole))
            return f"{self.names[self.whole[shape].body]} in {scene[thing].name}"
        if keeper is Keeper.FLOOR:
            return f"{self.names[self.balls[item].body]} in the floor"
        one, other = (self.names[self.limbs[i].body] for i in self.pairs[item])
        return f"{one} in {other}"


@dataclass(frozen=True, eq=False)
class StandingContact:
    """A contact of a point (a ball) on an object, from start to end, s."""

    contact: str
    point: Capsule
    start: float
    end: float
    thing: PlacedObject

    def off(self, poses: Poses, times: FloatArray) -> Standing:
        """How far off it is at the action's frames (T,) s."""
        inside = (times > self.start + SETTLING) & (times < self.end - SETTLING)
        gap = distances_to([self.point], self.thing, poses)[inside]
        return Standing(self.contact, self.thing.name, 1000.0 * float(np.abs(gap).max(initial=0.0)))


@dataclass(frozen=True, eq=False)
class SolidCheck:
    """A figure's solids at the frames of its action, and how deep its fit has them in each other.

    bones: of the bodies. scale: lengths of the figure over those of the armature. floor: (T,) m,
    its height. allowed: (T, items) m; of the scene nothing is. stands: contacts on objects.
    """

    solids: Solids
    bones: tuple[str, ...]
    scale: float
    floor: FloatArray
    allowed: Mapping[Keeper, FloatArray]
    scene: tuple[PlacedObject, ...]
    stands: tuple[StandingContact, ...]

    def worst(self, shown: Recording) -> tuple[Penetration, ...]:
        """The deepest of each keeper over every frame of what Blender shows."""
        poses = self._poses(shown)
        depths = dict(self.solids.depths(poses, self.floor))
        if self.scene:
            depths[Keeper.SCENE] = scene_depths(self.solids.whole, self.scene, poses)
        return tuple(self._deepest(keeper, depth, shown) for keeper, depth in depths.items())

    def standing(self, shown: Recording) -> tuple[Standing, ...]:
        """Of every contact that stands on an object."""
        poses = self._poses(shown)
        return tuple(each.off(poses, shown.times) for each in self.stands)

    def _poses(self, shown: Recording) -> Poses:
        bones = [shown.index(bone) for bone in self.bones]
        rest = np.stack([shown.bones[bone].rotation for bone in bones])
        turns = shown.rotations[:, bones] @ np.swapaxes(rest, 1, 2)
        return Poses(turns, self.scale * shown.heads[:, bones])

    def _deepest(self, keeper: Keeper, depth: FloatArray, shown: Recording) -> Penetration:
        deeper = depth - self.allowed.get(keeper, 0.0)
        if deeper.max(initial=0.0) <= 0.0:
            return Penetration(keeper, 0.0, "", float(shown.frames[0]))
        frame, item = np.unravel_index(int(deeper.argmax()), deeper.shape)
        what = self.solids.what(keeper, int(item), self.scene)
        return Penetration(keeper, 1000.0 * float(deeper.max()), what, float(shown.frames[frame]))


def solid_check(
    adaptation: Adaptation, problem: MotionProblem, times: FloatArray, scale: float = 1.0
) -> SolidCheck:
    """Of an adaptation whose action has frames at (T,) s. problem: at the figure's stature.

    scale: see SolidCheck.
    """
    setup, fitted = adaptation.setup, adaptation.fit
    figure, reference = fitted.motion.transcription.character, setup.context.reference
    changes = setup.changes
    pairs = meeting_pairs(figure, capsules(figure, changes), changes)
    old = np.clip(setup.context.timeline.to_old(times), 0.0, fitted.motion.duration)
    pose = fitted.motion.pose(old)
    before = Poses(pose.rotations, pose.centres + fitted.motion.com(old)[:, None])
    floor = floor_heights(fitted.schedule, fitted.places)(old)
    line = setup.context.timeline
    scene = tuple(
        placed_object(thing, times, line.first_frame, line.rate) for thing in problem.scene
    )
    return SolidCheck(
        Solids.of(reference, pairs, changes),
        tuple(body.bone for body in reference.transcription.character.bodies),
        scale,
        floor_of(adaptation.fit, setup.context, setup.target_places)(times),
        Solids.of(fitted.motion, pairs, changes).depths(before, floor),
        scene,
        tuple(_stands(adaptation, problem, scene)),
    )


def _stands(
    adaptation: Adaptation, problem: MotionProblem, scene: Sequence[PlacedObject]
) -> Iterator[StandingContact]:
    """Contacts that a pin puts on an object."""
    t, schedule = adaptation.motion.transcription, adaptation.fit.schedule
    objects = {each.name: each for each in scene}
    for pin in problem.pins:
        if pin.on is None:
            continue
        chosen = chosen_contacts(pin, phase_of(pin, schedule), schedule)
        names = {schedule.contacts[i].name for i in chosen}
        for each in t.contacts:
            contact, point = each.contact, t.points[each.point]
            if contact.name in names:
                ball = Capsule(point.body, point.place, point.place, 0.0)
                yield StandingContact(
                    contact.name, ball, contact.start, contact.end, objects[pin.on]
                )
