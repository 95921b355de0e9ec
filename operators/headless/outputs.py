"""Files of a headless job: .blend, FBX, picture, trajectory and report."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...solver.data.faults import OutputNotWritable
from ...solver.data.problem import MotionProblem
from ...solver.data.report import Report, as_json
from ...solver.data.scaling import scaled_problem
from ...solver.results.npz_export import save
from ...solver.scene.object_motion import ObjectMotion
from ...solver.worker.pipeline import AdaptationResult
from ..words.report_text import as_text
from .clip import LoadedClip
from .outbox import Outbox, not_writable
from .quiet import quiet
from .stages import Stages

if TYPE_CHECKING:  # as in clip.py
    import bpy

ASIDE = 1.5  # m; how far the recording stands beside the adapted figure


@dataclass(frozen=True)
class Outputs:
    """Writes the files of one result; every method raises OutputNotWritable.

    problem: as it was asked for, in the recording's own lengths.
    """

    clip: LoadedClip
    problem: MotionProblem
    result: AdaptationResult
    outbox: Outbox
    stages: Stages

    def write(self, *, picture: bool = True) -> Report:
        """All files of a result that is what was asked for; the picture where wanted."""
        with self.stages.stage("Writing keyframes"):
            performer, adapted = self._write_actions("adapted")
            self._build_scene()
            _save_blend(self.outbox.path("adapted.blend"))
        with self.stages.stage("Exporting FBX"), quiet():
            from ...bridge.files.export import export_fbx

            export_fbx(performer, adapted, self.outbox.path("adapted.fbx"))
        if picture:
            self._draw()
        with self.stages.stage("Measuring"):
            try:
                save(self.result.adaptation.motion, self.outbox.path("trajectory.npz"))
            except OSError as error:
                raise not_writable(self.outbox.folder / "trajectory.npz", error) from error
            report = self._report()
        self._write_report(report)
        return report

    def _draw(self) -> None:
        adaptation = self.result.adaptation
        with self.stages.stage("Drawing the picture"), quiet():
            from .annotate import marks_of
            from .picture import draw

            marks = marks_of(adaptation, self.result.subject.problem)
            draw(adaptation, self.problem, self.outbox.path("sheet.png"), marks)

    def write_failure(self) -> None:
        """The report, and the best motion that was found."""
        if self.result.adaptation.reached > 0.0:
            self._write_actions("best found, short of the goal")
            self._build_scene()
            _save_blend(self.outbox.path("best_found.blend"))
        self._write_report(self._report())

    def _report(self) -> Report:
        """With the stages that have ended."""
        return self.result.report(self.clip.origin, self.stages.done)

    def _write_report(self, report: Report) -> None:
        text = json.dumps(as_json(report), indent=1, allow_nan=False)
        self.outbox.write_text("report.json", text + "\n")
        self.outbox.write_text("report.txt", as_text(report))

    def _write_actions(self, called: str) -> tuple[bpy.types.Object, bpy.types.Action]:
        """The adapted action on the armature, or on one of its own where limbs were changed; the
        recording's on a copy beside it. Returns who performs the action, and the action."""
        from mathutils import Vector

        from ...bridge.accessors import current_action, present
        from ...bridge.armature.reproportioned import build_reproportioned
        from ...bridge.armature.write import side_by_side, write_action

        recorded = present(current_action(self.clip.armature))
        armature, track = self.clip.armature, self.result.track
        if self.result.subject.problem.requests.body.limbs:
            armature, track, _ = build_reproportioned(self.result.recording, track)
        adapted = write_action(armature, track, name=f"{recorded.name} {called}")
        if armature is self.clip.armature:
            side_by_side(armature, recorded, adapted, offset=self._beside())
        else:  # the recording's own armature performs it
            self.clip.armature.location += Vector(self._beside())
        _show_frames(round(track.frames[0]), round(track.frames[-1]))
        return armature, adapted

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


def _show_frames(first: int, last: int) -> None:
    from ...bridge.accessors import current_scene

    scene = current_scene()
    scene.frame_start, scene.frame_end = first, last
    scene.frame_set(first)


def _save_blend(path: Path) -> None:
    import bpy

    try:
        with quiet():
            bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True)
    except RuntimeError as error:
        raise OutputNotWritable(str(path), "Blender could not save it") from error
