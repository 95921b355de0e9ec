"""Results that go: because the artist discards them, or because they cannot be finished."""

import bpy

from ....bridge.accessors import armature_data, current_action, present, source_of
from ....bridge.armature.actions import show
from ....bridge.armature.strips import remove_strips
from ....bridge.fake_users import unguard
from ....bridge.properties.action import action_settings
from ....bridge.properties.settings import settings_of
from ....bridge.scene.played_end import play_what_is_left
from ....bridge.takes.takes import results_from
from ....bridge.takes.write_result import remove_slot


def remove_result(armature: bpy.types.Object, result: bpy.types.Action) -> None:
    """Remove a result that was made for an armature, with its strips, its slot and an armature that
    was made to perform it; whoever shows it shows what it was made from."""
    settings, recorded = settings_of(armature), source_of(result)
    performer = action_settings(result).performer
    if settings.source == result:
        settings.source = None
    if performer not in (None, armature):
        _remove_performer(performer, armature)
    for each in bpy.data.objects:  # a linked copy may perform it, too
        if current_action(each) == result:
            show(each, recorded)
        remove_strips(each, result)
    remove_slot(result)
    bpy.data.actions.remove(result)
    play_what_is_left(armature)
    if recorded is not None and not results_from(recorded):
        unguard(recorded)
    settings.adapted = None  # the edit at work is no other result's
    settings.status = ""


def _remove_performer(performer: bpy.types.Object, armature: bpy.types.Object) -> None:
    """Remove an armature that was made to perform a result; where it was active, the one that the
    result was made for is."""
    objects, bones = present(bpy.context.view_layer).objects, armature_data(performer)
    was_active = objects.active == performer
    bpy.data.objects.remove(performer)
    if bones.users == 0:
        bpy.data.armatures.remove(bones)
    if was_active and armature.name in objects:
        objects.active = armature
