"""What rows, phases and stances read of the stored settings, which are made of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Protocol, TypeVar

Row = TypeVar("Row", covariant=True)


class Rows(Protocol[Row]):
    """A collection of stored rows, as Blender keeps them."""

    def __iter__(self) -> Iterator[Row]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> Row: ...
    def get(self, name: str, /) -> Row | None: ...


class ContactRow(Protocol):
    """A contact; frames, and (3,) places in Blender units, world."""

    name: str
    point: str
    bone: str
    added: bool
    surplus: bool
    phase: str
    used: bool
    found_start: float
    found_end: float
    start_frame: float
    end_frame: float
    found_at: Any
    at: Any
    empty: Any
    on: Any

    @property
    def id_data(self) -> Any: ...  # the armature, or an action


class StanceRow(Protocol):
    """A stance: its shift (3,) along forward, left and up, and its turn, rad."""

    name: str
    forward_axis: Any
    backwards: bool
    shifted: Any
    turned: float
    turn: float


class ConstraintRow(Protocol):
    """What the names of phases need of a constraint."""

    name: str
    kind: str
    first_frame: float


class Settings(Protocol):
    """The clip of an armature's settings, its contacts and its stances."""

    use_range: bool
    first_frame: int
    last_frame: int
    moves: str
    moving: str
    whole_stance: bool
    active_contact: int
    unseen: str

    @property
    def id_data(self) -> Any: ...  # the armature
    @property
    def contacts(self) -> Rows[ContactRow]: ...
    @property
    def stances(self) -> Rows[StanceRow]: ...
    @property
    def constraints(self) -> Rows[ConstraintRow]: ...
