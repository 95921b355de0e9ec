"""The main job without a window: a recorded clip in, an adapted one out, with its report."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...solver.analysis.analyse import Analysis, analyse, build_figure
from ...solver.analysis.pinned_places import pinned_places
from ...solver.data.faults import NoArmature, NoFit, NoSolution, OutputNotWritable, UnreadableClip
from ...solver.data.problem import MotionProblem
from ...solver.data.recording import Recording
from ...solver.results.npz_export import save
from ...solver.results.report import Json, Origin, report
from ...solver.results.violations import most_telling
from ...solver.stages.fit import fit
from ...solver.stages.implicit import Adaptation, adapt, unadapted
from ..words.report_text import as_text
from .outbox import Outbox, not_writable
from .quiet import quiet
from .stages import Stages

if TYPE_CHECKING:
    import bpy

    from ...bridge.formats.motion_clip import UpAxis

ASIDE = 1.5  # m; how far the recording stands beside the adapted figure


@dataclass(frozen=True)
class Clip:
    """A motion file, or a .blend with a recorded armature, and what it does not tell.

    unit: m per unit of length. up: the axis that points up. rate, asf: of an AMC file.
    """

    path: Path
    unit: float | None = None
    up: "UpAxis | None" = None
    rate: float | None = None
    asf: Path | None = None


@dataclass(frozen=True)
class AdaptationJob:
    """What to adapt, how, and the folder for the results."""

    clip: Clip
    problem: MotionProblem
    out: Path


@dataclass(frozen=True)
class Loaded:
    """An imported clip: its armature and what was found in it."""

    armature: "bpy.types.Object"
    origin: Origin
    analysis: Analysis


@dataclass(frozen=True)
class Performed:
    """An adapted action, and the armature that performs it."""

    armature: "bpy.types.Object"
    action: "bpy.types.Action"


def run(job: AdaptationJob, stages: Stages) -> list[Path]:
    """Does the whole job and returns the files written.

    Raises NoSolution, having written the report, and any other Fault having written nothing.
    """
    with Outbox(job.out) as outbox:
        loaded = load(job.clip, job.problem, stages)
        performance = loaded.analysis.performance
        with stages.stage("Fitting the physics"):
            fitted = fit(performance, loaded.analysis.schedule, progress=stages.step)
            stages.ended(fitted.outcome.violation)
        if not fitted.solved:
            raise _reported(NoFit, unadapted(fitted), job, loaded, outbox, stages)
        with stages.stage("Adapting"):
            adaptation = adapt(fitted, job.problem, progress=stages.step)
            stages.ended(adaptation.outcome.violation)
        if not adaptation.solved:
            raise _reported(NoSolution, adaptation, job, loaded, outbox, stages)
        _write_results(job, loaded, adaptation, outbox, stages)
        return outbox.deliver()


def load(clip: Clip, problem: MotionProblem, stages: Stages) -> Loaded:
    """The clip in a new, empty file (a .blend in itself), analysed; scaled to the height asked for.

    Raises every Fault that a clip can have.
    """
    with stages.stage("Importing the clip"):
        armature, origin = _import(clip)
    with stages.stage("Finding contacts"):
        if problem.height is not None:
            measured = build_figure(_read(armature, problem), problem)[1].height
            _scale(armature, problem.height / measured)
        analysis = _analyse(armature, problem)
        # Wrong pins are said before the fit takes its seconds.
        pinned_places(problem, analysis.performance, analysis.schedule)
    return Loaded(armature, origin, analysis)


def _reported(
    kind: type[NoSolution],
    adaptation: Adaptation,
    job: AdaptationJob,
    loaded: Loaded,
    outbox: Outbox,
    stages: Stages,
) -> NoSolution:
    """Why a solve failed, once the report and the best motion that was found are written."""
    if adaptation.reached > 0.0:
        _write_actions(loaded, adaptation, called="best found, short of the goal")
        _save_blend(outbox.path("best_found.blend"))
    _write_report(_measured(job, loaded, adaptation, stages), outbox)
    outbox.deliver()
    worst = most_telling(adaptation, job.problem)
    return kind(adaptation.outcome.status.value, worst, adaptation.reached)


# ---------------------------------------------------------------- in


def _import(clip: Clip) -> tuple["bpy.types.Object", Origin]:
    if clip.path.suffix.lower() == ".blend":
        return _open(clip.path), Origin(clip.path.name)
    import bpy

    from ...bridge.files.import_clip import import_clip
    from ...bridge.formats.acclaim import USUAL_RATE

    # Not the factory *settings*: those would disable the extension that runs this.
    with quiet():
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    made = import_clip(
        clip.path,
        unit=clip.unit,
        up=clip.up,
        asf=clip.asf,
        rate=USUAL_RATE if clip.rate is None else clip.rate,
    )
    made.armature.animation_data.action.name = clip.path.stem
    origin = Origin(clip.path.name, made.unit_m, made.unit_guessed, made.up, made.up_guessed)
    return made.armature, origin


def _open(path: Path) -> "bpy.types.Object":
    """The armature of a .blend: the active one, else the only one that carries an action."""
    import bpy

    try:
        with quiet():
            bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False)
    except RuntimeError as error:
        problem = "Blender cannot open it" if path.is_file() else "there is no such file"
        raise UnreadableClip(str(path), None, problem) from error
    active = bpy.context.view_layer.objects.active
    if active is not None and active.type == "ARMATURE":
        return active
    armatures = [o for o in bpy.context.scene.objects if o.type == "ARMATURE"]
    animated = [o for o in armatures if o.animation_data and o.animation_data.action]
    if len(animated) != 1:
        raise NoArmature(path.name)
    return animated[0]


def _analyse(armature: "bpy.types.Object", problem: MotionProblem) -> Analysis:
    return analyse(_read(armature, problem), problem)


def _read(armature: "bpy.types.Object", problem: MotionProblem) -> Recording:
    from ...bridge.armature.read import read_recording

    first, last = _recorded_frames(armature, problem)
    return read_recording(armature, first=first, last=last)


def _recorded_frames(
    armature: "bpy.types.Object", problem: MotionProblem
) -> tuple[float | None, float | None]:
    """The problem's frames as far as the recording goes: beyond, Blender holds the last pose."""
    action = armature.animation_data.action if armature.animation_data else None
    if problem.frames is None or action is None:
        return None, None
    start, end = action.frame_range
    return max(problem.frames[0], start), min(problem.frames[1], end)


