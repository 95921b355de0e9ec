"""What the viewport and the timeline show of a motion; stored with the scene."""

from __future__ import annotations

from typing import Any

import bpy

from ..rows.row import declared
from ..rows.stored import boolean, text, whole


def _switch(name: str, description: str, *, on: bool = True) -> Any:
    return declared(boolean(name, description, default=on))


class HangtimeView(bpy.types.PropertyGroup):
    """Switches of overlays, plots and of the bars in the timeline."""

    show: _switch("Hangtime Overlays", "Show overlays in this scene")
    pins: _switch("Pins", "Contacts and points that are held, as red spheres")
    limits: _switch("Cones and Limits", "Cones around limbs, and arcs of joint limits")
    all_limits: _switch(
        "All Limits",
        "Every cone and limit; else the chosen one, those of selected bones, and what is missed",
        on=False,
    )
    poses: _switch("Poses", "Poses that are asked for, as white bodies")
    forces: _switch("Contact Forces", "Forces of the ground as arrows")
    path: _switch("Centre of Mass", "Its path, and the parabola of each flight")
    momentum: _switch("Angular Momentum", "As an arrow at the centre of mass", on=False)
    changes: _switch(
        "Joint Changes",
        "The adapted motion's limbs in colours that tell how far each joint is turned from the "
        "recording's: blue as it was, yellow by 15°, red by 45° and more",
        on=False,
    )
    shapes: _switch("Shapes", "The body's solid shapes; red where one is in something", on=False)
    faults: _switch(
        "Recording's Faults",
        "Points of feet that slide, float or sink, and bones at frames that are wrong, as the "
        "recording was examined",
    )
    ghosts: _switch("Ghosts", "The adapted motion beside the recording, at chosen frames")
    ghost_auto: _switch(
        "Automatic",
        "Some nine ghosts about the flight that is shown, fading towards its surroundings; "
        "else one every so many frames of the whole clip",
    )
    ghost_step: declared(whole("Every", "Frames from one ghost to the next", default=30, min=1))
    recording_too: _switch("Recording's Ghosts", "Also show the recording at these frames")

    labels: _switch("Labels", "Numbers beside pins, limits and arrows")

    plots: _switch("Plots", "Curves over time at the foot of the viewport", on=False)
    plot_forces: _switch("Contact Forces", "In body weights, those on Earth")
    plot_torque: _switch("Torque", "Of the chosen joint, with its limit, in N·m")
    plot_bone: declared(
        text("Joint", "The bone whose joint's torque is plotted; the active one if empty")
    )
    plot_com: _switch("Centre of Mass", "Its height and its speed")

    timeline: _switch(
        "Contacts in Timeline",
        "Contacts and phases as bars in the timeline and the dope sheet; drag their "
        "ends to retime them",
    )


CLASSES = (HangtimeView,)
