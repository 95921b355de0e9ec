"""Files of a headless job: .blend, FBX, picture, trajectory and report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...bridge.recipe.export import ExportOptions
from ...bridge.recipe.keys import KeyOptions
from ...bridge.recipe.loop import LoopOptions
from ...bridge.recipe.result import ResultOptions, require_return_after, require_return_within
from ...bridge.rows.choices import FileFormat, KeyChoice, LoopRoot, WrittenAs
from ...solver.data.faults import OutputNotWritable
from ...solver.data.reports.keys import KeysReport
from ...solver.data.reports.report import Report
from ...solver.data.scaling import scaled_problem
from ...solver.scene.object_motion import ObjectMotion
from ...solver.worker.pipeline import AdaptationResult
from ..files.outbox import Outbox
from ..terminal.quiet import quiet
from ..terminal.stages import Stages
from .clip import LoadedClip
from .result_files import (
    BEST,
    EXPORTED,
    FILM,
    PICTURE,
    SAVED,
    exported,
    write_report,
    write_trajectory,
)

if TYPE_CHECKING:  # as in clip.py
    import bpy

    from ...bridge.controls.control_rig import ControlRig
    from ...bridge.loops.write_loop import WrittenLoop
    from ...bridge.picture.sheet import SheetRow
    from ...bridge.properties.of_actions.known_contacts import SolvedContacts
    from ...bridge.takes.plan import AdaptedMotion
    from ...bridge.takes.span import WrittenTake
    from ...solver.data.contacts import ContactSchedule
    from ...solver.data.reports.keys import MissedContact

ASIDE = 1.5  # m; how far the recording stands beside the adapted figure


def linked_files() -> tuple[Path, ...]:
    """What the scene in Blender is made from beside its own file: libraries, images."""
    import bpy

    return tuple(map(Path, bpy.utils.blend_paths(absolute=True)))


def require_exported(clip: LoadedClip, folder: Path, export: ExportOptions) -> None:
    """Before a solve takes its seconds. Raises OutputNotWritable, SameUsdNames."""
    from ...bridge.exports.export import require_exportable

    require_exportable(clip.armature, exported(folder, export), export)


def require_place(clip: LoadedClip, wanted: ResultOptions, loop: LoopOptions | None) -> None:
    """Before a solve takes its seconds. Raises NoNewSlot, NoRootBone, ReturnTooEarly,
    ReturnTooLate, UnknownPhase."""
    from ...bridge.armature.read import last_keyed
    from ...bridge.loops.write_loop import root_bone
    from ...bridge.takes.write_result import require_slot

    if loop is not None and loop.root is LoopRoot.ROOT_BONE:
        root_bone(clip.armature, clip.subject.analysis.performance.character.bodies[0].bone)
    apart = loop is not None or clip.subject.problem.requests.body.limbs
    if apart:  # those are actions of their own
        return
    require_return_after(wanted, float(clip.subject.edited().recording.frames[-1]))
    require_return_within(wanted, last_keyed(clip.armature))
    if wanted.written_as is WrittenAs.SLOT:
        require_slot(clip.armature)


@dataclass(frozen=True)
class _Written:
    """An action and who performs it. schedule: its contacts, in the performer's axes. take: what
    was done to it where it is the whole one; or how near controls come to a loop."""

    performer: bpy.types.Object
    action: bpy.types.Action
    schedule: ContactSchedule
    take: WrittenTake | WrittenLoop | None


@dataclass(frozen=True)
class Outputs:
    """Writes the files of one result; every method raises OutputNotWritable.

    options: of the rest of the take. keys: of the adapted frames. loop: where the motion repeats.
    export: of the file for others.
    """

    clip: LoadedClip
    options: ResultOptions
    keys: KeyOptions
    result: AdaptationResult
    outbox: Outbox
    stages: Stages
    loop: LoopOptions | None = None
    export: ExportOptions = field(default_factory=ExportOptions)

    def write(
        self,
        *,
        picture: bool = True,
        film: bool = False,
        blend: bool = True,
        trajectory: bool = True,
        forms: Sequence[FileFormat | None] = (None,),
    ) -> Report:
        """The files of a result that is what was asked for, and its report.

        forms: of the files for others; None is what the options say.
        """
        from ...bridge.accessors import current_action, present
        from ...bridge.armature.played import adopt_strip
        from ...bridge.takes.span import WrittenTake

        with self.stages.stage("Writing keyframes"):
            recorded = present(current_action(self.clip.armature))
            adopt_strip(self.clip.armature, recorded)
            made = self._write_actions("adapted")
            performer, adapted, written = made.performer, made.action, made.take
            missed = self._missed(made)
            rig = written.rig if isinstance(written, WrittenTake) else None
            keys = self._choose_keys(performer, adapted, recorded, rig)
            self._mark_contacts(performer, adapted)
            if self.loop is None:  # which is an action of its own
                self._lay(performer, recorded, adapted)
            self._build_scene()
            if blend:
                _save_blend(self.outbox.path(SAVED))
        for form in forms:
            self._export(performer, adapted, form)
        self._draw(picture=picture, film=film)
        with self.stages.stage("Measuring"):
            if trajectory:
                write_trajectory(self.result, self.outbox)
            report = replace(self._report(written), keys=keys, missed_contacts=missed)
        self._write_report(report, written)
        return report

    def _export(
        self,
        performer: bpy.types.Object,
        adapted: bpy.types.Action,
        asked: FileFormat | None,
    ) -> None:
        from ...bridge.exports.engines import ENDINGS, format_of
        from ...bridge.exports.export import export_takes

        export = self.export if asked is None else replace(self.export, format=asked)
        form, pelvis = format_of(export), self.result.track.bones[0]
        with self.stages.stage(f"Exporting {form.name}"), quiet():
            path = self.outbox.path(f"{EXPORTED}{ENDINGS[form]}")
            export_takes(performer, [adapted], path, export, pelvis)

    def _draw(self, *, picture: bool, film: bool) -> None:
        from .picture import draw, draw_moving

        if not (picture or film):
            return
        adaptation, rows = self.result.adaptation, self._rows()
        if picture:
            with self.stages.stage("Drawing the picture"), quiet():
                draw(adaptation, rows, self.outbox.path(PICTURE))
        if film:
            with self.stages.stage("Drawing the film"), quiet():
                draw_moving(adaptation, rows, self.outbox.path(FILM))

    def _rows(self) -> tuple[SheetRow, SheetRow]:
        """Of the picture and the film."""
        from .annotate import marks_of, recorded_on
        from .picture import both_rows

        adaptation, problem = self.result.adaptation, self.result.subject.problem
        marks = recorded_on(adaptation, problem.scene), marks_of(adaptation, problem)
        return both_rows(adaptation, self.clip.problem, *marks)

    def write_failure(self) -> None:
        """The report, and the best motion that was found."""
        written = None
        if self.result.adaptation.reached > 0.0:
            written = self._write_actions("best found, short of the goal").take
            self._build_scene()
            _save_blend(self.outbox.path(BEST))
        self._write_report(self._report(written), written)

    def _report(self, written: WrittenTake | WrittenLoop | None) -> Report:
        """With the stages that have ended, and the blends that were written."""
        from ...bridge.takes.span import WrittenTake

        made = self.result.report(self.clip.origin, self.stages.done)
        if written is not None and written.controls is not None:
            made = replace(made, missed_bodies=written.controls.lost)
        if not isinstance(written, WrittenTake):
            return made
        return replace(made, blends=written.blends, slide_on_way_back_m=written.slide)

    def _missed(self, made: _Written) -> tuple[MissedContact, ...]:
        """Contacts that the keys which the performer shows have elsewhere than solved; none of a
        loop whose travel is left out."""
        from ...bridge.armature.incremental import complete
        from ...bridge.constraints.standing import missed_contacts

        if self.loop is not None and self.loop.root is LoopRoot.IN_PLACE:
            return ()
        return complete(missed_contacts(made.performer, made.schedule, self.result.traces()))

    def _write_report(self, report: Report, written: WrittenTake | WrittenLoop | None) -> None:
        from ..words.take_text import take_lines, take_record

        records: dict[str, object] = {} if written is None else {"take": take_record(written)}
        write_report(report, self.outbox, records, take_lines(written))

    def _write_actions(self, called: str) -> _Written:
        """The adapted action on the armature, or on one of its own where limbs were changed; the
        recording's on a copy beside it."""
        from mathutils import Vector

        from ...bridge.accessors import current_action, present
        from ...bridge.armature.fcurves import slot_identifier
        from ...bridge.armature.incremental import complete
        from ...bridge.armature.write import side_by_side, write_action
        from ...bridge.files.reproportioned import build_reproportioned, in_new_axes
        from ...bridge.loops.write_loop import Loop, write_loop
        from ...bridge.properties.of_actions.known_contacts import keep_contacts
        from ...bridge.takes.take_time import TakeTime
        from ...bridge.takes.write_result import write_result

        recorded = present(current_action(self.clip.armature))
        armature, track = self.clip.armature, self.result.track
        schedule = self.result.schedule
        name = f"{recorded.name} {called}"
        written: WrittenTake | WrittenLoop | None = None
        if self.result.subject.problem.requests.body.limbs:
            armature, track, turns = build_reproportioned(self.result.recording, track)
            schedule = in_new_axes(schedule, turns)
            adapted = write_action(armature, track, name=name)
            self.clip.armature.location += Vector(self._beside())  # it performs the recording
        elif self.loop is not None:
            loop = Loop.of(armature, track, self.loop.root)
            slot = slot_identifier(armature)
            adapted, written = complete(write_loop(armature, loop, recorded, slot, name=name))
            keep_contacts(adapted, self._solved_contacts())
            side_by_side(armature, recorded, adapted, offset=self._beside())
        else:
            motion = self._motion()
            adapted, take = write_result(armature, motion, name=name)
            time = TakeTime.of(motion.times, 1.0) if take is None else take.time
            known = self.result.subject.recording.known
            keep_contacts(adapted, self._solved_contacts(), known, time.later)
            written = take
            side_by_side(armature, recorded, adapted, offset=self._beside())
        first, last = adapted.frame_range.to_tuple()
        _show_frames(round(first), round(last), alone=not self.clip.in_scene)
        return _Written(armature, adapted, schedule, written)

    def _solved_contacts(self) -> SolvedContacts:
        from ...bridge.properties.of_actions.known_contacts import SolvedContacts

        made = self.result
        scene, rate = made.subject.problem.scene, made.recording.rate
        return SolvedContacts(made.schedule, made.track.frames, rate, scene)

    def _mark_contacts(self, performer: bpy.types.Object, adapted: bpy.types.Action) -> None:
        """By markers and channels, as is asked for."""
        from ...bridge.armature import fcurves
        from ...bridge.keys.contact_marks import (
            limb_contacts,
            write_contact_channels,
            write_markers,
        )

        frames, rate = self.result.track.frames, self.result.recording.rate
        found = limb_contacts(self.result.schedule, float(frames[0]), rate)
        between = round(frames[0]), round(frames[-1])
        write_markers(adapted, found, between, self.options.markers)
        curves = fcurves.holder_in(adapted, fcurves.slot_identifier(performer))
        if self.options.contact_channels and curves is not None:
            write_contact_channels(performer, curves, found, between)

    def _lay(
        self, performer: bpy.types.Object, take: bpy.types.Action, adapted: bpy.types.Action
    ) -> None:
        """Result and take as strips, or slots, where that is asked for and one armature performs
        both."""
        written_as = self.options.written_as
        if written_as is WrittenAs.ACTION or performer != self.clip.armature:
            return
        from ...bridge.armature.fcurves import slot_identifier
        from ...bridge.armature.played import in_scene_time
        from ...bridge.armature.strips import lay_strips
        from ...bridge.takes.difference import difference_of
        from ...bridge.takes.write_result import lay_in_slot

        if written_as is WrittenAs.SLOT:
            lay_in_slot(performer, take, adapted)
            return
        slot, combined = slot_identifier(performer), written_as is WrittenAs.COMBINE
        with in_scene_time(performer, take) as played:
            more = difference_of(performer, played, adapted, slot) if combined else None
        lay_strips(performer, take, adapted, slot, more)

    def _motion(self) -> AdaptedMotion:
        """The motion, to be put into the take."""
        from ...bridge.accessors import current_action, present
        from ...bridge.results.made import adapted_spans
        from ...bridge.takes.plan import AdaptedMotion

        return AdaptedMotion(
            self.result.track,
            self.result.times,
            self.result.moved,
            self.options,
            ends=any(hold.ends for hold in self.clip.problem.requests.holds),
            kept=adapted_spans(present(current_action(self.clip.armature))),
            touching=self.result.schedule.bones,
        )

    def _choose_keys(
        self,
        performer: bpy.types.Object,
        adapted: bpy.types.Action,
        recorded: bpy.types.Action,
        rig: ControlRig | None,
    ) -> KeysReport | None:
        """Give the action the keys that are asked for; None where every frame has one. rig: the
        controls that pose the performer, if such do."""
        if self.keys.on is KeyChoice.EVERY_FRAME:
            return None
        from ...bridge.armature import fcurves
        from ...bridge.armature.incremental import complete
        from ...bridge.armature.played import in_scene_time
        from ...bridge.keys.events import events_of
        from ...bridge.keys.written import KeyedAction, choose_keys

        track, rate = self.result.track, self.result.recording.rate
        slot = fcurves.slot_identifier(performer)
        events = events_of(self.result.schedule, float(track.frames[0]), rate)
        with in_scene_time(self.clip.armature, recorded) as played:
            take = fcurves.holder_in(played, fcurves.slot_identifier(self.clip.armature))
            keyed = KeyedAction(adapted, slot, track.bones, track.frames, take, rig)
            return complete(choose_keys(performer, keyed, self.keys, events))

    def _build_scene(self) -> None:
        from ...bridge.files.scene_objects import build_scene

        subject, line = self.result.subject, self.result.adaptation.setup.context.timeline
        scene = scaled_problem(subject.problem, 1.0 / subject.factor).scene
        frames = self.result.track.frames
        moving = (ObjectMotion.of(thing, line.first_frame, line.rate) for thing in scene)
        build_scene(
            tuple(each.keyed_at(frames) if each.thing.steady else each.thing for each in moving)
        )

    def _beside(self) -> tuple[float, float, float]:
        """To the left of where the recording travels, m, world."""
        com = self.result.subject.analysis.performance.com
        x, y = (com[-1] - com[0])[:2].tolist()
        far = float(np.hypot(x, y))
        return (-ASIDE * y / far, ASIDE * x / far, 0.0) if far > 0.05 else (ASIDE, 0.0, 0.0)


def _show_frames(first: int, last: int, *, alone: bool) -> None:
    """Play these frames, and what the scene played before, if they are not all that is in it."""
    from ...bridge.accessors import current_scene

    scene = current_scene()
    start, end = (first, last) if alone else (scene.frame_start, scene.frame_end)
    scene.frame_start, scene.frame_end = min(first, start), max(last, end)
    scene.frame_set(first)


def _save_blend(path: Path) -> None:
    import bpy

    try:
        with quiet():
            bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True)
    except RuntimeError as error:
        raise OutputNotWritable(str(path), "Blender could not save it") from error
