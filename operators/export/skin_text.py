"""What a file got of the skin, in words."""

from ...bridge.exports.skin import Skin

_NO_MESH = "; no mesh that is seen is deformed by its bones"
_BEHIND = "; left out, as bones do not deform them or they are no meshes: {}"


def skin_text(skin: Skin) -> str:
    """Continues a sentence: how many meshes went along, and by name what did not."""
    count = len(skin.meshes)
    said = f" with {count} mesh{'es' if count > 1 else ''}" if count else _NO_MESH
    return said + (_BEHIND.format(", ".join(o.name for o in skin.others)) if skin.others else "")
