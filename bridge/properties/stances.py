"""Moving contacts' places, one by one, a foot or a whole stance at once, and what a stance's move
is.

Lengths in Blender units, angles in rad, world.
A place has one truth, `row.at`; empties and the stances' offsets are kept to it. Of an empty that
moves in time it is where this is as the stance begins, which is looked at before a solve
(scene/moving_empties.py). A stance's middle
and move are those of its contacts that were found: one that the artist adds, or takes away again,
changes neither.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import atan2, isfinite, remainder, tau

import bpy
from mathutils import Matrix, Vector

from ...solver.contacts.footfalls import footfalls, stood_on_first, takes_steps
from ...solver.data.contacts import Touch
from ..accessors import attached
from ..movable import may_move
from ..rows.choices import Moves
from ..rows.phases import SAME, clip_ends
from ..rows.protocols import ContactRow, Settings, StanceRow

_SAME = 1e-6  # Blender units
_DIGITS = 6  # of a turn
_SAME_TURN = 1e-4  # rad
_RIGID = 1e-3  # m; contacts that are so far from their stance's move were moved with it


def place(
    settings: Settings, row: ContactRow, to: Sequence[float], *, whole: bool | None = None
) -> None:
    """Puts a contact somewhere; what goes with it makes the same move.

    whole: its whole stance goes, or it alone; None is as the settings have it (`moves`).
    """
    shift = Vector(to) - Vector(row.at)
    for contact in moving_with(settings, row, whole=whole):
        _put(contact, Vector(contact.at) + shift)
    remember(settings, row.phase)


def moving_with(
    settings: Settings, row: ContactRow, *, whole: bool | None = None
) -> list[ContactRow]:
    """The contacts that go where a contact goes. whole: as of `place`."""
    moves = Moves[settings.moves]
    if whole is not None:
        moves = Moves.STANCE if whole else Moves.CONTACT
    stance = stance_contacts(settings, row.phase)
    if moves is Moves.AUTO:
        moves = Moves.FOOT if _steps(settings, stance, row) else Moves.STANCE
    match moves:
        case Moves.CONTACT:
            return [row]
        case Moves.FOOT:
            return _footfall(stance, row)
    return stance


def _footfall(stance: Sequence[ContactRow], row: ContactRow) -> list[ContactRow]:
    """Of a stance's contacts that count those of the step that a contact is part of."""
    counted = [each for each in stance if each.used or each == row]
    steps = footfalls([_touch(each) for each in counted])
    mine = next(step for step in steps if counted.index(row) in step)
    return [counted[i] for i in mine]


def _steps(settings: Settings, stance: Sequence[ContactRow], row: ContactRow) -> bool:
    """Whether a contact is of a step: feet come down again within its stance, and it is not what
    the body lands on from a flight, or leaves from into one."""
    counted = [each for each in stance if each.used or each == row]
    touches = [_touch(each) for each in counted]
    ends = clip_ends(settings)
    if ends is None or not takes_steps(touches):
        return False
    borders: set[int] = set()
    if min(touch.start for touch in touches) > ends[0] + SAME:
        borders |= stood_on_first(touches)
    if max(touch.end for touch in touches) < ends[1] - SAME:
        borders |= stood_on_first([Touch(t.point, -t.end, -t.start) for t in touches])
    return counted.index(row) not in borders


def _touch(row: ContactRow) -> Touch:
    return Touch(row.point, row.start_frame, row.end_frame)


def get_moves(settings: Settings) -> int:
    """Place of `moves` among the choices. Files of earlier versions have `whole_stance` alone."""
    usual = Moves.AUTO if settings.whole_stance else Moves.CONTACT
    return list(Moves).index(Moves.__members__.get(settings.moving, usual))


def set_moves(settings: Settings, index: int) -> None:
    """Chooses what goes with a contact."""
    chosen = list(Moves)[index]
    settings.whole_stance = chosen in (Moves.AUTO, Moves.STANCE)
    settings.moving = chosen.name


def take_whole_stance(settings: Settings, _context: bpy.types.Context) -> None:
    """What scripts of earlier versions say is as they meant it."""
    settings.moving = (Moves.STANCE if settings.whole_stance else Moves.CONTACT).name


def stand_on(
    settings: Settings,
    row: ContactRow,
    ground: bpy.types.Object | None,
    *,
    whole: bool | None = None,
) -> None:
    """Lets a contact, and what goes with it, stand on an object. whole: as of `place`."""
    for contact in moving_with(settings, row, whole=whole):
        contact.on = ground


