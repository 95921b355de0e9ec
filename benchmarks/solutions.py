"""Our own solutions of one problem, by name."""

from dataclasses import replace

from ..solver.data.problem import MotionProblem
from ..solver.data.requests import Method, Solution

IMPLICIT = "implicit (q, λ)"  # what everything else is measured against
SOLUTIONS = {
    IMPLICIT: Solution(method=Method.IMPLICIT),
    "implicit (q, τ, λ)": Solution(method=Method.IMPLICIT_TORQUES),
    "explicit, torque smoothness": Solution(method=Method.EXPLICIT),
}


def with_solution(problem: MotionProblem, solution: Solution) -> MotionProblem:
    """The same problem, solved another way."""
    return replace(problem, requests=replace(problem.requests, solution=solution))
