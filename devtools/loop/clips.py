"""Recorded runs, and frames that an artist would choose of them."""

from dataclasses import dataclass

from ...solver.data.problem import MotionProblem


@dataclass(frozen=True)
class Run:
    """About one cycle of a recording, frames first to last. cut: where it begins."""

    file: str
    first: float
    last: float
    cut: str

    @property
    def name(self) -> str:
        return f"{self.file.removesuffix('.bvh')} from frame {self.first:g}"

    @property
    def problem(self) -> MotionProblem:
        return MotionProblem(frames=(self.first, self.last), loop=True)


RUNS = (
    Run("run_1.bvh", 24, 113, "in flight"),
    Run("run_1.bvh", 40, 131, "in a stance"),
    Run("run_2.bvh", 28, 122, "in flight"),
    Run("run_2.bvh", 45, 139, "in a stance"),
    Run("run_3.bvh", 42, 127, "at a landing"),
)
