"""How the body's mass is shared among its parts, as published.

THESIS is Table 3.1 of the thesis, segments as uniform boxes. DE_LEVA is de Leva (1996),
"Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", J. Biomech. 29(9), Table 4,
men: mass fraction, centre of mass from the proximal joint and radii of gyration (sagittal,
transverse, longitudinal) as fractions of the segment's length.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from ..data.problem import MassTable
from .anatomy import Part


@dataclass(frozen=True)
class Share:
    """One part's share: fraction of body mass (one side), of length: centre, gyration radii."""

    mass: float
    centre: float = 0.5
    gyration: tuple[float, float, float] | None = None  # None: that of a uniform box


# Spine and neck stand for all their bones together. The foot's share covers the toes too.
THESIS: Mapping[Part, Share] = {
    Part.PELVIS: Share(0.153),
    Part.SPINE: Share(0.22),
    Part.HEAD: Share(0.071),
    Part.CLAVICLE: Share(0.04),
    Part.UPPER_ARM: Share(0.033),
    Part.FOREARM: Share(0.019),
    Part.HAND: Share(0.006),
    Part.THIGH: Share(0.105),
    Part.SHANK: Share(0.06),
    Part.FOOT: Share(0.015),
}

# The lower trunk is the pelvis, middle and upper trunk the spine. De Leva has no shoulder girdle
# of its own: 1.5 % a side is taken from the upper trunk, so that a moving clavicle has inertia.
DE_LEVA: Mapping[Part, Share] = {
    Part.PELVIS: Share(0.1117),
    Part.SPINE: Share(0.3229 - 0.03),
    Part.HEAD: Share(0.0694),
    Part.CLAVICLE: Share(0.015),
    Part.UPPER_ARM: Share(0.0271, 0.5772, (0.285, 0.269, 0.158)),
    Part.FOREARM: Share(0.0162, 0.4574, (0.276, 0.265, 0.121)),
    Part.HAND: Share(0.0061, 0.79, (0.628, 0.513, 0.401)),
    Part.THIGH: Share(0.1416, 0.4095, (0.329, 0.329, 0.149)),
    Part.SHANK: Share(0.0433, 0.4395, (0.251, 0.246, 0.102)),
    Part.FOOT: Share(0.0137, 0.4415, (0.257, 0.245, 0.124)),
}

TABLES: Mapping[MassTable, Mapping[Part, Share]] = {
    MassTable.THESIS: THESIS,
    MassTable.DE_LEVA: DE_LEVA,
}

# Width over depth of the box that stands for a part, and where its mass goes if it has no bone.
ASPECT: Mapping[Part, float] = {
    Part.PELVIS: 1.5,
    Part.SPINE: 1.5,
    Part.CLAVICLE: 1.0,
    Part.HAND: 2.0,
    Part.FOOT: 1.4,
    Part.TOE: 2.0,
}
ABSENT_GOES_TO: Mapping[Part, Part] = {
    Part.CLAVICLE: Part.SPINE,
    Part.HAND: Part.FOREARM,
}
DENSITY = 1000.0  # kg/m3, the body's mean: fixes a box's cross-section from its mass and length
