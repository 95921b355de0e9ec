"""The bars of the chosen armature's contacts in a timeline or dope sheet."""

from collections.abc import Callable, Iterator

import bpy

from ...bridge.accessors import present
from ...bridge.plots.screen import Axis
from ...bridge.properties.of_actions.shown_times import shown_frames
from ...bridge.properties.settings import HangtimeSettings, scene_settings, settings_of
from ...bridge.repairs.stored import finding_of, findings, is_applied
from ...bridge.rows.phases import carried, clip_ends, phases
from ...solver.data.contacts import PhaseKind
from ..solve.common import chosen_armature
from .contact_bars import Bar, Bars, Row, lay_out

SIDES = ("Left", "Right")
PHASES, DOUBTS = "Phases", "Recording"
HALF = 0.5  # frames


def bars_in(context: bpy.types.Context) -> Bars | None:
    """The bars in the editor of a context; None where there are none to be seen."""
    armature, region = chosen_armature(context), context.region
    if armature is None or region is None or not _wanted(context):
        return None
    rows = rows_of(settings_of(armature), shown_frames(armature))
    axis = frames_axis(region)
    if not rows or axis is None:
        return None
    scale = present(context.preferences).system.ui_scale
    return lay_out(rows, axis, region.height, scale, markers=_markers(context))


def frames_axis(region: bpy.types.Region) -> Axis | None:
    """From frames to px, as the editor is scrolled and zoomed."""
    first, _ = region.view2d.region_to_view(0.0, 0.0)
    last, _ = region.view2d.region_to_view(float(region.width), 0.0)
    return Axis(first, last, 0.0, float(region.width)) if last > first else None


def rows_of(settings: HangtimeSettings, shown: Callable[[float], float]) -> tuple[Row, ...]:
    """A row of what is wrong with the recording, one for each point that touches, left before
    right, and the phases; none of what there is not.

    shown: where the recording's frames are in the action that is shown.
    """
    ends, doubts = clip_ends(settings), tuple(_doubts(settings, shown))
    wrong = (Row(DOUBTS, doubts),) if doubts else ()
    if ends is None:
        return wrong
    points: dict[str, list[Bar]] = {}
    for index, row in enumerate(settings.contacts):
        if row.surplus:
            continue
        chosen = index == settings.active_contact
        bar = Bar(row.name, shown(row.start_frame), shown(row.end_frame), row.used, chosen)
        points.setdefault(row.point, []).append(bar)
    rows = [Row(point, tuple(bars)) for point, bars in sorted(points.items(), key=_order)]
    spans = phases(carried(settings), *ends)
    bars = tuple(
        Bar(s.name, shown(s.start), shown(s.end), is_phase=True, firm=s.kind is PhaseKind.FLIGHT)
        for s in spans
    )
    return (*wrong, *rows, Row(PHASES, bars))


def _doubts(settings: HangtimeSettings, shown: Callable[[float], float]) -> Iterator[Bar]:
    """The frames of what is wrong with the recording, each half a frame wider on both sides; what
    is repaired already does not count."""
    for row in findings(settings):
        mended = any(is_applied(settings, row, other=other) for other in (False, True))
        for first, last in finding_of(row).frames:
            yield Bar(
                row.name.capitalize(),
                shown(first) - HALF,
                shown(last) + HALF,
                used=not mended,
                firm=True,
                is_doubt=True,
            )


def _order(item: tuple[str, list[Bar]]) -> tuple[int, str]:
    side = item[0].split(" ", maxsplit=1)[0]
    return SIDES.index(side) if side in SIDES else len(SIDES), item[0]


def _wanted(context: bpy.types.Context) -> bool:
    overlays = getattr(context.space_data, "overlays", None)  # since Blender 4.4
    shown = overlays is None or overlays.show_overlays
    return bool(shown and scene_settings(context.scene).view.timeline)


def _markers(context: bpy.types.Context) -> bool:
    """True where the editor shows markers, which have a strip of their own at its foot."""
    shown = getattr(context.space_data, "show_markers", False)
    return bool(shown and present(context.scene).timeline_markers)
