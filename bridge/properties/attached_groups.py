"""The settings' groups, where Blender's data-blocks carry them."""

from contextlib import ExitStack

import bpy

from ..accessors import ATTRIBUTE
from .settings import CARRIERS, CLASSES


def attach_groups(undo: ExitStack) -> None:
    """Lets scenes, objects, actions and bones carry their groups until `undo` is closed; the
    groups' classes are registered."""
    for carrier, group in CARRIERS.items():
        # a property until it is assigned; the stubs say nothing
        group_of = bpy.props.PointerProperty(  # type: ignore[func-returns-value]
            type=group, override={"LIBRARY_OVERRIDABLE"}
        )
        setattr(carrier, ATTRIBUTE, group_of)
        undo.callback(delattr, carrier, ATTRIBUTE)


def ensure_groups() -> None:
    """Has a Blender in which the extension is not enabled know what files hold of it."""
    if hasattr(bpy.types.Object, ATTRIBUTE):
        return
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    attach_groups(ExitStack())
