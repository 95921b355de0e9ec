"""Where a problem's contacts stand: places by its pins, and faces with their normals."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..analysis.pins.landing import Footing
from ..analysis.pins.pinned_places import chosen_contacts, phase_of, pinned_footing
from ..arrays import FloatArray
from ..data.constants import UP
from ..data.contacts import ContactSchedule
from ..data.faults import StandsBelow, StandsIn, TooSteep
from ..data.problem import MotionProblem, Pin
from ..data.scene import SceneObject
from ..fitting.fit import Fit
from ..scene.boxes import still_near
from ..scene.steep import is_steep
from ..scene.triangle_mesh import SHEET, placed_mesh
from ..transcription.contact_pins import PointContact
from ..transcription.motion import Motion

SUNK = 0.04  # m; as far as a place may be from the floor that it is put upon (grounding.py)


def find_footing(
    fit: Fit,
    problem: MotionProblem,
    schedule: ContactSchedule,
    standing: Mapping[Pin, SceneObject] | None = None,
) -> Footing:
    """Where the problem's pins put the contacts of its schedule.

    standing: of pins on objects that move, the object as it is when they land. Raises UnknownPhase,
    UnknownContact, ContradictoryPins, and as `land` does.
    """
    found = pinned_footing(problem, fit.performance, fit.schedule, standing)
    row = {contact.name: i for i, contact in enumerate(fit.schedule.contacts)}
    places = np.array([c.place for c in schedule.contacts]).reshape(-1, 3)
    normals = np.tile(UP, (len(places), 1))
    for i, contact in enumerate(schedule.contacts):
        if contact.name in row:
            places[i], normals[i] = (
                each[row[contact.name]] for each in (found.places, found.normals)
            )
    return Footing(places, normals, found.pins)


def check_sunk(scene: Sequence[SceneObject], schedule: ContactSchedule, footing: Footing) -> None:
    """No contact that is not on an object is in one that stands still: nothing could keep it out.
    What is at a side face is in it no deeper than the way out there.

    Raises StandsIn, StandsBelow.
    """
    loose = [
        i
        for i, contact in enumerate(schedule.contacts)
        if contact.name not in footing.pins and not contact.asked_for
    ]
    if not loose:
        return
    places = footing.places[loose]
    for thing in still_near(scene, places + SUNK * UP, SHEET):
        mesh = placed_mesh(thing)
        deep = mesh.heights(places[:, :2]).z - places[:, 2]
        inside = (mesh.distances(places + SUNK * UP).distance < 0.0) & (deep > SUNK)
        out = mesh.distances(places)
        beside = (out.distance < 0.0) & is_steep(out.normal)
        inside &= ~(beside & (out.distance > -SUNK))
        if (inside & ~beside).all():
            raise StandsBelow(thing.name, float(deep.max()))
        for i in np.flatnonzero(inside)[:1].tolist():
            metres = -out.distance[i] if beside[i] else deep[i]
            name = schedule.contacts[loose[i]].name
            raise StandsIn(thing.name, name, float(metres), beside=bool(beside[i]))


def on_faces(motion: Motion, footing: Footing) -> Motion:
    """The motion with contacts whose friction goes with the faces that they stand on.

    Raises TooSteep.
    """
    sloping = footing.normals[:, 2] < 1.0
    if not sloping.any():
        return motion
    t = motion.transcription
    contacts = tuple(
        _on_face(contact, normal, footing.pins[contact.contact.name]) if slopes else contact
        for contact, normal, slopes in zip(t.contacts, footing.normals, sloping, strict=True)
    )
    return replace(motion, transcription=replace(t, contacts=contacts))


def _on_face(contact: PointContact, normal: FloatArray, pin: Pin) -> PointContact:
    steep = float(np.hypot(*normal[:2]) / normal[2])
    if contact.friction is not None and steep >= contact.friction:
        angle = float(np.degrees(np.arctan(steep)))
        raise TooSteep(pin.name, contact.contact.name, pin.on or "", angle, contact.friction)
    return replace(contact, normal=normal)


def pin_turns(pins: Sequence[Pin], schedule: ContactSchedule) -> dict[str, float]:
    """Turns of the contacts that pins move, by their names; rad. schedule: the fit's."""
    turns: dict[str, float] = {}
    for pin in pins:
        for i in chosen_contacts(pin, phase_of(pin, schedule), schedule):
            name = schedule.contacts[i].name
            turns[name] = turns.get(name, 0.0) + pin.turn
    return turns
