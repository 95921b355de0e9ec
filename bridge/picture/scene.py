"""A Blender scene of a sheet's layout: solids, letters, lines, lamp and camera."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import product
from math import cos, pi, radians, sin

import bpy
import numpy as np
from mathutils import Matrix, Quaternion

from ...solver.arrays import BoolArray, FloatArray
from ..shapes.mesh import Mesh
from ..shapes.solids import box
from . import materials
from .layout import Figure, Layout, Tier
from .limb_meshes import ball, limb
from .mark_materials import FINISHES, TONES
from .mark_meshes import Solid
from .materials import Colour, mix, srgb

ACROSS = np.array([1.0, 0.0, 0.0])
APART = 80.0  # m between tiers along the view: unseen, and they cast no shadow on each other

DEPTH = 0.7  # m, half the depth of the floor, at least
BESIDE = 0.2  # m of floor beyond what stands farthest from its middle
THICKNESS, GRID_STEP = 0.05, 0.5
MARGIN, GAP, EDGE = 0.3, 0.14, 0.12  # m beside the figures, between the rows, around it all
LABEL = 1 / 75  # height of a time's letters, share of the picture's width
LETTER = 1.7  # cap heights to a letter's width, so that long captions are set smaller
PATH, BEAD = 0.012, 0.024  # m, radii

PAPER, FLOOR, GRID, INK = srgb("f7f8fa"), srgb("e9ebef"), srgb("c9ced6"), srgb("39424e")
BODIES = (srgb("7e8c9d"), srgb("3f83c4"), srgb("3a9d86"), srgb("8a6fc0"))  # one for each row
ABOVE = radians(70.0)  # elevation from which what goes sideways is seen
SHADED = 0.3  # how much darker limbs are that are away from the viewer
ADAPTED = 1  # the row whose colour an adapted motion has
BEFORE = 2.0  # m towards the viewer, by which is moved what nothing shall hide
PATHS = (srgb("2f3a48"), srgb("123f70"), srgb("115445"), srgb("3f2a75"))


@dataclass(frozen=True)
class Floor:
    """The ground as drawn: its corners nearest and farthest, (3,) m, canvas frame."""

    low: FloatArray
    high: FloatArray


@dataclass
class Painter:
    """Adds solids, letters and lines to a scene.

    elevation: rad, of the viewer above the horizon, as the current tier is seen; the camera's.
    frame: the current tier's canvas frame.
    """

    scene: bpy.types.Scene
    elevation: float
    frame: bpy.types.Object | None = None
    caption = 1 / 46  # height of a title's letters, share of the picture's width

    def __post_init__(self) -> None:
        self.matt, self.plain = self.surface(), materials.plain()

    @property
    def up(self) -> FloatArray:
        """In the picture."""
        return np.array([0.0, sin(self.elevation), cos(self.elevation)])

    @property
    def away(self) -> FloatArray:
        """From the viewer into the picture."""
        return np.array([0.0, cos(self.elevation), -sin(self.elevation)])

    @property
    def before(self) -> FloatArray:
        return -BEFORE * self.away

    @contextmanager
    def seen_from(self, elevation: float, origin: FloatArray) -> Iterator[None]:
        """Inside, what is added is tilted, so that the camera sees it from another elevation, and
        stands at an origin (3,) m."""
        frame = bpy.data.objects.new("tier", None)
        frame.location = origin.tolist()
        frame.rotation_euler = (elevation - self.elevation, 0.0, 0.0)
        self.scene.collection.objects.link(frame)
        usual, self.elevation, self.frame = self.elevation, elevation, frame
        try:
            yield
        finally:
            self.elevation, self.frame = usual, None

    def surface(self) -> bpy.types.Material:
        """Of solids and floor."""
        return materials.matt()

    def draw(self, layout: Layout, width: int, *, above: bool = False) -> None:
        """above: whether all tiers are shown once more, from above."""
        left, right = layout.low[0] - MARGIN, layout.high[0] + MARGIN
        wide = right - left + 2 * EDGE
        caption, label = self.caption * wide, LABEL * wide
        ground = np.array([0.0, 0.0, layout.floor])
        floor = Floor(
            np.array([left, min(-DEPTH, layout.low[1] - BESIDE), layout.floor]),
            np.array([right, max(DEPTH, layout.high[1] + BESIDE), layout.floor]),
        )
        bottom = 0.0  # m in the picture, from the first tier's floor
        views = (self.elevation, ABOVE) if above else (self.elevation,)
        for i, (elevation, (k, tier)) in enumerate(product(views, enumerate(layout.tiers))):
            head = self.head(tier, floor, elevation) + 0.6 * caption
            top = bottom - (head + caption + GAP if i else 0.0)
            title = tier.title if elevation == self.elevation else f"{tier.title} (from above)"
            # The tilt is about the world's origin, which the floor need not be at.
            turned = layout.floor * (cos(self.elevation) - cos(elevation))
            with self.seen_from(elevation, i * APART * self.away + (top + turned) * self.up):
                self.stage(floor)
                # a motion alone is an adapted one
                self.tier(tier, k if len(layout.tiers) > 1 else ADAPTED, floor, label)
                fitting = min(caption, LETTER * wide / max(len(title), 1))
                self.text(title, ground + left * ACROSS + head * self.up, fitting)
            bottom = top + floor.low[1] * sin(elevation) - THICKNESS - 2.2 * label
            if i == 0:
                crown = head + caption
        self.light()
        middle = ground + (left + right) / 2 * ACROSS + (crown + bottom) / 2 * self.up
        self.camera(middle, wide, crown - bottom + 2 * EDGE, width)

    @staticmethod
    def head(tier: Tier, floor: Floor, elevation: float) -> float:
        """Height of tier and floor above the middle of the floor in the picture, m."""
        up = np.array([0.0, sin(elevation), cos(elevation)])
        top = max((step.top for step in tier.steps), default=floor.high[2])
        back = np.array([0.0, floor.high[1], top])
        return max(tier.reach(up), float(back @ up)) - float(floor.low[2]) * cos(elevation)

    def stage(self, floor: Floor) -> None:
        down = np.array([0.0, 0.0, THICKNESS])
        self.mesh(box(floor.low - down, floor.high), FLOOR)
        (left, near, z), (right, far, _) = floor.low, floor.high
        for x in np.arange(np.ceil(left / GRID_STEP), right / GRID_STEP) * GRID_STEP:
            # clear of the front of a step
            self.line(np.array([x, near + 0.005, z]), np.array([x, far - 0.005, z]), 0.005)
        for y in np.arange(np.ceil(near / GRID_STEP), far / GRID_STEP) * GRID_STEP:
            self.line(np.array([left, y, z]), np.array([right, y, z]), 0.012)

    def line(self, start: FloatArray, end: FloatArray, half_width: float) -> None:
        """A line on the floor; those across the view are drawn wider, as they are foreshortened."""
        reach = half_width * np.sign(end - start)[[1, 0, 2]] + [0.0, 0.0, 0.0015]
        self.mesh(box(start - reach, end + reach), GRID)

    def tier(self, tier: Tier, k: int, floor: Floor, label: float) -> None:
        for step in tier.steps:
            low = np.array([step.left, floor.low[1], floor.low[2]])
            high = np.array([step.right, floor.high[1], step.top])
            self.mesh(box(low, high), FLOOR)
        solids = [
            self.shape(limb(size, end, head="head" in name.lower()), self.matt)
            for size, end, name in zip(tier.sizes, tier.proximal, tier.names, strict=True)
        ]
        self.figures(tier, solids, BODIES[k % len(BODIES)])
        self.labels(tier, floor, label)
        self.path(tier, PATHS[k % len(PATHS)])
        for mark in tier.marks:
            self.mark(mark)

    def mark(self, solid: Solid) -> None:
        finish = FINISHES[solid.look]
        shape = self.shape(solid.mesh, finish.material(), smooth=solid.smooth)
        made = self.object(shape, finish.colour, self.before if finish.front else np.zeros(3))
        if not finish.shadow:
            _casts_nothing(made)

    def figures(self, tier: Tier, solids: list[bpy.types.Mesh], colour: Colour) -> None:
        """Side by side, the earlier the paler."""
        for age, figure in zip(np.linspace(1, 0, len(tier.figures)), tier.figures, strict=True):
            self.figure(figure, solids, tier.far, mix(colour, PAPER, 0.5 * age))

    def figure(
        self, figure: Figure, solids: list[bpy.types.Mesh], far: BoolArray, colour: Colour
    ) -> None:
        for i, solid in enumerate(solids):
            tone = figure.tones.get(i)
            own = colour if tone is None else TONES[tone]
            paint = mix(own, (0.0, 0.0, 0.0), SHADED) if far[i] else own
            made = self.object(solid, paint, figure.centre[i])
            made.rotation_mode = "QUATERNION"
            made.rotation_quaternion = as_quaternion(figure.rotation[i])

    def labels(self, tier: Tier, floor: Floor, height: float) -> None:
        """The time below each figure, where it does not run into the one before."""
        end = -np.inf
        for figure in tier.figures:
            if figure.com[0] - end > 4.3 * height:
                end = figure.com[0]
                front = np.array([end, floor.low[1], floor.low[2] - THICKNESS])
                place = front - 1.5 * height * self.up
                self.text(f"{figure.time:.2f} s", place, height, centred=True)

    def path(self, tier: Tier, colour: Colour) -> None:
        """A tube along the centre of mass with a bead at each figure."""
        self.beads(tier, colour)
        curve = bpy.data.curves.new("path", "CURVE")
        curve.dimensions = "3D"
        curve.bevel_depth = PATH
        curve.use_fill_caps = True
        spline = curve.splines.new("POLY")
        spline.points.add(len(tier.path) - 1)
        four = np.column_stack([tier.path, np.ones(len(tier.path))])
        spline.points.foreach_set("co", four.astype(np.float32).ravel())
        curve.materials.append(self.plain)
        _casts_nothing(self.object(curve, colour, self.before))

    def beads(self, tier: Tier, colour: Colour) -> None:
        bead = self.shape(ball(BEAD), self.plain)
        for figure in tier.figures:
            _casts_nothing(self.object(bead, colour, figure.com + self.before))

    def text(self, body: str, place: FloatArray, height: float, *, centred: bool = False) -> None:
        curve = bpy.data.curves.new("text", "FONT")
        assert isinstance(curve, bpy.types.TextCurve)
        curve.body = body
        curve.size = height * 1.35  # the font's capitals fill three quarters of its size
        curve.align_x = "CENTER" if centred else "LEFT"
        curve.materials.append(self.plain)
        made = self.object(curve, INK, place + self.before)
        _casts_nothing(made)
        made.rotation_euler = (pi / 2 - self.elevation, 0.0, 0.0)

    def mesh(self, solid: Mesh, colour: Colour) -> None:
        self.object(self.shape(solid, self.matt, smooth=False), colour, np.zeros(3))

    def shape(
        self, solid: Mesh, material: bpy.types.Material, *, smooth: bool = True
    ) -> bpy.types.Mesh:
        mesh = bpy.data.meshes.new("solid")
        mesh.from_pydata(solid.points.tolist(), [], solid.faces.tolist())
        mesh.polygons.foreach_set("use_smooth", np.full(len(solid.faces), smooth))
        mesh.materials.append(material)
        return mesh

    def object(self, data: bpy.types.ID, colour: Colour, place: FloatArray) -> bpy.types.Object:
        made = bpy.data.objects.new(data.name, data)
        made.color = (*colour, 1.0)
        made.location, made.parent = place.tolist(), self.frame
        self.scene.collection.objects.link(made)
        return made

    def light(self) -> None:
        sun = bpy.data.lights.new("sun", "SUN")
        assert isinstance(sun, bpy.types.SunLight)
        sun.energy, sun.angle = 2.0, radians(25.0)
        lamp = self.object(sun, PAPER, np.zeros(3))
        lamp.rotation_euler = (radians(32), radians(-22), 0.0)
        self.scene.world = materials.soft_light(PAPER)

    def camera(self, centre: FloatArray, wide: float, high: float, width: int) -> None:
        camera = bpy.data.cameras.new("camera")
        camera.type, camera.sensor_fit, camera.ortho_scale = "ORTHO", "HORIZONTAL", wide
        camera.clip_end = 1000.0
        self.scene.camera = self.object(camera, PAPER, centre - 20 * self.away)
        self.scene.camera.rotation_euler = (pi / 2 - self.elevation, 0.0, 0.0)
        self.scene.render.resolution_percentage = 100
        self.scene.render.resolution_x = width
        self.scene.render.resolution_y = max(round(width * high / wide), 4)


def as_quaternion(rotation: FloatArray) -> Quaternion:
    return Matrix(rotation.tolist()).to_quaternion()


def _casts_nothing(thing: bpy.types.Object) -> None:
    """Neither a shadow nor its colour on others."""
    thing.visible_shadow = thing.visible_diffuse = thing.visible_glossy = False
