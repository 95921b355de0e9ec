"""What a play in the window brought: its scenes and its figures beside promises, as a JUnit report."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from .figures_limits import Figure, Limit, figure

CLIP = "forward_jump_116cm"
BLOCKED = "interface blocked at most during "
BETWEEN = "longest between Blender's free moments during "
REST = "rest"  # what is measured under it is a window that is only redrawn
STAGES = ("analyse", "fit", "solve", "write-back")
CLICKS = "clicks from an imported BVH to an adapted landing"
LIMITS = {
    "ghost updates per second during a drag": Limit("1/s", 5.0, 15.0, at_least=True),
    **{BLOCKED + stage: Limit("ms", 100.0, 30.0) for stage in STAGES},
    "Esc to idle": Limit("s", 0.3, 0.1),
    "overlay per redraw with 20 constraints": Limit("ms", 4.0, 1.0),
    CLICKS: Limit("1", 6.0, 4.0),
    # What is behind the figures of blocking; software draws the window here.
    **{BETWEEN + stage: Limit("ms") for stage in (REST, *STAGES)},
}
QUICKEST = ("opens_sidebar", "analyses", "chooses_landing", "moves_landing", "adapts")
# How lines of Blender's log begin that a sound extension does not cause.
FAULTS = ("Traceback (most recent call last)", "rna_", "Exception in", "Python: ")
Record = dict[str, Any]


@dataclass(frozen=True)
class Played:
    """What the stage wrote; code: how Blender ended; log: its words."""

    code: int
    log: str
    scenes: list[Record] = field(default_factory=list)
    figures: dict[str, float] = field(default_factory=dict)
    stretches: dict[str, Record] = field(default_factory=dict)
    clicks: list[Record] = field(default_factory=list)

    @staticmethod
    def read(out: Path, code: int, log: str) -> Played:
        """What the stage left in `out`, after Blender ended with that code."""
        file = out / "play.json"
        return Played(code, log, **(json.loads(file.read_text()) if file.is_file() else {}))

    @property
    def ending(self) -> str | None:
        """What was wrong with the play as a whole; None where nothing was."""
        if not self.scenes:
            return f"the play did not begin; Blender ended with code {self.code}"
        if self.code == 124:
            return "the play took too long and was ended"
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


def figures_of(played: Played) -> list[Figure]:
    """The measured numbers beside what they must reach."""
    values = {**played.figures, **blocking(played.stretches), **clicks(played)}
    return [figure(name, value, CLIP, "window", LIMITS) for name, value in values.items()]


def blocking(stretches: dict[str, Record]) -> dict[str, float]:
    """How long the interface was held up, ms: the longest call into our code, or what the longest
    time between free moments has beyond a redraw at rest, whichever is longer."""
    rest = stretches.get(REST, {}).get("gaps", {}).get("longest")
    if rest is None:
        return {}
    values = {BETWEEN + REST: 1000 * rest}
    for stage in STAGES:
        if stage in stretches:
            gap = stretches[stage]["gaps"]["longest"]
            call = max((c["longest"] for c in stretches[stage]["calls"].values()), default=0.0)
            values[BLOCKED + stage] = 1000 * max(call, gap - rest)
            values[BETWEEN + stage] = 1000 * gap
    return values


def clicks(played: Played) -> dict[str, float]:
    """How many clicks the way to the adapted landing took, if it was gone to its end."""
    done = {scene["name"] for scene in played.scenes if scene["failure"] is None}
    if not done.issuperset(QUICKEST):
        return {}
    return {CLICKS: sum(click["task"] in QUICKEST for click in played.clicks)}


def verdicts(played: Played, figures: list[Figure]) -> list[Verdict]:
    """Each scene, how the play ended, and each promise."""
    found = []
    for scene in played.scenes:
        failure = scene["failure"]
        if failure is not None and scene["pictures"]:
            failure = f"{failure} (see {scene['pictures'][-1]})"
        found.append(Verdict(scene["name"], failure, scene["seconds"], scene["skipped"]))
    found.append(Verdict("the play's end", played.ending))
    measured = {figure.name: figure for figure in figures}
    for name, limit in LIMITS.items():
        if limit.must is not None:
            found.append(Verdict(name, missed(measured.get(name))))
    return found


def missed(figure: Figure | None) -> str | None:
    """What is wrong with a promised figure; None where it is kept."""
    if figure is None:
        return "was not measured"
    return None if figure.ok else f"{figure.value:.4g} {figure.unit}, must {figure.must:g}"


def junit(found: list[Verdict]) -> str:
    """The verdicts as pytest would report them."""
    suite = ElementTree.Element("testsuite", name="window")
    for verdict in found:
        case = ElementTree.SubElement(
            suite, "testcase", name=verdict.name, time=f"{verdict.seconds:.3f}"
        )
        if verdict.failure is not None:
            kind = "skipped" if verdict.skipped else "failure"
            ElementTree.SubElement(case, kind, message=verdict.failure)
    failures, skipped = (len(suite.findall(f".//{kind}")) for kind in ("failure", "skipped"))
    counts = {"tests": len(found), "failures": failures, "errors": 0, "skipped": skipped}
    for name, count in counts.items():
        suite.set(name, str(count))
    suites = ElementTree.Element("testsuites")
    suites.append(suite)
    return ElementTree.tostring(suites, encoding="unicode")
