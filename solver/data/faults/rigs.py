"""Faults of a rig that poses bones whatever keys they have: a result could not be written to it."""

from dataclasses import dataclass

from .base import Fault


@dataclass
class PosedByOthers(Fault):
    """The armature has no keys, while constraints pose its bones after these other objects."""

    armature: str
    others: tuple[str, ...]


@dataclass
class NoControls(Fault):
    """Constraints pose these bones, and no bone that can be posed turns them by itself."""

    bones: tuple[str, ...]


@dataclass
class PulledFromOutside(Fault):
    """Constraints of inverse kinematics, of these bones, pull towards these objects, which no bone
    of the armature moves."""

    bones: tuple[str, ...]
    constraints: tuple[str, ...]
    targets: tuple[str, ...]


@dataclass
class DrivenBones(Fault):
    """Drivers set the rotations of these bones, or the location that carries the first."""

    bones: tuple[str, ...]


@dataclass
class HeldBones(Fault):
    """Constraints pose these bones otherwise than their keys say, first at a frame."""

    bones: tuple[str, ...]
    frame: float


@dataclass
class RenamedBones(Fault):
    """A recording's keys move bones that the armature does not have, and none move these, of the
    body or followed by it: they were renamed while another action was shown. paired: whether it is
    known which."""

    action: str
    bones: tuple[str, ...]
    unkeyed: tuple[str, ...]
    paired: bool


@dataclass
class DeadKeys(Fault):
    """A recording's keys move bones that the armature does not have; the body lacks none."""

    action: str
    bones: tuple[str, ...]
