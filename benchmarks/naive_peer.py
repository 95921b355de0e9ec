"""The naive peer: the same problem as a first-time user of CasADi writes it.

One big `MX` graph: splines as matrices on the unknowns, the figure's equations as
one function mapped over the instants, every row bounded, and IPOPT with CasADi's own exact
derivatives and everything else left as it comes. The rows' list (what holds when) is read off our
own, so that both are the same problem; `Graph.rows` lists them in the same order.
"""

import time
from dataclasses import dataclass

import casadi as ca
import numpy as np
from scipy.sparse import csc_matrix

from ..devtools.peers.ipopt_peer import run, sparse
from ..devtools.peers.newton_euler import BodyMotion, body_frames, momentum_rate, point_motion
from ..devtools.peers.task import PeerResult, Task, metric_matrix
from ..solver.arrays import FloatArray, IntArray
from ..solver.data.constants import STANDARD_GRAVITY
from ..solver.data.row_kinds import RowKind
from ..solver.transcription.rows import Rows
from ..solver.transcription.transcription import Transcription

LEAST = 1e-6  # BW; rounds off the tip of the friction cone, where it has no derivative


def solve(task: Task, limit_s: float) -> PeerResult:
    """Solves a task; the limit counts for set-up and iterations together, but at least one
    iteration is made."""
    begun = time.perf_counter()
    x = ca.MX.sym("x", task.transcription.n_unknowns)
    graph = Graph(task, x)
    problem = {"x": x, "f": graph.distance(), "g": graph.rows()}
    # IPOPT looks at its clock after every iteration; CasADi's set-up alone may outlast the limit.
    quiet = {"print_level": 0, "sb": "yes", "max_wall_time": limit_s}
    return run(task, problem, {"ipopt": quiet}, (graph.lower, graph.upper), begun)


@dataclass(frozen=True)
class _When:
    """The U vectors that the rows of one kind state: instants, spans and owners, each (U,)."""

    times: FloatArray
    spans: IntArray
    owners: IntArray

    @staticmethod
    def of(rows: Rows, kind: RowKind) -> "_When":
        each = 1 if kind in (RowKind.PUSH, RowKind.FRICTION) else 3
        mine = rows.kind == kind
        return _When(*(part[mine][::each] for part in (rows.time, rows.span, rows.owner)))


class Graph:
    """The rows as one CasADi expression of the packed unknowns x (n,)."""

    def __init__(self, task: Task, x: ca.MX) -> None:
        self.task, self.x = task, x
        t = self.t = task.transcription
        blocks, width = t.active.shape
        where = np.flatnonzero(t.active)
        places = np.ones(len(where)), (where, np.arange(len(where)))
        spread = sparse(csc_matrix(places, (t.active.size, len(where))))
        full = ca.reshape(spread @ x, width, blocks).T
        layout = t.layout
        self.com = full[:, layout.com.start : layout.com.stop]
        self.angles = full[:, layout.angles.start : layout.angles.stop]
        self.forces = full[:, layout.forces.start : layout.forces.stop]
        self.listed = task.rows(task.start)
        self.lower = self.listed.lower - self.listed.tolerance
        self.upper = self.listed.upper + self.listed.tolerance

    def distance(self) -> ca.MX:
        """Half the squared distance to the start, in the metric."""
        away = self.x - self.task.start[self.t.active]
        return 0.5 * ca.dot(away, sparse(metric_matrix(self.task)) @ away)

    def rows(self) -> ca.MX:
        """(R,) in the order of the transcription's. Raises ValueError for rows it cannot write."""
        write = {
            RowKind.BALANCE: self._balance,
            RowKind.MOMENT: self._moment,
            RowKind.PIN: self._place,
            RowKind.PIN_SPEED: self._speed,
            RowKind.PUSH: self._push,
            RowKind.FRICTION: self._friction,
        }
        kinds = list(dict.fromkeys(self.listed.kind.tolist()))
        unknown = [kind for kind in kinds if kind not in write]
        if unknown:
            raise ValueError(f"rows of kind {unknown} are not written for CasADi")
        parts = (write[kind](_When.of(self.listed, kind)) for kind in kinds)
        return ca.densify(ca.vertcat(*parts))  # IPOPT takes no rows that are zero whatever x is

    # -- the rows --------------------------------------------------------------------------

    def _balance(self, when: _When) -> ca.MX:
        bend = _spline(self.t, when, 2) @ self.com
        pushes = ca.reshape((_linear(self.t, when) @ self.forces).T, 3, -1)
        total = _summed(pushes, self.t.layout.n_points)
        return ca.vec(bend.T / STANDARD_GRAVITY + ca.DM([0.0, 0.0, 1.0]) - total)

    def _moment(self, when: _When) -> ca.MX:
        state = [(_spline(self.t, when, k) @ self.angles).T for k in range(3)]
        pushes = (_linear(self.t, when) @ self.forces).T
        node = moment_function(self.t)
        return ca.vec(node.map(len(when.times))(*state, pushes))

    def _place(self, when: _When) -> ca.MX:
        at, _ = self._points(when)
        com = (_spline(self.t, when, 0) @ self.com).T
        return ca.vec(com + at - ca.DM(self.task.places[when.owners].T))

    def _speed(self, when: _When) -> ca.MX:
        _, speed = self._points(when)
        return ca.vec((_spline(self.t, when, 1) @ self.com).T + speed)

    def _push(self, when: _When) -> ca.MX:
        return ca.vec(self._own_force(when)[2, :])

    def _friction(self, when: _When) -> ca.MX:
        """Above zero beyond the cone about the vertical."""
        force = self._own_force(when)
        friction = ca.DM([[self.t.contacts[i].friction for i in when.owners]])
        along = ca.sqrt(force[0, :] ** 2 + force[1, :] ** 2 + LEAST**2)
        return ca.vec(along - friction * force[2, :])

    def _own_force(self, when: _When) -> ca.MX:
        """(3, U) the force of each row's own point, BW."""
        return self._own((_linear(self.t, when) @ self.forces).T, when)

    def _own(self, every: ca.MX, when: _When) -> ca.MX:
        """(3, U) of (3 P, U): what belongs to each row's own point."""
        point = np.array([self.t.contacts[i].point for i in when.owners], dtype=int)
        index = (3 * (np.arange(len(point)) * self.t.layout.n_points + point))[:, None] + range(3)
        return ca.reshape(ca.vec(every)[index.ravel().tolist()], 3, -1)

    def _points(self, when: _When) -> tuple[ca.MX, ca.MX]:
        """Place and velocity (3, U) of each row's own point, relative to the centre of mass."""
        q, v = ((_spline(self.t, when, k) @ self.angles).T for k in (0, 1))
        every = points_function(self.t).map(len(when.times))(q, v)
        at, speed = (self._own(part, when) for part in every)
        return at, speed


