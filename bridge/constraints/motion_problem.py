"""The armature's stored settings as a MotionProblem, and an analysis as its settings.

The solver's metres and seconds become Blender's units and scene frames here, and back.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite, isnan
from typing import Any

import numpy as np

from ...solver.analysis.motion_sketch import MotionSketch
from ...solver.contacts.events import numbered
from ...solver.data.contacts import Contact, ContactSchedule, Interval, Phase, PhaseKind
from ...solver.data.faults import EmptyRange, NoNumber, PlacedNowhere, UnreadableRepairs
from ...solver.data.problem import AddedContact, ContactEdit, MassTable, MotionProblem, Pin
from ...solver.data.recording import Recording, Skin
from ...solver.data.requests import Clear, Path, Requests
from ...solver.data.scene import CLEARANCE, SceneObject
from ...solver.data.solver_options import HumanRanges, ShapeSource
from ...solver.doctor.repairs import Repairs
from ...solver.worker.protocol import Analysed
from ..accessors import current_scene
from ..armature.poses import frames_per_second, metres_per_unit
from ..properties.settings import HangtimeSettings
from ..properties.stances import active_contact, move_empties, place, remember, stance_contacts
from ..repairs.analysis_key import analysis_key, span_of
from ..repairs.stored import applied, of_recording, unreadable
from ..repairs.unreadable import require_readable
from ..rows.copying import rows_named
from ..rows.held_contacts import UNMOVED, Displacement, HeldContact, found_again, frame_of, movers
from ..rows.phases import listed, phases_of, unseen_frames
from ..rows.protocols import ContactRow
from ..scene.members import ground_members, present_members
from ..takes.options import loop_options, text_of
from .bone_mapping import chosen_parts
from .requests import joined, requests_of

_METRES_PER_MM = 1e-3
_UNTURNED = 1e-4  # rad


def problem_of(
    settings: HangtimeSettings,
    recording: Recording,
    scene: tuple[SceneObject, ...] = (),
    *,
    skin: Skin | None = None,
    with_contacts: bool = True,
    held: str = "",
    paths: Mapping[str, Path] | None = None,
) -> MotionProblem:
    """What the settings ask of a recording.

    scene, skin: the surfaces, and what the armature deforms, as they were read (bridge/scene).
    with_contacts: whether corrections, pins and surfaces count; an analysis starts without them.
    held: name of a contact that is pinned even where it was found, for of a long take what is
    solved is what pins are about, and a drag's shall be that before the mouse has moved.
    paths: as of `requests_of`.
    Raises NoNumber, PlacedNowhere, EmptyRange for a contact that ends before it begins,
    UnreadableRepairs, UnreadableText, BadRecipe, and as `requests_of`.
    """
    armature: Any = settings.id_data
    _require_numbers(settings)
    if with_contacts:
        _require_in_order(settings)
        require_readable(armature)
    span = span_of(settings, recording)
    repairs = applied(settings) if of_recording(armature) else Repairs()
    if of_recording(armature) and unreadable(settings):
        raise UnreadableRepairs
    return MotionProblem(
        frames=span,
        mass=settings.mass,
        height=settings.height if settings.use_height else None,
        mass_table=MassTable[settings.mass_table],
        bones=chosen_parts(settings),
        contacts=_edits(settings) if with_contacts else (),
        added=_added(settings) if with_contacts else (),
        pins=_pins(settings, span, held) if with_contacts else (),
        scene=scene if with_contacts else (),
        requests=_requests(settings, span, scene, paths) if with_contacts else Requests(),
        loop=loop_options(settings) is not None,
        skin=skin,
        good_enough=_METRES_PER_MM * round(settings.good_enough, 4),
        mend=repairs.mend,
        drift=repairs.drift,
        rise=repairs.rise,
    )


def _requests(
    settings: HangtimeSettings,
    span: tuple[float, float],
    scene: tuple[SceneObject, ...],
    paths: Mapping[str, Path] | None,
) -> Requests:
    """What the lists ask for, and what the armature's text does, which is a recipe's.

    span: first and last scene frame. scene, paths: as of `problem_of`. Raises BadRecipe, NamedTwice
    and as `requests_of`.
    """
    armature: Any = settings.id_data
    text = text_of(settings)
    beside = text.problem.requests if text is not None else None
    listed = requests_of(settings, armature, span, beside=beside, paths=paths)
    listed = replace(listed, clears=_clears(settings, scene))
    if beside is not None:
        listed = joined(listed, beside)
    solution = replace(
        listed.solution,
        keep_times=listed.solution.keep_times or settings.keep_times,
        solid=listed.solution.solid and settings.keep_out,
        shapes=_shapes(listed.solution.shapes, settings),
        human=_human(listed.solution.human, settings),
        wider=max(listed.solution.wider, settings.wider_ranges),
    )
    return replace(listed, solution=solution)


def _shapes(asked: ShapeSource, settings: HangtimeSettings) -> ShapeSource:
    """From the bones where the settings or a recipe's text say so."""
    return asked if ShapeSource[settings.shapes] is ShapeSource.MESH else ShapeSource.BONES


