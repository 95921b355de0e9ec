"""What the artist wants of a result: the panel's choices, or the armature's recipe text."""

from __future__ import annotations

from ..properties.settings import HangtimeSettings
from ..recipe.loop import LoopOptions
from ..recipe.problem import Recipe, parse_text
from ..recipe.result import ResultOptions
from ..rows.choices import After, ContactMarkers, LoopRoot, WrittenAs


def text_of(settings: HangtimeSettings) -> Recipe | None:
    """What the armature's recipe text says; None where it has none. Raises BadRecipe."""
    text = settings.requests
    return None if text is None else parse_text(text.as_string(), text.name)


def loop_options(settings: HangtimeSettings) -> LoopOptions | None:
    """How a loop is to be written, None where none is; a [loop] in the armature's text goes before
    the panel. Raises BadRecipe."""
    text = text_of(settings)
    if text is not None and text.loop is not None:
        return text.loop
    return LoopOptions(LoopRoot[settings.loop.root]) if settings.loop.use else None


def result_options(settings: HangtimeSettings) -> ResultOptions:
    """The options; a [result] in the armature's text goes before the panel. Raises BadRecipe."""
    text = text_of(settings)
    if text is not None and text.result is not None:
        return text.result
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
