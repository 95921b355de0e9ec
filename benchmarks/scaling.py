"""What an adaptation costs against the clip's length and the figure's degrees of freedom."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from statistics import median

import numpy as np

from ..devtools.peers.task import Task
from ..devtools.recordings import HOPS
from ..solver.analysis.analyse import analyse
from ..solver.analysis.performance import Performance
from ..solver.arrays import IntArray
from ..solver.body.anatomy import Part
from ..solver.body.character import Character, Joint
from ..solver.body.dynamics import MomentFunction
from ..solver.body.joint_axes import JointAxes
from ..solver.fitting.fit import ADAPT_COST_WEIGHTS, Fit, fit
from ..solver.numerics.rotations import mean_rotation
from ..solver.objectives.motion_metric import motion_metric
from ..solver.optimisation.restoration import restore
from ..solver.optimisation.sqp import FeasibleSet, Outcome
from ..solver.stages.implicit import adapt
from ..solver.transcription.motion import Motion
from ..solver.worker.pipeline import Subject, fit_possible, measure, solve
from ..solver.worker.stage_clock import StageClock
from .recordings import hops, recording
from .tables import Row
from .timing import REPEATS, memory, processor

FIRST = 0.99  # s, where the windows of the hops begin
LENGTHS = (2.0, 5.0, 10.0, 20.0)  # s
EDITED = 2.5  # s, the window of one jump
# Toes stay: a rigid foot cannot roll over the heel and toe that the recording plants.
WELDED: dict[str, tuple[Part, ...]] = {
    "every joint": (),
    "without hands": (Part.HAND,),
    "nor clavicles and neck": (Part.HAND, Part.CLAVICLE, Part.NECK),
    "nor spine and head": (Part.HAND, Part.CLAVICLE, Part.NECK, Part.SPINE, Part.HEAD),
}


def lengths(seconds: tuple[float, ...] = LENGTHS, repeats: int = 3) -> Iterator[Row]:
    """Windows of the hops, each fitted and its first landing moved, repeatedly."""
    for length in seconds:
        problem = hops(FIRST, length)
        analysis = analyse(recording(HOPS), problem)
        work = partial(fit, analysis.performance, analysis.schedule)
        fitted, fit_s = processor(work)
        _ = fitted.metric  # part of the stored fit
        runs = [processor(partial(adapt, fitted, problem)) for _ in range(repeats)]
        adaptation, adapt_s = runs[-1][0], median(seconds for _, seconds in runs)
        yield {
            "window": f"{length:g} s",
            "unknowns": adaptation.motion.transcription.n_unknowns,
            "fit (s)": fit_s,
            "its memory (MB)": memory(work),
            "adaptation (s)": adapt_s,
            "steps": sum(len(outcome.steps) for outcome in adaptation.outcomes),
            "solved": fitted.solved and adaptation.solved,
        }


def one_jump() -> Iterator[Row]:
    """A landing moved in a window of its own, and in the whole take of the hops."""
    own, take = hops(FIRST, EDITED), replace(hops(FIRST, EDITED), frames=None)
    for name, problem in (("its own window", own), ("the whole take", take)):
        subject, fits = measure(recording(HOPS), problem), list[tuple[Fit, float]]()

        def fitted(part: Subject, clock: StageClock, fits: list[tuple[Fit, float]] = fits) -> Fit:
            found, seconds = processor(partial(fit_possible, part, clock))
            _ = found.metric  # part of the stored fit
            fits.append((found, seconds))
            return found

        result = solve(subject, StageClock(), fitted)
        [(found, fit_s)] = fits
        work = partial(adapt, found, result.subject.problem)
        yield {
            "in": name,
            "lasts (s)": subject.analysis.schedule.duration,
            "solved of it": f"{result.subject.analysis.schedule.duration:.2f} s",
            "fit (s)": fit_s,
            "adaptation (s)": median(processor(work)[1] for _ in range(REPEATS)),
            "solved": result.fault is None,
        }


def welded(performance: Performance, parts: tuple[Part, ...]) -> tuple[Character, IntArray]:
    """The character with the joints of these parts rigid, at their mean over the clip, and the
    indices of the angles that are left."""
    character = performance.character
    joints: list[Joint] = []
    kept: list[int] = []
    for i, (body, joint) in enumerate(zip(character.bodies, character.joints, strict=True)):
        axes = joint.axes
        if body.part in parts:
            parent = performance.rotations[:, joint.parent]
            relative = np.swapaxes(parent, -1, -2) @ performance.rotations[:, i]
            axes = JointAxes(0, mean_rotation(relative), np.eye(3))
        else:
            kept += range(joint.first, joint.dofs.stop)
        first = joints[-1].first + joints[-1].axes.dofs if joints else 0
        joints.append(replace(joint, axes=axes, first=first))
    return replace(character, joints=tuple(joints)), np.array(kept)


def with_fewer(fitted: Fit, task: Task, parts: tuple[Part, ...]) -> Task:
    """The task for a figure with these parts' joints rigid: same knots, instants and pins."""
    old = task.transcription
    character, kept = welded(fitted.performance, parts)
    new = replace(old, character=character, moment=MomentFunction(character))
    forces = np.arange(old.layout.forces.start, old.layout.n_block)
    columns = np.concatenate([np.arange(3), 3 + kept, forces])
    metric = motion_metric(
        Motion(new, fitted.motion.x[:, columns], fitted.places), ADAPT_COST_WEIGHTS
    )
    return Task(new, task.places, task.start[:, columns], metric)


def finished(task: Task) -> Outcome:
    """The task solved by our steps."""
    return restore(
        FeasibleSet(task.transcription, task.places), task.metric, task.start, stage="adapt"
    )
