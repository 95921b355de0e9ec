"""What is solid in a problem: the body, the floor, and the objects of the scene as they move."""

from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray
from ..constraints.evaluation_context import EvaluationContext
from ..data.requests import Clear
from ..data.scene import SceneObject
from ..fitting.fit import Fit
from ..scene.object_motion import ObjectMotion
from ..solid.shape_changes import ShapeChanges
from ..solid.solid_world import SolidWorld, TimeFunction, floor_heights, solid_world


def surroundings(
    fit: Fit,
    context: EvaluationContext,
    target_places: FloatArray,
    scene: Sequence[SceneObject],
    clears: Sequence[Clear],
    changes: ShapeChanges,
) -> SolidWorld:
    """The solid world of a problem. target_places: (n_contacts, 3) m. Raises StillBone."""
    line = context.timeline
    floors = floor_of(fit, context, target_places), floor_heights(fit.schedule, fit.places)
    placed = [(thing, ObjectMotion.of(thing, line.first_frame, line.rate)) for thing in scene]
    by = _by_object(clears, context)
    known = frozenset(contact.on for contact in fit.schedule.contacts if contact.on is not None)
    return solid_world(
        fit.motion, context.reference, floors, line.to_old, placed, by, changes, known
    )


def floor_of(fit: Fit, context: EvaluationContext, target_places: FloatArray) -> TimeFunction:
    """The floor's height under a problem's motion, m, at instants (N,) s.

    Contacts that are lifted still tell how low it was recorded: without them it would rise by
    millimetres into the foot that stays. target_places: (n_contacts, 3) m.
    """
    own = floor_heights(context.schedule, target_places)
    placed = {
        contact.name: place
        for contact, place in zip(context.schedule.contacts, target_places, strict=True)
    }
    recorded = fit.schedule.contacts
    places = [placed.get(c.name, was) for c, was in zip(recorded, fit.places, strict=True)]
    before, line = floor_heights(fit.schedule, np.reshape(places, (-1, 3))), context.timeline
    return lambda times: np.minimum(own(times), before(line.to_old(times)))


def _by_object(clears: Sequence[Clear], context: EvaluationContext) -> dict[str, dict[int, float]]:
    """Clearances, m, by object and body; of several the largest."""
    found: dict[str, dict[int, float]] = {}
    for clear in clears:
        bodies = [context.body(clear.name, bone) for bone in clear.bones]
        mine = found.setdefault(clear.thing, {})
        for body in bodies or range(len(context.character.bodies)):
            mine[body] = max(clear.by, mine.get(body, 0.0))
    return found
