"""A trial's fit, made as the command line makes it, and its ground forces in the trial's axes."""

import sys
from dataclasses import dataclass

import numpy as np

from ...operators.headless.clip import Clip, load
from ...operators.terminal.stages import Stages
from ...solver.analysis.accelerations import com_acceleration
from ...solver.arrays import FloatArray
from ...solver.data.constants import STANDARD_GRAVITY, UP
from ...solver.data.problem import MotionProblem, Unseen
from ...solver.fitting.fit import Fit
from ...solver.results.unseen_support import refuse_unseen
from ...solver.worker.pipeline import fit_subject, no_fit
from .contacts import joined
from .trials import FEET, UNIT, GroundForces, Trial

RATE = 1000.0  # Hz, at which the fit's forces are sampled
# The trial's forward, left and up in Blender's world: BVH's +Z is its -Y, +X its +X, +Y its +Z.
TO_TRIAL = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
LEAST_CARRIED = 1e-6  # body weights; below it a foot has no centre of pressure


@dataclass(frozen=True)
class FittedTrial:
    """A trial and its fit. start: s, the trial's time at which the motion's begins."""

    trial: Trial
    fit: Fit
    start: float
    seconds: float

    @property
    def contacts(self) -> list[list[tuple[float, float]]]:
        """Of each foot, when its heel or toe touches by our analysis, in the trial's time, s."""
        every = [c for c in self.fit.schedule.contacts if not c.point.endswith("hand")]
        return [
            joined(
                sorted(
                    (self.start + c.start, self.start + c.end)
                    for c in every
                    if c.point.startswith(foot)
                )
            )
            for foot in FEET
        ]

    @property
    def flights(self) -> list[tuple[float, float]]:
        """Flights that were found, in the trial's time, s."""
        return [(self.start + f.start, self.start + f.end) for f in self.fit.schedule.flights]


def fit_trial(trial: Trial) -> FittedTrial:
    """Finds the contacts and fits, through the command line's reader and the pipeline.

    Raises every Fault that a clip can have, FitNeedsSupport and NoFit.
    """
    stages = Stages(sys.stderr)
    problem = MotionProblem(frames=trial.frames, mass=trial.mass, unseen=Unseen.REFUSE)
    loaded = load(Clip(trial.bvh, unit=UNIT, up="Y"), problem, stages)
    fitted = fit_subject(loaded.subject, stages)
    if not fitted.solved:
        raise no_fit(loaded.subject, fitted)
    refuse_unseen(loaded.subject.problem, fitted)
    start = (float(loaded.subject.recording.frames[0]) - 1.0) / loaded.subject.recording.rate
    return FittedTrial(trial, fitted, start, stages.done[-1].seconds)


def ground_forces(fitted: FittedTrial) -> GroundForces:
    """The fit's contact forces, summed over each foot's points; a hand counts with its side."""
    motion = fitted.fit.motion
    times = np.arange(int(motion.duration * RATE + 1e-6) + 1) / RATE
    weight = motion.transcription.character.mass * STANDARD_GRAVITY
    forces = motion.forces(times) / weight @ TO_TRIAL.T
    places = motion.contact_points(times) @ TO_TRIAL.T
    feet, pressure = np.zeros((len(times), 2, 3)), np.zeros((len(times), 2, 2))
    for side, mine in enumerate(points_of_sides(fitted.fit)):
        feet[:, side] = forces[:, mine].sum(axis=1)
        pressure[:, side] = _centre(forces[:, mine, 2], places[:, mine, :2])
    return GroundForces(fitted.start + times, feet, pressure)


def told_forces(fitted: FittedTrial, width: float) -> GroundForces:
    """The summed force that the recording alone tells, smoothed over `width` s; 0 in flight."""
    performance = fitted.fit.performance
    times = np.arange(int(performance.times[-1] * RATE + 1e-6) + 1) / RATE
    told = com_acceleration(performance, fitted.fit.schedule, times, (width, width))
    feet = np.zeros((len(times), 2, 3))
    feet[:, 0] = (told / STANDARD_GRAVITY + UP) @ TO_TRIAL.T  # the sum counts alone
    return GroundForces(fitted.start + times, feet, np.zeros((len(times), 2, 2)))


def points_of_sides(fit: Fit) -> list[list[int]]:
    """Indices of the touching points of the left and of the right side."""
    owners = {c.point: c.contact.point for c in fit.motion.transcription.contacts}
    return [[p for p, name in sorted(owners.items()) if name.startswith(foot)] for foot in FEET]


def _centre(vertical: FloatArray, places: FloatArray) -> FloatArray:
    """(T, 2) centre of points (T, P, 2) weighted by vertical forces (T, P)."""
    carried = np.maximum(vertical.sum(axis=1), LEAST_CARRIED)
    return np.asarray(np.einsum("tp,tpk->tk", vertical, places) / carried[:, None])
