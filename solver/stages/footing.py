"""Where a problem's contacts stand: places by its pins, and faces with their normals."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..analysis.pins.landing import Footing
from ..analysis.pins.pinned_places import chosen_contacts, phase_of, pinned_footing
from ..analysis.pins.pushed_faces import pushed_normals
from ..arrays import FloatArray
from ..data.constants import UP
from ..data.contacts import ContactSchedule
from ..data.faults import StandsBelow, StandsIn, TooSteep
from ..data.problem import MotionProblem, Pin
from ..data.scene import SceneObject
from ..fitting.fit import Fit
from ..scene.boxes import still_near
from ..scene.steep import is_side
from ..scene.triangle_mesh import SHEET, TriangleMesh, placed_mesh
from ..transcription.contact_pins import PointContact

SUNK = 0.04  # m; as far as a place may be from the floor that it is put upon (grounding.py)


def find_footing(
    fit: Fit,
    problem: MotionProblem,
    schedule: ContactSchedule,
    standing: Mapping[Pin, SceneObject] | None = None,
) -> Footing:
    """Where the problem's pins put the contacts of its schedule, and the faces that they are on or
    push against there.

    standing: of pins on objects that move, the object as it is when they land. Raises UnknownPhase,
    UnknownContact, ContradictoryPins, and as `land` does.
    """
    found = pinned_footing(problem, fit.performance, fit.schedule, standing)
    row = {contact.name: i for i, contact in enumerate(fit.schedule.contacts)}
    places = np.array([c.place for c in schedule.contacts]).reshape(-1, 3)
    for i, contact in enumerate(schedule.contacts):
        if contact.name in row:
            places[i] = found.places[row[contact.name]]
    character = fit.performance.character
    normals = pushed_normals(problem, schedule.contacts, places, character, schedule.floor_m)
    for i, contact in enumerate(schedule.contacts):
        if contact.name in found.pins:
            normals[i] = found.normals[row[contact.name]]
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
        out = np.minimum(_way_out_beside(mesh, places), _way_out_beside(mesh, places + SUNK * UP))
        beside = np.isfinite(out)
        inside &= out > SUNK
        if (inside & ~beside).all():
            raise StandsBelow(thing.name, float(deep.max()))
        for i in np.flatnonzero(inside)[:1].tolist():
            metres = out[i] if beside[i] else deep[i]
            name = schedule.contacts[loose[i]].name
            raise StandsIn(thing.name, name, float(metres), beside=bool(beside[i]))


def _way_out_beside(mesh: TriangleMesh, places: FloatArray) -> FloatArray:
    """(n,) m from places (n, 3) in a mesh out of it, where the nearest way is through a face at its
    side; infinite elsewhere."""
    out = mesh.distances(places)
    beside = (out.distance < 0.0) & is_side(out.normal)
    return np.where(beside, -out.distance, np.inf)


def on_faces(contacts: Sequence[PointContact], footing: Footing) -> tuple[PointContact, ...]:
    """Contacts whose friction goes with the faces that they stand on or push against; the very same
    where these are level.

    Raises TooSteep.
    """
    faced = zip(contacts, footing.normals, strict=True)
    return tuple(
        contact if normal[2] >= 1.0 else _on_face(contact, normal, footing)
        for contact, normal in faced
    )


def _on_face(contact: PointContact, normal: FloatArray, footing: Footing) -> PointContact:
    """Who stands needs friction for it, who pushes off from a wall may glide along it."""
    pin = footing.pins.get(contact.contact.name)
    if pin is not None and contact.friction is not None:
        steep = float(np.hypot(*normal[:2]) / normal[2])
        if steep >= contact.friction:
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
