"""What is told of a recording whose hips keep one height, beside that."""

from __future__ import annotations

from collections.abc import Mapping

from ...analysis.performance import perform
from ...body.character import build_character
from ...data.recording import Recording
from ..falls import Trusted, find_scale
from ..finding import Finding
from ..repairs import Repairs
from ..stance.in_place import find_in_place
from .repair import repaired
from .settled import remedy_of


def find_what_is_left(
    recording: Recording, height: Repairs, chosen: Mapping[str, str] | None
) -> list[Finding]:
    """A size that nobody has, and a way along the floor that was left out as well. How the body
    falls and stands is reckoned, and tells nothing.

    recording: in its own lengths. height: the remedy that gives it back. chosen: bones by parts of
    the body. Raises MissingPart.
    """
    no_falls = Trusted(fewest=len(recording.frames) + 1)
    size = find_scale(perform(recording, build_character(recording, chosen=chosen)), no_falls)
    mended = repaired(recording, height.joined(remedy_of(size)), chosen)
    in_place = find_in_place(perform(mended, build_character(mended, chosen=chosen)))
    return [finding for finding in (size, in_place) if finding is not None]
