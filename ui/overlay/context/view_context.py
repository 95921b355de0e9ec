"""Context of a redraw: everything that overlays and handles look at, read once."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ....bridge.accessors import armature_data, current_action, pose_of, present, snapshot
from ....bridge.armature.poses import frames_per_second, metres_per_unit
from ....bridge.armature.traces_store import StoredTraces, kept
from ....bridge.properties.action import action_settings
from ....bridge.properties.constraint import HangtimeConstraint
from ....bridge.properties.of_actions.shown_times import recorded_frame
from ....bridge.properties.settings import HangtimeSettings, scene_settings, settings_of
from ....bridge.properties.view import HangtimeView
from ....bridge.rows.choices import Span
from ....bridge.rows.times import Frames, Spans, interval_of, named_frames
from ....operators.lists.row_lists import chosen_bones
from ....operators.solve.common import chosen_armature
from ....operators.solve.live import live
from ....solver.data.traces import Traces
from ...drawing.editor import view_3d

USUAL = 1.7  # m, the height at which sizes are meant
NEAR = 0.5  # frames; what holds at one frame holds as long as that is shown


@dataclass(frozen=True)
class ShownMotion:
    """A motion. key: another for another motion; matrix: from its metres to the world now, frozen.

    stood: the armature's world matrix when it was traced.
    """

    traces: Traces
    key: object
    matrix: Matrix
    stood: Matrix


@dataclass(frozen=True)
class ViewContext:
    """The armature that a viewport shows, its settings and motions. known: the last state, if any,
    which stays the same object while it is equal: comparing it with itself takes no time."""

    armature: bpy.types.Object
    settings: HangtimeSettings
    options: HangtimeView
    frame: float
    metres: float  # of a Blender unit
    rate: float = 24.0  # frames a second
    known: object = None

    @cached_property
    def state(self) -> object:
        """Everything that overlay and handles depend on; equal while they would stay as they are.

        Reading it takes a fraction of what working them out anew does.
        """
        now = self._read_state()
        return self.known if now == self.known else now

    def _read_state(self) -> object:
        armature, recorded, adapted = self.armature, self.recorded, self.adapted
        targets = (row.target for row in self.settings.constraints if row.target is not None)
        return (
            (self.frame, self.metres, self.rate),
            (armature, armature.mode, armature.matrix_world.copy(), tuple(chosen_bones(armature))),
            (recorded and recorded.key, adapted and adapted.key, self.performs_adapted),
            [_told(action) for action in (current_action(armature), self.settings.adapted)],
            [target.matrix_world.copy() for target in targets],
            (pose_of(armature).bones.keys(), posed_bones(armature).tobytes(), _lengths(armature)),
            [snapshot(owner) for owner in (armature, present(self.options.id_data))],
        )

    @cached_property
    def recorded_frame(self) -> float:
        """The frame of the recording that `frame` shows, by which contacts are stated."""
        return recorded_frame(self.armature, self.frame)

    @cached_property
    def size(self) -> float:
        """Of the figure, of which 1 is a grown person."""
        height = self.settings.measured_height
        return height / USUAL if height > 0.0 else 1.0

    @cached_property
    def units(self) -> float:
        """`size` in Blender units."""
        return self.size / self.metres

    @cached_property
    def recorded(self) -> ShownMotion | None:
        return self._of(kept(self.armature))

    @cached_property
    def adapted(self) -> ShownMotion | None:
        """The adapted motion; while a pin is dragged, its forerunner."""
        return self.live or self._of(kept(self.settings.adapted))

    @cached_property
    def live(self) -> ShownMotion | None:
        traces = live().ghost(self.armature)
        if traces is None or not len(traces.frames):
            return None
        stood = self.armature.matrix_world.copy()
        matrix = Matrix.Scale(1.0 / self.metres, 4).freeze()
        return ShownMotion(traces, ("live", live().version), matrix, stood)

    @cached_property
    def performs_adapted(self) -> bool:
        """Whether the armature moves as the adapted motion does."""
        action = current_action(self.armature)
        return self.live is None and action is not None and action == self.settings.adapted

    @cached_property
    def phases(self) -> Spans:
        return named_frames(self.settings)

    def span(self, row: HangtimeConstraint) -> Frames:
        """From which frame to which a constraint holds."""
        known = self.phases if row.span == Span.PHASE.name else {}
        return interval_of(row, known, self.recorded.traces if self.recorded else None)

    def bone(self, row: HangtimeConstraint) -> bpy.types.PoseBone | None:
        """The bone that a single-bone constraint is about, where the armature has it."""
        if not len(row.bones) or self.armature.pose is None:
            return None
        return self.armature.pose.bones.get(row.bones[0].name)

    def rows(self, *kinds: str) -> Iterator[tuple[HangtimeConstraint, bool]]:
        """The constraints of these kinds, and whether each is the one chosen in the list."""
        chosen = self.settings.active_constraint
        for index, row in enumerate(self.settings.constraints):
            if row.kind in kinds:
                yield row, index == chosen

    def _of(self, found: StoredTraces | None) -> ShownMotion | None:
        if found is None or not len(found.traces.frames):
            return None
        matrix = found.moved(self.armature) @ Matrix.Scale(1.0 / self.metres, 4)
        return ShownMotion(found.traces, found.key, matrix.freeze(), found.stood)


def holds(span: Frames, frame: float) -> bool:
    """Whether a constraint holds at the frame that is shown."""
    return span[0] - NEAR <= frame <= span[1] + NEAR


def posed_bones(armature: bpy.types.Object) -> NDArray[np.float32]:
    """(N * 16,) all bones' matrices, as Blender stores them."""
    flat = np.empty(16 * len(pose_of(armature).bones), np.float32)
    pose_of(armature).bones.foreach_get("matrix", flat)
    return flat


def _lengths(armature: bpy.types.Object) -> bytes:
    """Of all bones, which their matrices do not tell."""
    bones = armature_data(armature).bones
    flat = np.empty(len(bones), np.float32)
    bones.foreach_get("length", flat)
    return flat.tobytes()


def _told(action: bpy.types.Action | None) -> object:
    """An action, and what is drawn of what was stored with it."""
    if action is None:
        return None
    stored = action_settings(action)
    return action, stored.times, stored.overlaps


def read_view(context: bpy.types.Context, known: object = None) -> ViewContext | None:
    """Reads the viewport that is being drawn; None where overlays are off or none is due. known: as
    of `ViewContext`."""
    space, scene = view_3d(context), present(context.scene)
    options = scene_settings(scene).view
    if space is None or not (space.overlay.show_overlays and options.show):
        return None
    armature = chosen_armature(context)
    if armature is None or armature.type != "ARMATURE":
        return None
    if not armature.visible_get(view_layer=context.view_layer, viewport=space):
        return None
    frame, metres = scene.frame_current_final, metres_per_unit(scene)
    rate = frames_per_second(scene)
    return ViewContext(armature, settings_of(armature), options, frame, metres, rate, known)
