"""The scene's last frame, which goes along with results that are longer than what they were made
from, and back as they are discarded."""

from math import floor

import bpy

from ..accessors import play_to_end, root_of, shown_range, source_of
from ..action_slots import lost_slot
from ..properties.action import action_settings
from ..properties.settings import scene_settings


def play_longer(
    scene: bpy.types.Scene, armature: bpy.types.Object, result: bpy.types.Action
) -> bool:
    """Where a scene plays to its end what an armature's result was made from, it plays the result
    to its own; and with it the armature's other scenes that have ended where it did. But not where
    the artist has set the end back since another result of that recording. Whether the scene's end
    has changed."""
    kept, (before, last) = scene_settings(scene), _ends(armature, result)
    ended = scene.frame_end
    set_back = kept.own_end <= ended < kept.lengthened_to and _is_repeated(scene, armature, result)
    others = [each for each in armature.users_scene if each != scene]
    alike = [each for each in others if each.frame_end == scene.frame_end]
    if not set_back and ended != kept.lengthened_to:  # the artist's own, from which all counts anew
        kept.own_end = kept.lengthened_to = scene.frame_end
        for _, earlier in _results(scene):
            action_settings(earlier).lengthens = False
    action_settings(result).lengthens = floor(before) <= ended
    if set_back:  # also for the next one, should those before this be discarded
        return False
    play_to_end(scene, before, last)
    kept.lengthened_to = scene.frame_end
    for each in alike:
        its = scene_settings(each)
        if each.frame_end != its.lengthened_to:
            its.own_end = each.frame_end
        each.frame_end = its.lengthened_to = scene.frame_end
    return bool(scene.frame_end != ended)


def play_what_is_left(armature: bpy.types.Object) -> None:
    """After a result has gone: the armature's scenes end as if only those that are left had been
    made since the artist set their ends, of any armature; but they stay where the artist has
    changed them since."""
    for scene in armature.users_scene:
        _play_what_is_left(scene)


def _play_what_is_left(scene: bpy.types.Scene) -> None:
    kept, left = scene_settings(scene), _lengthening(scene)
    if scene.frame_end == kept.lengthened_to:
        scene.frame_end = kept.own_end
        for before, last in sorted(_ends(*each) for each in left):
            play_to_end(scene, before, last)
        kept.lengthened_to = scene.frame_end
    elif not left:  # nothing is left of what the artist has set back
        kept.own_end = kept.lengthened_to = scene.frame_end


def _is_repeated(
    scene: bpy.types.Scene, armature: bpy.types.Object, result: bpy.types.Action
) -> bool:
    """Whether a scene was lengthened for another result of an armature's recording."""
    return any(
        maker == armature and earlier != result and root_of(earlier) == root_of(result)
        for maker, earlier in _lengthening(scene)
    )


def _ends(armature: bpy.types.Object, result: bpy.types.Action) -> tuple[float, float]:
    """Last frames of what a result was made from, and of itself."""
    source = source_of(result)
    assert source is not None
    return shown_range(armature, source)[1], shown_range(armature, result)[1]


def _lengthening(scene: bpy.types.Scene) -> list[tuple[bpy.types.Object, bpy.types.Action]]:
    """The results that a scene goes to the end of, unless the artist has set it back."""
    return [each for each in _results(scene) if action_settings(each[1]).lengthens]


def _results(scene: bpy.types.Scene) -> list[tuple[bpy.types.Object, bpy.types.Action]]:
    """All results of a scene's armatures."""
    made = (a for a in bpy.data.actions if source_of(a) is not None and not lost_slot(a))
    pairs = ((action_settings(action).maker, action) for action in made)
    return [(o, action) for o, action in pairs if o is not None and scene in o.users_scene]
