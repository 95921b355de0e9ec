"""Materials and colours of the marks."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import bpy

from . import materials
from .annotations import Tone
from .mark_meshes import Look
from .materials import Colour, srgb

Maker = Callable[[], bpy.types.Material]

RED = srgb("d8202a")
TONES: Mapping[Tone, Colour] = {Tone.FIXED: srgb("9a48d6"), Tone.LIMP: srgb("f0a02c")}


@dataclass(frozen=True)
class Finish:
    """A surface. front: drawn before the body, whatever is nearer. shadow: whether it casts one."""

    colour: Colour
    material: Maker = materials.matt
    front: bool = False
    shadow: bool = False


def _glass(thin: float, edge: float, rim: float = 0.3) -> Maker:
    return lambda: materials.glass(thin=thin, edge=edge, rim=rim)


FINISHES: Mapping[Look, Finish] = {
    Look.SOLID: Finish(RED, front=True),
    Look.RING: Finish(RED, _glass(0.08, 1.0, 0.8), front=True),
    Look.GLASS: Finish(srgb("e5303a"), _glass(0.16, 0.42)),
    Look.LINE: Finish(srgb("b3121c"), materials.plain, front=True),
    Look.RIM: Finish(srgb("cf2a34"), materials.plain),
    Look.VEIL: Finish(srgb("ffffff"), _glass(0.34, 0.5)),
    Look.EDGE: Finish(srgb("8d97a5"), materials.plain),
    Look.WEIGHT: Finish(srgb("6b4a2f"), shadow=True),
    Look.ENVIRONMENT: Finish(srgb("8b929d"), shadow=True),
    Look.THING: Finish(srgb("d9c3a0"), shadow=True),
    Look.WALL: Finish(srgb("c9a66b"), _glass(0.3, 0.5)),
}
