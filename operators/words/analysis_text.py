"""Text of an analysis, for a person who is about to write a recipe."""

import json
import os
from collections.abc import Sequence
from pathlib import Path

from ...bridge.recipe.object_texts import object_text, offered_texts
from ...bridge.recipe.recording import FILE, RECORDING, FileReading
from ...bridge.recipe_syntax.toml_text import sections
from ...solver.analysis.analyse import Analysis
from ...solver.analysis.pins.pinned_places import backward_stances
from ...solver.contacts.footfalls import footfalls, takes_steps
from ...solver.data.contacts import Contact, Phase, PhaseKind
from ...solver.data.problem import MotionProblem
from ...solver.data.reports.recording import Origin
from ...solver.doctor.repairs import Repairs
from ...solver.unseen.offered import OfferedSupport
from .messages import sentence, together
from .report_text import guesses, held_at_rest

LEAST_WIDTH = 16  # letters of a column


def analysis_text(analysis: Analysis, origin: Origin) -> str:
    """Figure, phases and contacts; frames are the scene's."""
    recording, figure = analysis.performance.recording, analysis.performance.character
    lines = [
        f"{origin.clip}: frames {recording.frames[0]:g} to {recording.frames[-1]:g}, "
        f"{recording.times[-1]:.2f} s at {recording.rate:.4g} frames a second",
        f"figure: {figure.height:.2f} m tall, {figure.mass:g} kg, {len(figure.bodies)} bodies, "
        f"{figure.n_dofs} degrees of freedom; floor at {analysis.schedule.floor_m:.3f} m",
    ]
    lines += [f"guessed: {guess}" for guess in guesses(origin)]
    if origin.bind_frames:
        lines.append(f"left out: {held_at_rest(origin.bind_frames)} (else say --first)")
    lines += ["", f"{'phase':<12}{'frames':>17}{'seconds':>9}"]
    lines += [_phase_line(analysis, phase) for phase in analysis.schedule.phases]
    lines += _unseen(analysis)
    lines += ["", *_contact_lines(analysis)]
    return "\n".join(lines) + "\n"


def _unseen(analysis: Analysis) -> list[str]:
    """Where something unseen carries the body, and a box, hands or what they hold, that would."""
    told = [sentence(each) for each in together(analysis.unseen)]
    return ["", *told, *offered_texts(OfferedSupport.of(analysis.unseen))] if told else []


def _contact_lines(analysis: Analysis) -> list[str]:
    """A table of the contacts; its columns are as wide as the longest name in them."""
    contacts = analysis.schedule.contacts
    name, bone = (
        max((len(each) + 1 for each in names), default=0)
        for names in ([c.name for c in contacts], [c.bone for c in contacts])
    )
    name, bone = max(name, LEAST_WIDTH), max(bone, LEAST_WIDTH)
    lines = [f"{'contact':<{name}}{'frames':>17}  {'bone':<{bone}}place (m)"]
    for contact in contacts:
        span = _span(analysis, contact.start, contact.end)
        place = ", ".join(f"{x:.3f}" for x in contact.place)
        on = f" on {contact.on}" if contact.on is not None else ""
        lines.append(f"{contact.name:<{name}}{span:>17}  {contact.bone:<{bone}}{place}{on}")
    return lines


def _phase_line(analysis: Analysis, phase: Phase) -> str:
    line = f"{phase.name:<12}{_span(analysis, phase.start, phase.end):>17}"
    line += f"{phase.end - phase.start:>9.2f}"
    if phase.kind is PhaseKind.FLIGHT:
        return f"{line}  apex {_apex(analysis, phase):.2f} m (centre of mass)"
    return line


def _apex(analysis: Analysis, phase: Phase) -> float:
    performance = analysis.performance
    inside = (performance.times >= phase.start) & (performance.times <= phase.end)
    return float(performance.com[inside, 2].max()) if inside.any() else float("nan")


def _span(analysis: Analysis, start: float, end: float) -> str:
    """The scene's frames from start to end, s."""
    recording = analysis.performance.recording
    first, rate = float(recording.frames[0]), recording.rate
    return f"{first + start * rate:.1f} to {first + end * rate:.1f}"