def _human(asked: HumanRanges, settings: HangtimeSettings) -> HumanRanges:
    """What the settings and a recipe's text say: off where either does, else hard likewise."""
    if not (asked and settings.human_ranges):
        return HumanRanges.OFF
    return HumanRanges.HARD if settings.hard_ranges else asked


def _clears(settings: HangtimeSettings, scene: tuple[SceneObject, ...]) -> tuple[Clear, ...]:
    """Of the hurdles among the surfaces."""
    metres, there = metres_per_unit(current_scene()), {thing.name for thing in scene}
    return tuple(
        Clear(CLEARANCE.format(member.name), member.name, metres * member.clearance)
        for member in present_members(settings, current_scene())
        if member.clearance is not None and member.name in there
    )


def _require_numbers(settings: HangtimeSettings) -> None:
    """NaN, which no range of a property keeps out, has the solver give up without a reason."""
    counting = {
        "mass": True,
        "height": settings.use_height,
        "new_mass": settings.use_new_mass,
        "gravity": True,
    }
    for name, counts in counting.items():
        if counts and isnan(getattr(settings, name)):
            raise NoNumber(settings.bl_rna.properties[name].name)


def _require_in_order(settings: HangtimeSettings) -> None:
    """Without a word the solver would leave such a contact out, or where it was recorded."""
    for row in settings.contacts:
        if row.used and not all(map(isfinite, (*row.at, row.start_frame, row.end_frame))):
            raise PlacedNowhere(row.name)
        if row.used and row.end_frame < row.start_frame:
            raise EmptyRange(row.name, row.start_frame, row.end_frame)


def _edits(settings: HangtimeSettings) -> tuple[ContactEdit, ...]:
    edits = []
    for row in settings.contacts:
        if row.added:
            continue
        start = row.start_frame if row.start_frame != row.found_start else None
        end = row.end_frame if row.end_frame != row.found_end else None
        if not row.used:
            edits.append(ContactEdit(row.name, remove=True))
        elif start is not None or end is not None:
            edits.append(ContactEdit(row.name, start, end))
    return tuple(edits)


def _added(settings: HangtimeSettings) -> tuple[AddedContact, ...]:
    return tuple(
        AddedContact(row.point, row.start_frame, row.end_frame)
        for row in settings.contacts
        if row.added and row.used
    )


def _pins(settings: HangtimeSettings, span: tuple[float, float], held: str) -> tuple[Pin, ...]:
    """A pin for each contact that has been moved, stands on a surface, or is held.

    Each states its stance's turn, too: places do not tell a half turn left from one right, nor a
    whole turn from none. Corrections renumber contacts and phases, so pins name both as they are
    called afterwards.
    """
    metres = metres_per_unit(current_scene())
    rate = frames_per_second(current_scene())
    duration = (span[1] - span[0]) / rate
    ground = ground_members(settings, current_scene())
    used = [row for row in settings.contacts if row.used]
    bare = [_bare_contact(row, span[0], rate, duration) for row in used]
    unseen = tuple(
        Interval(*((frame - span[0]) / rate for frame in ends)) for ends in unseen_frames(settings)
    )
    schedule = ContactSchedule(numbered(bare), duration, 0.0, unseen)
    called = {(c.point, c.start): c.name for c in schedule.contacts}
    turns = {stance.name: stance.turned for stance in settings.stances}
    spun = {name for name, turn in turns.items() if _spun(settings, name, turn)}
    pins = []
    for row, contact in zip(used, bare, strict=True):
        phase = _ground_phase(schedule, contact)
        on = next((each.name for each in ground if each.object == row.on), None)
        if phase is None or not (moved(row) or on or row.name == held or row.phase in spun):
            continue
        x, y, z = (metres * value for value in row.at)
        name, turn = called[contact.point, contact.start], turns.get(row.phase, 0.0)
        pins.append(Pin(row.name, phase.name, (name,), place=(x, y, z), turn=turn, on=on))
    return tuple(pins)


def _spun(settings: HangtimeSettings, phase: str, turn: float) -> bool:
    """Whether a stance is turned, rad, and all of it is where it was recorded, as after a whole
    turn, or as a single contact is after any."""
    return abs(turn) > _UNTURNED and not any(map(moved, stance_contacts(settings, phase)))


def moved(row: ContactRow) -> bool:
    """Whether a contact is to be elsewhere than recorded."""
    return any(abs(a - b) > UNMOVED for a, b in zip(row.at, row.found_at, strict=True))


def _bare_contact(row: ContactRow, first: float, rate: float, duration: float) -> Contact:
    """When a row's point touches, after the artist's correction; nowhere in particular."""
    start = max((row.start_frame - first) / rate, 0.0)
    end = min((row.end_frame - first) / rate, duration)
    return Contact(row.name, row.point, row.bone, np.zeros(3), start, end, np.zeros(3))


def _ground_phase(schedule: ContactSchedule, contact: Contact) -> Phase | None:
    ground = (p for p in schedule.phases if p.kind is PhaseKind.GROUND)
    return next((p for p in ground if p.start < contact.end and p.end > contact.start), None)


