"""What `dev.py benchmark` measures, table by table."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial

from ..devtools.peers import ipopt_peer
from ..devtools.peers.task import PeerResult, Task
from ..devtools.recordings import JUMP
from ..solver.analysis.analyse import analyse
from ..solver.fitting.fit import Fit, fit
from ..solver.stages.implicit import Adaptation, adapt
from . import floor, naive_peer, scaling, snopt_peer
from .recordings import jump, recording
from .solutions import IMPLICIT, SOLUTIONS, with_solution
from .tables import Row, Table, Value, with_ratios
from .timing import REPEATS, in_turns

Peer = Callable[[Task, float], PeerResult]


FIRST_TIME = "IPOPT, as first written with CasADi"
PEERS: dict[str, Peer] = {
    "IPOPT, fair": ipopt_peer.solve,
    FIRST_TIME: naive_peer.solve,
    "Drake with SNOPT": snopt_peer.solve,
}


@dataclass(frozen=True)
class Extent:
    """How much is measured. limit_s: for each peer."""

    limit_s: float
    lengths: tuple[float, ...] = scaling.LENGTHS
    repeats: int = REPEATS
    peers: tuple[str, ...] = tuple(PEERS)

    @staticmethod
    def quick(limit_s: float) -> "Extent":
        """About a minute: short clips, once each, and no peer whose set-up takes minutes."""
        peers = tuple(name for name in PEERS if name != FIRST_TIME)
        return Extent(limit_s, lengths=(2.0, 5.0), repeats=1, peers=peers)


class Benchmark:
    """All tables; the jump is fitted once."""

    def __init__(self, extent: Extent) -> None:
        self.extent = extent
        self.problem = jump()

    @cached_property
    def fitted(self) -> Fit:
        analysis = analyse(recording(JUMP), self.problem)
        fitted = fit(analysis.performance, analysis.schedule)
        _ = fitted.metric  # part of the stored fit
        return fitted

    @cached_property
    def task(self) -> Task:
        return Task.of(self.fitted, self.problem)

    def tables(self) -> Iterator[Table]:
        """Each as soon as it is measured."""
        yield self._solvers()
        yield self._iteration()
        yield self._lengths()
        yield self._one_jump()
        yield self._dofs()

    def _solvers(self) -> Table:
        t = self.task.transcription
        caption = (
            "forward_jump_116cm, frames 60 to 330, its landing moved 0.4 m forward and 0.3 m up, "
            f"from the stored fit: {t.n_unknowns} unknowns, "
            f"{len(self.task.rows(self.task.start).value)} rows. Every peer gets our "
            "rows, start and metric, and as bounds the violations that we let stand; after "
            f"{self.extent.limit_s:g} s it is stopped and judged where it is, by our rows."
        )
        ours = in_turns({name: self._adapting(name) for name in SOLUTIONS}, self.extent.repeats)
        one, distance = ours[IMPLICIT][1], self._distance(ours[IMPLICIT][0])
        rows: list[tuple[Value, ...]] = []
        for name, (found, seconds) in ours.items():
            off = self._distance(found)
            steps = sum(len(outcome.steps) for outcome in found.outcomes)
            apart = None if off is None or distance is None else off / distance
            violation = found.outcome.violation
            rows.append((name, seconds, seconds / one, None, steps, found.solved, violation, apart))
        for name in self.extent.peers:
            peer = PEERS[name](self.task, self.extent.limit_s)
            apart = None if distance is None else peer.distance / distance
            times = (peer.seconds, peer.seconds / one, peer.setup / one)
            rows.append((name, *times, peer.iterations, peer.solved, peer.violation, apart))
        columns = (
            "solver",
            "time (s)",
            "times ours",
            "set-up, times ours",
            "iterations",
            "solved",
            "worst violation / tolerance",
            "distance / ours",
        )
        named = [dict(zip(columns, row, strict=True)) for row in rows]
        return Table("Solutions and peers", caption, named)

    def _adapting(self, name: str) -> Callable[[], Adaptation]:
        problem = with_solution(self.problem, SOLUTIONS[name])
        return partial(adapt, self.fitted, problem)

    def _distance(self, adaptation: Adaptation) -> float | None:
        """From the task's start; None where knots or unknowns were added since."""
        same = [o.x for o in adaptation.outcomes if o.x.shape == self.task.start.shape]
        return self.task.distance(same[-1]) if same else None

    def _iteration(self) -> Table:
        task = self.task
        nodes, bands = floor.Nodes.of(task), floor.band_matrix(task)
        works: dict[str, Callable[[], object]] = {
            "our rows and Jacobian": partial(task.rows, task.start),
            "our iteration: rows, factor, step": partial(floor.our_iteration, task),
            "Pinocchio, inverse dynamics' derivatives": nodes.all_derivatives,
            "Pinocchio, centroidal momentum's derivatives": nodes.root_derivatives,
            "LAPACK, banded Cholesky": partial(floor.factor, bands),
        }
        found = {name: s for name, (_, s) in in_turns(works, 3 * self.extent.repeats).items()}
        quickest = min(s for name, s in found.items() if name.startswith("Pinocchio"))
        least = quickest + found["LAPACK, banded Cholesky"]
        found["floor: the quicker derivatives and Cholesky"] = least
        caption = (
            f"One full iteration at {len(nodes.q)} nodes against the floor: Pinocchio's analytic "
            "derivatives at all of them plus one banded Cholesky of the same size and band "
            f"({bands.shape[1]} unknowns, half-bandwidth {len(bands) - 1})."
        )
        rows: list[Row] = [
            {"work": name, "time (s)": s, "times the floor": s / least} for name, s in found.items()
        ]
        return Table("One iteration", caption, rows)

    def _lengths(self) -> Table:
        rows = list(scaling.lengths(self.extent.lengths, min(3, self.extent.repeats)))
        ratios = {
            "unknowns": "unknowns / first",
            "fit (s)": "fit / first",
            "its memory (MB)": "memory / first",
            "adaptation (s)": "adaptation / first",
        }
        caption = (
            f"Windows of the ten hops, CMU 01_01, from {scaling.FIRST:g} s on, each fitted, then "
            "its first landing moved 0.3 m forward, as a whole. The processor's time, and the "
            "most memory that the fit holds at once."
        )
        return Table("Cost against length", caption, with_ratios(rows, ratios))

    def _one_jump(self) -> Table:
        ratios = {"fit (s)": "fit / first", "adaptation (s)": "adaptation / first"}
        caption = (
            "The first landing of the ten hops moved 0.3 m forward, in a window of its own and in "
            "the whole take, of which the part that the edit is about is solved: the processor's "
            "time of fit and adaptation."
        )
        rows = list(scaling.one_jump())
        return Table("One jump in a long take", caption, with_ratios(rows, ratios))

    def _dofs(self) -> Table:
        tasks = {
            name: scaling.with_fewer(self.fitted, self.task, parts)
            for name, parts in scaling.WELDED.items()
        }
        works = {name: partial(floor.our_iteration, small) for name, small in tasks.items()}
        one = in_turns(works, 3 * self.extent.repeats)
        whole = in_turns(
            {name: partial(scaling.finished, small) for name, small in tasks.items()},
            self.extent.repeats,
        )
        rows: list[Row] = [
            {
                "figure": name,
                "DOFs": small.transcription.character.n_dofs,
                "unknowns": small.transcription.n_unknowns,
                "iteration (s)": one[name][1],
                "solve (s)": whole[name][1],
                "steps": len(whole[name][0].steps),
                "solved": whole[name][0].violation <= 1.0,
            }
            for name, small in tasks.items()
        ]
        ratios = {"iteration (s)": "iteration / all DOFs", "solve (s)": "solve / all DOFs"}
        caption = (
            "The jump's edit with joints made rigid at their mean over the clip, at the same knots."
        )
        return Table("Cost against degrees of freedom", caption, with_ratios(rows, ratios))
