"""Recordings without force plates, of whose fits the motion alone is judged."""

from collections.abc import Mapping
from dataclasses import dataclass

from ...solver.data.problem import MotionProblem
from ...solver.fitting.fit import Fit
from ...solver.worker.pipeline import fit_subject, measure, no_fit
from ...solver.worker.stage_clock import StageClock
from ..recordings import HOPS, JUMP, find, read


@dataclass(frozen=True)
class Recorded:
    """A recording's file, and the scene frames that are used; None: all of them."""

    file: str
    frames: tuple[float, float] | None = None


# Every jump and run that is held here, and the demo's hop. Of a long one what the gallery, the
# pairs or the demo use of it, or its first two seconds.
RECORDINGS: Mapping[str, Recorded] = {
    "forward_jump_116cm": Recorded(JUMP, (60, 330)),
    "forward_jump_114cm": Recorded("forward_jump_114cm.bvh", (133, 385)),
    "high_jump": Recorded("high_jump.bvh"),
    "fair1_jumping": Recorded("fair1_jumping.bvh"),
    "demo_hop": Recorded(HOPS, (120, 370)),
    "131_03_hop": Recorded("131_03_hop.bvh"),
    "hops_in_place": Recorded("hops_in_place.bvh", (1, 241)),
    "cmu1_jumping_jacks": Recorded("cmu1_jumping_jacks.bvh"),
    "run_1": Recorded("run_1.bvh"),
    "run_2": Recorded("run_2.bvh"),
    "run_3": Recorded("run_3.bvh"),
}


def fit_recording(recorded: Recorded) -> Fit:
    """Finds the contacts and fits. Raises SetUpError, every Fault that a clip can have, NoFit."""
    problem = MotionProblem(frames=recorded.frames)
    subject = measure(read(find(recorded.file)), problem)
    fitted = fit_subject(subject, StageClock())
    if not fitted.solved:
        raise no_fit(subject, fitted)
    return fitted
