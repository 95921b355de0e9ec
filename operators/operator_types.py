"""Types of operators: what their methods return, and what their mixins are."""

from __future__ import annotations

import re
import sys
from types import FrameType
from typing import TYPE_CHECKING, Any, Literal

import bpy

from .names import OperatorId

OperatorResult = set[Literal["RUNNING_MODAL", "CANCELLED", "FINISHED", "PASS_THROUGH", "INTERFACE"]]

NOT_OURS = "Hangtime has no operator “{}”"

# Of a file's path that may begin with "//", the folder of the .blend file: else Blender warns.
FROM_BLEND: set[Any] = {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (4, 5, 0) else set()
MOST_BYTES = 200  # of a precondition's sentence that Blender passes on to scripts
TAIL_BYTES = 120  # of these for its end, which says what to do

# What Blender puts before an operator's sentence, where it refuses and where it cannot begin.
_BEFORE_SENTENCE = re.compile(r"^(Error: |Operator bpy\.ops\.\S+\.poll\(\) )")

if TYPE_CHECKING:
    OperatorMixin = bpy.types.Operator
else:  # Blender looks for properties in those bases only that are no types of its own
    OperatorMixin = object


class PolledOperator(OperatorMixin):
    """Mixin: an operator that is greyed out while there is an obstacle, which its tooltip tells."""

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        """A sentence why it cannot run now; None where it can."""
        raise NotImplementedError

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        why = cls.obstacle(context)
        if why is not None:
            cls.poll_message_set(_told, why)
        return why is None

    def refuse(self, why: str, level: Literal["WARNING", "ERROR"] = "ERROR") -> OperatorResult:
        """Reports why nothing is done. A script gets an error for a warning, too, as it would take
        no notice of that; a person reads it in the status bar, without a pop-up in the way."""
        self.report({"ERROR" if self._by_script() else level}, why)
        return {"CANCELLED"}

    def _by_script(self) -> bool:
        """Whether code runs this: beneath what Blender calls for a click are no other frames."""
        frame: FrameType = sys._getframe()
        while frame.f_back is not None:
            frame = frame.f_back
        return frame.f_locals.get("self") is not self

    def go_on_with(self, name: str, **values: object) -> OperatorResult:
        """Invokes another of Hangtime's operators, by its bl_idname; refuses where that does."""
        if name not in list(OperatorId):
            return self.refuse(NOT_OURS.format(name))
        try:
            _of_blender(name)("INVOKE_DEFAULT", **values)
        except RuntimeError as error:
            return self.refuse(_BEFORE_SENTENCE.sub("", str(error)).strip())
        return {"FINISHED"}


def may_go_on_with(name: str) -> bool:
    """Whether it is one of Hangtime's operators, and one that can run now."""
    return name in list(OperatorId) and bool(_of_blender(name).poll())


def _of_blender(name: str) -> Any:
    category, _, own = name.partition(".")
    return getattr(getattr(bpy.ops, category), own)


def _told(why: str) -> str:
    """A precondition's sentence as Blender asks for it: for a tooltip whole. A script, whose code
    is then being run, gets what Blender would not cut, and the whole on the console."""
    if sys._getframe().f_back is None or len(why.encode()) <= MOST_BYTES:
        return why
    print(why, file=sys.stderr)
    return _without_middle(why)


def _without_middle(text: str) -> str:
    """A sentence of at most MOST_BYTES, in whole words: what is wrong, and what to do."""
    whole, gap = text.encode(), " … "
    head = whole[: MOST_BYTES - TAIL_BYTES - len(gap.encode())].decode(errors="ignore")
    tail = whole[-TAIL_BYTES:].decode(errors="ignore")
    return gap.join([head.rpartition(" ")[0] or head, tail.partition(" ")[2] or tail])
