"""Everything that enabling the extension adds to Blender, in order, and how it is taken back."""

from __future__ import annotations

import atexit
from collections.abc import Callable
from contextlib import ExitStack

import bpy
from bpy.app.handlers import persistent

from ..bridge import worker_client
from ..bridge.accessors import ATTRIBUTE, present
from ..bridge.properties import settings, stances
from ..operators import names
from ..operators.drag import aim_cone, limit_operator, pin_operator, turn_stance
from ..operators.export import exports, save_plots
from ..operators.lists import body_changes, constraints, contacts, place_by_empty, presets, put_back
from ..operators.solve import adapt, analyze, results, session, show
from ..operators.timeline import contact_edge_operator
from ..operators.words.translations import TRANSLATIONS
from .gizmos import limit_handles, pin_handles
from .overlay import handlers as overlay
from .panels import constraint_lists, constraint_menus, contact_list, display, menu, setup, solve
from .panels import constraints as constraint_panels
from .panels import contacts as contact_panels
from .plots import handler as plots
from .timeline import handler as timeline

CLASSES = (
    *settings.CLASSES,
    *analyze.CLASSES,
    *adapt.CLASSES,
    *place_by_empty.CLASSES,
    *put_back.CLASSES,
    *show.CLASSES,
    *contacts.CLASSES,
    *constraints.CLASSES,
    *body_changes.CLASSES,
    *presets.CLASSES,
    *results.CLASSES,
    *exports.CLASSES,
    *pin_operator.CLASSES,
    *turn_stance.CLASSES,
    *limit_operator.CLASSES,
    *aim_cone.CLASSES,
    *contact_edge_operator.CLASSES,
    *save_plots.CLASSES,
    *contact_list.CLASSES,
    *menu.CLASSES,
    *setup.CLASSES,
    *contact_panels.CLASSES,
    *constraint_lists.CLASSES,
    *constraint_menus.CLASSES,
    *constraint_panels.CLASSES,
    *solve.CLASSES,
    *display.CLASSES,
    *pin_handles.CLASSES,
    *limit_handles.CLASSES,
)


def register() -> Callable[[], None]:
    """Adds everything, or nothing where a part fails, whose failure is then raised.

    Returns what takes it all back, in reverse.
    """
    with ExitStack() as undo:
        _add_worker(undo)
        for cls in CLASSES:
            # the stubs leave out groups of gizmos
            bpy.utils.register_class(cls)  # type: ignore[arg-type]
            undo.callback(bpy.utils.unregister_class, cls)  # type: ignore[arg-type]
        for carrier, group in settings.CARRIERS.items():
            # a property until it is assigned; the stubs say nothing
            group_of = bpy.props.PointerProperty(  # type: ignore[func-returns-value]
                type=group, override={"LIBRARY_OVERRIDABLE"}
            )
            setattr(carrier, ATTRIBUTE, group_of)
            undo.callback(delattr, carrier, ATTRIBUTE)
        bpy.app.handlers.depsgraph_update_post.append(_follow_empties)
        undo.callback(bpy.app.handlers.depsgraph_update_post.remove, _follow_empties)
        undo.callback(session.session().end)
        # Keys are pairs, whatever the stubs say.
        bpy.app.translations.register(__package__, TRANSLATIONS)  # type: ignore[arg-type]
        undo.callback(bpy.app.translations.unregister, __package__)
        menu.add(undo)
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
def _follow_empties(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    for update in depsgraph.updates:
        if update.is_updated_transform and isinstance(update.id, bpy.types.Object):
            stances.follow(present(update.id.original))


def _run_command(arguments: list[str]) -> int:
    from ..operators.headless import cli  # most sessions never run it

    return int(cli.command(arguments))
