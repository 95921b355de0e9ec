"""What the extension stores of each weight that is carried and each limb that is changed."""

from __future__ import annotations

import bpy

from ..rows.choices import BodyKind, Met
from ..rows.row import ASKED, HIDDEN, OVERRIDABLE, OVERRIDABLE_LIST, HangtimeBone, items


class HangtimeBodyChange(bpy.types.PropertyGroup):
    """A row of the body changes' list; `name` is the artist's."""

    name: bpy.props.StringProperty(
        name="Name", description="Your name for it, by which it is reported", override=OVERRIDABLE
    )
    kind: bpy.props.EnumProperty(
        name="Kind", items=items(BodyKind), options=HIDDEN, override=OVERRIDABLE
    )
    met: bpy.props.EnumProperty(name="Met", items=items(Met), options=HIDDEN, override=OVERRIDABLE)
    status: bpy.props.StringProperty(options=HIDDEN, override=OVERRIDABLE)  # a line to be drawn
    used: bpy.props.BoolProperty(
        name="Use", description="Whether this counts", default=True, **ASKED
    )
    bones: bpy.props.CollectionProperty(type=HangtimeBone, override=OVERRIDABLE_LIST)
    by_share: bpy.props.BoolProperty(
        name="Share of the Body", description="Give the weight as a share", **ASKED
    )
    mass: bpy.props.FloatProperty(name="Mass (kg)", min=0.0, soft_max=100.0, default=10.0, **ASKED)
    share: bpy.props.FloatProperty(
        name="Share",
        subtype="FACTOR",
        min=0.0,
        soft_max=1.0,
        default=0.1,
        **ASKED,
    )
    use_offset: bpy.props.BoolProperty(
        name="Own Place",
        description="Carry it elsewhere than at the bone's tail",
        **ASKED,
    )
    offset: bpy.props.FloatVectorProperty(
        name="Offset",
        description="From the bone's head, in the bone's axes and the armature's own scale",
        size=3,
        subtype="TRANSLATION",
        unit="LENGTH",
        **ASKED,
    )
    length: bpy.props.FloatProperty(
        name="Length",
        description="Times as long",
        min=0.2,
        max=5.0,
        default=1.0,
        **ASKED,
    )
    mass_factor: bpy.props.FloatProperty(
        name="Mass",
        description="Times as heavy",
        min=0.1,
        max=10.0,
        default=1.0,
        **ASKED,
    )


CLASSES = (HangtimeBodyChange,)
