"""Motion-capture recording and resulting pose track as plain arrays (world frame, Z up, SI)."""

import hashlib
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from .contacts import KnownContacts

POSE_TOLERANCE = 1e-5  # m and rad; going into edit mode and back moves bones by less
MIN_CLIP_DURATION = 0.3  # s
BEYOND = 0.5  # s, on both sides of the range that is adapted, which a recording may have and tell


@dataclass(frozen=True)
class Bone:
    """Bone of the rest skeleton.

    parent: index of the parent in `Recording.bones`, -1 for a root; parents come first.
    head, tail: (3,) rest positions, world, m. rotation: (3, 3) rest orientation, bone to world.
    follows: the bone of the same skeleton whose turns a constraint copies; "" for none.
    """

    name: str
    parent: int
    head: FloatArray
    tail: FloatArray
    rotation: FloatArray
    follows: str = ""


@dataclass(frozen=True, eq=False)
class Skin:
    """Points spread evenly over the meshes that bones deform, in the rest pose.

    meshes: their names. bones: names. points: (N, 3) m, world, where `Bone` has its rest.
    owners: (N,) indices of bones, of each point the one that moves it most; -1 where none does.
    Two are equal whose values are.
    """

    meshes: tuple[str, ...]
    bones: tuple[str, ...]
    points: FloatArray
    owners: IntArray

    def scaled(self, factor: float) -> "Skin":
        """With every length times `factor`, about the world's origin."""
        return replace(self, points=factor * self.points)

    def digest(self) -> str:
        """SHA-256, hexadecimal, of everything."""
        content = hashlib.sha256(repr((self.meshes, self.bones)).encode())
        for values in (self.points, self.owners):
            content.update(values.tobytes())
        return content.hexdigest()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Skin):
            return NotImplemented
        named = (self.meshes, self.bones) == (other.meshes, other.bones)
        pairs = ((self.points, other.points), (self.owners, other.owners))
        return self is other or (named and all(np.array_equal(a, b) for a, b in pairs))

    def __hash__(self) -> int:
        return hash((self.meshes, self.bones, self.points.shape))


@dataclass(frozen=True)
class Recording:
    """Pose of every bone at every frame, world frame, Z up.

    frames: (T,) scene frame numbers. times: (T,) s, 0 at the first frame, or at the first one of
    the range that is looked at where there are frames beyond it.
    heads: (T, B, 3) m. rotations: (T, B, 3, 3), bone to world, proper rotations. known: contacts of
    frames that adaptations wrote, in order; these may lie beyond the recording's.
    """

    name: str
    bones: tuple[Bone, ...]
    frames: FloatArray
    times: FloatArray
    heads: FloatArray
    rotations: FloatArray
    known: tuple[KnownContacts, ...] = ()

    @property
    def rate(self) -> float:
        """Frames per second."""
        return (len(self.times) - 1) / float(self.times[-1] - self.times[0])

    @property
    def ends(self) -> tuple[float, float]:
        """First and last frame."""
        return float(self.frames[0]), float(self.frames[-1])

    def frame_at(self, time: float) -> float:
        """The scene's frame, whole or not, at an instant, s."""
        return float(self.frames[0]) + self.rate * time

    def index(self, bone: str) -> int:
        """Index of the bone called `bone`. Raises KeyError where there is none."""
        for i, b in enumerate(self.bones):
            if b.name == bone:
                return i
        raise KeyError(bone)

    def window(self, first: float, last: float) -> "Recording":
        """The same recording cut to the frames in [first, last]; times start at 0 again."""
        cut = self.part((self.frames >= first - 1e-6) & (self.frames <= last + 1e-6))
        return replace(cut, times=cut.times - cut.times[:1])

    def part(self, keep: BoolArray | slice) -> "Recording":
        """Some frames of the recording, (T,) or a slice; their times stay."""
        return replace(
            self,
            frames=self.frames[keep],
            times=self.times[keep],
            heads=self.heads[keep],
            rotations=self.rotations[keep],
        )


@dataclass(frozen=True)
class PoseTrack:
    """Pose trajectory of the moving bones, ready to be written as keyframes.

    frames: (T,) scene frames. bones: the bones that move, parents first; the first is the pelvis.
    rotations: (T, len(bones), 3, 3), bone to world. root_head: (T, 3) m, the pelvis bone's head.
    """

    frames: FloatArray
    bones: tuple[str, ...]
    rotations: FloatArray
    root_head: FloatArray


def digest(recording: Recording, grid: float = 0.0) -> str:
    """SHA-256, hexadecimal, of name, bones, rest pose, frames, times and poses; and of contacts
    that are known, and bones that follow others, where there are any. grid: to which poses are
    rounded, 0 not at all: their last bits are the processor's."""

    def content_of(values: FloatArray) -> bytes:
        return (np.round(values / grid) + 0.0 if grid else values).tobytes()  # no -0.0

    content = hashlib.sha256(recording.name.encode())
    for bone in recording.bones:
        content.update(f"\0{bone.name}\0{bone.parent}".encode())
        for rest in (bone.head, bone.tail, bone.rotation):
            content.update(content_of(rest))
    for samples in (recording.frames, recording.times, recording.heads, recording.rotations):
        content.update(content_of(samples))
    following = {bone.name: bone.follows for bone in recording.bones if bone.follows}
    if recording.known or following:
        content.update(repr((recording.known, following)).encode())
    return content.hexdigest()


def same_motion(one: Recording, other: Recording) -> bool:
    """Whether two recordings are the same motion of the same bones, to POSE_TOLERANCE."""
    if [(b.name, b.parent) for b in one.bones] != [(b.name, b.parent) for b in other.bones]:
        return False
    pairs = [
        (one.frames, other.frames),
        (one.times, other.times),
        (one.heads, other.heads),
        (one.rotations, other.rotations),
        *((a.rotation, b.rotation) for a, b in zip(one.bones, other.bones, strict=True)),
    ]
    return all(
        a.shape == b.shape and np.allclose(a, b, rtol=0.0, atol=POSE_TOLERANCE) for a, b in pairs
    )