def starter_recipe(
    analysis: Analysis,
    problem: MotionProblem,
    clip: Path,
    recipe: Path,
    file: FileReading | None = None,
    repairs: Repairs | None = None,
) -> str:
    """A commented recipe that pins the first landing (of a motion without a flight what there is)
    where it is, for the artist to change. file: what was stated of how the clip is read. repairs:
    that it got."""
    recording = analysis.performance.recording
    landing = _first_landing(analysis)
    contacts = () if landing is None else analysis.schedule.of_phase(landing)
    backwards = backward_stances(analysis.performance, analysis.schedule)
    jumps = bool(analysis.schedule.flights)
    what = "jump" if jumps else "motion"
    phases, found = (
        [f"#   {each.name}: {_span(analysis, each.start, each.end)}" for each in several]
        for several in (analysis.schedule.phases, analysis.schedule.contacts)
    )
    return "\n".join(
        [
            f"# What to change in a recorded {what}. Metres, degrees, the scene's frames.",
            f"clip = {_quoted(relative(clip, recipe))}",
            f"frames = [{recording.frames[0] + 0.0:g}, {recording.frames[-1]:g}]",
            f"mass = {problem.mass:g}  # kg",
            _height(analysis, problem),
            f"mass_table = {_quoted(problem.mass_table.value)}",
            *_bones(problem),
            "",
            *sections(FILE.header, FILE.write(file or FileReading())),
            *sections(RECORDING.header, RECORDING.write(repairs or Repairs())),
            "# Phases found, with their frames:",
            *phases,
            "",
            *_pin(landing, contacts, backwards, jumps=jumps),
            *_steps(analysis, contacts),
            "# Contacts found, with their frames; correct one by its name:",
            *found,
            "# [[contact]]",
            f"# name = {_quoted(contacts[0].name if contacts else 'Left heel 1')}",
            "# start_frame = 0  # or end_frame, or remove = true",
            "",
            *(object_text(thing) for thing in problem.scene),
        ]
    )


def _height(analysis: Analysis, problem: MotionProblem) -> str:
    if problem.height is not None:
        return f"height = {problem.height:g}  # m"
    measured = analysis.performance.character.height
    return f"# height = {measured:.2f}  # m, as measured; another one scales the figure"


def _pin(
    landing: Phase | None, contacts: Sequence[Contact], backwards: Sequence[str], *, jumps: bool
) -> list[str]:
    """backwards: the ground phases whose forward is at the body's back. jumps: whether it flies."""
    if landing is None:
        return ["# Nothing touches here, so there is nothing to pin.", ""]
    name, way = ("Landing", "the jump") if jumps else ("Stance", "its way")
    there = ", which is at the body's back" if landing.name in backwards else ""
    points = ", ".join(dict.fromkeys(_quoted(c.point) for c in contacts))
    step = [f"# step = {_quoted(contacts[0].name)}  # only this foot and time, see below"]
    return [
        "[[pin]]",
        f"name = {_quoted(name)}",
        f"phase = {_quoted(landing.name)}",
        f"# points = [{points}]  # only these; else all that touches",
        *(step if takes_steps([c.touch for c in contacts]) else []),
        f"forward = 0.0  # along {way}{there}; negative is back",
        "left = 0.0",
        "up = 0.0",
        "turn = 0  # counter-clockwise from above",
        "",
    ]


def _steps(analysis: Analysis, contacts: Sequence[Contact]) -> list[str]:
    """The footfalls of a phase in which feet come down again; a pin moves each by itself."""
    touches = [c.touch for c in contacts]
    if not takes_steps(touches):
        return []
    told = ["# Its steps, with their frames; name any contact of one as the pin's “step”:"]
    for mine in footfalls(touches):
        step = [contacts[i] for i in mine]
        span = _span(analysis, min(c.start for c in step), max(c.end for c in step))
        told.append(f"#   {', '.join(c.name for c in step)}: {span}")
    return [*told, ""]


def _bones(problem: MotionProblem) -> list[str]:
    if not problem.bones:
        return []
    chosen = [f"{_quoted(part)} = {_quoted(bone)}" for part, bone in problem.bones.items()]
    return ["", "[bones]", *chosen]


def _first_landing(analysis: Analysis) -> Phase | None:
    """The first stance after a flight, or the first of all; None where nothing touches."""
    phases, ground = analysis.schedule.phases, analysis.schedule.stances
    flown = next((p.end for p in phases if p.kind is PhaseKind.FLIGHT), 0.0)
    return next((p for p in ground if p.start >= flown - 1e-9), ground[0] if ground else None)


def relative(clip: Path, recipe: Path) -> str:
    """A clip's path as the recipe beside which it lies tells it."""
    try:
        return Path(os.path.relpath(clip.resolve(), recipe.resolve().parent)).as_posix()
    except ValueError:  # on another drive
        return clip.resolve().as_posix()


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