def shift_stance(settings: Settings, stance: StanceRow, to: Sequence[float]) -> None:
    """Moves a stance so that it stands (forward, left, up) of where it was recorded."""
    shift = _axes(stance) @ (Vector(to) - Vector(stance.shifted))
    for contact in stance_contacts(settings, stance.name):
        _put(contact, Vector(contact.at) + shift)
    stance.shifted = to


def turn_stance(settings: Settings, stance: StanceRow, to: float) -> None:
    """Turns a stance about the vertical through its middle, to `to` from as recorded."""
    contacts = stance_contacts(settings, stance.name)
    if not contacts:
        return
    middle = _middle([contact.at for contact in telling(contacts)])
    turn = Matrix.Rotation(to - stance.turned, 3, "Z")
    for contact in contacts:
        _put(contact, middle + turn @ (Vector(contact.at) - middle))
    stance.turned = to


def put_back(settings: Settings, stance: StanceRow) -> None:
    """Puts a stance's contacts where they were recorded."""
    for contact in stance_contacts(settings, stance.name):
        _put(contact, Vector(contact.found_at))
        contact.on = None
    stance.shifted = (0.0, 0.0, 0.0)
    stance.turned = 0.0


def stance_contacts(settings: Settings, phase: str) -> list[ContactRow]:
    """The contacts of a ground phase by its name."""
    return [row for row in settings.contacts if row.phase == phase]


def telling(contacts: Sequence[ContactRow]) -> list[ContactRow]:
    """Those of a stance that tell its middle and its move: what was found; of a stance that the
    artist made all."""
    return [row for row in contacts if not row.added] or list(contacts)


def join(settings: Settings, row: ContactRow, metre: float) -> None:
    """Takes a contact that is added where it was recorded to where its stance stands, and on what
    the nearest one of that does: with the whole stance's move, else, where contacts were moved one
    by one, with the nearest one's of its own step, where that has others. metre: in Blender
    units."""
    others = [each for each in stance_contacts(settings, row.phase) if each != row]
    found = telling(others)
    stance = settings.stances.get(row.phase)
    if stance is None or not found:
        return
    recorded = Vector(row.found_at)
    own = [each for each in _footfall([*found, row], row) if each != row]
    nearest = min(own or found, key=lambda each: (Vector(each.found_at) - recorded).length)
    old, new = (_middle([getattr(each, at) for each in found]) for at in ("found_at", "at"))
    turn = Matrix.Rotation(stance.turned, 3, "Z")
    apart = (new + turn @ (Vector(each.found_at) - old) - Vector(each.at) for each in found)
    if all(each.length < _RIGID * metre for each in apart):
        _put(row, new + turn @ (recorded - old))
    else:
        _put(row, recorded + Vector(nearest.at) - Vector(nearest.found_at))
    row.on = nearest.on


def stance_middle(settings: Settings, phase: str) -> Vector | None:
    """Where a stance stands, and about what it turns; None where no contact belongs to it."""
    contacts = telling(stance_contacts(settings, phase))
    return _middle([contact.at for contact in contacts]) if contacts else None


def active_stance_index(settings: Settings) -> int:
    """The place in the list of the stance that the chosen contact belongs to; -1 where none is."""
    row = active_contact(settings)
    phases = [stance.name for stance in settings.stances]
    return phases.index(row.phase) if row is not None and row.phase in phases else -1


def choose_stance(settings: Settings, index: int) -> None:
    """Choose a stance in the list, which is to choose the first of its contacts."""
    if not 0 <= index < len(settings.stances):
        return
    phases = [row.phase for row in settings.contacts]
    name = settings.stances[index].name
    if name in phases and active_stance_index(settings) != index:
        settings.active_contact = phases.index(name)


def stance_frames(settings: Settings, phase: str) -> tuple[float, float] | None:
    """From which frame to which contacts of a stance that count touch; None where none does."""
    used = [row for row in stance_contacts(settings, phase) if row.used]
    if not used:
        return None
    return min(row.start_frame for row in used), max(row.end_frame for row in used)


def active_contact(settings: Settings) -> ContactRow | None:
    """The contact chosen in the list, which shows no surplus ones."""
    index = settings.active_contact
    row = settings.contacts[index] if 0 <= index < len(settings.contacts) else None
    return None if row is None or row.surplus else row


def active_stance(settings: Settings) -> StanceRow | None:
    """The stance of the contact chosen in the list."""
    row = active_contact(settings)
    return settings.stances.get(row.phase) if row is not None else None


