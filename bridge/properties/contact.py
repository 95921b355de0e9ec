"""Contacts and stances as the artist has them; stored with the armature.

Lengths are in Blender units, world; frames are the scene's; angles in rad.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy

from ..accessors import attached
from ..rows.row import chosen, hidden
from ..rows.stored import DIGITS, angle, boolean, frame, number, position, target, text, vector
from . import stances
from .surface import has_faces

SHOWN = 3  # decimals of a length, as while a pin is dragged; Blender would show 0.004764 m


def _is_empty(_owner: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    return bool(candidate.type == "EMPTY")


# Blender evaluates a class's annotations apart from this module's names, so that a lambda among
# them would not find any: callbacks are functions.


def _get_place(row: HangtimeContact) -> Sequence[float]:
    return tuple(row.at)


def _set_place(row: HangtimeContact, to: Sequence[float]) -> None:
    stances.place(attached(row.id_data), row, to)


class HangtimeContact(bpy.types.PropertyGroup):
    """A contact as it was found and as the artist wants it; `name` is its own ("Left heel 2").

    surplus: a linked row, which an override cannot drop, of a contact that is not there.
    """

    COMPUTED = ("place",)  # from what else is stored

    point: hidden(text())
    bone: hidden(text("Bone"))
    phase: hidden(text("Phase"))
    found_start: hidden(number())
    found_end: hidden(number())
    found_at: hidden(vector())
    at: hidden(vector())

    added: hidden(boolean())  # by the artist
    surplus: hidden(boolean())
    used: chosen(boolean("Touches", "Whether this contact counts; off removes it", default=True))
    start_frame: chosen(frame("Start", "Frame at which the point begins to carry"))
    end_frame: chosen(frame("End", "Frame at which the point ceases to carry"))
    place: chosen(
        position(
            "Place",
            "Where the point shall touch, in the world. What Moves says goes along",
            get=_get_place,
            set=_set_place,
        )
    )
    empty: chosen(target("Empty", "Where this empty is, the point shall touch", poll=_is_empty))
    on: chosen(
        target(
            "On",
            "The ground that the point stands on, vertically below or above its place; "
            "it must be among the surfaces. Dragging the pin there chooses it",
            poll=has_faces,
        )
    )

    def let_go(self) -> None:
        """Have it count for nothing; `listed` leaves it out."""
        self.surplus, self.added, self.used = True, True, False
        self.phase, self.empty, self.on = "", None, None


def _shown(length: float) -> float:
    """A length as the artist reads it; what is stored keeps all digits, and so do solves."""
    return round(float(length), SHOWN) + 0.0  # no zero has a minus


def _shift(axis: int, name: str, description: str) -> Any:
    """A stance's shift along one of its axes."""

    def get(stance: HangtimeStance) -> float:
        return _shown(stance.shifted[axis])

    def put(stance: HangtimeStance, to: float) -> None:
        shifted = list(stance.shifted)
        shifted[axis] = to
        stances.shift_stance(attached(stance.id_data), stance, shifted)

    options = {"unit": "LENGTH", "subtype": "DISTANCE", "step": 1, "precision": DIGITS}
    return chosen(number(name, description, get=get, set=put, **options))


def _get_turn(stance: HangtimeStance) -> float:
    return float(stance.turned)


def _set_turn(stance: HangtimeStance, to: float) -> None:
    stances.turn_stance(attached(stance.id_data), stance, to)


class HangtimeStance(bpy.types.PropertyGroup):
    """A stance, which is all contacts of a ground phase; `name` is the phase's ("ground 2").

    backwards: whether forward is at the body's back.
    """

    COMPUTED = ("forward", "left", "up", "turn")

    forward_axis: hidden(vector())
    backwards: hidden(boolean())
    shifted: hidden(vector())
    turned: hidden(number())

    forward: _shift(0, "Forward", "Move the stance along the way of the motion")
    left: _shift(1, "Left", "Move the stance to the left of the way of the motion")
    up: _shift(2, "Up", "Raise or lower the stance")
    turn: chosen(
        angle(
            "Turn",
            "Turn the stance about the vertical, counter-clockwise seen from above",
            get=_get_turn,
            set=_set_turn,
        )
    )

    def let_go(self) -> None:
        """Have it move nothing; without contacts it is not listed."""
        self.shifted, self.turned = (0.0, 0.0, 0.0), 0.0


CLASSES = (HangtimeContact, HangtimeStance)
