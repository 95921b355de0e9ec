"""The figures of a picture."""

import numpy as np
import pytest
from hangtime.operators.headless.picture import limbs
from hangtime.solver.analysis.performance import perform
from hangtime.solver.body.anatomy import Part
from hangtime.solver.body.character import build_character
from hangtime.tests.helpers.clips import JUMP, load_recording

NEAR = 0.06  # m, that a slice of the trunk is drawn beyond its box


@pytest.mark.parametrize("name", ["BMC_run.bvh", "131_03_hop.bvh", JUMP])
def test_the_trunk_is_in_one_piece(name: str) -> None:
    """The pelvis's box reaches to where the spine hangs on it, wherever the hips' joint is."""
    recording = load_recording(name)
    character = build_character(recording)
    performance = perform(recording, character)
    drawn = list(limbs(character, performance.rotations, performance.centres))
    pelvis = drawn[0]
    spine = next(i for i, body in enumerate(character.bodies) if body.part is Part.SPINE)
    apart = performance.centres[:, spine] - pelvis.centre
    inside = np.einsum("tji,tj->ti", pelvis.rotation, apart)[:, 2]
    assert (np.abs(inside) < 0.5 * pelvis.size[2] + NEAR).all()
