"""Our own solutions of one problem, by name."""

from dataclasses import replace

from ..solver.data.problem import MotionProblem
from ..solver.data.solver_options import Method, SolverOptions

IMPLICIT = "implicit (q, λ)"  # what everything else is measured against
SOLUTIONS = {
    IMPLICIT: SolverOptions(method=Method.IMPLICIT),
    "implicit (q, τ, λ)": SolverOptions(method=Method.IMPLICIT_TORQUES),
    "explicit, torque smoothness": SolverOptions(method=Method.EXPLICIT),
}


def with_solution(problem: MotionProblem, solution: SolverOptions) -> MotionProblem:
    """The same problem, solved another way."""
    return replace(problem, requests=replace(problem.requests, solution=solution))
