"""The work of a cell: as the command `adapt` does it, without Blender where none is needed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from ...bridge.formats.acclaim import clip_files
from ...bridge.recipe.export import ExportOptions
from ...bridge.recipe.keys import KeyOptions, require_every_frame
from ...bridge.recipe.objects import placed_objects
from ...bridge.recipe.problem import Recipe
from ...bridge.recipe.recording import FileReading
from ...bridge.recipe.result import ResultOptions, require_return_after
from ...bridge.rows.choices import FileFormat
from ...operators.files.outbox import Outbox
from ...operators.headless.clip import Clip, LoadedClip, load
from ...operators.headless.doubts import doubts_about
from ...operators.headless.outputs import Outputs, require_exported, require_place
from ...operators.headless.result_files import result_lines
from ...operators.terminal.stages import Stages
from ...operators.words.doctor_text import diagnosis_text, finding_sentence
from ...operators.words.headline import nearness
from ...solver.data.faults import BadRecipe, Fault, FitNeedsSupport
from ...solver.data.problem import MotionProblem
from ...solver.data.reports.recording import Origin
from ...solver.data.requests import Requests
from ...solver.doctor.examination.diagnose import diagnose
from ...solver.doctor.stretch import Span
from ...solver.results.fit_quality import fit_quality
from ...solver.results.unseen_support import refuse_unseen
from ...solver.worker.pipeline import Subject, measure, no_fit, solve
from ..planning.blender_need import needs_blender, require_blender
from ..planning.clips import clip_sha256
from ..planning.recipes import VariedRecipe
from ..records.faults import WrongPlan
from ..records.manifest import BatchSettings, CellPlan, Output
from .figures import figures, fit_figures
from .fits import SharedFits, digest_of
from .outputs import write_motion, write_plain
from .reading import ReadClip, read_clip

DIAGNOSIS = "doctor.txt"
MEASURING = "Measuring"  # as `adapt` calls it
FORMS = {Output.FBX: FileFormat.FBX, Output.GLTF: FileFormat.GLTF}


class InputChanged(Exception):
    """A clip or a recipe is not, or no longer, what was planned; the text is for people."""


@dataclass(frozen=True)
class Done:
    """What the work on a cell found. fault: why it is not what was asked for."""

    headline: tuple[str, ...] = ()
    figures: Mapping[str, float] = field(default_factory=dict)
    fault: Fault | None = None


@dataclass(frozen=True)
class _Loaded:
    """A clip that was read and analysed. whole: first and last frame of all of it. scene: where
    Blender holds it."""

    subject: Subject
    origin: Origin
    problem: MotionProblem
    whole: Span
    scene: LoadedClip | None = None


def adapt_cell(
    settings: BatchSettings, plan: CellPlan, fits: SharedFits, outbox: Outbox, stages: Stages
) -> Done:
    """Adapts, and writes the outputs. Raises Fault, InputChanged, OSError."""
    recipe = _recipe(plan)
    wanted, keys = recipe.result or ResultOptions(), recipe.keys or KeyOptions()
    export = recipe.export or ExportOptions()
    if recipe.loop is not None:
        require_every_frame(keys)
    loaded = _load(settings, plan, recipe, fits, stages)
    require_return_after(wanted, float(loaded.subject.recording.frames[-1]))
    forms = [form for output, form in FORMS.items() if output in settings.outputs]
    if loaded.scene is not None:
        require_place(loaded.scene, wanted, recipe.loop)
        for form in forms:
            require_exported(loaded.scene, outbox.folder, replace(export, format=form))
    for line in doubts_about(recipe.problem, recipe.repairs, loaded.subject, loaded.origin):
        stages.out.write(f"Warning: {line}\n")
    placed = placed_objects(recipe.under, loaded.subject.problem, loaded.subject.analysis)
    result = solve(loaded.subject.with_objects(placed), stages, fits)
    if Output.BVH in settings.outputs and result.fault is None:
        write_motion(result, loaded.origin, outbox)
    if result.fault is not None:
        report = result.report(loaded.origin, stages.done)
        write_plain(result, report, (), outbox)
    elif loaded.scene is None:
        with stages.stage(MEASURING):
            report = result.report(loaded.origin, stages.done)
        write_plain(result, report, settings.outputs, outbox)
    else:
        outputs = Outputs(loaded.scene, wanted, keys, result, outbox, stages, recipe.loop, export)
        report = outputs.write(
            picture=Output.PICTURE in settings.outputs,
            film=Output.FILM in settings.outputs,
            blend=Output.BLEND in settings.outputs,
            trajectory=Output.NPZ in settings.outputs,
            forms=forms,
        )
    told = result_lines(result, report, loaded.subject.analysis.unseen)
    return Done(told, figures(report), result.fault)


def check_cell(
    settings: BatchSettings, plan: CellPlan, fits: SharedFits, outbox: Outbox, stages: Stages
) -> Done:
    """Diagnoses and fits. Raises as `adapt_cell` does."""
    recipe = _recipe(plan)
    loaded = _load(settings, plan, recipe, fits, stages)
    recording = loaded.subject.analysis.performance.recording
    with stages.stage("Diagnosing"):
        found = diagnose(recording, loaded.problem.bones, recipe.problem.mass)
        diagnosis = found.counted_in(loaded.whole, recording.ends)
    outbox.write_text(DIAGNOSIS, diagnosis_text(diagnosis))
    faults = [each for each in diagnosis.findings if not each.kind.note]
    fitted = fits.fit(loaded.subject, stages)
    told = tuple(finding_sentence(each) for each in faults)
    counted = {"findings": float(len(faults))}
    if not fitted.solved:
        return Done(told, counted, no_fit(loaded.subject, fitted, examined=True))
    quality = fit_quality(fitted)
    refused = None
    try:
        refuse_unseen(loaded.subject.problem, fitted)
    except FitNeedsSupport as fault:
        refused = fault
    return Done((nearness(quality), *told), counted | fit_figures(quality), refused)


def cell_files(plan: CellPlan) -> tuple[Path, ...]:
    """Every file that a cell reads beside the manifest. Raises InputChanged."""
    try:
        return (*clip_files(plan.clip), *VariedRecipe.read(plan.recipe, plan.values).files)
    except (WrongPlan, BadRecipe, OSError) as fault:
        raise InputChanged(changed(plan.recipe)) from fault


def _recipe(plan: CellPlan) -> Recipe:
    try:
        varied = VariedRecipe.read(plan.recipe, plan.values)
        resolved = varied.resolved(plan.values)
        recipe, sha256 = varied.recipe(resolved), varied.sha256(resolved)
    except (WrongPlan, BadRecipe, OSError) as fault:  # when it was planned it could be read
        raise InputChanged(changed(plan.recipe)) from fault
    if sha256 != plan.recipe_sha256:
        raise InputChanged(changed(plan.recipe))
    return recipe


def _load(
    settings: BatchSettings, plan: CellPlan, recipe: Recipe, fits: SharedFits, stages: Stages
) -> _Loaded:
    """Reads and analyses the clip, in Blender where that is needed. What came of it counts only
    where the clip still is what was planned afterwards."""
    try:
        return _loaded(settings, plan, recipe, fits, stages)
    finally:
        _require_unchanged(plan)


def _require_unchanged(plan: CellPlan) -> None:
    try:
        same = clip_sha256(plan.clip) == plan.clip_sha256
    except OSError as error:
        raise InputChanged(changed(plan.clip)) from error
    if not same:
        raise InputChanged(changed(plan.clip))


def _loaded(
    settings: BatchSettings, plan: CellPlan, recipe: Recipe, fits: SharedFits, stages: Stages
) -> _Loaded:
    problem, stated = recipe.problem, _stated(settings, recipe)
    if needs_blender(plan.clip, settings.outputs):
        require_blender(plan.clip)
        clip = Clip(
            Path(plan.clip),
            stated.unit,
            stated.up,
            stated.rate,
            armature=stated.armature,
            take=stated.take,
        )
        scene = load(clip, problem, stages, recipe.repairs)
        return _Loaded(scene.subject, scene.origin, scene.problem, scene.whole, scene)
    # Neither pins nor requests tell what was recorded (as in worker/service.py); nor does the
    # folder that a clip lies in, which is another for each cell where clips are sent to workers.
    asked = replace(problem, pins=(), requests=Requests())
    key = digest_of(Path(plan.clip).name, plan.clip_sha256, stated, recipe.repairs, asked)
    with stages.stage("Finding contacts"):
        subject, read = fits.analysed(key, partial(_analysed, stated, plan, recipe))
    problem = replace(problem, frames=read.problem.frames)
    return _Loaded(subject.asked(problem), read.origin, problem, read.whole)


def _stated(settings: BatchSettings, recipe: Recipe) -> FileReading:
    """How a clip is read as the command says, else as the recipe does."""
    return FileReading(
        recipe.file.unit if settings.unit is None else settings.unit,
        settings.up or recipe.file.up,
        recipe.file.rate if settings.rate is None else settings.rate,
        armature=settings.armature or recipe.file.armature,
        take=settings.take or recipe.file.take,
    )


def _analysed(stated: FileReading, plan: CellPlan, recipe: Recipe) -> tuple[Subject, ReadClip]:
    read = read_clip(
        Path(plan.clip),
        recipe.problem,
        recipe.repairs,
        unit=stated.unit,
        up=stated.up,
        rate=stated.rate,
    )
    return measure(read.recording, read.problem), read


def changed(path: str) -> str:
    """The sentence of an `InputChanged`."""
    return (
        f"{path} has changed since the batch was planned, or is gone; give the batch's command "
        "again, which plans it as it is then."
    )
