"""The bones that carry the body: what fingers and faces do is no matter of physics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..body.anatomy import SIDED_PARTS, Part, map_anatomy
from ..data.recording import Recording
from ..skeleton.parts import Key
from ..skeleton.still_bones import without_still


@dataclass(frozen=True)
class Figure:
    """Indices of bones in the recording, by the parts that they move. limbs: those that hang on
    another, so that their joints have a place in it. sided: those of one part and side."""

    parts: tuple[tuple[int, Part], ...]
    limbs: tuple[int, ...]
    sided: Mapping[Key, int]

    @property
    def bones(self) -> list[int]:
        """All of them, the root first."""
        return [bone for bone, _ in self.parts]

    def of(self, *parts: Part) -> list[int]:
        """Those that move one of these parts."""
        return [bone for bone, part in self.parts if part in parts]


def figure_of(recording: Recording, chosen: Mapping[str, str] | None = None) -> Figure:
    """chosen: bones by parts of the body, as in a problem. Raises MissingPart."""
    segments, _ = without_still(recording, map_anatomy(recording.bones, chosen))
    bones = [segment.bone for segment in segments]
    limbs = tuple(bone for bone in bones[1:] if recording.bones[bone].parent in bones)
    parts = tuple((segment.bone, segment.part) for segment in segments)
    sided = {(s.part, s.side): s.bone for s in segments if s.part in SIDED_PARTS}
    return Figure(parts, limbs, sided)
