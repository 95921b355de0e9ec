"""How near a fit is to its recording."""

from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..body.anatomy import Part
from ..data.reports.report import FitQuality
from ..fitting.fit import Fit
from ..numerics.rotations import rotation_vector
from .flight_summary import apex, flights, recorded_apex


class _Worst(NamedTuple):
    """Of a fit: the body that is furthest off the recording, by how much, and the scene frame."""

    body: str
    off: float
    frame: float


def fit_quality(fit: Fit) -> FitQuality:
    """Distance of the fit from the recording, at the recording's frames."""
    performance = fit.performance
    apart = fit.motion.joint_centres(performance.times) - performance.centres
    each = np.sqrt((apart**2).sum(axis=2).mean(axis=1))  # frame by frame
    turns, bodies = _turns(fit), performance.character.bodies
    limbs = np.where([body.part is Part.TOE for body in bodies], 0.0, turns)
    joint = _worst(fit, np.linalg.norm(apart, axis=2))
    turned, limb = _worst(fit, turns), _worst(fit, limbs)
    whole = (f for f in flights(fit) if f.start > 0.0 and f.end < fit.schedule.duration)
    lost = [100.0 * (apex(fit.motion, f) - recorded_apex(fit, f)) for f in whole]
    return FitQuality(
        joint_centres_rms_cm=100.0 * float(np.sqrt((each**2).mean())),
        pelvis_apex_difference_cm=max(lost, key=abs, default=None),
        worst_frame_rms_cm=100.0 * float(each.max()),
        worst_frame=float(performance.recording.frames[each.argmax()]),
        worst_joint=joint.body,
        worst_joint_cm=100.0 * joint.off,
        worst_joint_frame=joint.frame,
        most_turned=turned.body,
        most_turned_deg=float(np.degrees(turned.off)),
        most_turned_frame=turned.frame,
        turned_limb=limb.body,
        turned_limb_deg=float(np.degrees(limb.off)),
        turned_limb_frame=limb.frame,
    )


def _worst(fit: Fit, off: FloatArray) -> _Worst:
    """off: (T, B), of the bodies at the recording's frames."""
    performance = fit.performance
    frame, body = divmod(int(off.argmax()), off.shape[1])
    name = performance.character.bodies[body].name
    return _Worst(name, float(off[frame, body]), float(performance.recording.frames[frame]))


def _turns(fit: Fit) -> FloatArray:
    """(T, B) rad, by which bodies are turned away from the recording."""
    performance = fit.performance
    now = fit.motion.pose(performance.times).rotations
    turned = np.swapaxes(performance.rotations, -1, -2) @ now
    return np.asarray(np.linalg.norm(rotation_vector(turned), axis=-1))
