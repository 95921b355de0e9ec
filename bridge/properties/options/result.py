"""What a result holds beside the adapted frames, as the artist chooses it; with the armature."""

from __future__ import annotations

import bpy

from ...rows.choices import After, ContactMarkers, WrittenAs
from ...rows.row import OVERRIDABLE, chosen
from ...rows.stored import boolean, whole


class HangtimeResultOptions(bpy.types.PropertyGroup):
    """Of the rest of the take, and the form in which a result is written."""

    after: bpy.props.EnumProperty(
        name="After",
        description="What becomes of the take after the adapted frames",
        items=[
            (
                After.CARRY.name,
                "Carry Along",
                "What follows goes on from where the last stance has been moved and turned to",
            ),
            (
                After.RETURN.name,
                "Return",
                "What follows comes back to where the take was, by a chosen frame",
            ),
            (
                After.CUT.name,
                "Cut",
                "The result holds the adapted frames alone; the rest of the take is left out",
            ),
        ],
        override=OVERRIDABLE,
    )
    use_return_frame: chosen(
        boolean("By Frame", "Choose by when it is back; else a second after the adapted frames")
    )
    return_frame: chosen(
        whole("By", "Frame of the recording by which the take is back where it was", default=250)
    )
    use_blend: chosen(
        boolean(
            "Custom Blend",
            "Choose how many frames before and after the adapted ones are blended; "
            "else those of a quarter of a second",
        )
    )
    blend_in: chosen(
        whole("In", "Frames before the adapted ones that are blended", default=10, min=0)
    )
    blend_out: chosen(
        whole("Out", "Frames after the adapted ones that are blended", default=10, min=0)
    )
    lock_others: chosen(
        boolean(
            "Lock Other Channels",
            "Face, fingers, properties and whatever else physics does not own keep their times "
            "where durations changed; else they go with the body",
        )
    )
    written_as: bpy.props.EnumProperty(
        name="Written As",
        description="Form in which the next result is written",
        items=[
            (WrittenAs.ACTION.name, "New Action", "The armature performs a new action"),
            (
                WrittenAs.STRIP.name,
                "NLA Strip, Replace",
                "The take goes down into a strip of its own, and the result into one above; "
                "mute its track and the take is there, untouched",
            ),
            (
                WrittenAs.COMBINE.name,
                "NLA Strip, Combine",
                "The strip above holds only the difference, so that the take below can still be "
                "edited. Channels that physics does not own keep their times",
            ),
            (
                WrittenAs.SLOT.name,
                "New Slot",
                "A new slot of the take's own action, whose other slots stay as they are "
                "(Blender 4.5 and later)",
            ),
        ],
        override=OVERRIDABLE,
    )
    keep_polish: chosen(
        boolean(
            "Keep Polish",
            "What you changed by hand in the last result is put on the next one, as offsets from "
            "what was solved. Off: it stays behind with that result",
            default=True,
        )
    )
    markers: bpy.props.EnumProperty(
        name="Contact Markers",
        description="Mark where each foot, hand or knee comes down and goes up",
        items=[
            (ContactMarkers.NONE.name, "None", "No markers"),
            (ContactMarkers.ACTION.name, "Pose Markers", "Markers of the result's action"),
            (ContactMarkers.TIMELINE.name, "Timeline", "Markers of the scene"),
        ],
        override=OVERRIDABLE,
    )
    contact_channels: chosen(
        boolean(
            "Contact Channels",
            "Key a custom property of the armature for each foot, hand or knee, such as "
            "contact_left_foot: 1 while it touches and else 0",
        )
    )


CLASSES = (HangtimeResultOptions,)
