"""The settings' groups, where Blender's data-blocks carry them."""

from contextlib import ExitStack

import bpy
from bpy.app.handlers import persistent

from ..accessors import ATTRIBUTE, attached, snapshot
from ..app_handlers import add_handler
from ..rows.finding import CLASSES as FINDING_CLASSES
from ..rows.row import CLASSES as ROW_CLASSES
from ..rows.row import HangtimeBoneMark
from .action import HangtimeAction, HangtimeAskedFor
from .body_change import CLASSES as BODY_CHANGE_CLASSES
from .constraint import CLASSES as CONSTRAINT_CLASSES
from .contact import CLASSES as CONTACT_CLASSES
from .options.keys import CLASSES as KEYS_CLASSES
from .options.loop import CLASSES as LOOP_CLASSES
from .options.result import CLASSES as RESULT_CLASSES
from .overridden_lists import settle_lists
from .settings import HangtimePart, HangtimeScene, HangtimeSettings
from .surface import CLASSES as SURFACE_CLASSES
from .view import CLASSES as VIEW_CLASSES

CLASSES = (
    *ROW_CLASSES,
    *CONSTRAINT_CLASSES,
    *BODY_CHANGE_CLASSES,
    *SURFACE_CLASSES,
    *VIEW_CLASSES,
    *RESULT_CLASSES,
    *KEYS_CLASSES,
    *LOOP_CLASSES,
    HangtimePart,
    *FINDING_CLASSES,
    *CONTACT_CLASSES,
    HangtimeSettings,
    HangtimeScene,
    HangtimeAskedFor,
    HangtimeAction,
)
CARRIERS = {
    bpy.types.Scene: HangtimeScene,
    bpy.types.Object: HangtimeSettings,
    bpy.types.Action: HangtimeAction,
    bpy.types.Bone: HangtimeBoneMark,
}
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
    # Opened files too: automatic saves, of which nobody is told, come before the artist's.
    for handlers in (bpy.app.handlers.save_pre, bpy.app.handlers.load_post):
        add_handler(undo, handlers, complete_overrides)


@persistent  # type: ignore[untyped-decorator]  # any, in the stubs
def complete_overrides(*_of_handlers: object) -> None:
    """Library overrides and what they override have the same groups, when a file is saved, and
    their lists the same rows.

    Of a group that only one of them has, Blender 5 saves that it is another one instead of its
    fields, and cannot read that again: all of it would be lost.
    """
    for thing in bpy.data.objects:
        override = thing.override_library
        if thing.library is None and override is not None and snapshot(thing):
            for each in filter(None, (thing, override.reference)):
                _make_groups(attached(each))
            if isinstance(override.reference, bpy.types.Object):
                settle_lists(thing, override.reference)
                override.operations_update()  # else a resync puts the rows back that were joined


def _make_groups(group: bpy.types.PropertyGroup) -> None:
    """Have a group all groups within it, which Blender makes when they are asked for."""
    for each in group.bl_rna.properties:
        if each.type == "POINTER":
            getattr(group, each.identifier)


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
