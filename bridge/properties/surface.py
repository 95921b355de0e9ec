"""What the extension stores of each surface: an object of the scene, or a collection of them."""

from __future__ import annotations

import bpy

from ..rows.choices import SurfaceRole
from ..rows.row import MET, NAME, STATUS, USED, asked, chosen, hidden
from ..rows.stored import choice, number, target

ROLES = "Feet land on the ground, limbs keep out of all three, and the way goes over a hurdle"
SOLID_TYPES = ("MESH", "CURVE", "SURFACE", "FONT", "META")  # of objects: those that have faces


def has_faces(_owner: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    """Whether an object is of a type that Blender can make a mesh of."""
    return candidate.type in SOLID_TYPES


class HangtimeSurface(bpy.types.PropertyGroup):
    """A row of the surfaces' list; `name` is what its object or collection was called last."""

    name: chosen(NAME)
    used: asked(USED)
    met: hidden(MET)
    status: hidden(STATUS)
    role: asked(choice("Role", SurfaceRole, ROLES))
    clearance: asked(
        number(
            "Clearance",
            "How far above the hurdle's highest face beneath it every part of the body stays",
            unit="LENGTH",
            subtype="DISTANCE",
            min=0.0,
        )
    )
    object: asked(target("Object", "The object that is solid", poll=has_faces))
    collection: asked(
        target(
            "Collection",
            "A collection of which every object with faces is solid",
            type=bpy.types.Collection,
        )
    )

    @property
    def called(self) -> str:
        """What its object or collection is called now; what it was called where that is gone."""
        owner = self.object or self.collection
        return str(owner.name if owner is not None else self.name)


CLASSES = (HangtimeSurface,)
