"""A Blender scene in which the figures of a layout are one after another, a frame each."""

import bpy
import numpy as np

from . import materials
from .layout import Tier
from .materials import Colour, mix
from .scene import SHADED, Floor, Painter, as_quaternion


class FilmPainter(Painter):
    """Draws a tier as one figure that moves; path, floor and marks stand as in the picture."""

    caption = 1 / 28  # films are small

    def surface(self) -> bpy.types.Material:
        return materials.shaded()

    def figures(self, tier: Tier, solids: list[bpy.types.Mesh], colour: Colour) -> None:
        for i, solid in enumerate(solids):
            paint = mix(colour, (0.0, 0.0, 0.0), SHADED) if tier.far[i] else colour
            made = self.object(solid, paint, np.zeros(3))
            made.rotation_mode = "QUATERNION"
            for frame, figure in enumerate(tier.figures, start=1):
                made.location = figure.centre[i].tolist()
                made.rotation_quaternion = as_quaternion(figure.rotation[i])
                made.keyframe_insert("location", frame=frame)
                made.keyframe_insert("rotation_quaternion", frame=frame)

    def labels(self, tier: Tier, floor: Floor, height: float) -> None:
        """No times: the film has its own."""

    def beads(self, tier: Tier, colour: Colour) -> None:
        """None on the path: the figure is where it is."""
