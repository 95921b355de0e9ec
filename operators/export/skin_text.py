"""What a file got of the skin, in words."""

from ...bridge.exports.skin import Skin

_NO_MESH = "; no mesh that is seen is deformed by its bones"
_BEHIND = "; left out, as bones do not deform them or they are no meshes: {}"
_UNAPPLIED = "; modifiers left out for the sake of shape keys: {}"


def skin_text(skin: Skin) -> str:
    """Continues a sentence: how many meshes went along, and by name what did not."""
    count = len(skin.meshes)
    said = f" with {count} mesh{'es' if count > 1 else ''}" if count else _NO_MESH
    if skin.others:
        said += _BEHIND.format(", ".join(thing.name for thing in skin.others))
    if skin.unapplied:
        told = (f"{mesh.name} ({', '.join(names)})" for mesh, names in skin.unapplied.items())
        said += _UNAPPLIED.format(", ".join(told))
    return said
