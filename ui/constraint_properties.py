"""What the extension stores of each constraint and body change: one class for all their kinds.

Lengths are in Blender units, world unless said otherwise; frames are the scene's; angles in rad.
bridge/constraint_requests.py says which fields count for which kind, and makes requests of them.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from math import pi, radians

import bpy

from ..bridge.kinds import (
    BodyKind,
    ConstraintKind,
    ForceShape,
    Instant,
    Met,
    PointAxes,
    PoseSource,
    Span,
    TimingBy,
    TorqueBy,
)

HIDDEN = {"HIDDEN"}
OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}
OVERRIDABLE_LIST = {"LIBRARY_OVERRIDABLE", "USE_INSERTION"}


def _items(kinds: Iterable[Enum]) -> list[tuple[str, str, str]]:
    return [(kind.name, kind.value, "") for kind in kinds]


class HangtimeBone(bpy.types.PropertyGroup):
    """A bone of the armature; `name` is its name when last looked at, `key` outlives renaming."""

    key: bpy.props.StringProperty(options=HIDDEN, override=OVERRIDABLE)


class HangtimeConstraint(bpy.types.PropertyGroup):
    """A row of the constraints' list; `name` is the artist's, by which it is reported."""

    kind: bpy.props.EnumProperty(
        name="Kind", items=_items(ConstraintKind), options=HIDDEN, override=OVERRIDABLE
    )
    used: bpy.props.BoolProperty(
        name="Use", description="Whether this counts", default=True, override=OVERRIDABLE
    )
    met: bpy.props.EnumProperty(name="Met", items=_items(Met), options=HIDDEN, override=OVERRIDABLE)
    status: bpy.props.StringProperty(options=HIDDEN, override=OVERRIDABLE)  # a line to be drawn

    # Whose: the first is what single-bone kinds are about.
    bones: bpy.props.CollectionProperty(type=HangtimeBone, override=OVERRIDABLE_LIST)

    # When.
    span: bpy.props.EnumProperty(
        name="When",
        description="During what it holds",
        items=_items(Span),
        default=Span.ALWAYS.name,
        override=OVERRIDABLE,
    )
    phase: bpy.props.StringProperty(
        name="Phase", description="Phase of the clip, as Analyze named it", override=OVERRIDABLE
    )
    instant: bpy.props.EnumProperty(
        name="At",
        description="Throughout the phase, or at one instant of it",
        items=_items(Instant),
        override=OVERRIDABLE,
    )
    first_frame: bpy.props.FloatProperty(
        name="First", description="First frame at which it holds", override=OVERRIDABLE
    )
    last_frame: bpy.props.FloatProperty(
        name="Last", description="Last frame at which it holds", override=OVERRIDABLE
    )

    # POINT
    use_place: bpy.props.BoolProperty(
        name="Own Place",
        description="Hold the point at a place of yours instead of where the recording has it",
        override=OVERRIDABLE,
    )
    place: bpy.props.FloatVectorProperty(
        name="Place",
        description="Where the point shall be, in the world",
        size=3,
        subtype="TRANSLATION",
        unit="LENGTH",
        override=OVERRIDABLE,
    )
    use_offset: bpy.props.BoolProperty(
        name="Own Point",
        description="Choose the point of the bone instead of its middle",
        override=OVERRIDABLE,
    )
    offset: bpy.props.FloatVectorProperty(
        name="Offset",
        description="From the bone's head, in the bone's axes",
        size=3,
        subtype="TRANSLATION",
        unit="LENGTH",
        override=OVERRIDABLE,
    )
    target: bpy.props.PointerProperty(
        name="Target",
        description="An object that the point follows, wherever it moves",
        type=bpy.types.Object,
        override=OVERRIDABLE,
    )
    environment: bpy.props.BoolProperty(
        name="Pushes Back",
        description="Something is there that pushes back with a force, such as a bar or a wall",
        override=OVERRIDABLE,
    )
    grip: bpy.props.BoolProperty(
        name="Grip", description="It can be held on to, so that it pulls too", override=OVERRIDABLE
    )
    axes: bpy.props.EnumProperty(
        name="Axes",
        description="The axes of the bounds",
        items=_items(PointAxes),
        override=OVERRIDABLE,
    )
    normal: bpy.props.FloatVectorProperty(
        name="Normal",
        description="Out of the surface",
        size=3,
        subtype="DIRECTION",
        default=(0.0, 0.0, 1.0),
        override=OVERRIDABLE,
    )
    use_bounds: bpy.props.BoolProperty(
        name="Bounds",
        description="Keep the point within bounds about the place instead of exactly there",
        override=OVERRIDABLE,
    )
    bound_axes: bpy.props.BoolVectorProperty(
        name="Bounded",
        description="Along which axes the point is bounded; it is free along the others",
        size=3,
        default=(True, True, True),
        override=OVERRIDABLE,
    )
    at_least: bpy.props.FloatVectorProperty(
        name="At Least", size=3, unit="LENGTH", subtype="XYZ", override=OVERRIDABLE
    )
    at_most: bpy.props.FloatVectorProperty(
        name="At Most", size=3, unit="LENGTH", subtype="XYZ", override=OVERRIDABLE
    )

    # ANGLE, TWIST
    use_lower: bpy.props.BoolProperty(name="Use At Least", default=True, override=OVERRIDABLE)
    lower: bpy.props.FloatProperty(
        name="At Least", subtype="ANGLE", soft_min=-pi, soft_max=pi, override=OVERRIDABLE
    )
    use_upper: bpy.props.BoolProperty(name="Use At Most", default=True, override=OVERRIDABLE)
    upper: bpy.props.FloatProperty(
        name="At Most",
        subtype="ANGLE",
        soft_min=-pi,
        soft_max=pi,
        default=radians(140.0),
        override=OVERRIDABLE,
    )

    # CONE
    half_angle: bpy.props.FloatProperty(
        name="Half Angle",
        description="How far the bone may lean from the cone's axis",
        subtype="ANGLE",
        min=radians(1.0),
        max=radians(179.0),
        default=radians(40.0),
        override=OVERRIDABLE,
    )
    use_axis: bpy.props.BoolProperty(
        name="Own Axis",
        description="Aim the cone yourself instead of along the recording's mean direction",
        override=OVERRIDABLE,
    )
    axis: bpy.props.FloatVectorProperty(
        name="Axis",
        description="Where the bone would point in the armature's rest pose, in its parent",
        size=3,
        subtype="DIRECTION",
        default=(0.0, 0.0, -1.0),
        override=OVERRIDABLE,
    )
    stretch: bpy.props.FloatVectorProperty(
        name="Stretch",
        description="How much wider the cone is sideways, and forwards and backwards",
        size=2,
        min=0.1,
        max=10.0,
        default=(1.0, 1.0),
        override=OVERRIDABLE,
    )

    # TORQUE
    torque_by: bpy.props.EnumProperty(name="In", items=_items(TorqueBy), override=OVERRIDABLE)
    torque: bpy.props.FloatProperty(
        name="At Most (N·m)",
        description="Largest torque of the joint; zero makes it limp",
        min=0.0,
        soft_max=500.0,
        default=50.0,
        override=OVERRIDABLE,
    )
    share: bpy.props.FloatProperty(
        name="At Most",
        description="Of the largest torque that the recording needs; zero makes the joint limp",
        subtype="FACTOR",
        min=0.0,
        soft_max=1.0,
        default=0.5,
        override=OVERRIDABLE,
    )
    torque_value: bpy.props.FloatProperty(
        name="About (N·m)", description="The torque about which it is bounded", override=OVERRIDABLE
    )
    use_dof: bpy.props.BoolProperty(
        name="One Angle", description="Bound only one of the joint's angles", override=OVERRIDABLE
    )
    dof: bpy.props.IntProperty(name="Angle", min=0, max=2, override=OVERRIDABLE)

    # POSE, ORIENTATION
    source: bpy.props.EnumProperty(name="From", items=_items(PoseSource), override=OVERRIDABLE)
    use_pose_frame: bpy.props.BoolProperty(
        name="Of Another Frame",
        description="Take the pose from one frame of the recording instead of the same frame",
        override=OVERRIDABLE,
    )
    pose_frame: bpy.props.FloatProperty(name="Pose Frame", override=OVERRIDABLE)
    hard: bpy.props.BoolProperty(
        name="Hold Exactly",
        description="The pose is held; off, it is only preferred",
        default=True,
        override=OVERRIDABLE,
    )
    weight: bpy.props.FloatProperty(
        name="Weight",
        description="How strongly the pose is preferred",
        min=0.0,
        default=1.0,
        override=OVERRIDABLE,
    )
    slack: bpy.props.FloatProperty(
        name="Slack",
        description="By how much each angle may miss it",
        subtype="ANGLE",
        min=0.0,
        max=pi,
        override=OVERRIDABLE,
    )
    turn: bpy.props.FloatProperty(
        name="Turn",
        description="About the vertical, counter-clockwise seen from above",
        subtype="ANGLE",
        override=OVERRIDABLE,
    )
    tilt: bpy.props.FloatProperty(
        name="Tilt", description="Forwards", subtype="ANGLE", override=OVERRIDABLE
    )

    # FORCE
    use_peak: bpy.props.BoolProperty(
        name="Limit Peak",
        description="Cap the largest contact force, for a softer landing",
        default=True,
        override=OVERRIDABLE,
    )
    peak: bpy.props.FloatProperty(
        name="Peak",
        description="Largest contact force, in body weights",
        min=0.1,
        soft_max=10.0,
        default=3.0,
        override=OVERRIDABLE,
    )
    use_friction: bpy.props.BoolProperty(
        name="Own Friction",
        description="Set how slippery the ground is; 1 otherwise",
        override=OVERRIDABLE,
    )
    friction: bpy.props.FloatProperty(
        name="Friction", min=0.0, soft_max=1.5, default=0.8, override=OVERRIDABLE
    )
    shape: bpy.props.EnumProperty(name="Shape", items=_items(ForceShape), override=OVERRIDABLE)
    use_match: bpy.props.BoolProperty(
        name="Keep Forces",
        description="Keep all forces more like the recording's",
        override=OVERRIDABLE,
    )
    match: bpy.props.FloatProperty(
        name="How Strongly", min=1.0, soft_max=100.0, default=10.0, override=OVERRIDABLE
    )

    # TIMING, HOLD
    timing_by: bpy.props.EnumProperty(name="By", items=_items(TimingBy), override=OVERRIDABLE)
    factor: bpy.props.FloatProperty(
        name="Times", min=0.1, max=10.0, default=1.0, override=OVERRIDABLE
    )
    seconds: bpy.props.FloatProperty(
        name="Seconds", min=0.0, soft_max=5.0, default=0.5, override=OVERRIDABLE
    )
    ends: bpy.props.BoolProperty(
        name="Ends There",
        description="Leave out the recording after the held frame",
        override=OVERRIDABLE,
    )


class HangtimeBodyChange(bpy.types.PropertyGroup):
    """A row of the body changes' list; `name` is the artist's."""

    kind: bpy.props.EnumProperty(
        name="Kind", items=_items(BodyKind), options=HIDDEN, override=OVERRIDABLE
    )
    used: bpy.props.BoolProperty(
        name="Use", description="Whether this counts", default=True, override=OVERRIDABLE
    )
    bones: bpy.props.CollectionProperty(type=HangtimeBone, override=OVERRIDABLE_LIST)
    by_share: bpy.props.BoolProperty(
        name="Share of the Body", description="Give the weight as a share", override=OVERRIDABLE
    )
    mass: bpy.props.FloatProperty(
        name="Mass (kg)", min=0.0, soft_max=100.0, default=10.0, override=OVERRIDABLE
    )
    share: bpy.props.FloatProperty(
        name="Share",
        subtype="FACTOR",
        min=0.0,
        soft_max=1.0,
        default=0.1,
        override=OVERRIDABLE,
    )
    use_offset: bpy.props.BoolProperty(
        name="Own Place",
        description="Carry it elsewhere than at the bone's tail",
        override=OVERRIDABLE,
    )
    offset: bpy.props.FloatVectorProperty(
        name="Offset",
        description="From the bone's head, in the bone's axes",
        size=3,
        subtype="TRANSLATION",
        unit="LENGTH",
        override=OVERRIDABLE,
    )
    length: bpy.props.FloatProperty(
        name="Length",
        description="Times as long",
        min=0.2,
        max=5.0,
        default=1.0,
        override=OVERRIDABLE,
    )
    mass_factor: bpy.props.FloatProperty(
        name="Mass",
        description="Times as heavy",
        min=0.1,
        max=10.0,
        default=1.0,
        override=OVERRIDABLE,
    )


CLASSES = (HangtimeBone, HangtimeConstraint, HangtimeBodyChange)
