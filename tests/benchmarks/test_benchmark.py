"""Every peer of the benchmark gets the same problem as our solver, and solves a small one."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from hangtime.benchmarks import naive_peer, scaling
from hangtime.benchmarks.solutions import SOLUTIONS, with_solution
from hangtime.benchmarks.tables import Table, with_ratios, write_json
from hangtime.benchmarks.timing import in_turns
from hangtime.devtools.peers import ipopt_peer
from hangtime.devtools.peers.task import Equations, Task, metric_matrix
from hangtime.solver.body.anatomy import Part
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.fitting.fit import ADAPT_COST_WEIGHTS
from hangtime.solver.objectives.motion_metric import motion_metric
from hangtime.solver.transcription.motion import Motion
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.toy_problems import places, random_state, standing

LIMIT = 60.0  # s


@cache
def toy() -> Task:
    """Two legs that stand, from a guess that is in balance but for its moment; their beginning is
    as free as their end."""
    start = random_state(3, 0.0)
    weights = replace(ADAPT_COST_WEIGHTS, came_from=0.0)
    metric = motion_metric(Motion(standing(), start, places()), weights)
    return Task(standing(), places(), start, metric)


NEAREST = 0.0134  # what three solvers of different kinds agree on


@pytest.mark.slow
def test_ipopt_solves_the_toy() -> None:
    found = ipopt_peer.solve(toy(), LIMIT)
    assert found.solved
    assert found.distance < 1.1 * NEAREST


@pytest.mark.slow
def test_a_first_time_user_s_form_solves_the_toy_too() -> None:
    found = naive_peer.solve(toy(), LIMIT)
    assert found.solved
    assert found.distance == pytest.approx(NEAREST, rel=0.05)


@pytest.mark.slow
def test_drake_with_snopt_solves_the_toy_too() -> None:
    snopt_peer = pytest.importorskip(
        "hangtime.benchmarks.snopt_peer", reason="no Drake", exc_type=ImportError
    )
    found = snopt_peer.solve(toy(), LIMIT)
    assert found.solved
    assert found.distance == pytest.approx(NEAREST, rel=0.05)


def test_a_peer_that_runs_out_of_time_is_judged_where_it_is() -> None:
    found = ipopt_peer.solve(toy(), 1e-3)
    assert not found.solved
    assert found.violation == toy().violation(found.x)


def test_the_first_time_user_s_rows_and_distance_are_ours() -> None:
    task = toy()
    near = task.start[task.transcription.active]
    near = near + 0.05 * np.random.default_rng(0).normal(size=near.shape)
    x = ca.MX.sym("x", len(near))
    graph = naive_peer.Graph(task, x)
    rows, half = ca.Function("graph", [x], [graph.rows(), graph.distance()])(near)
    full = task.unpack(near)
    assert np.asarray(rows).ravel() == pytest.approx(
        task.transcription.values(full, task.places), abs=1e-5
    )
    assert np.sqrt(2 * float(half)) == pytest.approx(task.distance(full))


def test_the_sparse_rows_and_metric_are_the_task_s() -> None:
    task, equations = toy(), Equations(toy())
    packed = task.start[task.transcription.active]
    random = np.random.default_rng(1)
    packed = packed + 0.02 * random.normal(size=packed.shape)  # away from the cones' tips
    step = 1e-6 * random.normal(size=packed.shape)
    value, jacobian = equations.jacobian(packed)
    ahead, behind = (equations.values(packed + s * step) for s in (1, -1))
    assert jacobian @ step == pytest.approx(0.5 * (ahead - behind), abs=1e-10)
    metric = metric_matrix(task)
    away = packed - task.start[task.transcription.active]
    assert np.sqrt(away @ (metric @ away)) == pytest.approx(task.distance(task.unpack(packed)))
    assert value == pytest.approx(equations.values(packed))


def test_pinocchio_computes_the_same_equations() -> None:
    floor = pytest.importorskip(
        "hangtime.benchmarks.floor", reason="no Pinocchio", exc_type=ImportError
    )
    task, t = toy(), toy().transcription
    rates = floor.Nodes.of(task).momentum_rates() / (t.character.mass * 9.81)
    angles = [t.angles_at_nodes(task.start, k) for k in range(3)]
    assert rates == pytest.approx(t.moment.value(*angles), abs=1e-9)
    bands = floor.band_matrix(task)
    assert floor.factor(bands).shape == bands.shape


def test_each_solution_is_asked_for_by_its_name() -> None:
    asked = [with_solution(MotionProblem(), s).requests.solution for s in SOLUTIONS.values()]
    assert len({a.method for a in asked}) == len(SOLUTIONS) == 3


@pytest.mark.slow
def test_fewer_degrees_of_freedom_leave_a_problem_that_is_solved() -> None:
    problem = MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.1, 0.0, 0.0)),))
    task = Task.of(fitted_hop(), problem)
    small = scaling.with_fewer(fitted_hop(), task, (Part.HAND, Part.CLAVICLE))
    lost = sum(
        joint.axes.dofs
        for body, joint in zip(
            task.transcription.character.bodies, task.transcription.character.joints, strict=True
        )
        if body.part in (Part.HAND, Part.CLAVICLE)
    )
    whole, fewer = (t.transcription.character for t in (task, small))
    assert fewer.n_dofs == whole.n_dofs - lost
    assert small.transcription.basis is task.transcription.basis
    assert scaling.finished(small).solved


def test_quick_works_take_turns_and_long_ones_run_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "hangtime.benchmarks.timing.timed", lambda work: (work(), 99.0 if work is long else 1.0)
    )
    order: list[str] = []

    def long() -> str:
        order.append("long")
        return "long"

    def short() -> str:
        order.append("short")
        return "short"

    found = in_turns({"a": short, "b": long}, 3)
    assert order == ["short", "long", "short", "short"]
    assert found == {"a": ("short", 1.0), "b": ("long", 99.0)}


def test_tables_are_told_with_and_without_the_machine_s_seconds(tmp_path: Path) -> None:
    rows = [
        {"who": "a", "took (s)": 1.23456, "ok": True},
        {"who": "b", "took (s)": None, "ok": False},
    ]
    table = Table("T", "C", rows)
    assert "took" not in table.without_seconds().markdown()
    assert "| a | 1.23 | yes |" in table.markdown()
    assert table.text().splitlines()[-1].split() == ["b", "–", "no"]
    write_json([table, replace(table, title="U")], tmp_path / "t.json")
    back = json.loads((tmp_path / "t.json").read_text(encoding="utf-8"))
    assert back[1]["rows"][0] == {"who": "a", "took (s)": 1.23456, "ok": True}


def test_a_ratio_stands_after_its_column() -> None:
    rows = with_ratios([{"n": 2, "took (s)": 0.5}, {"n": 4, "took (s)": 1.5}], {"n": "n / first"})
    assert [list(row.items()) for row in rows] == [
        [("n", 2), ("n / first", 1.0), ("took (s)", 0.5)],
        [("n", 4), ("n / first", 2.0), ("took (s)", 1.5)],
    ]
