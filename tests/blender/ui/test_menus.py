"""What is found by name (F3): the entries of the menu Hangtime and of the menus in it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.operators.names import OperatorId
from hangtime.ui.panels import menus

MENUS = {kind.bl_idname: kind for kind in vars(menus).values() if hasattr(kind, "bl_idname")}


class Layout:
    """Notes the operators that a menu shows, in menus of it too."""

    def __init__(self) -> None:
        self.operators: set[str] = set()

    def operator(self, name: str, **_: object) -> SimpleNamespace:
        self.operators.add(name)
        return SimpleNamespace()

    def menu(self, name: str, **_: object) -> None:
        MENUS[name].draw(SimpleNamespace(layout=self), bpy.context)

    def separator(self) -> None:
        pass


def test_what_acts_on_the_armature_or_adds_a_row_is_in_the_menu() -> None:
    layout = Layout()
    layout.menu(menus.HangtimeMenu.bl_idname)
    wanted = {
        *(OperatorId.EXAMINE, OperatorId.REPAIR_ALL, OperatorId.UPDATE, OperatorId.TURN_STANCE),
        *(each for each in OperatorId if each.name.startswith("ADD_")),
    } - {OperatorId.ADD_BONE}  # of a row
    assert wanted <= layout.operators
