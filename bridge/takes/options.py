"""What the artist wants of a result: the panel's choices, or the armature's recipe text."""

from __future__ import annotations

from ..properties.settings import HangtimeSettings
from ..recipe.loop import LoopOptions
from ..recipe.problem import parse_recipe
from ..recipe.result import ResultOptions
from ..rows.choices import After, ContactMarkers, LoopRoot, WrittenAs


def loop_options(settings: HangtimeSettings) -> LoopOptions | None:
    """How a loop is to be written, None where none is; a [loop] in the armature's text goes before
    the panel. Raises BadRecipe."""
    text = settings.requests
    stated = None if text is None else parse_recipe(text.as_string(), text.name).loop
    if stated is not None:
        return stated
    return LoopOptions(LoopRoot[settings.loop.root]) if settings.loop.use else None


def result_options(settings: HangtimeSettings) -> ResultOptions:
    """The options; a [result] in the armature's text goes before the panel. Raises BadRecipe."""
    text = settings.requests
    if text is not None:
        stated = parse_recipe(text.as_string(), text.name).result
        if stated is not None:
            return stated
    chosen = settings.result
    return ResultOptions(
        after=After[chosen.after],
        return_frame=float(chosen.return_frame) if chosen.use_return_frame else None,
        blend_in=float(chosen.blend_in) if chosen.use_blend else None,
        blend_out=float(chosen.blend_out) if chosen.use_blend else None,
        lock_others=chosen.lock_others,
        written_as=WrittenAs[chosen.written_as],
        markers=ContactMarkers[chosen.markers],
        contact_channels=chosen.contact_channels,
    )