def follow(empty: bpy.types.Object) -> None:
    """Takes over where an empty that marks a contact has been moved to. One that moves in time is
    elsewhere at each frame that is shown, and tells nothing by that."""
    armature = getattr(attached(empty), "marks", None)
    if armature is None or may_move(empty):
        return
    settings: Settings = attached(armature)
    for row in settings.contacts:
        to = empty.matrix_world.translation
        if row.empty == empty and (to - Vector(row.at)).length > _SAME:
            place(settings, row, to.to_tuple())


def follow_moving(settings: Settings, places: Mapping[str, Sequence[float]]) -> None:
    """Takes over where empties that move are as their contacts' stances begin. What goes with
    several of them goes along with the first.

    places: by the contact's name.
    """
    led = set[str]()
    for row in [each for each in settings.contacts if each.name in places]:
        was, to = Vector(row.at), Vector(places[row.name])
        if row.on is not None:
            to.z = was.z  # the height is the surface's
        if (to - was).length <= _SAME:
            to = was
        row.at = to
        for contact in moving_with(settings, row):
            if contact.name not in {*places, *led}:
                led.add(contact.name)
                _put(contact, Vector(contact.at) + to - was)
        remember(settings, row.phase)


def may_mark(empty: bpy.types.Object, armature: bpy.types.Object) -> bool:
    """Whether an empty marks an armature's contact; of a copied one it marks the original's."""
    return getattr(attached(empty), "marks", None) in (None, armature)


def move_empties(settings: Settings) -> None:
    """Puts the empties that mark contacts to where the contacts are, but for those that move."""
    for row in settings.contacts:
        if row.empty is not None and not may_move(row.empty):
            _shift_empty(row, Vector(row.at) - row.empty.matrix_world.translation)


def _put(row: ContactRow, to: Vector) -> None:
    if abs(to.z - row.at[2]) > _SAME:
        row.on = None  # a height that somebody states is not a surface's
    was, row.at = Vector(row.at), to
    if row.empty is not None:
        began = was if may_move(row.empty) else row.empty.matrix_world.translation
        _shift_empty(row, to - began)


def _shift_empty(row: ContactRow, by: Vector) -> None:
    empty = row.empty
    if empty is None or not may_mark(empty, row.id_data) or by.length <= _SAME:
        return
    world = empty.matrix_world.copy()
    world.translation += by
    empty.matrix_world = world


def remember(settings: Settings, phase: str) -> None:
    """Keeps a stance's shift and turn to what its contacts' places say; whole turns, of which they
    say nothing, as long as they say the same turn as before, and any where a single one counts."""
    stance = settings.stances.get(phase)
    contacts = telling(stance_contacts(settings, phase))
    if stance is None or not contacts:
        return
    old, new = (_middle([getattr(c, at) for c in contacts]) for at in ("found_at", "at"))
    if not all(map(isfinite, new[:])):  # which a solve tells, and Put Back mends
        return
    stance.shifted = _axes(stance).transposed() @ (new - old)
    counted = [contact for contact in contacts if contact.used]
    if len(counted) > 1:
        turn = _turn_of(counted)
        if abs(remainder(stance.turned - turn, tau)) > _SAME_TURN:
            stance.turned = turn


def _turn_of(contacts: Sequence[ContactRow]) -> float:
    """Rad, about the vertical, that is nearest to how contacts were moved."""
    old, new = (_middle([getattr(c, at) for c in contacts]) for at in ("found_at", "at"))
    arms = [(Vector(c.found_at) - old, Vector(c.at) - new) for c in contacts]
    across = sum(a.x * b.y - a.y * b.x for a, b in arms)
    along = sum(a.x * b.x + a.y * b.y for a, b in arms)
    return round(atan2(across, along), _DIGITS)  # places are in single precision


def _middle(points: Sequence[Sequence[float]]) -> Vector:
    return sum((Vector(p) for p in points), Vector()) / len(points)


def told_along(stance: StanceRow, shift: Sequence[float]) -> tuple[float, float, float]:
    """How far forward, left and up a shift in the world goes."""
    told = _axes(stance).transposed() @ Vector(shift)
    return told.x, told.y, told.z


def _axes(stance: StanceRow) -> Matrix:
    """Columns forward, left and up, world."""
    forward, up = Vector(stance.forward_axis), Vector((0.0, 0.0, 1.0))
    left = Vector(up.cross(forward))  # type: ignore[arg-type]  # of 3D vectors it is one
    return Matrix((forward[:], left[:], up[:])).transposed()