def _scale(armature: "bpy.types.Object", factor: float) -> None:
    """Makes the figure larger, and how far it travels with it."""
    from ...bridge.files.import_clip import scale_about_origin

    while armature.parent is not None:
        armature = armature.parent
    scale_about_origin([armature], factor)


# ---------------------------------------------------------------- out


def _write_results(
    job: AdaptationJob, loaded: Loaded, adaptation: Adaptation, outbox: Outbox, stages: Stages
) -> None:
    with stages.stage("Writing keyframes"):
        adapted = _write_actions(loaded, adaptation)
        _save_blend(outbox.path("adapted.blend"))
    with stages.stage("Exporting FBX"), quiet():
        from ...bridge.files.export import export_fbx

        export_fbx(adapted.armature, adapted.action, outbox.path("adapted.fbx"))
    with stages.stage("Drawing the picture"), quiet():
        from .annotate import marks_of
        from .picture import draw

        draw(
            adaptation,
            job.problem,
            outbox.path("sheet.png"),
            marks_of(adaptation, job.problem),
        )
    with stages.stage("Measuring"):
        try:
            save(adaptation.motion, outbox.path("trajectory.npz"))
        except OSError as error:
            raise not_writable(job.out / "trajectory.npz", error) from error
        content = _measured(job, loaded, adaptation, stages)
    _write_report(content, outbox)


def _measured(job: AdaptationJob, loaded: Loaded, adaptation: Adaptation, stages: Stages) -> Json:
    """The report, with the stages that have ended."""
    content = report(adaptation, job.problem, loaded.origin)
    return content | {"stages": stages.as_json()}


def _write_report(content: Json, outbox: Outbox) -> None:
    outbox.write_text("report.json", json.dumps(content, indent=1, allow_nan=False) + "\n")
    outbox.write_text("report.txt", as_text(content))


def _write_actions(
    loaded: Loaded, adaptation: Adaptation, *, called: str = "adapted"
) -> "Performed":
    """The adapted action on the armature, or on one of its own where limbs were changed; the
    recording's on a copy beside it."""
    import bpy

    from ...bridge.armature.reproportioned import build_reproportioned
    from ...bridge.armature.write import side_by_side, write_action

    performance = adaptation.fit.performance
    recorded = loaded.armature.animation_data.action
    armature, track = loaded.armature, adaptation.track
    if adaptation.setup.requests.body.limbs:
        armature, track, _ = build_reproportioned(adaptation.setup.recording, track)
    adapted = write_action(armature, track, name=f"{recorded.name} {called}")
    x, y = (performance.com[-1] - performance.com[0])[:2]
    far = float(np.hypot(x, y))
    beside = (-ASIDE * y / far, ASIDE * x / far, 0.0) if far > 0.05 else (ASIDE, 0.0, 0.0)
    if armature is loaded.armature:
        side_by_side(armature, recorded, adapted, offset=beside)
    else:  # the recording's own armature performs it
        loaded.armature.location = np.add(loaded.armature.location, beside)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = (round(track.frames[k]) for k in (0, -1))
    scene.frame_set(scene.frame_start)
    return Performed(armature, adapted)


def _save_blend(path: Path) -> None:
    import bpy

    try:
        with quiet():
            bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True)
    except RuntimeError as error:
        raise OutputNotWritable(str(path), "Blender could not save it") from error
