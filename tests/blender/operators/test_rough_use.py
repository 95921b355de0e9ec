"""What newcomers do: clips as Blender's importers bring them, and changes while a solve goes on."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import present
from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.traces_store import kept
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.bridge.files.import_clip import import_clip
from hangtime.bridge.polish.samples import written_of
from hangtime.bridge.repairs.analysed_state import AnalysedState, changed_since_analysis
from hangtime.bridge.results.look_again import EDIT_CHANGED, look_again
from hangtime.bridge.results.made import AskedSettings
from hangtime.bridge.worker_client import shared
from hangtime.operators.solve import analyze
from hangtime.operators.solve import write_answer as write_answer_module
from hangtime.operators.solve.adapt import AdaptOperator, ask_for
from hangtime.operators.solve.analyze import AnalyzeOperator, FitOperator
from hangtime.operators.solve.common import said
from hangtime.operators.solve.session import Asked, session
from hangtime.operators.solve.solving import SolveState, Solving
from hangtime.operators.solve.task import Task, TaskOperator
from hangtime.operators.solve.write_answer import write_answer
from hangtime.operators.solve.written.keys import mark_contacts
from hangtime.solver.data.faults import Fault, NoArmature
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.worker.protocol import RequestKind
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.helpers.clips import mocap_path

RUN = "run_1.bvh"
TOO_LARGE = 14.0

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def run() -> bpy.types.Object:
    """A run, many times too large, as Blender's own importer brings it by default."""
    rigs.reset()
    armature = import_clip(mocap_path(RUN)).armature
    armature.scale *= TOO_LARGE
    return armature


@pytest.mark.parametrize("shrunk", [1.0, 0.002])
def test_a_figure_of_a_wrong_scale_is_told_as_such(run: bpy.types.Object, shrunk: float) -> None:
    """Not that feet never touch the ground, which is what gravity's size makes of it."""
    run.scale *= shrunk
    with pytest.raises(RuntimeError, match=r"run_1.* is .* m tall.*import it again at .* scale"):
        bpy.ops.hangtime.analyze()
    assert not run.hangtime.contacts


@pytest.mark.slow
def test_the_scale_that_is_told_mends_it(run: bpy.types.Object) -> None:
    with pytest.raises(RuntimeError) as told:
        bpy.ops.hangtime.analyze()
    factor = float(str(told.value).split("again at ")[1].split()[0])
    shown = run.scale.copy()
    run.scale = shown / TOO_LARGE
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    true_height = run.hangtime.measured_height
    run.scale = shown * factor
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    # What makes the falls right, to a fifth in a run's short ones; a person's in any case.
    assert run.hangtime.measured_height == pytest.approx(true_height, rel=0.2)
    assert 1.4 < run.hangtime.measured_height < 2.0


def test_frames_beside_the_recording_are_told_as_such(run: bpy.types.Object) -> None:
    run.hangtime.use_range = True
    run.hangtime.first_frame, run.hangtime.last_frame = 5000, 5200
    with pytest.raises(RuntimeError, match=r"no keys \(they lie from frame 1 to 167\)"):
        bpy.ops.hangtime.analyze()


@pytest.mark.slow
def test_a_contact_that_ends_before_it_begins_is_named(run: bpy.types.Object) -> None:
    """It would be left out without a word."""
    settings = run.hangtime
    run.scale /= TOO_LARGE
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    row = settings.contacts[2]
    row.start_frame, row.end_frame = 90.0, 60.0
    told = rf"{row.name}.*ends at frame 60, before it begins at frame 90; swap them"
    with pytest.raises(RuntimeError, match=told):
        bpy.ops.hangtime.adapt()
    row.used = False
    assert problem_of(settings, read_recorded(run, None, None)).contacts


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ("no keys", "its keys"),
        ("uneven scale", "its scale"),
        ("frame rate", "frame rate"),
        ("deleted", "was removed while it was solved; undo that"),
        ("edit mode", "leave edit mode, and try again"),
        ("renamed", "“Hero” changed while it was solved (its bones)"),
    ],
)
def test_a_change_meanwhile_is_said_to_have_cost_the_result(
    run: bpy.types.Object, change: str, told: str
) -> None:
    """Also where what is there now cannot be read at all."""
    recording = read_recorded(run, 1.0, 20.0)
    settings, state = AskedSettings.of(run.hangtime), AnalysedState.of(run)
    asked = Asked(run.name, run.session_uid, recording, MotionProblem(), settings, state=state)
    if change == "no keys":
        run.animation_data.action = bpy.data.actions.new("Other")
    elif change == "uneven scale":
        run.scale = (1.0, 1.0, 2.0)
    elif change == "renamed":
        run.name, run.data.bones[0].name = "Hero", "Base"
    elif change == "deleted":  # which keeps it in the file until that is saved
        for collection in run.users_collection:
            collection.objects.unlink(run)
    elif change == "edit mode":
        bpy.ops.object.mode_set(mode="EDIT")
    else:
        bpy.context.scene.render.fps = 24
    session().solving = replace(Solving(), state=SolveState.SOLVING)
    try:
        with pytest.raises(Fault) as fault:
            complete(write_answer(asked, None))
    finally:
        session().solving = None
    assert "thrown away" in said(fault.value)
    assert told in said(fault.value)


