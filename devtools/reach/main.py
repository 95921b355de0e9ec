"""How a body shares a reach: python3 dev.py reach [--out DIR].

A hand, or both, is asked for 0.3 m away from where the recording has it, standing before a jump and
at its top, of four jumps of two performers; for a person, and for a figure that is no human
(`human = false`), whose changes are measured by what they move alone. Writes docs/reach.md.
"""

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import fmean

import numpy as np

from ...solver.body.anatomy import Part, Side
from ...solver.data.problem import MotionProblem
from ...solver.data.requests import PointAxes, PointRequest, Requests, When
from ...solver.data.solver_options import HumanRanges, SolverOptions
from ...solver.fitting.fit import Fit
from ...solver.results.joint_report import joint_turns
from ...solver.stages.implicit import Adaptation
from ...solver.worker.pipeline import Subject, adapt_fit, fit_subject, measure
from ...solver.worker.stage_clock import StageClock
from ..environment.virtual_environment import ROOT
from ..pairs.clips import RATE, Jump, broad_jumps, hops
from ..pairs.jump_frame import longest_flight
from ..reports import report_options

FAR = 0.3  # m
STANDING = 0.15  # s after the clip's first frame
AROUND = 2.0  # frames before and after
SAMPLES = 400  # instants that are looked at
JUMPS = ("broad 114cm", "broad 116cm", "hop 1", "hop 9")
ARM = {
    "collarbone": (Part.CLAVICLE,),
    "shoulder": (Part.UPPER_ARM,),
    "elbow": (Part.FOREARM,),
    "wrist": (Part.HAND,),
}
MIDDLE = {"neck": (Part.NECK, Part.HEAD), "spine": (Part.SPINE,)}
LEGS = {"hip": (Part.THIGH,), "knee": (Part.SHANK,), "ankle": (Part.FOOT,)}
JOINTS = (*ARM, *MIDDLE, *LEGS)
HEAD = """# How a reach is shared

`python3 dev.py reach` measures these anew and wrote this page; `reach.json` has every number.

A hand is asked for 0.3 m further than the recording has it, for five frames, standing before a jump
and at its top. Of each joint: degrees by which it is turned from the recording's fit at most; bones
of one spine or neck are summed up, legs are the mean of both, arms that of those which reach. Means
over {count} jumps of two performers: {names}. *Moves alone* is what a change costs by what it moves
(`human = false`); *and ranges* is what it costs for a person: half by what it moves, half by what
it takes of the joints' ranges. The weight of the halves was not chosen on any recording. Seconds
are the clock's, and other work may have gone on beside.

People reach with the arm first (Kaminski, Bock & Gentile 1995). Where they have to lean, spine and
hips share: the spine bends 1.2 times as far as the hips in men, 0.2 times in women (Thomas, Corcos
& Hasan 1998). Forwards and upwards 0.3 m is within what arm, spine and a lean over the ankles give,
so hips and knees add little; downwards they have to bend, and do.
"""


@dataclass(frozen=True)
class Reach:
    """What is asked for. sides: hands. away: (3,) m forward, left, up."""

    name: str
    sides: tuple[Side, ...]
    away: tuple[float, float, float]
    flying: bool


@dataclass(frozen=True)
class ReachResult:
    """What a reach does to the joints, degrees by name. solved: whether it was; seconds: taken."""

    jump: str
    reach: str
    human: bool
    solved: bool
    seconds: float
    joints: Mapping[str, float]


