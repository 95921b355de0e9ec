"""Objects that move: their poses between the frames, and that equal values are equal objects."""

import pickle
from dataclasses import replace

import numpy as np
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.scene.object_motion import ObjectMotion
from hangtime.tests.helpers.meshes import box, thing


def test_a_turning_cart_is_between_its_frames() -> None:
    frames = np.arange(10.0, 22.0, 2.0)
    along = 0.1 * (frames - 10.0) ** 2
    cart = replace(
        thing("Cart", box((1.0, 1.0, 1.0))),
        frames=frames,
        positions=np.stack([along, 0 * along, 0 * along], axis=1),
        rotations=axis_rotation(2, 0.3 * frames),
    )
    motion = ObjectMotion.of(cart, first_frame=10.0, rate=20.0)
    times = np.array([-1.0, 0.05, 0.23, 9.0])
    places, turns = motion.at(times)
    at = np.clip(10.0 + 20.0 * times, 10.0, 20.0)
    np.testing.assert_allclose(places[:, 0], 0.1 * (at - 10.0) ** 2, atol=1e-12)
    np.testing.assert_allclose(turns, axis_rotation(2, 0.3 * at), atol=1e-12)


def test_objects_are_equal_by_value() -> None:
    crate = thing("Crate", box((1.0, 1.0, 1.0)))
    again = pickle.loads(pickle.dumps(crate))
    assert crate == again
    assert hash(crate) == hash(again)
    assert crate != replace(crate, positions=crate.positions + 1.0)
    assert crate != replace(crate, vertices=crate.vertices[:-1])