def _spline(t: Transcription, when: _When, derivative: int) -> ca.DM:
    """(U, K) a spline's values at instants, as a matrix on its coefficients."""
    first = t.basis.first_coefficient[when.spans]
    return _matrix(t.basis.evaluate(when.times, derivative, when.spans), first, t)


def _linear(t: Transcription, when: _When) -> ca.DM:
    """(U, K) likewise for the forces, which are linear in each span."""
    first = t.basis.first_coefficient[when.spans] + 1
    return _matrix(t.basis.force_weights(when.times, when.spans), first, t)


def _matrix(values: FloatArray, first: IntArray, t: Transcription) -> ca.DM:
    """(U, K) with the row's values (U, m) from its first column (U,) on."""
    row = np.repeat(np.arange(len(values)), values.shape[1])
    column = (first[:, None] + np.arange(values.shape[1])).ravel()
    entries = values.ravel(), (row, column)
    return sparse(csc_matrix(entries, (len(values), t.basis.n_coefficients)))


def _summed(pushes: ca.MX, points: int) -> ca.MX:
    """(3, U) sums of (3, U P) forces, an instant's points side by side."""
    count = pushes.shape[1] // points
    return pushes @ ca.DM(np.kron(np.eye(count), np.ones((points, 1))))


def moment_function(t: Transcription) -> ca.Function:
    """(q, v, a, forces (3 P,) BW) -> what the moment leaves unexplained, (3,) BW m."""
    q, v, a = (ca.SX.sym(name, t.character.n_angles) for name in "qva")
    push = ca.SX.sym("f", 3 * t.layout.n_points)
    left = momentum_rate(t.character, q, v, a) / (t.character.mass * STANDARD_GRAVITY)
    at, _ = _relative(t, q, v)
    for i, arm in enumerate(at):
        left -= ca.cross(arm, push[3 * i : 3 * i + 3])
    return ca.Function("moment", [q, v, a, push], [left])


def points_function(t: Transcription) -> ca.Function:
    """(q, v) -> places and velocities (3 P,) of the touching points, relative to the centre of
    mass."""
    q, v = (ca.SX.sym(name, t.character.n_angles) for name in "qv")
    at, speed = _relative(t, q, v)
    return ca.Function("points", [q, v], [ca.vertcat(*at), ca.vertcat(*speed)])


def _relative(t: Transcription, q: ca.SX, v: ca.SX) -> tuple[list[ca.SX], list[ca.SX]]:
    frames: list[BodyMotion] = body_frames(t.character, q, v, ca.SX.zeros(t.character.n_angles))
    bodies = t.character.bodies
    moving = [point_motion(f, ca.SX(b.com)) for f, b in zip(frames, bodies, strict=True)]
    shares = [b.mass / t.character.mass for b in bodies]
    com = [sum(s * m[k] for s, m in zip(shares, moving, strict=True)) for k in (0, 1)]
    found = [point_motion(frames[p.body], ca.SX(p.place)) for p in t.points]
    return [f[0] - com[0] for f in found], [f[1] - com[1] for f in found]
