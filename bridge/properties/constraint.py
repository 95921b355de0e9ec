"""What the extension stores of each constraint: one class for all their kinds.

Lengths are in Blender units, world unless said otherwise; frames are the scene's; angles in rad.
bridge/constraints/requests.py says which fields count for which kind, and makes requests of them.
"""

from __future__ import annotations

from math import pi, radians

import bpy

from ..accessors import attached
from . import phases
from .kinds import (
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
from .row import ASKED, HIDDEN, OVERRIDABLE, OVERRIDABLE_LIST, HangtimeBone, items


def _phases(row: HangtimeConstraint, _context: bpy.types.Context, _typed: str) -> tuple[str, ...]:
    return phases.names(attached(row.id_data))


class HangtimeConstraint(bpy.types.PropertyGroup):
    """A row of the constraints' list; `name` is the artist's, by which it is reported."""

    name: bpy.props.StringProperty(
        name="Name", description="Your name for it, by which it is reported", override=OVERRIDABLE
    )
    kind: bpy.props.EnumProperty(
        name="Kind", items=items(ConstraintKind), options=HIDDEN, override=OVERRIDABLE
    )
    used: bpy.props.BoolProperty(
        name="Use", description="Whether this counts", default=True, **ASKED
    )
    met: bpy.props.EnumProperty(name="Met", items=items(Met), options=HIDDEN, override=OVERRIDABLE)
    status: bpy.props.StringProperty(options=HIDDEN, override=OVERRIDABLE)  # a line to be drawn

    # Whose: the first is what single-bone kinds are about.
    bones: bpy.props.CollectionProperty(type=HangtimeBone, override=OVERRIDABLE_LIST)

    # When.
    span: bpy.props.EnumProperty(
        name="When",
        description="During what it holds",
        items=items(Span),
        default=Span.ALWAYS.name,
        **ASKED,
    )
    phase: bpy.props.StringProperty(
        name="Phase",
        description="Phase of the clip, as Analyze named it, or a Hold",
        search=_phases,
        search_options={"SUGGESTION"},
        **ASKED,
    )
    instant: bpy.props.EnumProperty(
        name="At",
        description="Throughout the phase, or at one instant of it",
        items=items(Instant),
        **ASKED,
    )
    first_frame: bpy.props.FloatProperty(
        name="First",
        description="First frame at which it holds",
        precision=1,
        step=100,
        **ASKED,
    )
    last_frame: bpy.props.FloatProperty(
        name="Last",
        description="Last frame at which it holds",
        precision=1,
        step=100,
        **ASKED,
    )

    # POINT
    use_place: bpy.props.BoolProperty(
        name="Own Place",
        description="Hold the point at a place of yours instead of where the recording has it",
        **ASKED,
    )
    place: bpy.props.FloatVectorProperty(
        name="Place",
        description="Where the point shall be, in the world",
        size=3,
        subtype="TRANSLATION",
        unit="LENGTH",
        **ASKED,
    )
    use_offset: bpy.props.BoolProperty(
        name="Own Point",
        description="Choose the point of the bone instead of its middle",
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
    target: bpy.props.PointerProperty(
        name="Target",
        description="An object that the point follows, wherever it moves",
        type=bpy.types.Object,
        **ASKED,
    )
    environment: bpy.props.BoolProperty(
        name="Pushes Back",
        description="Something is there that pushes back with a force, such as a bar or a wall",
        **ASKED,
    )
    grip: bpy.props.BoolProperty(
        name="Grip", description="It can be held on to, so that it pulls too", **ASKED
    )
    axes: bpy.props.EnumProperty(
        name="Axes",
        description="The axes of the bounds",
        items=items(PointAxes),
        **ASKED,
    )
    normal: bpy.props.FloatVectorProperty(
        name="Normal",
        description="Out of the surface",
        size=3,
        subtype="DIRECTION",
        default=(0.0, 0.0, 1.0),
        **ASKED,
    )
    use_bounds: bpy.props.BoolProperty(
        name="Bounds",
        description="Keep the point within bounds about the place instead of exactly there",
        **ASKED,
    )
    bound_axes: bpy.props.BoolVectorProperty(
        name="Bounded",
        description="Along which axes the point is bounded; it is free along the others",
        size=3,
        default=(True, True, True),
        **ASKED,
    )
    bound_below: bpy.props.BoolVectorProperty(
        name="Bounded Below",
        description="Along which axes there is a least value",
        size=3,
        default=(True, True, True),
        **ASKED,
    )
    bound_above: bpy.props.BoolVectorProperty(
        name="Bounded Above",
        description="Along which axes there is a greatest value",
        size=3,
        default=(True, True, True),
        **ASKED,
    )
    at_least: bpy.props.FloatVectorProperty(
        name="At Least",
        description="Least distance from the place along each axis",
        size=3,
        unit="LENGTH",
        subtype="XYZ",
        **ASKED,
    )
    at_most: bpy.props.FloatVectorProperty(
        name="At Most",
        description="Greatest distance from the place along each axis",
        size=3,
        unit="LENGTH",
        subtype="XYZ",
        **ASKED,
    )

    # ANGLE, TWIST
    use_lower: bpy.props.BoolProperty(name="Use At Least", default=True, **ASKED)
    lower: bpy.props.FloatProperty(
        name="At Least", subtype="ANGLE", soft_min=-pi, soft_max=pi, **ASKED
    )
    use_upper: bpy.props.BoolProperty(name="Use At Most", default=True, **ASKED)
    upper: bpy.props.FloatProperty(
        name="At Most",
        subtype="ANGLE",
        soft_min=-pi,
        soft_max=pi,
        default=radians(140.0),
        **ASKED,
    )

    # CONE
    half_angle: bpy.props.FloatProperty(
        name="Half Angle",
        description="How far the bone may lean from the cone's axis",
        subtype="ANGLE",
        min=radians(1.0),
        max=radians(179.0),
        default=radians(40.0),
        **ASKED,
    )
    use_axis: bpy.props.BoolProperty(
        name="Own Axis",
        description="Aim the cone yourself instead of along the recording's mean direction",
        **ASKED,
    )
    axis: bpy.props.FloatVectorProperty(
        name="Axis",
        description="Where the bone would point in the armature's rest pose, in its parent",
        size=3,
        subtype="DIRECTION",
        default=(0.0, 0.0, -1.0),
        **ASKED,
    )
    stretch: bpy.props.FloatVectorProperty(
        name="Stretch",
        description="How much wider the cone is sideways, and forwards and backwards",
        size=2,
        min=0.1,
        max=10.0,
        default=(1.0, 1.0),
        **ASKED,
    )

    # TORQUE
    torque_by: bpy.props.EnumProperty(name="In", items=items(TorqueBy), **ASKED)
    torque: bpy.props.FloatProperty(
        name="At Most (N·m)",
        description="Largest torque of the joint; zero makes it limp",
        min=0.0,
        soft_max=500.0,
        default=50.0,
        **ASKED,
    )
    share: bpy.props.FloatProperty(
        name="At Most",
        description="Of the largest torque that the recording needs; zero makes the joint limp",
        subtype="FACTOR",
        min=0.0,
        soft_max=1.0,
        default=0.5,
        **ASKED,
    )
    torque_value: bpy.props.FloatProperty(
        name="About (N·m)", description="The torque about which it is bounded", **ASKED
    )
    use_dof: bpy.props.BoolProperty(
        name="One Angle", description="Bound only one of the joint's angles", **ASKED
    )
    dof: bpy.props.IntProperty(name="Angle", min=0, max=2, **ASKED)

    # POSE, ORIENTATION
    source: bpy.props.EnumProperty(name="From", items=items(PoseSource), **ASKED)
    use_pose_frame: bpy.props.BoolProperty(
        name="Of Another Frame",
        description="Take the pose from one frame of the recording instead of the same frame",
        **ASKED,
    )
    pose_frame: bpy.props.FloatProperty(
        name="Pose Frame",
        description="Frame of the recording whose pose is taken",
        precision=1,
        step=100,
        **ASKED,
    )
    hard: bpy.props.BoolProperty(
        name="Hold Exactly",
        description="The pose is held; off, it is only preferred",
        default=True,
        **ASKED,
    )
    weight: bpy.props.FloatProperty(
        name="Weight",
        description="How strongly the pose is preferred",
        min=0.01,
        default=1.0,
        **ASKED,
    )
    slack: bpy.props.FloatProperty(
        name="Slack",
        description="By how much each angle may miss it",
        subtype="ANGLE",
        min=0.0,
        max=pi,
        **ASKED,
    )
    turn: bpy.props.FloatProperty(
        name="Turn",
        description="About the vertical, counter-clockwise seen from above",
        subtype="ANGLE",
        **ASKED,
    )
    tilt: bpy.props.FloatProperty(name="Tilt", description="Forwards", subtype="ANGLE", **ASKED)

    # FORCE
    use_peak: bpy.props.BoolProperty(
        name="Limit Peak",
        description="Cap the largest contact force, for a softer landing",
        default=True,
        **ASKED,
    )
    peak: bpy.props.FloatProperty(
        name="Peak",
        description="Largest contact force, in body weights",
        min=0.1,
        soft_max=10.0,
        default=3.0,
        **ASKED,
    )
    use_friction: bpy.props.BoolProperty(
        name="Own Friction",
        description="Set how slippery the ground is; 1 otherwise",
        **ASKED,
    )
    friction: bpy.props.FloatProperty(name="Friction", min=0.0, soft_max=1.5, default=0.8, **ASKED)
    shape: bpy.props.EnumProperty(name="Shape", items=items(ForceShape), **ASKED)
    use_match: bpy.props.BoolProperty(
        name="Keep Forces",
        description="Keep all forces more like the recording's",
        **ASKED,
    )
    match: bpy.props.FloatProperty(
        name="How Strongly", min=1.0, soft_max=100.0, default=10.0, **ASKED
    )

    # TIMING, HOLD
    timing_by: bpy.props.EnumProperty(name="By", items=items(TimingBy), **ASKED)
    factor: bpy.props.FloatProperty(name="Times", min=0.1, max=10.0, default=1.0, **ASKED)
    seconds: bpy.props.FloatProperty(name="Seconds", min=0.0, soft_max=5.0, default=0.5, **ASKED)
    ends: bpy.props.BoolProperty(
        name="Ends There",
        description="Leave out the recording after the held frame",
        **ASKED,
    )


CLASSES = (HangtimeConstraint,)
