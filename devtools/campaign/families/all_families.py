"""The families, and which of them a case is of."""

import numpy as np

from ..protocol.case import Family
from . import clips, fbx, outputs, recipes, requests, rigs, sessions, two_blenders, workers

FAMILIES: tuple[Family, ...] = (
    *clips.FAMILIES,
    *fbx.FAMILIES,
    *recipes.FAMILIES,
    *outputs.FAMILIES,
    *requests.FAMILIES,
    *workers.FAMILIES,
    *rigs.FAMILIES,
    *sessions.FAMILIES,
    *two_blenders.FAMILIES,
)


def family_of(number: int, seed: int) -> Family:
    """The family of a case: by the families' shares, and the same in every run."""
    shares = np.array([family.share for family in FAMILIES])
    drawn = np.random.default_rng([seed, number, 1]).random()
    return FAMILIES[int(np.searchsorted(np.cumsum(shares) / shares.sum(), drawn, side="right"))]
