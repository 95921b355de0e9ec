"""Motion-capture recording and resulting pose track as plain arrays (world frame, Z up, SI)."""

from dataclasses import dataclass

from ..arrays import FloatArray


@dataclass(frozen=True)
class Bone:
    """Bone of the rest skeleton.

    parent: index of the parent in `Recording.bones`, -1 for a root; parents come first.
    head, tail: (3,) rest positions, world, m. rotation: (3, 3) rest orientation, bone to world.
    """

    name: str
    parent: int
    head: FloatArray
    tail: FloatArray
    rotation: FloatArray


@dataclass(frozen=True)
class Recording:
    """Pose of every bone at every frame, world frame, Z up.

    frames: (T,) scene frame numbers. times: (T,) s, times[0] = 0.
    heads: (T, B, 3) m. rotations: (T, B, 3, 3), bone to world, proper rotations.
    """

    name: str
    bones: tuple[Bone, ...]
    frames: FloatArray
    times: FloatArray
    heads: FloatArray
    rotations: FloatArray

    def index(self, bone: str) -> int:
        """Index of the bone called `bone`. Raises KeyError where there is none."""
        for i, b in enumerate(self.bones):
            if b.name == bone:
                return i
        raise KeyError(bone)

    def window(self, first: float, last: float) -> "Recording":
        """The same recording cut to the frames in [first, last]; times start at 0 again."""
        keep = (self.frames >= first - 1e-6) & (self.frames <= last + 1e-6)
        times = self.times[keep]
        return Recording(
            self.name,
            self.bones,
            self.frames[keep],
            times - times[:1],
            self.heads[keep],
            self.rotations[keep],
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
