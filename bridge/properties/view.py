"""What the viewport and the timeline show of a motion; stored with the scene."""

from __future__ import annotations

import bpy


class HangtimeView(bpy.types.PropertyGroup):
    """Switches of overlays, plots and of the bars in the timeline."""

    show: bpy.props.BoolProperty(
        name="Hangtime Overlays", description="Show overlays in this scene", default=True
    )
    pins: bpy.props.BoolProperty(
        name="Pins", description="Contacts and points that are held, as red spheres", default=True
    )
    limits: bpy.props.BoolProperty(
        name="Cones and Limits",
        description="Cones around limbs, and arcs of joint limits",
        default=True,
    )
    poses: bpy.props.BoolProperty(
        name="Poses", description="Poses that are asked for, as white bodies", default=True
    )
    forces: bpy.props.BoolProperty(
        name="Contact Forces", description="Forces of the ground as arrows", default=True
    )
    path: bpy.props.BoolProperty(
        name="Centre of Mass",
        description="Its path, and the parabola of each flight",
        default=True,
    )
    momentum: bpy.props.BoolProperty(
        name="Angular Momentum", description="As an arrow at the centre of mass", default=False
    )
    ghosts: bpy.props.BoolProperty(
        name="Ghosts",
        description="The adapted motion beside the recording, at chosen frames",
        default=True,
    )
    ghost_step: bpy.props.IntProperty(
        name="Every", description="Frames from one ghost to the next", default=30, min=1
    )
    recording_too: bpy.props.BoolProperty(
        name="Recording's Ghosts",
        description="Also show the recording at these frames",
        default=True,
    )

    labels: bpy.props.BoolProperty(
        name="Labels", description="Numbers beside pins, limits and arrows", default=True
    )

    plots: bpy.props.BoolProperty(
        name="Plots", description="Curves over time at the foot of the viewport", default=False
    )
    plot_forces: bpy.props.BoolProperty(
        name="Contact Forces", description="In body weights", default=True
    )
    plot_torque: bpy.props.BoolProperty(
        name="Torque", description="Of the chosen joint, with its limit, in N·m", default=True
    )
    plot_bone: bpy.props.StringProperty(
        name="Joint",
        description="The bone whose joint's torque is plotted; the active one if empty",
    )
    plot_com: bpy.props.BoolProperty(
        name="Centre of Mass", description="Its height and its speed", default=True
    )

    timeline: bpy.props.BoolProperty(
        name="Contacts in Timeline",
        description="Contacts and phases as bars in the timeline and the dope sheet; drag their "
        "ends to retime them",
        default=True,
    )


CLASSES = (HangtimeView,)
