"""The figures of a picture."""

import numpy as np
import pytest
from hangtime.operators.headless.picture import goes_sideways, limbs
from hangtime.solver.analysis.performance import perform
from hangtime.solver.body.anatomy import Part
from hangtime.solver.body.character import build_character
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import Hold, Requests
from hangtime.solver.stages.implicit import adapt
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.fitted_hop import fitted_hop

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


@pytest.mark.slow
@pytest.mark.parametrize("left", [0.0, 0.15])
def test_it_is_seen_from_above_where_contacts_went_sideways_also_without_the_landing(
    left: float,
) -> None:
    """A held frame in flight leaves out all that came after it, contacts among it."""
    fit = fitted_hop()
    frame = float(fit.performance.recording.frames[0]) + 120.0 * 0.6
    held = Requests(holds=(Hold("Hang", frame, 0.1, ends=True),))
    assert not goes_sideways(adapt(fit, MotionProblem(requests=held)), np.eye(3))
    moved = adapt(fit, MotionProblem(pins=(Pin("Landing", "ground 2", offset=(0.0, left, 0.0)),)))
    x, y = fit.performance.com[-1, :2] - fit.performance.com[0, :2]
    x, y = np.array([x, y]) / np.hypot(x, y)
    assert goes_sideways(moved, np.array([[x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, 1.0]])) == (
        left > 0.0
    )
