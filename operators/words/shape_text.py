"""What is said about the meshes from which the body's solid shapes are made."""

from collections.abc import Collection, Iterable, Iterator

from ...bridge.scene.skin import SkinReading, Unusable

REMEDY = {
    Unusable.NO_BONE: "bind it by Parent > With Automatic Weights, or name its groups as the bones",
    Unusable.NO_FACES: "choose another mesh as the armature's skin",
    Unusable.TOO_MANY: "bind a simpler copy and hide it",
}


def shapes_told(read: SkinReading, every: Collection[str], fleshed: Collection[str]) -> str:
    """Lines: whose shapes are the mesh's, whose are not, and what is wrong with a mesh.

    every: names of the bodies; fleshed: of those with the mesh's shapes.
    """
    told = []
    if read.skin is not None:
        told.append(
            f"{len(fleshed)} of {len(every)} bodies have the shape of {_listed(read.skin.meshes)}"
        )
        told += _from_bones([name for name in every if name not in fleshed], fleshed)
    told += [
        f"{mesh} tells no shapes: {why.value}; {REMEDY[why]}" for mesh, why in read.unusable.items()
    ]
    return "\n".join(told)


def _from_bones(bones: list[str], fleshed: Collection[str]) -> Iterator[str]:
    """Whose shapes are from their bones, in as few names as will do."""
    if not bones:
        return
    if not fleshed:
        yield "From the bones: all, since nowhere is enough of it around a bone that moves a body"
    elif len(bones) <= len(fleshed):
        yield f"From the bones: {_listed(bones)}"
    else:
        yield f"From the bones: all but {_listed(fleshed)}"


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names)
