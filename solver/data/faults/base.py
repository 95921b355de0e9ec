"""Base classes of faults: exceptions as data, worded in operators/words only."""

from collections.abc import Callable
from dataclasses import dataclass, fields


@dataclass
class Fault(Exception):
    """Base of every fault that an artist can mend; each subclass carries where and by how much."""

    def __reduce__(self) -> tuple[Callable[..., "Fault"], tuple[object, ...]]:
        """Pickled by its fields: an exception's own way forgets those that were given by name."""
        return type(self), tuple(getattr(self, field.name) for field in fields(self))


@dataclass
class RequestFault(Fault):
    """Base of faults of one request, which goes by the name that the artist gave it."""

    request: str


@dataclass
class NameMissing(Fault):
    """A request without a name; kind: what it is, in the artist's words."""

    kind: str
