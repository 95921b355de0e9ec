"""What is said about the meshes from which the body's solid shapes are made."""

from ...bridge.scene.skin import SkinReading, Unusable
from ...solver.worker.protocol import Analysed

REMEDY = {
    Unusable.NO_BONE: "bind it by Parent > With Automatic Weights, or name its groups as the bones",
    Unusable.NO_FACES: "choose another mesh as the armature's skin",
    Unusable.TOO_MANY: "bind a simpler copy and hide it",
}


def shapes_told(read: SkinReading, found: Analysed) -> str:
    """Lines for the panel: whose shapes are the mesh's, and what is wrong with a mesh."""
    every, fleshed = len(found.bones), len(found.fleshed)
    told = []
    if read.skin is not None:
        told.append(f"{fleshed} of {every} bodies have the shape of {_listed(read.skin.meshes)}")
    bones = [name for name in found.bones if name not in found.fleshed]
    if 0 < len(bones) <= fleshed:
        told.append(f"From the bones: {_listed(bones)}")
    told += [
        f"{mesh} tells no shapes: {why.value}; {REMEDY[why]}" for mesh, why in read.unusable.items()
    ]
    return "\n".join(told)


def _listed(names: tuple[str, ...] | list[str]) -> str:
    return ", ".join(names)
