"""Landings as they were recorded: what the fit has to make up for when a foot's force begins."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ....solver.arrays import FloatArray
from ....solver.body.anatomy import Part, Side
from ....solver.data.constants import UP
from ....solver.data.contacts import Contact
from ....solver.fitting.fit import Fit
from ....solver.numerics.interpolation import interpolate
from ....solver.transcription.contact_pins import PointContact

LEG = (Part.THIGH, Part.SHANK, Part.FOOT)
SIDES = (Side.LEFT, Side.RIGHT)
SPEED_STEP = 0.005  # s, to both sides


@dataclass(frozen=True)
class RecordedLanding:
    """A foot's first point as recorded when its contact begins.

    height: m above the place where it then stands. speed: m/s, downwards. short: m, by which the
    straight leg does not reach that place from the recorded hip; negative where it does.
    """

    height: float
    speed: float
    short: float


def recorded_landings(fit: Fit) -> tuple[RecordedLanding, ...]:
    """Of all feet that land within the clip."""
    return tuple(_landings(fit))


def _landings(fit: Fit) -> Iterator[RecordedLanding]:
    for contact, place in zip(fit.motion.transcription.contacts, fit.places, strict=True):
        side = next((s for s in SIDES if contact.contact.point.startswith(s.value.title())), None)
        on_foot = contact.contact.point.endswith(("heel", "toe"))
        if side is not None and on_foot and _lands(contact.contact, fit.schedule.contacts):
            yield _landing(fit, contact, place, side)


def _lands(contact: Contact, contacts: Sequence[Contact]) -> bool:
    """Whether the foot's other end does not stand yet."""
    foot = contact.point.split()[0]
    stands = any(c.point.startswith(foot) and c.start < contact.start <= c.end for c in contacts)
    return contact.start > 0.0 and not stands


def _landing(fit: Fit, contact: PointContact, place: FloatArray, side: Side) -> RecordedLanding:
    performance, start = fit.performance, contact.contact.start
    legs = [performance.character.body(part, side) for part in LEG]
    bodies = [body for body in legs if body is not None]
    around = start + SPEED_STEP * np.array([-1.0, 0.0, 1.0])
    point = fit.motion.transcription.points[contact.point]
    before, at, after = performance.points((point,), around)[:, 0]
    centres = performance.centres[:, bodies]
    hip, knee, ankle = interpolate(performance.times, centres, np.array([start]))[0]
    leg = float(np.linalg.norm(hip - knee) + np.linalg.norm(knee - ankle))
    held = place + contact.contact.rise[0] * UP
    needed = float(np.linalg.norm(held + ankle - at - hip))
    speed = float((before - after)[2] / (2.0 * SPEED_STEP))
    return RecordedLanding(float(at[2] - place[2]), speed, needed - leg)
