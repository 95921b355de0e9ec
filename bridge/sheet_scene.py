"""Draws a sheet's layout with Cycles in a scene of its own and removes whatever that made."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import cos, pi, radians, sin
from pathlib import Path
from typing import Any

import numpy as np

from ..solver.recording import FloatArray
from . import sheet_solids
from .sheet_layout import Figure, Layout, Tier

Colour = tuple[float, float, float]

ELEVATION = radians(9.0)
ACROSS = np.array([1.0, 0.0, 0.0])
UP = np.array([0.0, sin(ELEVATION), cos(ELEVATION)])  # up in the picture
AWAY = np.array([0.0, cos(ELEVATION), -sin(ELEVATION)])  # from the viewer into the picture
APART = 80.0  # m between tiers along AWAY: unseen, and they cast no shadow on each other

DEPTH = 0.8  # m, half the depth of the floor
THICKNESS = 0.05
FOOT = DEPTH * sin(ELEVATION) + THICKNESS + 0.2  # m that floor and labels take below z = floor
MARGIN, GAP, EDGE = 0.3, 0.14, 0.12  # m beside the figures, between the rows, around it all
CAPTION, LABEL = 0.17, 0.1  # m, heights of the letters
PIN, PATH = 0.034, 0.012  # m, radii
SAMPLES = 8  # for each pixel; the denoiser does the rest


def srgb(code: str) -> Colour:
    """Linear colour of "rrggbb"."""
    c = np.array([int(code[i : i + 2], 16) for i in (0, 2, 4)]) / 255
    r, g, b = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4).tolist()
    return r, g, b


PAPER, FLOOR, GRID, INK = srgb("f7f8fa"), srgb("e9ebef"), srgb("c9ced6"), srgb("39424e")
RED = srgb("d8202a")
BODIES = (srgb("7e8c9d"), srgb("3f83c4"), srgb("3a9d86"), srgb("8a6fc0"))  # one for each row
PATHS = (srgb("2f3a48"), srgb("123f70"), srgb("115445"), srgb("3f2a75"))


def render(layout: Layout, path: Path, width: int) -> None:
    """Render `layout` to the PNG file `path`."""
    with _clean_scene() as scene:
        _Painter(scene).draw(layout, width)
        _render(scene, path)


@contextmanager
def _clean_scene() -> Iterator[Any]:
    """A new scene; every data-block that appears while it lives is removed at the end."""
    import bpy

    kinds = [p.identifier for p in bpy.data.bl_rna.properties if p.type == "COLLECTION"]
    before = {kind: set(getattr(bpy.data, kind)) for kind in kinds}
    scene = bpy.data.scenes.new("Hangtime sheet")
    try:
        yield scene
    finally:
        made = [block for kind in kinds for block in set(getattr(bpy.data, kind)) - before[kind]]
        bpy.data.batch_remove(made)


@contextmanager
def _cycles() -> Iterator[None]:
    """Cycles is enabled inside, and disabled afterwards where the user had it disabled."""
    import addon_utils

    _, enabled = addon_utils.check("cycles")
    if not enabled:
        addon_utils.enable("cycles")
    try:
        yield
    finally:
        if not enabled:
            addon_utils.disable("cycles")


def _render(scene: Any, path: Path) -> None:
    import bpy

    with _cycles():
        settings = scene.render
        settings.engine = "CYCLES"
        settings.filepath = str(path)
        settings.use_file_extension = False
        settings.image_settings.file_format = "PNG"
        settings.image_settings.color_mode = "RGB"
        scene.view_settings.view_transform = "Standard"
        scene.cycles.device = "CPU"
        scene.cycles.samples = SAMPLES if _has_denoiser() else 4 * SAMPLES
        scene.cycles.use_adaptive_sampling = False
        scene.cycles.use_light_tree = False  # one lamp
        scene.cycles.max_bounces = 2
        scene.cycles.use_denoising = _has_denoiser()
        scene.cycles.denoising_prefilter = "NONE"
        scene.cycles.denoising_quality = "FAST"
        bpy.ops.render.render(write_still=True, scene=scene.name)


def _has_denoiser() -> bool:
    import _cycles

    return bool(_cycles.with_openimagedenoise)


@dataclass
class _Painter:
    """Adds objects to a scene; `origin` is the place of the current tier's canvas origin."""

    scene: Any
    origin: FloatArray = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        self.solid = _solid_material()
        self.flat = _flat_material()

    def draw(self, layout: Layout, width: int) -> None:
        left, right = layout.left - MARGIN, layout.right + MARGIN
        ground = np.array([0.0, 0.0, layout.floor])
        bottom = 0.0  # m in the picture, from the first tier's floor
        for k, tier in enumerate(layout.tiers):
            head = (tier.corners()[1, 2] - layout.floor) * cos(ELEVATION) + 0.08
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
        for x in np.arange(np.ceil(left * 2) / 2, right, 0.5):
            line = np.array([x, 0.0, floor + 0.001])
            reach = np.array([0.005, DEPTH, 0.0005])
            self.mesh(sheet_solids.block(line - reach, line + reach), GRID)
        for y in (-0.5, 0.0, 0.5):
            line = np.array([0.0, y, floor + 0.001])
            reach = np.array([0.0, 0.012, 0.0005])
            ends = np.array([left, 0, 0]), np.array([right, 0, 0])
            self.mesh(sheet_solids.block(line + ends[0] - reach, line + ends[1] + reach), GRID)

    def tier(self, tier: Tier, k: int, floor: float) -> None:
        for step in tier.steps:
            low = np.array([step.left, -DEPTH, floor])
            self.mesh(sheet_solids.block(low, np.array([step.right, DEPTH, step.top])), FLOOR)
        solids = [
            self.shape(sheet_solids.limb(size, end, head="head" in name.lower()), self.solid)
            for size, end, name in zip(tier.sizes, tier.proximal, tier.names, strict=True)
        ]
        colour = BODIES[k % len(BODIES)]
        for age, figure in zip(np.linspace(1, 0, len(tier.figures)), tier.figures, strict=True):
            self.figure(figure, solids, tier.far, _mix(colour, PAPER, 0.5 * age))
            self.label(figure, floor)
        self.path(tier.path, PATHS[k % len(PATHS)])
        ball = self.shape(sheet_solids.ball(PIN), self.solid)
        for pin in tier.pins:
            self.overlay(self.object(ball, RED, pin - 2 * AWAY))

    def figure(self, figure: Figure, solids: list[Any], far: FloatArray, colour: Colour) -> None:
        shade = _mix(colour, (0.0, 0.0, 0.0), 0.35)
        for i, solid in enumerate(solids):
            made = self.object(solid, shade if far[i] else colour, figure.centre[i])
            made.rotation_mode = "QUATERNION"
            made.rotation_quaternion = _quaternion(figure.rotation[i])

    def label(self, figure: Figure, floor: float) -> None:
        front = np.array([figure.com[0], -DEPTH, floor - THICKNESS])
        self.text(f"{figure.time:.2f} s", front - 1.5 * LABEL * UP, LABEL, centred=True)

    def path(self, points: FloatArray, colour: Colour) -> None:
        """A tube through the points, in front of everything."""
        import bpy

        curve = bpy.data.curves.new("path", "CURVE")
        curve.dimensions = "3D"
        curve.bevel_depth = PATH
        curve.use_fill_caps = True
        spline = curve.splines.new("POLY")
        spline.points.add(len(points) - 1)
        four = np.column_stack([points, np.ones(len(points))])
        spline.points.foreach_set("co", four.astype(np.float32).ravel())
        curve.materials.append(self.flat)
        self.overlay(self.object(curve, colour, -1.5 * AWAY))

    def text(self, body: str, place: FloatArray, height: float, *, centred: bool = False) -> None:
        import bpy

        curve = bpy.data.curves.new("text", "FONT")
        curve.body = body
        curve.size = height * 1.35  # the font's capitals fill three quarters of its size
        curve.align_x = "CENTER" if centred else "LEFT"
        curve.materials.append(self.flat)
        made = self.object(curve, INK, place - AWAY)
        made.rotation_euler = (pi / 2 - ELEVATION, 0.0, 0.0)
        self.overlay(made)

    def mesh(self, solid: sheet_solids.Mesh, colour: Colour) -> None:
        self.object(self.shape(solid, self.solid, smooth=False), colour, np.zeros(3))

    def shape(self, solid: sheet_solids.Mesh, material: Any, *, smooth: bool = True) -> Any:
        import bpy

        vertices, faces = solid
        mesh = bpy.data.meshes.new("solid")
        mesh.from_pydata(vertices.tolist(), [], faces.tolist())
        mesh.polygons.foreach_set("use_smooth", np.full(len(faces), smooth))
        mesh.materials.append(material)
        return mesh

    def object(self, data: Any, colour: Colour, place: FloatArray) -> Any:
        import bpy

        made = bpy.data.objects.new(data.name, data)
        made.color = (*colour, 1.0)
        made.location = self.origin + place
        self.scene.collection.objects.link(made)
        return made

    def overlay(self, drawn: Any) -> None:
        """Seen by the camera alone: no shadow on, no light for, the rest."""
        drawn.visible_shadow = drawn.visible_diffuse = drawn.visible_glossy = False

    def light(self) -> None:
        import bpy

        sun = bpy.data.lights.new("sun", "SUN")
        sun.energy, sun.angle = 2.0, radians(25.0)
        self.object(sun, PAPER, np.zeros(3)).rotation_euler = (radians(32), radians(-22), 0.0)
        self.scene.world = _world()

    def camera(self, centre: FloatArray, wide: float, high: float, width: int) -> None:
        import bpy

        camera = bpy.data.cameras.new("camera")
        camera.type, camera.sensor_fit, camera.ortho_scale = "ORTHO", "HORIZONTAL", wide
        camera.clip_end = 1000.0
        self.scene.camera = self.object(camera, PAPER, centre - 20 * AWAY)
        self.scene.camera.rotation_euler = (pi / 2 - ELEVATION, 0.0, 0.0)
        self.scene.render.resolution_percentage = 100
        self.scene.render.resolution_x = width
        self.scene.render.resolution_y = max(round(width * high / wide), 4)


