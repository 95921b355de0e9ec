"""Colours, materials and light of the picture."""

from typing import Any

import bpy
import numpy as np

from ..accessors import present

LAMP = (-0.32, -0.45, 0.83)  # direction to it, where nothing is lit truly
SHADE = (-0.7, 0.9, 0.45, 1.05)  # from its cosine's least and largest to strengths
Colour = tuple[float, float, float]  # linear


def srgb(code: str) -> Colour:
    """Linear colour of "rrggbb"."""
    c = np.array([int(code[i : i + 2], 16) for i in (0, 2, 4)]) / 255
    r, g, b = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4).tolist()
    return r, g, b


def mix(a: Colour, b: Colour, amount: float) -> Colour:
    r, g, b_ = (np.array(a) * (1 - amount) + np.array(b) * amount).tolist()
    return r, g, b_


def matt() -> bpy.types.Material:
    """Evenly scattering, in the object's colour."""
    material, nodes, links = _material("matt")
    surface = nodes.new("ShaderNodeBsdfDiffuse")
    links.new(nodes.new("ShaderNodeObjectInfo").outputs["Color"], surface.inputs["Color"])
    links.new(surface.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def shaded() -> bpy.types.Material:
    """In the object's colour, the darker the more it turns from the lamp: without light, so without
    noise and shadows, in a fraction of the time."""
    material, nodes, links = _material("shaded")
    present(material.cycles).emission_sampling = "NONE"
    towards = nodes.new("ShaderNodeVectorMath")
    towards.operation = "DOT_PRODUCT"
    towards.inputs[1].default_value = LAMP
    links.new(nodes.new("ShaderNodeNewGeometry").outputs["Normal"], towards.inputs[0])
    strength = nodes.new("ShaderNodeMapRange")
    for name, value in zip(("From Min", "From Max", "To Min", "To Max"), SHADE, strict=True):
        strength.inputs[name].default_value = value
    links.new(towards.outputs["Value"], strength.inputs["Value"])
    surface = nodes.new("ShaderNodeEmission")
    links.new(nodes.new("ShaderNodeObjectInfo").outputs["Color"], surface.inputs["Color"])
    links.new(strength.outputs["Result"], surface.inputs["Strength"])
    links.new(surface.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def plain() -> bpy.types.Material:
    """Exactly the object's colour, unlit."""
    material, nodes, links = _material("plain")
    present(material.cycles).emission_sampling = "NONE"  # letters are no lamps
    surface = nodes.new("ShaderNodeEmission")
    links.new(nodes.new("ShaderNodeObjectInfo").outputs["Color"], surface.inputs["Color"])
    links.new(surface.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def glass(*, thin: float, edge: float, rim: float) -> bpy.types.Material:
    """See-through and unlit, in the object's colour, without noise.

    thin, edge: opacity where the surface faces the viewer, and where it turns away. rim: 0 to 1,
    how far the edge's reaches in.
    """
    material, nodes, links = _material("glass")
    present(material.cycles).emission_sampling = "NONE"
    facing = nodes.new("ShaderNodeLayerWeight")
    facing.inputs["Blend"].default_value = rim
    opacity = nodes.new("ShaderNodeMapRange")
    opacity.inputs["To Min"].default_value, opacity.inputs["To Max"].default_value = thin, edge
    surface, mixed = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeMixShader")
    links.new(facing.outputs["Facing"], opacity.inputs["Value"])
    links.new(nodes.new("ShaderNodeObjectInfo").outputs["Color"], surface.inputs["Color"])
    links.new(opacity.outputs["Result"], mixed.inputs[0])
    links.new(nodes.new("ShaderNodeBsdfTransparent").outputs[0], mixed.inputs[1])
    links.new(surface.outputs[0], mixed.inputs[2])
    links.new(mixed.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def _material(name: str) -> tuple[bpy.types.Material, Any, Any]:
    material = bpy.data.materials.new(name)
    return material, *_empty_tree(material)


def _empty_tree(owner: bpy.types.Material | bpy.types.World) -> tuple[Any, Any]:
    """Its nodes and links; any, for sockets have the types of their nodes."""
    if bpy.app.version < (5, 0):
        owner.use_nodes = True  # always on, and its setter deprecated, from 5.0
    tree = present(owner.node_tree)
    tree.nodes.clear()
    return tree.nodes, tree.links


def soft_light(paper: Colour) -> bpy.types.World:
    """A world of even, slightly cool light; the viewer sees paper instead of it."""
    world = bpy.data.worlds.new("sheet")
    present(world.cycles).sampling_method = "NONE"  # even light needs no aim
    nodes, links = _empty_tree(world)
    glow, seen = (nodes.new("ShaderNodeBackground") for _ in range(2))
    glow.inputs["Color"].default_value = (0.93, 0.96, 1.0, 1.0)
    glow.inputs["Strength"].default_value = 0.5
    seen.inputs["Color"].default_value = (*paper, 1.0)
    mixed = nodes.new("ShaderNodeMixShader")
    links.new(nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"], mixed.inputs[0])
    links.new(glow.outputs[0], mixed.inputs[1])
    links.new(seen.outputs[0], mixed.inputs[2])
    links.new(mixed.outputs[0], nodes.new("ShaderNodeOutputWorld").inputs["Surface"])
    return world
