"""What moving ground did to a motion's stances, for the report."""

from collections.abc import Iterator

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import Phase, PhaseKind
from ..data.problem import MotionProblem
from ..data.reports.constraints import MovingGroundReport
from ..stages.implicit import Adaptation
from ..stages.platforms import first_footing
from ..transcription.ride import Ride
from .violations import pins_of_contacts

LEAST_MOVE = 1e-6  # m
LEAST_SPEED = 0.01  # m/s, of ground that a take-off can keep


def moving_ground(adaptation: Adaptation, problem: MotionProblem) -> Iterator[MovingGroundReport]:
    """Every stance that rides on an object that moves, or is carried on from one, in order."""
    setup = adaptation.setup
    if not setup.target.moves:
        return
    pins = pins_of_contacts(adaptation.fit, problem)
    still = first_footing(adaptation.fit, problem, setup.context).places
    contacts = setup.schedule.contacts
    for phase in setup.schedule.phases:
        mine = [i for i, c in enumerate(contacts) if c.start < phase.end and c.end > phase.start]
        if phase.kind is not PhaseKind.GROUND or not mine:
            continue
        moved = (setup.target.places - still)[mine].mean(axis=0)
        x, y, z = moved.tolist()
        found = ((i, setup.target.rides[i]) for i in mine)
        riding = [(i, ride) for i, ride in found if ride not in (None, setup.fitted.rides[i])]
        if riding:
            last, ride = max(riding, key=lambda each: contacts[each[0]].end)
            place, name = setup.target.places[last], ride.ground.thing.name
            yield MovingGroundReport(
                phase=phase.name,
                object=name,
                pin=pins.get(contacts[last].name),
                moved_m=(x, y, z),
                ground_speed_m_s=_speeds(ride, place, phase),
                kept_speed_share=_kept(adaptation, ride, place, phase),
            )
        elif np.linalg.norm(moved) > LEAST_MOVE:
            yield MovingGroundReport(phase.name, None, None, (x, y, z), (0.0, 0.0), None)


def _speeds(ride: Ride, place: FloatArray, phase: Phase) -> tuple[float, float]:
    """m/s of the ground under a contact at its stance's start and end."""
    ends = np.array([phase.start, phase.end])
    first, last = np.linalg.norm(ride.rates(ends).of(place), axis=1).tolist()
    return first, last


def _kept(adaptation: Adaptation, ride: Ride, place: FloatArray, phase: Phase) -> float | None:
    """Share of the ground's velocity with which the body leaves it on top of the fit's own."""
    motion, at = adaptation.motion, np.array([phase.end])
    velocity = ride.rates(at).of(place)[0]
    if phase.end > motion.duration - 1e-6 or np.linalg.norm(velocity) < LEAST_SPEED:
        return None
    pose = ride.poses(at).turn[0]
    was = adaptation.fit.motion.com(adaptation.setup.context.reference_times(at), 1)[0]
    gained = motion.com(at, 1)[0] - pose @ was
    return float(gained @ velocity / (velocity @ velocity))
