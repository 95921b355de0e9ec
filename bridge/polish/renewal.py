"""A result made anew, with the hand polish of the one before it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import bpy

from ...solver.arrays import FloatArray
from ...solver.data.contacts import ContactSchedule
from ..armature import fcurves
from ..armature.incremental import Incremental
from ..properties.action import action_settings
from ..properties.settings import settings_of
from ..repairs.analysis_key import wanted_range
from ..results.look_again import polished_result
from ..rows.choices import BodyKind
from ..takes.options import loop_options
from ..takes.take_time import TakeTime
from .hand_offsets import Polish, polish_of, without
from .pins import MovedPin, PinnedFrames, contact_pins, point_pins
from .put_on import PlacedPolish, placed, put_on
from .samples import CurveSamples, Written, edited_action, keep_written, sampled, written_of


@dataclass
class Renewal:
    """Takes over the polish of an armature's last result, if there is any that is to be kept.

    polish: as the last result has it, and that one as it was made; None where nothing is kept.
    put: once it is on the new result.
    """

    armature: bpy.types.Object
    polish: tuple[Polish, Written] | None
    put: PlacedPolish | None = None

    @staticmethod
    def of(armature: bpy.types.Object) -> Renewal:
        """Before the new result is written."""
        result = polished_result(armature)
        written = written_of(result) if result is not None and is_kept(armature, result) else None
        if result is None or written is None:
            return Renewal(armature, None)
        return Renewal(armature, (polish_of(armature, result, written), written))

    def put_on(
        self,
        action: bpy.types.Action,
        owned: Collection[str],
        time: TakeTime,
        schedule: ContactSchedule,
        rate: float,
    ) -> Incremental[tuple[MovedPin, ...]]:
        """Put the polish on a new result, which the armature shows; tells which pins that moves.

        owned: paths of the curves that were written, whether bodies', controls' or of what goes
        along. time: where the take's frames are in it. schedule, rate (frames a s): its contacts,
        from its first adapted frame on.
        """
        if self.polish is None:
            return ()
        slot, (polish, before) = fcurves.slot_identifier(self.armature), self.polish
        place = placed(action, slot, polish, time)
        first = float(time.result[0])
        points = [*contact_pins(schedule, first, rate), *point_pins(self.armature, time)]
        pinned = PinnedFrames.of(points, place.frames)
        was = yield from pinned.poses(self.armature)
        put_on(action, slot, place, before, owned)
        self.put = place
        now = yield from pinned.poses(self.armature)
        return pinned.moved(was, now)

    def note(self, action: bpy.types.Action, time: TakeTime, adapted: tuple[float, float]) -> None:
        """Keep with a finished result what it is without polish. adapted: the take's frames."""
        edited = edited_action(action)
        samples = sampled(edited, fcurves.slot_identifier(self.armature))
        if self.put is not None:
            samples = without(self.put.polish, samples, self._at(samples, time))
            kept = action_settings(action)
            kept.holds_polish = kept.polished = bool(len(self.put.frames))
        keep_written(action, Written(samples, time, adapted))

    def _at(self, samples: CurveSamples, time: TakeTime) -> FloatArray:
        """Frames of the polished result that a new one's samples show."""
        assert self.put is not None
        return self.put.polish.time.to_result(time.to_recorded(samples.frames))


def is_kept(armature: bpy.types.Object, result: bpy.types.Action) -> bool:
    """Whether the next result takes over the polish of the last one: of the same frames, by a body
    as long, not in a loop, and where the artist has not chosen otherwise. Raises BadRecipe."""
    settings, written = settings_of(armature), written_of(result)
    if written is None or not settings.result.keep_polish or loop_options(settings) is not None:
        return False
    if any(row.used and row.kind == BodyKind.LIMB.name for row in settings.body_changes):
        return False
    first, last = wanted_range(settings)
    if first is None or last is None:
        return True
    return first < written.adapted[1] and last > written.adapted[0]
