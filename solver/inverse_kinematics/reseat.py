"""Warm start for a changed body or other gravity, from the fit's motion (thesis 6.2)."""

import numpy as np

from ..arrays import FloatArray
from ..body.body_changes import changed_points
from ..body.character import Character
from ..body.kinematics import BodyPoint, Pose, forward_kinematics
from ..numerics.splines import THIRD_DERIVATIVE_WEIGHT, dense_instants
from ..transcription.motion import Motion


def reseat(motion: Motion, character: Character) -> FloatArray:
    """Unknowns (K, n_block) of a motion of the old figure as an initial guess for the new one.

    character: of the same joints, see `changed_character`. The angles stay; the root moves so that
    the contact points stay where they were, on average over those pinned at each instant and
    linearly in between. Forces in body weights stay, as the accelerations do: in newtons they grow
    with the mass. Vertical forces follow gravity in proportion (their mean over a clip does, and
    none begins to pull); horizontal ones do not, for the body travels as far in the same time.
    """
    t, x = motion.transcription, motion.x.copy()
    times = dense_instants(t.basis)
    posed = forward_kinematics(character, motion.angles(times))
    shift = com_shift(motion, posed, changed_points(t.points, t.character, character), times)
    x[:, t.layout.com] += t.basis.project(times, shift, THIRD_DERIVATIVE_WEIGHT)
    if character.gravity != t.character.gravity:
        x[:, t.layout.vertical_forces] *= character.gravity / t.character.gravity
    return x


def com_shift(
    motion: Motion, new: Pose, points: tuple[BodyPoint, ...], times: FloatArray
) -> FloatArray:
    """(T, 3) displacement of the centre of mass that keeps contact points in place, m.

    new: the poses that the motion's own are replaced by at instants (T,) s; points: the touching
    points of that figure.
    """
    t = motion.transcription
    old = motion.pose(times)
    off = old.centres[:, 0] - new.centres[:, 0]  # with the root where it was
    spans = [(c.contact.start, c.contact.end) for c in t.contacts]
    pinned = np.array([(start <= times) & (times <= end) for start, end in spans])
    if not pinned.any():
        return off
    apart = old.points(t.points) - new.points(points) - off[:, None]
    apart = apart[:, [c.point for c in t.contacts]]
    held = pinned.any(axis=0)
    mean = np.einsum("ct,tci->ti", pinned, apart)[held] / pinned.sum(axis=0)[held, None]
    between = [np.interp(times, times[held], mean[:, k]) for k in range(3)]
    return np.asarray(off + np.stack(between, axis=1))