RIGHT, BOTH = (Side.RIGHT,), (Side.LEFT, Side.RIGHT)
REACHES = tuple(
    Reach(f"{words}{where}", sides, away, flying)
    for flying, where in ((False, ", standing"), (True, ", at the top"))
    for words, sides, away in (
        ("right hand forward", RIGHT, (FAR, 0.0, 0.0)),
        ("right hand up", RIGHT, (0.0, 0.0, FAR)),
        ("both hands forward", BOTH, (FAR, 0.0, 0.0)),
        ("right hand down", RIGHT, (0.0, 0.0, -FAR)),
    )
    if away[2] >= 0.0 or not flying  # at the top there is nothing below
)


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py reach", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    options = report_options(parser, argv)
    jumps = [jump for jump in (*broad_jumps(), *hops()) if jump.name in JUMPS]
    results = [result for jump in jumps for result in measured(jump)]
    content = json.dumps([vars(each) for each in results], indent=1)
    (options.out / "reach.json").write_text(content + "\n", encoding="utf-8")
    table = "\n".join(rows(results))
    print(table)
    head = HEAD.format(count=len(jumps), names=", ".join(jump.name for jump in jumps))
    (ROOT / "docs" / "reach.md").write_text(f"{head}\n{table}\n", encoding="utf-8")
    return 0 if all(each.solved for each in results) else 1


def measured(jump: Jump) -> Iterator[ReachResult]:
    """Every reach in one jump, of a figure that is no human and of a person."""
    subject = measure(jump.recording(), jump.problem)
    fitted = fit_subject(subject, StageClock())
    for reach in REACHES:
        for human in (False, True):
            clock = StageClock()
            problem = asked(reach, jump, subject, fitted, human=human)
            result = adapt_fit(subject.asked(problem), fitted, clock)
            joints = turned(result.adaptation, reach.sides)
            seconds, solved = clock.done[-1].seconds, result.adaptation.solved
            yield ReachResult(jump.name, reach.name, human, solved, seconds, joints)


def asked(reach: Reach, jump: Jump, subject: Subject, fitted: Fit, *, human: bool) -> MotionProblem:
    """The problem of a reach."""
    flight = longest_flight(subject.schedule)
    time = 0.5 * (flight.start + flight.end) if reach.flying else STANDING
    middle = jump.frames[0] + round(time * RATE)
    when = When(frames=(middle - AROUND, middle + AROUND))
    bodies = fitted.motion.transcription.character.bodies
    hands = tuple(
        PointRequest(
            f"{b.side.value} hand", b.bone, when, relative=reach.away, axes=PointAxes.TRAVEL
        )
        for b in bodies
        if b.part is Part.HAND and b.side in reach.sides
    )
    ranges = HumanRanges.SOFT if human else HumanRanges.OFF
    requests = Requests(points=hands, solution=SolverOptions(human=ranges))
    return replace(subject.problem, requests=requests)


def turned(adaptation: Adaptation, sides: Sequence[Side]) -> dict[str, float]:
    """Degrees by joint."""
    motion = adaptation.motion
    turns = joint_turns(adaptation, np.linspace(0.0, motion.duration, SAMPLES)).max(axis=0)
    bodies = motion.transcription.character.bodies

    def of(parts: tuple[Part, ...], some: Sequence[Side]) -> float:
        mine = [b.part in parts and b.side in some for b in bodies]
        return float(np.degrees(turns[mine].sum())) / len(some)

    return {
        **{name: of(parts, sides) for name, parts in ARM.items()},
        **{name: of(parts, (Side.MIDDLE,)) for name, parts in MIDDLE.items()},
        **{name: of(parts, BOTH) for name, parts in LEGS.items()},
    }


def rows(results: Sequence[ReachResult]) -> Iterator[str]:
    """The table, a reach by one measure a row."""
    yield f"| reach | change measured by | {' | '.join(JOINTS)} | spine / hip | seconds |"
    yield "|---" * (len(JOINTS) + 4) + "|"
    for reach in REACHES:
        for human in (False, True):
            mine = [r for r in results if r.reach == reach.name and r.human is human]
            means = {name: fmean(each.joints[name] for each in mine) for name in JOINTS}
            cells = " | ".join(f"{means[name]:.0f}" for name in JOINTS)
            how = "what it moves, and ranges" if human else "what it moves alone"
            share = means["spine"] / means["hip"]
            seconds = fmean(each.seconds for each in mine)
            yield f"| {reach.name} | {how} | {cells} | {share:.1f} | {seconds:.1f} |"
