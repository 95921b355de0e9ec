"""A motion as sampled rigid bodies and forces, so that anybody can check its physics."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..transcription.motion import Motion


def sample(motion: Motion, rate: float = 1000.0) -> dict[str, NDArray[Any]]:
    """Bodies and contact forces at `rate` Hz from the first to the last instant of the clip.

    time (T,) s; body_names (B,); mass (B,) kg; inertia (B, 3, 3) kg·m² about each centre of mass,
    in the body's frame; com (T, B, 3) m; rotation (T, B, 3, 3) body to world; contact_names (C,)
    the points that touch; contact_point (T, C, 3) m; contact_force (T, C, 3) N on the body, zero
    when not in contact; gravity (3,) m/s². World, Z up.
    """
    character, transcription = motion.transcription.character, motion.transcription
    times = instants(motion.duration, rate)
    posed, com = motion.pose(times), motion.com(times)[:, None]
    names = {c.point: c.contact.point for c in transcription.contacts}
    points = np.zeros((len(times), 0, 3))
    if transcription.points:
        points = posed.points(transcription.points) + com
    return {
        "time": times,
        "body_names": np.array([body.name for body in character.bodies]),
        "mass": np.array([body.mass for body in character.bodies]),
        "inertia": np.stack([body.inertia for body in character.bodies]),
        "com": posed.body_coms + com,
        "rotation": posed.rotations,
        "contact_names": np.array([names[i] for i in range(len(transcription.points))], dtype=str),
        "contact_point": points,
        "contact_force": motion.forces(times),
        "gravity": np.array([0.0, 0.0, -character.gravity]),
    }


def instants(duration: float, rate: float) -> FloatArray:
    """Every 1 / rate s from 0 while within [0, duration]."""
    # The last may be the duration itself, which rounding must not let it pass.
    return np.minimum(np.arange(int(np.floor(duration * rate + 1e-6)) + 1) / rate, duration)


def save(motion: Motion, path: Path, rate: float = 1000.0) -> None:
    """Writes the arrays of `sample` as a compressed .npz. Raises OSError."""
    with path.open("wb") as file:
        np.savez_compressed(file, **sample(motion, rate))
