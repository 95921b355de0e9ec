"""Random but legal requests, of every kind and in every combination, extremes among them.

The solver runs in this process. A case's steps end after a while; what never comes to a step hangs.
"""

import json
from collections.abc import Callable
from functools import cache, partial

import numpy as np

from ....bridge.recipe.objects import placed_objects
from ....bridge.recipe.problem import parse_recipe
from ....solver.data.faults import NotComputable
from ....solver.data.problem import MotionProblem
from ....solver.data.recording import digest
from ....solver.data.reports.recording import Origin
from ....solver.data.reports.report import as_json
from ....solver.data.solver_options import ObjectiveKind, ReductionKind
from ....solver.fitting.fit import Fit
from ....solver.worker.pipeline import AdaptationResult, Subject, fit_subject, measure, solve
from ....solver.worker.stage_clock import StageClock
from ...recordings import HELD, read
from ..protocol.case import Changed, Family, HostileCase
from ..protocol.patience import at_most

CLIPS = (("forward_jump_116cm.bvh", 150.0, 260.0), ("run_3.bvh", 40.0, 120.0))
ENOUGH = 3.0  # s of this process, in steps
EXTREME = (1e-9, 1e-3, 0.2, 1.0, 3.0, 30.0, 1e3, 1e6, 1e12)
PARTS = ("Hips", "Spine", "Head", "LeftHand", "RightHand", "LeftFoot", "RightLeg", "LeftUpLeg")
Table = dict[str, object]


def requests(case: HostileCase) -> None:
    """One to five tables of any kind."""
    _solve(case, int(case.rng.integers(1, 6)), partial(_amount, case, 0.1))


def extremes(case: HostileCase) -> None:
    """One to three tables, most of whose values nobody means."""
    _solve(case, int(case.rng.integers(1, 4)), partial(_amount, case, 0.7))


def _amount(case: HostileCase, wild: float, usual: float) -> float:
    """A positive number about the usual one, or in some cases any at all."""
    if case.chance(wild):
        return usual * case.pick(EXTREME)
    return usual * float(np.exp(0.5 * case.rng.normal()))


def _solve(case: HostileCase, count: int, amount: Callable[[float], float]) -> None:
    subject, fitted = _fitted(*case.pick(CLIPS))
    text = recipe(case, subject, count, amount)
    (case.folder / "recipe.toml").write_text(text, encoding="utf-8")
    parsed = parse_recipe(text)
    before = digest(subject.recording)
    asked = subject.asked(parsed.problem)
    placed = placed_objects(parsed.under, asked.problem, asked.analysis)

    def fit(*_: object) -> Fit:
        case.taken_on = True  # what can be known before the fit has been asked
        return fitted

    with at_most(ENOUGH) as clock:
        _check(solve(asked.with_objects(placed), clock, fit))
    if digest(subject.recording) != before:
        raise Changed("the recording")


def _check(result: AdaptationResult) -> None:
    """What is told and written of a result is numbers, also of one that fell short."""
    json.dumps(as_json(result.report(Origin("clip"))), allow_nan=False)
    for part in (result.track.root_head, result.track.rotations):
        if not np.isfinite(part).all():
            raise ValueError("a pose is not finite")
    result.traces()
    if result.fault is not None:
        raise result.fault


@cache
def _fitted(name: str, first: float, last: float) -> tuple[Subject, Fit]:
    problem = MotionProblem(frames=(first, last))
    subject = measure(read(HELD / name), problem)
    try:
        return subject, fit_subject(subject, StageClock())
    except NotComputable as fault:  # which only what is asked for may be
        raise ArithmeticError(f"{name} itself is not computable") from fault


# ---------------------------------------------------------------- recipes


def recipe(
    case: HostileCase, subject: Subject, count: int, amount: Callable[[float], float]
) -> str:
    """Random tables, written as TOML."""
    maker = _Maker(case, subject, amount)
    lines = []
    for _ in range(count):
        header = case.pick(list(maker.makers))
        lines += [f"[[{header}]]", *_lines(maker.makers[header]())]
    if case.chance(0.4):
        lines += ["[body]", *_lines({"gravity": amount(9.8), "mass": amount(70.0)})]
    if case.chance(0.6):
        lines += maker.solution()
    return "\n".join(lines) + "\n"


def _lines(table: Table) -> list[str]:
    return [f"{key} = {toml(value)}" for key, value in table.items()]


