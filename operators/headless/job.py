"""The main job without a window: a recorded clip in, an adapted one out, with its report."""

from dataclasses import dataclass
from pathlib import Path

from ...solver.data.problem import MotionProblem
from ...solver.worker.pipeline import solve
from .clip import Clip, load
from .outbox import Outbox
from .outputs import Outputs
from .stages import Stages


@dataclass(frozen=True)
class AdaptationJob:
    """A clip, the problem to solve on it, and the folder for the results."""

    clip: Clip
    problem: MotionProblem
    out: Path


def run(job: AdaptationJob, stages: Stages) -> list[Path]:
    """Does the whole job and returns the files written.

    Raises NoSolution, having written the report, and any other Fault having written nothing.
    """
    with Outbox(job.out) as outbox:
        loaded = load(job.clip, job.problem, stages)
        result = solve(loaded.subject, stages)
        outputs = Outputs(loaded, job.problem, result, outbox, stages)
        if result.fault is not None:
            outputs.write_failure()
            outbox.deliver()
            raise result.fault
        outputs.write()
        return outbox.deliver()
