"""Anatomical labelling of a skeleton's bones: what `skeleton` finds, and what an artist chose."""

from collections.abc import Mapping, Sequence

from ..data.recording import Bone
from ..skeleton.mapping import guess_labels, settled, trunk
from ..skeleton.names import split_side as split_side
from ..skeleton.parts import SIDED_PARTS as SIDED_PARTS
from ..skeleton.parts import Part as Part
from ..skeleton.parts import Segment as Segment
from ..skeleton.parts import Side as Side
from ..skeleton.tree import tree_of


def map_anatomy(
    bones: Sequence[Bone], chosen: Mapping[str, str] | None = None
) -> tuple[Segment, ...]:
    """Segments of a skeleton, parents first; the pelvis is the first.

    bones: parents first. chosen: the artist's own choices, segment label -> bone name
    ("left foot" -> "Fuss.L"); they win over the guess. Clavicles, hands, toes and necks may be
    absent. Raises MissingPart for a part that the physics needs, or a chosen bone that is absent;
    NotJoined, NoSpine.
    """
    tree = tree_of(bones)
    found = settled(tree, chosen or {})
    spine, neck = trunk(tree, found)
    segments = [Segment(part, side, bone) for (part, side), bone in found.items()]
    segments += [Segment(Part.SPINE, Side.MIDDLE, bone) for bone in spine]
    segments += [Segment(Part.NECK, Side.MIDDLE, bone) for bone in neck]
    # Bones come parents first, but a tree's parents are not always those of the armature.
    by_depth = not tree.in_order
    return tuple(sorted(segments, key=lambda s: (by_depth and tree.depth(s.bone), s.bone)))


def guess_anatomy(bones: Sequence[Bone]) -> dict[str, str | None]:
    """Bone name, or None, for the label of every part but spine and neck; sided parts in pairs.

    Raises nothing, so that an artist can fill in what is missing.
    """
    return {label: found[0] if found else None for label, found in guess_labels(bones).items()}
