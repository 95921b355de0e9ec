"""Independent checks of a motion's dynamics: MuJoCo, and Newton and Euler on the npz file."""

from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.transcription.motion import Motion
from .mjcf import ROOT_SIZE, mjcf, motion_state

RATE = 960.0  # Hz


@dataclass(frozen=True)
class Residual:
    """Dynamics residual at (T,) instants: root force (T, 3) in body weights, moment (T, 3) in body
    weights x m about the centre of mass of the whole body. flying: (T,) bool. A body weight is
    the mass's on the Earth, on the Moon too."""

    times: FloatArray
    force: FloatArray
    moment: FloatArray
    flying: BoolArray

    def rms(self, part: str, flying: bool) -> float:
        """Root mean square length of "force" or "moment" in flight or on the ground."""
        lengths = self._lengths(part, flying)
        return float(np.sqrt((lengths**2).mean())) if len(lengths) else 0.0

    def worst(self, part: str, flying: bool) -> float:
        """The largest length."""
        return float(self._lengths(part, flying).max(initial=0.0))

    def _lengths(self, part: str, flying: bool) -> FloatArray:
        values = {"force": self.force, "moment": self.moment}[part]
        return np.asarray(np.linalg.norm(values[self.flying == flying], axis=1))


def inverse_dynamics(
    model: mujoco.MjModel,
    state: tuple[FloatArray, FloatArray, FloatArray],
    forces: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Generalised forces (T, nv) that the movement needs beside the forces (T, P, 3) N at the
    model's sites, and the whole body's centre of mass (T, 3) m. By mj_inverse."""
    data = mujoco.MjData(model)
    sites = range(model.nsite)
    names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_SITE, s) for s in sites]
    point = [int(name.split()[1]) for name in names]
    out = np.zeros((len(forces), model.nv))
    com = np.zeros((len(forces), 3))
    for i, (qpos, qvel, qacc) in enumerate(zip(*state, strict=True)):
        data.qpos[:], data.qvel[:], data.qacc[:] = qpos, qvel, qacc
        mujoco.mj_inverse(model, data)
        pushed = np.zeros(model.nv)
        for s in sites:
            place, body = data.site_xpos[s], int(model.site_bodyid[s])
            force, moment = forces[i, point[s]], np.zeros(3)
            mujoco.mj_applyFT(model, data, force, moment, place, body, pushed)
        out[i] = data.qfrc_inverse - pushed
        com[i] = data.subtree_com[1]
    return out, com


def root_wrench(
    qpos: FloatArray, generalised: FloatArray, com: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Root force (T, 3) N and moment (T, 3) N·m about the centre of mass, world axes.

    MuJoCo's free joint takes the force at the root's origin and the moment in the root's own axes.
    """
    force = generalised[:, :3]
    moment = np.empty_like(force)
    for i in range(len(force)):
        turned = np.zeros(3)
        mujoco.mju_rotVecQuat(turned, generalised[i, 3:ROOT_SIZE], qpos[i, 3:7])
        moment[i] = turned + np.cross(qpos[i, :3] - com[i], force[i])
    return force, moment


def check_motion(motion: Motion, rate: float = RATE) -> tuple[Residual, FloatArray]:
    """The motion under MuJoCo on a grid of `rate` Hz, which also gives the joint torques
    (T, n_angles - 3) N·m in MJCF order."""
    t = motion.transcription
    count = int(motion.duration * rate)
    times = (np.arange(count) + 0.5) * motion.duration / count
    model = mujoco.MjModel.from_xml_string(mjcf(t.character, t.points))
    state = motion_state(motion, times)
    generalised, com = inverse_dynamics(model, state, motion.forces(times))
    force, moment = root_wrench(state[0], generalised, com)
    weight = STANDARD_GRAVITY * float(model.body_mass.sum())
    touching = np.zeros(count, dtype=bool)
    for contact in t.contacts:
        touching |= (times >= contact.contact.start) & (times <= contact.contact.end)
    if t.support is not None:
        for unseen in t.support.intervals:
            touching |= (times >= unseen.start) & (times <= unseen.end)
    residual = Residual(times, force / weight, moment / weight, ~touching)
    return residual, generalised[:, ROOT_SIZE:]


def check_npz(path: str | Path) -> Residual:
    """Newton and Euler by finite differences from trajectory.npz alone.

    Needs time, mass, inertia, com, rotation, contact_point, contact_force and gravity. Instants
    whose differences reach across the beginning or end of a contact force are left out, as
    accelerations jump there.
    """
    with np.load(path) as file:
        data = {name: file[name] for name in file.files if file[name].dtype.kind == "f"}
    step = float(data["time"][1] - data["time"][0])
    mass, com = data["mass"], data["com"]
    share = mass / mass.sum()
    centre = np.einsum("b,tbi->ti", share, com)
    inner = slice(2, -2)
    acceleration = _second(com, step)
    turn = data["rotation"]
    back = np.swapaxes(turn, -1, -2)[inner]
    # R' R^T = [omega] and R'' R^T = [alpha] + [omega][omega], the last of which is symmetric.
    omega, alpha = (_axial(d(turn, step) @ back) for d in (_first, _second))
    inertia = turn[inner] @ data["inertia"] @ back
    spin = np.einsum("tbij,tbj->tbi", inertia, omega)
    spin_rate = np.einsum("tbij,tbj->tbi", inertia, alpha) + np.cross(omega, spin)
    push, at = data["contact_force"][inner], data["contact_point"][inner]
    force = np.einsum("b,tbi->ti", mass, acceleration - data["gravity"]) - push.sum(axis=1)
    arms = com[inner] - centre[inner, None]
    moment = np.cross(arms, mass[:, None] * acceleration).sum(axis=1) + spin_rate.sum(axis=1)
    moment -= np.cross(at - centre[inner, None], push).sum(axis=1)
    weight = STANDARD_GRAVITY * float(mass.sum())
    touch = np.abs(data["contact_force"]).max(axis=2) > 0.0
    reach = np.stack([touch[k : len(touch) - 4 + k] for k in range(5)])
    whole = (reach == reach[2]).all(axis=(0, 2))
    flying = ~touch[inner].any(axis=1)
    return Residual(
        data["time"][inner][whole], force[whole] / weight, moment[whole] / weight, flying[whole]
    )


def _axial(m: FloatArray) -> FloatArray:
    """(..., 3) vectors whose cross matrices are the skew parts of (..., 3, 3) matrices."""
    skew = 0.5 * (m - np.swapaxes(m, -1, -2))
    return np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)


def _first(x: FloatArray, step: float) -> FloatArray:
    """(T - 4, ...) first derivative, five points, fourth order."""
    return np.asarray((x[:-4] - 8 * x[1:-3] + 8 * x[3:-1] - x[4:]) / (12 * step))


def _second(x: FloatArray, step: float) -> FloatArray:
    """(T - 4, ...) second derivative, five points, fourth order."""
    middle = -x[:-4] + 16 * x[1:-3] - 30 * x[2:-2] + 16 * x[3:-1] - x[4:]
    return np.asarray(middle / (12 * step**2))