def write_analysis(
    settings: HangtimeSettings, recording: Recording, found: Analysed
) -> tuple[str, ...]:
    """Fills the settings' contacts and stances; contacts that are found again keep their edits.
    Names of those that were edited and are not found any more."""
    edits = [HeldContact.of(row) for row in listed(settings) if not row.added]
    added = [HeldContact.of(row) for row in listed(settings) if row.added]
    turns = {each.name: each.turned for each in settings.stances if isfinite(each.turned)}
    metres = metres_per_unit(current_scene())
    first, rate = span_of(settings, recording)[0], frames_per_second(current_scene())
    settings.measured_height = found.height
    settings.analysed, settings.analysed_rate = analysis_key(settings, recording), rate
    settings.analysed_motion = MotionSketch.of(recording).text
    settings.analysed_span = span_of(settings, recording)
    unseen = [[first + u.start * rate, first + u.end * rate] for u in found.schedule.unseen]
    settings.unseen = json.dumps(unseen) if unseen else ""
    stances = rows_named(settings.stances, list(found.axes))
    for stance, axes in zip(stances, found.axes.values(), strict=True):
        stance.shifted, stance.turned, stance.forward_axis = (0.0, 0.0, 0.0), 0.0, axes[:, 0]
        stance.backwards = stance.name in found.backwards
    contacts = found.schedule.contacts
    names = [contact.name for contact in contacts] + [held.name for held in added]
    settings.analysed_contacts = "\n".join((*names, *settings.analysed.splitlines()))
    rows = rows_named(settings.contacts, names)
    for row in rows:
        row.used, row.added, row.surplus, row.empty, row.on = True, False, False, None, None
    for row, contact in zip(rows, contacts, strict=False):
        phase = _ground_phase(found.schedule, contact)
        row.point, row.bone = contact.point, contact.bone
        row.phase = phase.name if phase is not None else ""
        row.found_start = row.start_frame = first + contact.start * rate
        row.found_end = row.end_frame = first + contact.end * rate
        row.found_at = row.at = contact.place / metres
    for row, kept in zip(rows[len(contacts) :], added, strict=True):
        _put(row, kept)
    lost = _restore(settings, edits, turns, found.schedule, first)
    settings.active_contact = min(settings.active_contact, len(settings.contacts) - 1)
    if not edits or active_contact(settings) is None:
        _choose_first_landing(settings)
    return lost


def _choose_first_landing(settings: HangtimeSettings) -> None:
    """What artists mostly move; the first stance where nothing flies."""
    flown = False
    contacts = listed(settings)
    landing = contacts[0].phase if contacts else ""
    for phase in phases_of(settings):
        if flown and phase.is_ground:
            landing = phase.name
            break
        flown = flown or not phase.is_ground
    rows = enumerate(settings.contacts)
    of_landing = (i for i, row in rows if row.phase == landing and not row.surplus)
    settings.active_contact = next(of_landing, 0)


def _put(row: ContactRow, held: HeldContact) -> None:
    for name, value in vars(held).items():
        setattr(row, name, value)


def _restore(
    settings: HangtimeSettings,
    edits: Sequence[HeldContact],
    turns: Mapping[str, float],
    schedule: ContactSchedule,
    first: float,
) -> tuple[str, ...]:
    """Gives contacts their edits, and takes added ones along; names of those that were edited and
    are not found any more. turns: of the stances that were, rad."""
    rows = [row for row in settings.contacts if not row.added]
    metre = 1.0 / metres_per_unit(current_scene())
    again = found_again(rows, edits, metre)
    for i, edit in again.contacts.items():
        row = rows[i]
        row.used = edit.used
        row.start_frame = frame_of(row.found_start, edit.found_start, edit.start_frame)
        row.end_frame = frame_of(row.found_end, edit.found_end, edit.end_frame)
    going = movers(rows, again.contacts)
    for i, edit in going.items():
        move = again.displacement.direction(edit.move)
        place(settings, rows[i], (np.asarray(rows[i].found_at) + move).tolist(), whole=False)
    for i, edit in going.items():  # a contact that is raised leaves what it was on
        rows[i].on = edit.on
    for i, edit in again.contacts.items():
        rows[i].empty = edit.empty
        if rows[i].phase in settings.stances:  # whole turns, of which places tell nothing
            settings.stances[rows[i].phase].turned = turns.get(edit.phase, 0.0)
    for stance in settings.stances:
        remember(settings, stance.name)
    move_empties(settings)
    if not again.displacement.slight(metre):
        _take_along(settings, again.displacement, schedule, first)
    kept = set(map(id, again.contacts.values()))
    return tuple(edit.name for edit in edits if edit.changed and id(edit) not in kept)


def _take_along(
    settings: HangtimeSettings, by: Displacement, schedule: ContactSchedule, first: float
) -> None:
    """Contacts that the artist added, with a take that is elsewhere or later."""
    rate = frames_per_second(current_scene())
    for row in listed(settings):
        if row.added:
            _put(row, by.contact(HeldContact.of(row)))
            phase = _ground_phase(schedule, _bare_contact(row, first, rate, schedule.duration))
            row.phase = phase.name if phase is not None else row.phase
