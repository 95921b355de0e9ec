"""What is wrong with the recording at the frame that is shown: feet's points, and bones."""

from collections.abc import Iterator
from dataclasses import dataclass

from mathutils import Matrix, Vector

from ....bridge.repairs.stored import finding_of, findings, foot_faults, is_applied
from ....operators.words.doctor_text import amount_text, foot_fault_words
from ....solver.doctor.finding import FindingKind
from ...drawing.sketch import Colour
from ..context.layer import IDENTITY, Layer, Part, xyz
from ..context.view_context import ViewContext, holds
from ..geometry import palette, solids
from ..geometry.shapes import Label, Shape, rings

RADIUS = 0.025  # m, of a grown person's figure
WIDE = 2.0  # radii of the ring about a mark


@dataclass(frozen=True)
class Mark:
    """A place, world, and what is wrong there; no words where a worse one says it."""

    place: tuple[float, float, float]
    words: str
    colour: Colour


def layer(view: ViewContext) -> Layer:
    """In the world, where the armature is now."""
    marks = (*_feet(view), *_bones(view))
    return Layer(Part.FAULTS, (marks, view.units), lambda: _shapes(marks, view.units), IDENTITY)


def _shapes(marks: tuple[Mark, ...], units: float) -> Iterator[Shape | Label]:
    for mark in marks:
        yield solids.balls(mark.place, RADIUS * units, mark.colour)
        yield rings(mark.place, WIDE * RADIUS * units, mark.colour)
        if mark.words:
            yield Label(mark.words, mark.place, mark.colour)


def _feet(view: ViewContext) -> Iterator[Mark]:
    """Of each kind the worst alone has words: points of one foot are too near for more."""
    now = [f for f in foot_faults(view.settings) if holds((f.first, f.last), view.recorded_frame)]
    worst = {fault.kind: fault for fault in sorted(now, key=lambda fault: fault.amount)}
    for fault in now:
        matrix = _bone(view, fault.bone)
        if matrix is not None:
            turned = matrix.to_quaternion() @ Vector(fault.offset)
            place = matrix.translation + turned / view.metres
            words = foot_fault_words(fault) if worst[fault.kind] == fault else ""
            yield Mark(xyz(place), words, palette.FAULT)


def _bones(view: ViewContext) -> Iterator[Mark]:
    """Of findings at single frames, the bone that shows it most, where it is named."""
    for row in findings(view.settings):
        finding = finding_of(row)
        matrix = _bone(view, finding.part)
        now = any(holds(span, view.recorded_frame) for span in finding.frames)
        if matrix is None or not now or is_applied(view.settings, row):
            continue
        kind = finding.kind
        amount = f" {amount_text(finding)}" if kind is FindingKind.SPIKE else ""
        words = f"{kind.value.capitalize()}{amount}: {finding.part}"
        yield Mark(xyz(matrix.translation), words, palette.FAULT)


def _bone(view: ViewContext, name: str) -> Matrix | None:
    """A bone's matrix in the world; None where the armature lacks it."""
    pose = view.armature.pose
    bone = pose.bones.get(name) if pose is not None and name else None
    return None if bone is None else view.armature.matrix_world @ bone.matrix
