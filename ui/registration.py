"""Everything that enabling the extension adds to Blender, in order, and how it is taken back."""

import atexit
from collections.abc import Callable, Iterator
from contextlib import ExitStack

import bpy
from bpy.app.handlers import persistent

from ..bridge import worker_client
from ..bridge.accessors import present
from ..bridge.app_handlers import add_handler
from ..bridge.properties import stances
from ..bridge.properties.attached_groups import CLASSES as GROUP_CLASSES
from ..bridge.properties.attached_groups import attach_groups, release_groups
from ..bridge.properties.deleted_objects import leave_out_of_files
from ..bridge.takes.takes import adopt_copied_slots
from ..operators import names
from ..operators.drag import limit_operator, pin_operator, turn_stance
from ..operators.export import export_takes, recipe_export, save_plots
from ..operators.lists import (
    body_changes,
    bone_presets,
    choose_named,
    constraints,
    contacts,
    offered_support,
    presets,
    surfaces,
)
from ..operators.recording import examine, remedies, repair
from ..operators.solve import adapt, analyze, results, session, takes, watch
from ..operators.timeline import contact_edge_operator
from ..operators.words.translations import TRANSLATIONS
from .gizmos import limit_handles, pin_handles
from .overlay import handlers as overlay
from .panels import constraints as constraint_panels
from .panels import contacts as contact_panels
from .panels import display, keys, lists, menus, recording, setup, solve, world
from .plots import handler as plots
from .timeline import handler as timeline

# A panel comes after the one that it is part of.
MODULES = (
    *(analyze, adapt, contacts, constraints, body_changes, surfaces, offered_support, presets),
    *(bone_presets, choose_named, examine, remedies, repair, results, takes),
    *(export_takes, recipe_export, save_plots),
    *(pin_operator, turn_stance, limit_operator, contact_edge_operator),
    *(
        lists,
        menus,
        setup,
        recording,
        contact_panels,
        constraint_panels,
        world,
        solve,
        keys,
        display,
    ),
    *(pin_handles, limit_handles),
)


def classes() -> Iterator[type]:
    """All that Blender is to know: the settings, and what the modules define under a bl_idname."""
    yield from GROUP_CLASSES
    for module in MODULES:
        for each in vars(module).values():
            own = isinstance(each, type) and each.__module__ == module.__name__
            if own and "bl_idname" in vars(each):
                yield each


def register() -> Callable[[], None]:
    """Adds everything, or nothing where a part fails, whose failure is then raised.

    Returns what takes it all back, in reverse.
    """
    release_groups()  # of a command that ran in this session before
    with ExitStack() as undo:
        _add_worker(undo)
        for cls in classes():
            bpy.utils.register_class(cls)
            undo.callback(bpy.utils.unregister_class, cls)
        attach_groups(undo)
        leave_out_of_files(undo)
        for follow in (_follow_objects, watch.follow_takes):
            add_handler(undo, bpy.app.handlers.depsgraph_update_post, follow)
        for changing in ("undo_post", "redo_post", "frame_change_post"):
            add_handler(undo, getattr(bpy.app.handlers, changing), watch.forget_digests)
        add_handler(undo, bpy.app.handlers.load_post, session.forget_file)
        undo.callback(watch.forget)
        undo.callback(session.session().end)
        # Keys are pairs, whatever the stubs say.
        bpy.app.translations.register(__package__, TRANSLATIONS)  # type: ignore[arg-type]
        undo.callback(bpy.app.translations.unregister, __package__)
        menus.add(undo)
        overlay.add(undo)
        plots.add(undo)
        timeline.add(undo)
        # a handle, of which the stubs do not know
        command = bpy.utils.register_cli_command(  # type: ignore[func-returns-value]
            names.COMMAND, _run_command
        )
        undo.callback(bpy.utils.unregister_cli_command, command)
        return undo.pop_all().close


def _add_worker(undo: ExitStack) -> None:
    """The worker starts with the first request; it must not outlive Blender."""
    end = worker_client.shared().close
    atexit.register(end)
    undo.callback(atexit.unregister, end)
    undo.callback(end)


@persistent  # type: ignore[untyped-decorator]  # any, in the stubs
def _follow_objects(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Empties that were moved, and armatures that were copied."""
    for update in depsgraph.updates:
        if update.is_updated_transform and isinstance(update.id, bpy.types.Object):
            thing = present(update.id.original)
            stances.follow(thing)
            if thing.type == "ARMATURE":
                adopt_copied_slots(thing)


def _run_command(arguments: list[str]) -> int:
    if arguments[:1] == ["batch"]:
        from ..batch import cli as batch  # most sessions never run either

        return batch.main(arguments[1:])
    from ..operators.headless import cli

    return cli.main(arguments)
