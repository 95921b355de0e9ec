"""Puts a sheet's layout into a Blender scene: solids, letters, lines, lamp and camera."""

from dataclasses import dataclass, field
from math import cos, pi, radians, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..solver.recording import FloatArray
from . import sheet_materials, sheet_solids
from .sheet_layout import Figure, Layout, Tier
from .sheet_materials import Colour, mix, srgb

ELEVATION = radians(9.0)
ACROSS = np.array([1.0, 0.0, 0.0])
UP = np.array([0.0, sin(ELEVATION), cos(ELEVATION)])  # up in the picture
AWAY = np.array([0.0, cos(ELEVATION), -sin(ELEVATION)])  # from the viewer into the picture
APART = 80.0  # m between tiers along AWAY: unseen, and they cast no shadow on each other

DEPTH = 0.8  # m, half the depth of the floor
THICKNESS, GRID_STEP = 0.05, 0.5
FOOT = DEPTH * sin(ELEVATION) + THICKNESS + 0.2  # m that floor and labels take below z = floor
MARGIN, GAP, EDGE = 0.3, 0.14, 0.12  # m beside the figures, between the rows, around it all
CAPTION, LABEL = 0.17, 0.1  # m, heights of the letters
PIN, PATH, BEAD = 0.034, 0.012, 0.024  # m, radii

PAPER, FLOOR, GRID, INK = srgb("f7f8fa"), srgb("e9ebef"), srgb("c9ced6"), srgb("39424e")
RED = srgb("d8202a")
BODIES = (srgb("7e8c9d"), srgb("3f83c4"), srgb("3a9d86"), srgb("8a6fc0"))  # one for each row
PATHS = (srgb("2f3a48"), srgb("123f70"), srgb("115445"), srgb("3f2a75"))


