"""A cache of what was built for a content, of the last few contents that were asked for."""

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

T = TypeVar("T")

CACHED_CONTENTS = 4  # contents of a name: windows may show different scenes and frames


class ContentCache(Generic[T]):
    """For each name the last few things built, by content."""

    def __init__(self, remembered: int = CACHED_CONTENTS) -> None:
        self._remembered = remembered
        self._made: dict[Hashable, dict[Hashable, T]] = {}

    def get(self, name: Hashable, content: Hashable, make: Callable[[], T]) -> T:
        """The thing made for this content; where there is none, `make` makes it."""
        known = self._made.setdefault(name, {})
        made = known.pop(content, None)
        known[content] = made = make() if made is None else made
        while len(known) > self._remembered:
            del known[next(iter(known))]
        return made

    def clear(self) -> None:
        self._made.clear()