def toml(value: object) -> str:
    """A value as TOML writes it."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


class _Maker:
    """Makes tables of each kind."""

    def __init__(
        self, case: HostileCase, subject: Subject, amount: Callable[[float], float]
    ) -> None:
        self._case, self._amount = case, amount
        bones = [bone.name for bone in subject.recording.bones]
        self._bones = [b for b in bones if b in PARTS] if case.chance(0.8) else bones
        self._phases = [phase.name for phase in subject.schedule.phases]
        self._ground = [name for name in self._phases if name.startswith("ground")]
        self._frames = subject.recording.frames
        self._points = sorted({contact.point for contact in subject.schedule.contacts})
        self.makers: dict[str, Callable[[], Table]] = {
            "pin": self._pin,
            "point": self._point,
            "lift": lambda: {"phase": case.pick(self._ground)},
            "angle": self._limit,
            "twist": self._limit,
            "cone": lambda: {**self._bone(), "half_angle": self._angle(40.0), **self._when()},
            "torque": self._torque,
            "pose": self._pose,
            "orientation": self._orientation,
            "force": self._force,
            "load": lambda: {**self._bone(), case.pick(("mass", "share")): amount(0.3)},
            "limb": lambda: {"bones": self._some(), "length": amount(1.0), "mass": amount(1.0)},
            "timing": self._timing,
            "hold": self._hold,
            "shape": lambda: {"bones": self._some(), "thickness": amount(1.0)},
            "object": self._object,
        }

    def _bone(self) -> Table:
        return {"bone": self._case.pick(self._bones)}

    def _some(self) -> list[str]:
        return sorted({self._case.pick(self._bones) for _ in range(2)})

    def _signed(self, usual: float) -> float:
        return self._amount(usual) * self._case.pick((-1.0, 1.0))

    def _vector(self, usual: float) -> list[float]:
        return [self._signed(usual) if self._case.chance(0.7) else 0.0 for _ in range(3)]

    def _angle(self, usual: float) -> float:
        return min(self._amount(usual), 179.0)

    def _frame(self) -> float:
        return float(round(self._case.rng.uniform(self._frames[0], self._frames[-1])))

    def _when(self) -> Table:
        start = self._frame()
        moment = self._case.pick(("start", "middle", "apex", "end"))
        return self._case.pick(
            (
                {},
                {"phase": self._case.pick(self._phases)},
                {"frames": [start, min(start + self._amount(10.0), 1e4)]},
                {"frame": start},
                {"phase": self._case.pick(self._phases), "moment": moment},
            )
        )

    def _pin(self) -> Table:
        ways = {way: self._signed(0.15) for way in ("forward", "left", "up")}
        table: Table = {"phase": self._case.pick(self._ground)}
        table |= {way: far for way, far in ways.items() if self._case.chance(0.4)}
        if self._case.chance(0.2):
            table["turn"] = self._signed(30.0)
        if self._case.chance(0.2):
            table["points"] = [self._case.pick(self._points)]
        return table

    def _point(self) -> Table:
        table = {**self._bone(), **self._when()}
        table |= self._case.pick(
            (
                {"relative": self._vector(0.1)},
                {"place": self._vector(1.0)},
                {"at_least": {"z": self._signed(0.2)}},
                {"at_most": {"up": self._signed(0.2)}},
                {"at_least": {"x": -0.1}, "at_most": {"x": 0.1}, "relative": self._vector(0.1)},
                {"normal": self._vector(1.0), "at_most": {"out": 0.01}},
            )
        )
        if self._case.chance(0.3):
            table |= {"environment": True, "grip": self._case.chance(0.5)}
        return table

    def _limit(self) -> Table:
        low, high = sorted((self._signed(40.0), self._signed(40.0)))
        bounds: Table = {"at_least": low, "at_most": high}
        return {**self._bone(), **(bounds if self._case.chance(0.7) else {"at_most": high})} | (
            self._when()
        )

    def _torque(self) -> Table:
        kind = self._case.pick(("bound", "share"))
        bound = 0.0 if self._case.chance(0.3) else self._amount(50.0 if kind == "bound" else 0.5)
        return {"bones": self._some(), kind: bound, **self._when()}

    def _pose(self) -> Table:
        table = {"bones": self._some(), **self._when()}
        if self._case.chance(0.3):
            table["reference"] = "rest"
        key = self._case.pick(("slack", "weight"))
        return table | {key: self._amount(2.0)}

    def _orientation(self) -> Table:
        turns: Table = {"turn": self._signed(20.0), "tilt": self._signed(10.0)}
        return {**self._bone(), **turns, "slack": self._amount(2.0), **self._when()}

    def _force(self) -> Table:
        amounts = {"friction": 0.8, "peak": 3.0, "match": 10.0}
        table: Table = {k: self._amount(v) for k, v in amounts.items() if self._case.chance(0.5)}
        table["shape"] = self._case.pick(("exact", "pyramid"))
        return table | self._when()

    def _timing(self) -> Table:
        kind, usual = self._case.pick((("factor", 1.0), ("seconds", 0.4)))
        return {"phase": self._case.pick(self._phases), kind: min(self._amount(usual), 20.0)}

    def _hold(self) -> Table:
        return {"frame": self._frame(), "seconds": min(self._amount(0.3), 10.0)}

    def _object(self) -> Table:
        box = [self._amount(0.5) for _ in range(3)]
        role = self._case.pick(("ground", "obstacle"))
        return {"box": box, "role": role, "place": self._vector(1.0)}

    def solution(self) -> list[str]:
        """Lines of solution, objectives and reduction."""
        case = self._case
        method = case.pick(("implicit", "implicit with torques", "explicit", "explicit"))
        table: Table = {"method": method, "dynamics": case.pick(("automatic", "standard"))}
        table |= {flag: case.chance(0.5) for flag in ("keep_times", "solid", "human")}
        if case.chance(0.2):
            table["longest_span"] = max(self._amount(0.1), 0.02)
        lines = ["[solution]", *_lines(table)]
        if method == "explicit":
            kinds = {
                case.pick(list(ObjectiveKind)).value for _ in range(int(case.rng.integers(1, 4)))
            }
            weights = {json.dumps(kind): self._amount(1.0) for kind in sorted(kinds)}
            lines += ["[solution.objectives]", *_lines(dict(weights))]
        if case.chance(0.2):
            kind = case.pick([k for k in ReductionKind if k is not ReductionKind.MATRIX])
            lines += ["[solution.reduction]", *_lines({"kind": kind.value})]
            if kind is not ReductionKind.MIRROR_LEGS:
                lines.append(f"dimensions = {int(case.rng.integers(1, 50))}")
        return lines


FAMILIES = (
    Family("requests", 2.5, 60.0, requests),
    Family("requests, extreme", 2.5, 60.0, extremes),
)
