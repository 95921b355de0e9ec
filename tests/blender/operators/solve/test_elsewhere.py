"""What is solved for one character in one scene, while another one is chosen or shown."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.worker_requests import PendingRequest
from hangtime.operators.solve.adapt import Adapting, AdaptOperator, RefineOperator
from hangtime.operators.solve.session import session
from hangtime.operators.solve.solving import Solving
from hangtime.operators.solve.task import Task, kept_in_scene
from hangtime.solver.data.solver_options import ObjectiveKind
from hangtime.tests.blender.helpers import rigs

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def _solving() -> Iterator[None]:
    session().solving = Solving()
    yield
    session().solving = None


class _Begun(Adapting):
    """Adapt or Refine, as Blender runs it without a window."""

    def __init__(self, kind: type[Adapting]) -> None:
        self.report = lambda _level, _told: None
        self.solution = lambda *of: kind.solution(self, *of)


@pytest.mark.usefixtures("_solving")
def test_refine_takes_the_objective_of_the_character_it_began_with(
    analysed: bpy.types.Object,
) -> None:
    other = analysed.copy()
    bpy.context.collection.objects.link(other)
    analysed.hangtime.objective, other.hangtime.objective = "MASS_DISPLACEMENT", "POWER"
    asking = _Begun(RefineOperator)._asked(bpy.context)
    next(asking)
    bpy.context.view_layer.objects.active = other
    asked = complete(asking)
    assert asked.uid == analysed.session_uid
    assert asked.problem.requests.solution.objectives[0][0] is ObjectiveKind.MASS_DISPLACEMENT


def answered(task: Task) -> str:
    """Another scene, of another frame rate, is shown while a task is solved."""
    while True:
        try:
            job = next(task)
        except StopIteration as end:
            return str(end.value)
        if isinstance(job, PendingRequest):
            bpy.context.window.scene = bpy.data.scenes.new("Other")
            job.wait()


def test_work_goes_on_in_its_scene_and_stops_where_that_is_gone() -> None:
    rigs.reset()
    begun = bpy.context.scene

    def work() -> Task:
        seen = [bpy.context.scene == begun]
        yield None
        seen.append(bpy.context.scene == begun)
        yield None
        return f"{seen}"

    staying, losing = (kept_in_scene(bpy.context, work()) for _ in range(2))
    next(staying), next(losing)
    bpy.context.window.scene = bpy.data.scenes.new("Other")
    assert complete(staying) == "[True, True]"
    bpy.data.scenes.remove(begun)
    with pytest.raises(ReferenceError):
        next(losing)


@pytest.mark.slow
@pytest.mark.usefixtures("_solving")
def test_a_result_comes_in_the_scene_in_which_it_was_asked_for(analysed: bpy.types.Object) -> None:
    scene = bpy.context.scene
    analysed.hangtime.stances["ground 2"].forward += 0.2
    last = analysed.animation_data.action.frame_range[1]
    scene.frame_end = round(last)
    told = answered(kept_in_scene(bpy.context, _Begun(AdaptOperator).task(bpy.context)))
    assert told.startswith("Wrote the action")
    assert scene.frame_end > last
    assert bpy.context.scene.name == "Other"
    assert bpy.context.scene.frame_end == bpy.data.scenes.new("New").frame_end
