"""The bones that carry the body: what fingers and faces do is no matter of physics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..body.anatomy import Part, map_anatomy
from ..data.recording import Recording
from ..skeleton.still_bones import without_still


@dataclass(frozen=True)
class Figure:
    """Indices of bones in the recording, by the parts that they move. limbs: those that hang on
    another, so that their joints have a place in it."""

    parts: tuple[tuple[int, Part], ...]
    limbs: tuple[int, ...]

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
    return Figure(tuple((segment.bone, segment.part) for segment in segments), limbs)
