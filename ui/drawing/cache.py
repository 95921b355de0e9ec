"""A cache of what was built for a content, of the last few contents that were asked for."""

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

T = TypeVar("T")

CACHED_CONTENTS = 4  # contents of a name: windows may show different scenes and frames


class ContentCache(Generic[T]):
    """For each name the last few things built, by content, which need only be comparable."""

    def __init__(self, remembered: int = CACHED_CONTENTS) -> None:
        self._remembered = remembered
        self._made: dict[Hashable, list[tuple[object, T]]] = {}

    def get(self, name: Hashable, content: object, make: Callable[[], T]) -> T:
        """The thing made for this content; where there is none, `make` makes it."""
        known = self._made.setdefault(name, [])
        at = next((i for i, (before, _) in enumerate(known) if before == content), None)
        made = known.pop(at)[1] if at is not None else None
        made = make() if made is None else made
        known.insert(0, (content, made))
        del known[self._remembered :]
        return made

    def clear(self) -> None:
        self._made.clear()
