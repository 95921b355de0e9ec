"""Segment inertia parameters, as published.

THESIS_TABLE is Table 3.1 of the thesis, segments as uniform boxes. DE_LEVA_TABLE is de Leva (1996),
"Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", J. Biomech. 29(9), Table 4,
men: mass fraction, centre of mass from the proximal joint and radii of gyration (sagittal,
transverse, longitudinal) as fractions of the segment's length.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from ..data.problem import MassTable
from .anatomy import Part


@dataclass(frozen=True)
class SegmentInertia:
    """Inertia parameters of one part (one side).

    mass: fraction of body mass. centre, gyration: fractions of the segment's length, the centre of
    mass from the proximal joint, radii (sagittal, transverse, longitudinal).
    """

    mass: float
    centre: float = 0.5
    gyration: tuple[float, float, float] | None = None  # None: that of a uniform box


# Spine and neck stand for all their bones together. The foot's share covers the toes too.
THESIS_TABLE: Mapping[Part, SegmentInertia] = {
    Part.PELVIS: SegmentInertia(0.153),
    Part.SPINE: SegmentInertia(0.22),
    Part.HEAD: SegmentInertia(0.071),
    Part.CLAVICLE: SegmentInertia(0.04),
    Part.UPPER_ARM: SegmentInertia(0.033),
    Part.FOREARM: SegmentInertia(0.019),
    Part.HAND: SegmentInertia(0.006),
    Part.THIGH: SegmentInertia(0.105),
    Part.SHANK: SegmentInertia(0.06),
    Part.FOOT: SegmentInertia(0.015),
}

# The lower trunk is the pelvis, middle and upper trunk the spine. De Leva has no shoulder girdle
# of its own: 1.5 % a side is taken from the upper trunk, so that a moving clavicle has inertia.
DE_LEVA_TABLE: Mapping[Part, SegmentInertia] = {
    Part.PELVIS: SegmentInertia(0.1117),
    Part.SPINE: SegmentInertia(0.3229 - 0.03),
    Part.HEAD: SegmentInertia(0.0694),
    Part.CLAVICLE: SegmentInertia(0.015),
    Part.UPPER_ARM: SegmentInertia(0.0271, 0.5772, (0.285, 0.269, 0.158)),
    Part.FOREARM: SegmentInertia(0.0162, 0.4574, (0.276, 0.265, 0.121)),
    Part.HAND: SegmentInertia(0.0061, 0.79, (0.628, 0.513, 0.401)),
    Part.THIGH: SegmentInertia(0.1416, 0.4095, (0.329, 0.329, 0.149)),
    Part.SHANK: SegmentInertia(0.0433, 0.4395, (0.251, 0.246, 0.102)),
    Part.FOOT: SegmentInertia(0.0137, 0.4415, (0.257, 0.245, 0.124)),
}

MASS_TABLES: Mapping[MassTable, Mapping[Part, SegmentInertia]] = {
    MassTable.THESIS: THESIS_TABLE,
    MassTable.DE_LEVA: DE_LEVA_TABLE,
}

# Width over depth of the box that stands for a part, and where its mass goes if it has no bone.
BOX_ASPECT: Mapping[Part, float] = {
    Part.PELVIS: 1.5,
    Part.SPINE: 1.5,
    Part.CLAVICLE: 1.0,
    Part.HAND: 2.0,
    Part.FOOT: 1.4,
    Part.TOE: 2.0,
}
MASS_FALLBACK: Mapping[Part, Part] = {
    Part.CLAVICLE: Part.SPINE,
    Part.HAND: Part.FOREARM,
}
BODY_DENSITY = (
    1000.0  # kg/m3, the body's mean: fixes a box's cross-section from its mass and length
)
