"""One iteration of ours against the least that any method of second order must do.

The floor: Pinocchio's analytic derivatives of the same equations of motion at every node, and one
banded Cholesky factorisation by LAPACK of a matrix of the same size and band. It has no contacts'
rows, assembles nothing and takes no step.
"""

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio
from scipy.linalg import cholesky_banded
from scipy.spatial.transform import Rotation

from ..devtools.checks.mjcf import mjcf, motion_state
from ..devtools.peers.task import Equations, Task, metric_matrix
from ..solver.arrays import FloatArray
from ..solver.body.character import Character
from ..solver.optimisation.kkt_step import LinearisedProblem
from ..solver.transcription.motion import Motion

RIDGE = 100.0  # weight of the rows beside the metric, as in our own steps


def our_iteration(task: Task) -> FloatArray:
    """The rows, the factor and the step; (K, n_block)."""
    rows = task.rows(task.start)
    return LinearisedProblem(task.transcription, rows, task.metric).step(rows.value).d


def pinocchio_model(character: Character) -> pinocchio.Model:
    """The figure in Pinocchio, by way of MJCF."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "figure.xml"
        path.write_text(mjcf(character))
        return pinocchio.buildModelFromMJCF(str(path))


@dataclass(frozen=True)
class Nodes:
    """A motion in Pinocchio's coordinates at instants: q (N, nq), v and a (N, nv)."""

    model: pinocchio.Model
    data: pinocchio.Data
    q: FloatArray
    v: FloatArray
    a: FloatArray

    @staticmethod
    def of(task: Task) -> "Nodes":
        """The task's start at its dynamics nodes."""
        t = task.transcription
        motion = Motion(t, task.start, task.places)
        qpos, qvel, qacc = (np.array(part) for part in motion_state(motion, t.node_times))
        back = Rotation.from_quat(qpos[:, 3:7], scalar_first=True).inv()
        q = np.concatenate([qpos[:, :3], qpos[:, 4:7], qpos[:, 3:4], qpos[:, 7:]], axis=1)
        # MuJoCo's linear velocity is the world's; Pinocchio's is the root's own, which turns.
        v, a = qvel.copy(), qacc.copy()
        v[:, :3] = back.apply(qvel[:, :3])
        a[:, :3] = back.apply(qacc[:, :3]) - np.cross(qvel[:, 3:6], v[:, :3])
        model = pinocchio_model(t.character)
        return Nodes(model, model.createData(), q, v, a)

    def momentum_rates(self) -> FloatArray:
        """(N, 3) rate of the angular momentum about the centre of mass, N·m."""
        rates = []
        for state in zip(self.q, self.v, self.a, strict=True):
            pinocchio.computeCentroidalMomentumTimeVariation(self.model, self.data, *state)
            rates.append(np.array(self.data.dhg.angular))
        return np.stack(rates)

    def root_derivatives(self) -> None:
        """Derivatives of the momentum's rate: those of the root's equations of motion."""
        for state in zip(self.q, self.v, self.a, strict=True):
            pinocchio.computeCentroidalDynamicsDerivatives(self.model, self.data, *state)

    def all_derivatives(self) -> None:
        """Derivatives of every equation of motion (inverse dynamics)."""
        for state in zip(self.q, self.v, self.a, strict=True):
            pinocchio.computeRNEADerivatives(self.model, self.data, *state)


def band_matrix(task: Task) -> FloatArray:
    """(half-bandwidth + 1, n) lower bands of W + ρ J'J over the unknowns, in order of time."""
    equations = Equations(task)
    n = equations.size
    _, jacobian = equations.jacobian(task.start[task.transcription.active])
    system = (metric_matrix(task) + RIDGE * jacobian.T @ jacobian).tocoo()
    low = system.row >= system.col
    row, column = system.row[low], system.col[low]
    bands = np.zeros((int((row - column).max()) + 1, n))
    bands[row - column, column] = system.data[low]
    return bands


def factor(bands: FloatArray) -> FloatArray:
    """LAPACK's banded Cholesky."""
    return np.asarray(cholesky_banded(bands, lower=True, check_finite=False))
