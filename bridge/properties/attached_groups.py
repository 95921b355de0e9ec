"""The settings' groups, where Blender's data-blocks carry them."""

from contextlib import ExitStack

import bpy

from ..accessors import ATTRIBUTE
from .settings import CARRIERS, CLASSES

_ensured = ExitStack()  # what takes back what `ensure_groups` did


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
        _ensured.callback(bpy.utils.unregister_class, cls)
    attach_groups(_ensured)


def release_groups() -> None:
    """Takes back what `ensure_groups` did, so that the extension can be enabled; what files hold
    stays with them."""
    _ensured.close()
