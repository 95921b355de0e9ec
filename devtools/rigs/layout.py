"""Skeletons of conventions, as the files in `layouts` state them.

A line of `bones` is "NAME < PARENT @ PLACE", parents first, {s} for the side; lines with a side
count once for each. A place is a joint of the actor, or "JOINT:SHARE" of the way from it to the
joint's end, and "+METRES" ahead of that; "ground" is the floor's origin. A bone that is placed at a
joint without a share is the one that moves the part of the body that begins there.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from .actor import JOINTS

LAYOUTS = Path(__file__).parent / "layouts"
GROUND = "ground"
_LINE = re.compile(r"(?P<name>.+?)(?: < (?P<parent>.+?))? @ (?P<place>\S+)")
_PLACE = re.compile(
    r"(?P<joint>[a-z_0-9]+)(?:\.(?P<side>[lr]))?(?::(?P<share>[\d.]+))?(?P<ahead>[+-][\d.]+)?"
)


class Axes(Enum):
    """Where bones point."""

    ALONG = "along"  # to the next joint, rolled somehow
    ASIDE = "aside"  # with X to the next joint, as importers leave what other programs made
    UP = "up"  # all upwards


class Travel(Enum):
    """What carries the body over the floor."""

    HIPS = "hips"
    ROOT = "root"  # the root bone
    OBJECT = "object"


@dataclass(frozen=True)
class Placed:
    """A bone and its place. joint: of the actor, or GROUND. ahead: m. part: whether the bone moves
    the part that begins at the joint."""

    name: str
    parent: str | None
    joint: str
    share: float
    ahead: float
    part: bool


@dataclass(frozen=True)
class Layout:
    """A rig. key: its file's name. unit: m. lowered: whether it rests in an A pose.

    mode: rotation mode of its bones. unknown: whether its names follow no convention.
    """

    key: str
    name: str
    bones: tuple[Placed, ...]
    unit: float
    axes: Axes
    lowered: bool
    mode: str
    travel: Travel
    unknown: bool

    @property
    def parts(self) -> dict[str, str]:
        """The bone that moves the part at each joint."""
        return {bone.joint: bone.name for bone in self.bones if bone.part}


def layouts() -> tuple[Layout, ...]:
    """All rigs, the conventions first."""
    found = [read_layout(path) for path in sorted(LAYOUTS.glob("*.toml"))]
    return tuple(sorted(found, key=lambda layout: layout.unknown))


def read_layout(path: Path) -> Layout:
    """A layout's file."""
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    bones: list[Placed] = []
    for line in filter(None, table["bones"].splitlines()):
        for word, side in zip(table["sides"], "lr", strict=True):
            bone = _placed(line, word, side)
            if bone not in bones:
                bones.append(bone)
    return Layout(
        path.stem,
        table["name"],
        tuple(bones),
        table["unit"],
        Axes(table["axes"]),
        table["rest"] == "A",
        table["mode"],
        Travel(table["motion"]),
        table.get("unknown", False),
    )


def _placed(line: str, word: str, side: str) -> Placed:
    said = _LINE.fullmatch(line)
    assert said is not None, line
    place = _PLACE.fullmatch(said["place"])
    assert place is not None, line
    joint = place["joint"]
    if joint not in (*JOINTS, GROUND):
        joint = f"{joint}.{place['side'] or side}"
    parent = said["parent"]
    return Placed(
        said["name"].format(s=word),
        parent.format(s=word) if parent else None,
        joint,
        float(place["share"] or 0.0),
        float(place["ahead"] or 0.0),
        place["share"] is None and joint != GROUND,
    )
