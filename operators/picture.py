"""The sheet's rows: the recording above, the adapted motion below."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from ..bridge.sheet import Limb, SheetRow, draw_sheet
from ..solver.adapt import Adaptation
from ..solver.character import Body
from ..solver.contacts import PhaseKind
from ..solver.problem import Axes3, MotionProblem, Pin
from ..solver.recording import FloatArray


def draw(adaptation: Adaptation, problem: MotionProblem, path: Path) -> None:
    """Renders both motions into a PNG file. Raises OutputNotWritable."""
    performance, motion = adaptation.fit.performance, adaptation.motion
    bodies, times = performance.character.bodies, performance.times
    posed, com = motion.pose(times), motion.com(times)
    edit = "; ".join(map(caption, problem.pins)) or "made to obey physics"
    contacts, keys = adaptation.fit.schedule.contacts, key_times(adaptation)
    spans = tuple((c.start, c.end) for c in contacts)
    recorded = SheetRow(
        f"Recording: {performance.recording.name}",
        times,
        tuple(limbs(bodies, performance.rotations, performance.centres)),
        performance.com,
        np.array([c.place for c in contacts]).reshape(-1, 3),
        keys,
        spans,
    )
    adapted = SheetRow(
        f"Adapted: {edit}",
        times,
        tuple(limbs(bodies, posed.rotations, posed.centres + com[:, None])),
        com,
        adaptation.places,
        keys,
        spans,
    )
    draw_sheet([recorded, adapted], path)


def limbs(bodies: Iterable[Body], rotations: FloatArray, centres: FloatArray) -> Iterable[Limb]:
    """Every body's box at (T, B) rotations and joint centres, m, world."""
    for i, body in enumerate(bodies):
        turn = rotations[:, i]
        middle = centres[:, i] + turn @ body.box_centre
        yield Limb(body.name, body.box_size, middle, turn @ body.box_rotation)


def key_times(adaptation: Adaptation) -> tuple[float, ...]:
    """Take-off, apex and landing of every flight, s."""
    keys: list[float] = []
    for phase in adaptation.fit.schedule.phases:
        if phase.kind is PhaseKind.FLIGHT:
            during = np.linspace(phase.start, phase.end, 100)
            apex = during[adaptation.motion.com(during)[:, 2].argmax()]
            keys += [phase.start, float(apex), phase.end]
    return tuple(keys)


def caption(pin: Pin) -> str:
    """Such as "Landing: 0.3 m forward, 0.2 m up, turned by 90°"."""
    words = []
    if pin.place is not None:
        words.append(f"to ({', '.join(f'{x:g}' for x in pin.place)}) m")
    if pin.axes is Axes3.WORLD and any(pin.offset):
        words.append(f"by ({', '.join(f'{x:g}' for x in pin.offset)}) m")
    elif pin.axes is Axes3.TRAVEL:
        ways = (("forward", "back"), ("left", "right"), ("up", "down"))
        for amount, (ahead, behind) in zip(pin.offset, ways, strict=True):
            if amount:
                words.append(f"{abs(amount):g} m {ahead if amount > 0.0 else behind}")
    if pin.turn:
        words.append(f"turned by {np.degrees(pin.turn):.4g}°")
    return f"{pin.name}: {', '.join(words) or 'held'}"
