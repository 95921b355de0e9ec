"""What the next results are made from: the recording, or a result."""

from __future__ import annotations

import bpy

from ..accessors import root_of, source_of
from ..armature.actions import recorded_action, show
from ..armature.traces_store import forget
from ..properties.overridden_lists import linked_count
from ..properties.settings import HangtimeSettings, settings_of
from ..rows.choices import Span
from ..rows.copying import rows_named
from ..takes.takes import keep_edit, show_take
from .combined import bake_shown


def starts_from_result(armature: bpy.types.Object) -> bool:
    """Whether the next result is made from a result, and not from the recording."""
    source = recorded_action(armature)
    return source is not None and source_of(source) is not None


def start_from_result(armature: bpy.types.Object, result: bpy.types.Action) -> None:
    """Make the next results from a result: a second jump builds on the first, and hand polish
    stays. Contacts are to be found anew; limits that always hold stay."""
    keep_edit(armature)
    bake_shown(armature, result)
    settings = settings_of(armature)
    settings.source, settings.adapted = result, None
    rows_named(settings.contacts, ())
    rows_named(settings.stances, ())
    _drop_constraints(armature, settings)
    forget(armature)
    settings.analysed = settings.analysed_motion = settings.analysed_contacts = ""
    settings.analysed_state = settings.unseen = settings.fit_quality = settings.status = ""
    result.use_fake_user = True
    show(armature, result)


def _drop_constraints(armature: bpy.types.Object, settings: HangtimeSettings) -> None:
    """But for those that always hold; an override's linked ones are switched off."""
    linked = linked_count(armature, "constraints")
    for index in reversed(range(len(settings.constraints))):
        if settings.constraints[index].span == Span.ALWAYS.name:
            continue
        if index < linked:
            settings.constraints[index].used = False
        else:
            settings.constraints.remove(index)


def start_from_recording(armature: bpy.types.Object) -> None:
    """Make the next results from the recording again, with the edit that belongs to it."""
    source = recorded_action(armature)
    if source is not None:
        show_take(armature, root_of(source))
