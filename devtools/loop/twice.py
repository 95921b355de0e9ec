"""A loop played twice under MuJoCo, which differentiates the places itself, across the seam too."""

from dataclasses import dataclass

import mujoco
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.transcription.motion import Motion
from ..checks.mjcf import mjcf, qpos
from ..checks.mujoco_check import RATE, Residual, inverse_dynamics, root_wrench

BESIDE = 0.02  # s


@dataclass(frozen=True)
class TwicePlayed:
    """Residual at instants of both cycles, and which of these are beside the seam."""

    residual: Residual
    seam: BoolArray

    def beside(self, part: str) -> float:
        """The largest length of "force" or "moment" beside the seam."""
        values = {"force": self.residual.force, "moment": self.residual.moment}[part]
        return float(np.linalg.norm(values[self.seam], axis=1).max())


def played_twice(motion: Motion) -> TwicePlayed:
    """Velocities and accelerations are differences of positions on a grid of RATE Hz. Instants
    whose differences reach across a landing or lift-off are left out: accelerations jump there."""
    t, count = motion.transcription, int(motion.duration * RATE)
    step = motion.duration / count
    times = step * np.arange(2 * count + 1)
    within = np.mod(times, motion.duration)
    within[-1] = motion.duration
    travel = np.diff(motion.com(np.array([0.0, motion.duration])), axis=0)[0] * [1.0, 1.0, 0.0]
    places = qpos(motion, within)
    places[:, :3] += (times >= motion.duration - 0.5 * step)[:, None] * travel
    model = mujoco.MjModel.from_xml_string(mjcf(t.character, t.points))
    rates = np.zeros((2 * count, model.nv))
    for rate, one, other in zip(rates, places[:-1], places[1:], strict=True):
        mujoco.mj_differentiatePos(model, rate, step, one, other)
    inner = slice(1, -1)
    state = (places[inner], 0.5 * (rates[1:] + rates[:-1]), np.diff(rates, axis=0) / step)
    forces = motion.forces(within[inner])
    generalised, com = inverse_dynamics(model, state, forces)
    force, moment = root_wrench(places[inner], generalised, com)
    weight = STANDARD_GRAVITY * float(model.body_mass.sum())
    touching, whole = _phases(motion, within[inner], 2.0 * step)
    residual = Residual(
        times[inner][whole], force[whole] / weight, moment[whole] / weight, ~touching[whole]
    )
    return TwicePlayed(residual, np.abs(residual.times - motion.duration) < BESIDE)


def _phases(motion: Motion, times: FloatArray, apart: float) -> tuple[BoolArray, BoolArray]:
    """Whether anything touches at instants, and whether none is near them at which that changes."""
    touching = np.zeros(len(times), dtype=bool)
    whole = np.ones(len(times), dtype=bool)
    for contact in (each.contact for each in motion.transcription.contacts):
        touching |= (times >= contact.start) & (times <= contact.end)
        for instant in (contact.start, contact.end):
            if 0.0 < instant < motion.duration:
                whole &= np.abs(times - instant) > apart
    return touching, whole