@dataclass
class Painter:
    """Adds objects to a scene, in two collections: `lit` solids, and `flat` letters and lines.

    origin: (3,) m, the place of the current tier's canvas origin.
    """

    scene: Any
    origin: FloatArray = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        self.matt, self.plain = sheet_materials.matt(), sheet_materials.plain()
        self.lit, self.flat = self.collection("lit"), self.collection("flat")

    def collection(self, name: str) -> Any:
        import bpy

        made = bpy.data.collections.new(name)
        self.scene.collection.children.link(made)
        return made

    def draw(self, layout: Layout, width: int) -> None:
        left, right = layout.left - MARGIN, layout.right + MARGIN
        ground = np.array([0.0, 0.0, layout.floor])
        bottom = 0.0  # m in the picture, from the first tier's floor
        for k, tier in enumerate(layout.tiers):
            head = (tier.corners()[1, 2] - layout.floor) * cos(ELEVATION) + 0.12
            top = bottom - (head + CAPTION + GAP if k else 0.0)
            self.origin = k * APART * AWAY + top * UP
            self.stage(left, right, layout.floor)
            self.tier(tier, k, layout.floor)
            self.text(tier.title, ground + left * ACROSS + head * UP, CAPTION)
            bottom = top - FOOT
            if k == 0:
                crown = head + CAPTION
        self.origin = np.zeros(3)
        self.light()
        middle = ground + (left + right) / 2 * ACROSS + (crown + bottom) / 2 * UP
        self.camera(middle, right - left + 2 * EDGE, crown - bottom + 2 * EDGE, width)

    def stage(self, left: float, right: float, floor: float) -> None:
        top = np.array([0.0, 0.0, floor])
        low = np.array([left, -DEPTH, -THICKNESS])
        self.mesh(sheet_solids.block(top + low, top + np.array([right, DEPTH, 0.0])), FLOOR)
        for x in np.arange(np.ceil(left / GRID_STEP), right / GRID_STEP) * GRID_STEP:
            reach = np.array([0.0, DEPTH - 0.005, 0.0])  # clear of the front of a step
            self.line(np.array([x, 0.0, floor]) - reach, np.array([x, 0.0, floor]) + reach, 0.005)
        for y in (-GRID_STEP, 0.0, GRID_STEP):
            self.line(np.array([left, y, floor]), np.array([right, y, floor]), 0.012)

    def line(self, start: FloatArray, end: FloatArray, half_width: float) -> None:
        """A line on the floor; those across the view are drawn wider, as they are foreshortened."""
        reach = half_width * np.sign(end - start)[[1, 0, 2]] + [0.0, 0.0, 0.0015]
        self.mesh(sheet_solids.block(start - reach, end + reach), GRID)

    def tier(self, tier: Tier, k: int, floor: float) -> None:
        for step in tier.steps:
            low = np.array([step.left, -DEPTH, floor])
            self.mesh(sheet_solids.block(low, np.array([step.right, DEPTH, step.top])), FLOOR)
        solids = [
            self.shape(sheet_solids.limb(size, end, head="head" in name.lower()), self.matt)
            for size, end, name in zip(tier.sizes, tier.proximal, tier.names, strict=True)
        ]
        colour = BODIES[k % len(BODIES)]
        for age, figure in zip(np.linspace(1, 0, len(tier.figures)), tier.figures, strict=True):
            self.figure(figure, solids, tier.far, mix(colour, PAPER, 0.5 * age))
        self.labels(tier, floor)
        self.path(tier, PATHS[k % len(PATHS)])
        ball = self.shape(sheet_solids.ball(PIN), self.matt)
        for pin in tier.pins:
            made = self.object(self.lit, ball, RED, pin - 2 * AWAY)  # before the feet
            made.visible_shadow = made.visible_diffuse = made.visible_glossy = False

    def figure(
        self, figure: Figure, solids: list[Any], far: NDArray[np.bool_], colour: Colour
    ) -> None:
        shade = mix(colour, (0.0, 0.0, 0.0), 0.35)
        for i, solid in enumerate(solids):
            made = self.object(self.lit, solid, shade if far[i] else colour, figure.centre[i])
            made.rotation_mode = "QUATERNION"
            made.rotation_quaternion = _quaternion(figure.rotation[i])

    def labels(self, tier: Tier, floor: float) -> None:
        """The time below each figure, where it does not run into the one before."""
        end = -np.inf
        for figure in tier.figures:
            if figure.com[0] - end > 4.3 * LABEL:
                end = figure.com[0]
                front = np.array([end, -DEPTH, floor - THICKNESS])
                self.text(f"{figure.time:.2f} s", front - 1.5 * LABEL * UP, LABEL, centred=True)

    def path(self, tier: Tier, colour: Colour) -> None:
        """A tube along the centre of mass with a bead at each figure."""
        import bpy

        bead = self.shape(sheet_solids.ball(BEAD), self.plain)
        for figure in tier.figures:
            self.object(self.flat, bead, colour, figure.com)
        curve = bpy.data.curves.new("path", "CURVE")
        curve.dimensions = "3D"
        curve.bevel_depth = PATH
        curve.use_fill_caps = True
        spline = curve.splines.new("POLY")
        spline.points.add(len(tier.path) - 1)
        four = np.column_stack([tier.path, np.ones(len(tier.path))])
        spline.points.foreach_set("co", four.astype(np.float32).ravel())
        curve.materials.append(self.plain)
        self.object(self.flat, curve, colour, np.zeros(3))

    def text(self, body: str, place: FloatArray, height: float, *, centred: bool = False) -> None:
        import bpy

        curve = bpy.data.curves.new("text", "FONT")
        curve.body = body
        curve.size = height * 1.35  # the font's capitals fill three quarters of its size
        curve.align_x = "CENTER" if centred else "LEFT"
        curve.materials.append(self.plain)
        made = self.object(self.flat, curve, INK, place)
        made.rotation_euler = (pi / 2 - ELEVATION, 0.0, 0.0)

    def mesh(self, solid: sheet_solids.Mesh, colour: Colour) -> None:
        self.object(self.lit, self.shape(solid, self.matt, smooth=False), colour, np.zeros(3))

    def shape(self, solid: sheet_solids.Mesh, material: Any, *, smooth: bool = True) -> Any:
        import bpy

        vertices, faces = solid
        mesh = bpy.data.meshes.new("solid")
        mesh.from_pydata(vertices.tolist(), [], faces.tolist())
        mesh.polygons.foreach_set("use_smooth", np.full(len(faces), smooth))
        mesh.materials.append(material)
        return mesh

    def object(self, where: Any, data: Any, colour: Colour, place: FloatArray) -> Any:
        import bpy

        made = bpy.data.objects.new(data.name, data)
        made.color = (*colour, 1.0)
        made.location = self.origin + place
        where.objects.link(made)
        return made

    def light(self) -> None:
        import bpy

        sun = bpy.data.lights.new("sun", "SUN")
        sun.energy, sun.angle = 2.0, radians(25.0)
        lamp = self.object(self.scene.collection, sun, PAPER, np.zeros(3))
        lamp.rotation_euler = (radians(32), radians(-22), 0.0)
        self.scene.world = sheet_materials.soft_light()

    def camera(self, centre: FloatArray, wide: float, high: float, width: int) -> None:
        import bpy

        camera = bpy.data.cameras.new("camera")
        camera.type, camera.sensor_fit, camera.ortho_scale = "ORTHO", "HORIZONTAL", wide
        camera.clip_end = 1000.0
        self.scene.camera = self.object(self.scene.collection, camera, PAPER, centre - 20 * AWAY)
        self.scene.camera.rotation_euler = (pi / 2 - ELEVATION, 0.0, 0.0)
        self.scene.render.resolution_percentage = 100
        self.scene.render.resolution_x = width
        self.scene.render.resolution_y = max(round(width * high / wide), 4)


def _quaternion(rotation: FloatArray) -> Any:
    from mathutils import Matrix

    return Matrix(rotation.tolist()).to_quaternion()
