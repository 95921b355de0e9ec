"""Results of a run in the window: scenarios, figures beside their limits, a JUnit report."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from ..figures.limits import Figure, Limit, figure

CLIP = "forward_jump_116cm"
BLOCKED = "interface blocked at most during "
BETWEEN = "longest between Blender's free moments during "
REST = "rest"  # what is measured under it is a window that is only redrawn
STAGES = ("analyse", "examine", "fit", "solve", "write-back")
OVERLAY = "overlay per redraw with 20 constraints"
FIRST_GHOST = "first ghost after the mouse moves"
CLICKS = "clicks from an imported BVH to an adapted landing"
LIMITS = {
    "ghost updates per second during a drag": Limit("1/s", 10.0, 15.0, at_least=True),
    "ghost updates per second during a drag, drawn or not": Limit("1/s"),
    FIRST_GHOST: Limit("ms", 150.0, 100.0),
    "worker's processor time per update during a drag": Limit("ms"),
    **{BLOCKED + stage: Limit("ms", 100.0, 30.0) for stage in STAGES},
    "Esc to idle": Limit("s", 0.3, 0.1),
    OVERLAY: Limit("ms", 2.5, 1.0),
    f"{OVERLAY}, by the clock": Limit("ms"),
    CLICKS: Limit("1", 6.0, 4.0),
    # What is behind the figures of blocking; software draws the window here.
    **{BETWEEN + stage: Limit("ms") for stage in (REST, *STAGES)},
}
QUICKEST = ("opens_sidebar", "analyses", "chooses_landing", "drags_landing")
# Beginnings of log lines that a sound extension does not cause.
FAULTS = ("Traceback (most recent call last)", "rna_", "Exception in", "Python: ", "LEFT ")
Record = dict[str, Any]


@dataclass(frozen=True)
class RunRecord:
    """Scenarios, figures, profiles and clicks of a run; Blender's exit code and log."""

    code: int
    log: str
    scenarios: list[Record] = field(default_factory=list)
    figures: dict[str, float] = field(default_factory=dict)
    profiles: dict[str, Record] = field(default_factory=dict)
    clicks: list[Record] = field(default_factory=list)

    @staticmethod
    def read(out: Path, code: int, log: str) -> RunRecord:
        """Read the record that a run left in `out`."""
        file = out / "run.json"
        return RunRecord(code, log, **(json.loads(file.read_text()) if file.is_file() else {}))

    @property
    def ending(self) -> str | None:
        """Failure of the run as a whole; None where there was none."""
        if not self.scenarios:
            return f"the run did not begin; Blender ended with code {self.code}"
        if self.code == 124:
            return "the run took too long and was ended"
        if self.code != 0:
            return f"Blender ended with code {self.code}"
        wrong = [line for line in self.log.splitlines() if line.startswith(FAULTS)]
        return f"Blender's log says: {wrong[0]} ({len(wrong)} such lines)" if wrong else None


@dataclass(frozen=True)
class Verdict:
    """One thing that had to be so. failure: None where it is."""

    name: str
    failure: str | None
    seconds: float = 0.0
    skipped: bool = False

    def __str__(self) -> str:
        word = "skipped" if self.skipped else "failed" if self.failure else "ok"
        why = f": {self.failure}" if word == "failed" else ""
        return f"  {self.name:58} {word:8} {self.seconds:5.1f} s{why}"


def figures_of(run: RunRecord) -> list[Figure]:
    """The measured numbers beside what they must reach."""
    values = {**run.figures, **blocking(run.profiles), **clicks(run)}
    return [figure(name, value, CLIP, "window", LIMITS) for name, value in values.items()]


def blocking(profiles: dict[str, Record]) -> dict[str, float]:
    """Longest blocking of the interface by stage, ms: in a call into our code by the clock, drawing
    left out, or between two free moments by what Blender's thread computed, whichever is longer.

    The rest of the time between free moments is waiting for software to draw the window.
    """
    values = {}
    for stage in (REST, *STAGES):
        if stage in profiles:
            gaps, calls = profiles[stage]["gaps"], profiles[stage]["calls"]
            acting = [spans["longest"] for name, spans in calls.items() if not draws(name)]
            values[BETWEEN + stage] = 1000 * gaps["longest"]
            if stage != REST:
                values[BLOCKED + stage] = 1000 * max([gaps["busy_longest"], *acting])
    return values


def draws(function: str) -> bool:
    """Whether a function of ours is one that draws, by its qualified name."""
    return function.rpartition(".")[2].startswith("draw")


def clicks(run: RunRecord) -> dict[str, float]:
    """Number of clicks to the adapted landing, if it was reached."""
    done = {scenario["name"] for scenario in run.scenarios if scenario["failure"] is None}
    if not done.issuperset(QUICKEST):
        return {}
    return {CLICKS: sum(click["task"] in QUICKEST for click in run.clicks)}


def scenario_verdicts(run: RunRecord) -> list[Verdict]:
    """Each scenario, and the end of the run."""
    found = []
    for scenario in run.scenarios:
        failure = scenario["failure"]
        if failure is not None and scenario["pictures"]:
            failure = f"{failure} (see {scenario['pictures'][-1]})"
        found.append(Verdict(scenario["name"], failure, scenario["seconds"], scenario["skipped"]))
    return [*found, Verdict("the run's end", run.ending)]


def figure_verdicts(figures: list[Figure]) -> list[Verdict]:
    """Each promise."""
    measured = {figure.name: figure for figure in figures}
    promised = [name for name, limit in LIMITS.items() if limit.must is not None]
    return [Verdict(name, missed(measured.get(name))) for name in promised]


def missed(figure: Figure | None) -> str | None:
    """Failure of a promised figure; None where it is kept."""
    if figure is None:
        return "was not measured"
    return None if figure.ok else f"{figure.value:.4g} {figure.unit}, must {figure.must:g}"


def junit(found: list[Verdict]) -> str:
    """The verdicts as pytest would report them."""
    skipped = sum(verdict.skipped for verdict in found)
    failed = sum(verdict.failure is not None for verdict in found) - skipped
    counts = {"tests": len(found), "failures": failed, "errors": 0, "skipped": skipped}
    attributes = {name: str(count) for name, count in counts.items()}
    suites = ElementTree.Element("testsuites")
    suite = ElementTree.SubElement(suites, "testsuite", attributes, name="window")
    for verdict in found:
        attributes = {"name": verdict.name, "time": f"{verdict.seconds:.3f}"}
        case = ElementTree.SubElement(suite, "testcase", attributes)
        if verdict.failure is not None:
            kind = "skipped" if verdict.skipped else "failure"
            ElementTree.SubElement(case, kind, message=verdict.failure)
    return ElementTree.tostring(suites, encoding="unicode")
