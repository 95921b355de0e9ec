"""Records of the report on the keys that a result was written with, and on its blends."""

from dataclasses import dataclass


@dataclass(frozen=True)
class KeysReport:
    """Keys of the channels that a result has of its own, and what they leave.

    choice: such as "reduced"; "every frame" where that could not be. keys: all channels' together.
    largest_error_mm: of a joint centre in the world, over every frame, and where;
    largest_turn_deg: of a bone in the world.
    """

    choice: str
    keys: int
    channels: int
    seconds: float
    largest_error_mm: float
    error_bone: str
    error_frame: float
    largest_turn_deg: float
    turn_bone: str
    turn_frame: float

    @property
    def rate(self) -> float:
        """Keys a second and channel."""
        return self.keys / (self.channels * self.seconds)


@dataclass(frozen=True)
class MissedContact:
    """A contact whose point the keys have elsewhere than solved, by how far at most, and at which
    frame; and the bones and armature whose scale changes lengths above it."""

    name: str
    mm: float
    frame: float
    scaled: tuple[str, ...] = ()


@dataclass(frozen=True)
class BodyMiss:
    """What a bone that controls pose misses most, in mm and degrees, and at which frames."""

    bone: str
    mm: float
    far_frame: float
    degrees: float
    turned_frame: float


@dataclass(frozen=True)
class BlendReport:
    """A blend between the take and the adapted frames: how it moves the hips.

    into: whether it leads into the adapted frames; else out of them. first_frame, last_frame: its
    own, the seam included. off_m: of the hips from the take (carried along) at the seam. speed_m_s:
    the hips' highest in it, at `frame`; take_speed_m_s: the take's highest there. slide_m: how far
    it takes the foot along that slides the most while it stands in the take, and its bone.
    """

    into: bool
    first_frame: float
    last_frame: float
    off_m: float
    speed_m_s: float
    frame: float
    take_speed_m_s: float
    slide_m: float = 0.0
    slide_bone: str = ""