def _mix(a: Colour, b: Colour, amount: float) -> Colour:
    r, g, b_ = (np.array(a) * (1 - amount) + np.array(b) * amount).tolist()
    return r, g, b_


def _quaternion(rotation: FloatArray) -> Any:
    from mathutils import Matrix

    return Matrix(rotation.tolist()).to_quaternion()


def _solid_material() -> Any:
    """Matt, in the object's colour."""
    material, nodes, links = _material("solid")
    surface = nodes.new("ShaderNodeBsdfPrincipled")
    surface.inputs["Roughness"].default_value = 0.6
    links.new(nodes.new("ShaderNodeObjectInfo").outputs["Color"], surface.inputs["Base Color"])
    links.new(surface.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def _flat_material() -> Any:
    """Exactly the object's colour, unlit."""
    material, nodes, links = _material("flat")
    surface = nodes.new("ShaderNodeEmission")
    links.new(nodes.new("ShaderNodeObjectInfo").outputs["Color"], surface.inputs["Color"])
    links.new(surface.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def _material(name: str) -> tuple[Any, Any, Any]:
    import bpy

    material = bpy.data.materials.new(name)
    return material, *_empty_tree(material)


def _empty_tree(owner: Any) -> tuple[Any, Any]:
    import bpy

    if bpy.app.version < (5, 0):
        owner.use_nodes = True  # always on, and its setter deprecated, from 5.0
    owner.node_tree.nodes.clear()
    return owner.node_tree.nodes, owner.node_tree.links


def _world() -> Any:
    """Soft white light from everywhere; to the camera plain paper."""
    import bpy

    world = bpy.data.worlds.new("sheet")
    nodes, links = _empty_tree(world)
    glow, paper = nodes.new("ShaderNodeBackground"), nodes.new("ShaderNodeBackground")
    glow.inputs["Color"].default_value = (0.93, 0.96, 1.0, 1.0)
    glow.inputs["Strength"].default_value = 0.5
    paper.inputs["Color"].default_value = (*PAPER, 1.0)
    mix = nodes.new("ShaderNodeMixShader")
    links.new(nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"], mix.inputs[0])
    links.new(glow.outputs[0], mix.inputs[1])
    links.new(paper.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], nodes.new("ShaderNodeOutputWorld").inputs["Surface"])
    return world