def test_an_armature_that_is_moved_while_it_is_analysed_is_elsewhere_than_its_contacts(
    analysed: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    in_peace = analyze._analysed

    def meanwhile(*asked: object) -> Task:
        answer = yield from in_peace(*asked)
        analysed.location.x += 1.0
        bpy.context.view_layer.update()
        return answer

    stood = analysed.matrix_world.copy()
    monkeypatch.setattr(analyze, "_analysed", meanwhile)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    now = read_recorded(analysed, 1.0, 20.0)
    assert changed_since_analysis(analysed, now) == ("its place",)
    assert present(kept(analysed)).stood == stood
    with pytest.raises(RuntimeError, match=r"changed since the analysis \(its place\)"):
        bpy.ops.hangtime.fit()


def test_what_adapt_begins_from_is_known_and_no_drag_waits_for_that(
    analysed: bpy.types.Object,
) -> None:
    """It looks through all keys, which takes long on large rigs."""
    assert complete(ask_for(bpy.context)).state is None
    adapting = SimpleNamespace(solution=lambda _, asked: asked, report=lambda *_: None)
    session().solving = Solving()
    try:
        asked = complete(AdaptOperator._asked(adapting, bpy.context))
    finally:
        session().solving = None
    assert asked.state == AnalysedState.of(analysed)


@pytest.mark.parametrize("name", ["analyze", "fit"])
def test_an_armature_deleted_before_the_work_begins_is_missed(
    run: bpy.types.Object, name: str
) -> None:
    bpy.data.objects.remove(run)
    session().solving = Solving()
    operator = {"analyze": AnalyzeOperator, "fit": FitOperator}[name]
    try:
        with pytest.raises(NoArmature):
            next(operator.task(None, bpy.context))
    finally:
        session().solving = None


class _Mistaken(TaskOperator):
    """As Blender runs it, without a window."""

    def __init__(self) -> None:
        self.left = False
        self._task = self.task()

    def task(self) -> Task:
        yield from ()
        raise AttributeError("a mistake of ours")

    def leave(self) -> None:
        self.left = True


def test_a_mistake_of_ours_does_not_leave_every_button_grey() -> None:
    operator = _Mistaken()
    with pytest.raises(AttributeError):
        operator._work()
    assert operator.left


def test_plots_of_a_recording_that_was_only_analyzed(run: bpy.types.Object, tmp_path: Path) -> None:
    """It has contacts, but no forces."""
    run.scale /= TOO_LARGE
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert bpy.ops.hangtime.save_plots(filepath=str(tmp_path / "plots.csv")) == {"FINISHED"}
    assert any(tmp_path.iterdir())


@pytest.mark.slow
def test_a_result_that_is_cancelled_while_it_is_finished_is_whole(
    analysed: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = complete(ask_for(bpy.context))
    job = shared().ask(RequestKind.ADAPT, asked.recording, asked.problem)
    job.wait()
    begun = []

    def marked(*told: object) -> None:
        begun.append(True)
        mark_contacts(*told)

    monkeypatch.setattr(write_answer_module, "mark_contacts", marked)
    session().solving = replace(Solving(), state=SolveState.SOLVING)
    try:
        writing = write_answer(asked, job.answer)
        while not begun:
            next(writing)
        writing.close()
        assert "the result is kept" in session().solving.cancelled
    finally:
        session().solving = None
    assert begun == [True]
    result = analysed.hangtime.adapted
    assert result.hangtime.own_key
    assert written_of(result) is not None


@pytest.mark.slow
def test_settings_changed_during_a_solve_are_kept_and_the_result_is_told_as_of_those_before(
    analysed: bpy.types.Object,
) -> None:
    settings = analysed.hangtime
    asked = complete(ask_for(bpy.context))
    job = shared().ask(RequestKind.ADAPT, asked.recording, asked.problem)
    before = settings.mass
    settings.mass, settings.result.written_as, settings.loop.use = 90.0, "STRIP", True
    job.wait()
    session().solving = replace(Solving(), state=SolveState.SOLVING)
    try:
        complete(write_answer(asked, job.answer))
    finally:
        session().solving = None
    result = settings.adapted
    assert result == analysed.animation_data.action
    assert (result.hangtime.edit.mass, settings.mass) == (before, 90.0)
    assert look_again(analysed)
    assert result.hangtime.stale == EDIT_CHANGED
    settings.mass, settings.result.written_as, settings.loop.use = before, "ACTION", False
    assert look_again(analysed)
    assert not result.hangtime.stale
