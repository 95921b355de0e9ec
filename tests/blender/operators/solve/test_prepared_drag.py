"""What the worker prepares for the first drag, and what a drag asks of it."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import present
from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.constraint_kinds import point
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.bridge.worker_client import shared
from hangtime.operators.drag import follow_mixin
from hangtime.operators.drag.follow_mixin import FollowedDrag
from hangtime.operators.drag.mouse import Press
from hangtime.operators.drag.typed_number import TypedNumber
from hangtime.operators.solve.analyze import _prepare_drag
from hangtime.operators.solve.live import live
from hangtime.operators.solve.session import session
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.status import DragStatus
from hangtime.solver.worker.protocol import Followed
from hangtime.tests.blender.helpers.actions import curves_of
from hangtime.tests.blender.helpers.jump_scene import ask_by_text
from hangtime.tests.blender.helpers.rows import added
from hangtime.tests.helpers.clips import JUMP_FRAMES
from mathutils import Vector

pytestmark = pytest.mark.usefixtures("_enabled")


class Asked:
    """In the worker's stead: the problems that are prepared and followed."""

    def __init__(self) -> None:
        self.problems: list[MotionProblem] = []
        self.ahead: list[bool] = []
        self.waited = 0  # times

    def prepare(self, _recording, problem: MotionProblem) -> None:
        self.problems.append(problem)

    def follow(self, _recording) -> Asked:
        return self

    def want(self, problem: MotionProblem, *, ahead: bool) -> None:
        self.problems.append(problem)
        self.ahead.append(ahead)

    news = staticmethod(lambda: ())

    def first_news(self, _seconds: float) -> tuple[()]:
        self.waited += 1
        return ()


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Asked:
    worker = Asked()
    monkeypatch.setattr(shared(), "prepare", worker.prepare)
    monkeypatch.setattr(shared(), "follow", worker.follow)
    return worker


class Drag(FollowedDrag):
    """Of the chosen contact, without a mouse."""

    held = "Left toe 2"
    _moved = _idle = _told = True

    def __init__(self, armature: bpy.types.Object) -> None:
        self._armature = armature
        self._press = Press((0.0, 0.0), slack=3.0, dragging=False)
        self._typed = TypedNumber()
        self.refused: list[str] = []

    def begin(self) -> None:
        """The contact is dragged away, and the ghost shows."""
        row = self._armature.hangtime.contacts[self.held]
        self._was, row.at = Vector(row.at), Vector(row.at) + Vector((1.0, 0.0, 0.0))
        session().running.append(self)
        live().show(self._armature.name, Followed(0, None, None, DragStatus.CONVERGED))

    def put_back(self) -> None:
        self._armature.hangtime.contacts[self.held].at = self._was

    def let_go(self) -> bool:
        self.put_back()  # a click
        return False

    def chosen(self) -> bool:
        return True

    def leave(self) -> None:
        session().running.remove(self)

    def refuse(self, why: str, *_kind: str) -> set[str]:
        self.refused.append(why)
        return {"CANCELLED"}


def test_a_contact_that_is_held_is_pinned_where_it_was_found(analysed) -> None:
    settings, recording = analysed.hangtime, read_recorded(analysed, *JUMP_FRAMES)
    assert not problem_of(settings, recording).pins
    row = settings.contacts["Left toe 2"]
    (pin,) = problem_of(settings, recording, held=row.name).pins
    assert (pin.phase, pin.touching) == ("ground 2", ("Left toe 2",))
    assert pin.place == pytest.approx(tuple(row.found_at))


def test_the_drag_of_the_chosen_contact_is_prepared_as_it_will_be_asked_for(
    analysed, asked: Asked
) -> None:
    complete(_prepare_drag(bpy.context))
    (prepared,) = asked.problems
    chosen = analysed.hangtime.contacts[analysed.hangtime.active_contact]
    assert [pin.phase for pin in prepared.pins] == [chosen.phase] == ["ground 2"]
    drag = Drag(analysed)
    drag.held = chosen.name
    next(drag._follow(bpy.context))
    assert asked.problems[1:] == [prepared]


def test_the_first_ghost_waits_for_no_reading(
    analysed, asked: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    complete(_prepare_drag(bpy.context))
    read: list[int] = []
    monkeypatch.setattr(follow_mixin, "ask_for", lambda _: (read.append(part) for part in count()))
    drag = Drag(analysed)
    drag._told = False
    following = drag._follow(bpy.context)
    next(following)
    drag._press.dragging = drag._moved = True
    next(following)
    assert not read
    assert asked.ahead == [True, False]
    assert asked.waited == 1
    drag._told, drag._idle = True, False
    next(following)  # one of the mouse's many moves
    assert not read
    assert asked.waited == 1, "only the first move waits"
    drag._idle = True
    next(following)
    assert read == [0]


def test_what_adapt_will_refuse_is_no_fault_of_the_analysis(analysed, asked: Asked) -> None:
    row = analysed.hangtime.contacts[0]
    row.start_frame, row.end_frame = row.end_frame, row.start_frame
    complete(_prepare_drag(bpy.context))
    assert not asked.problems


def test_a_drag_is_among_the_surfaces_as_they_are_now(analysed, asked: Asked) -> None:
    complete(_prepare_drag(bpy.context))
    bpy.ops.mesh.primitive_cube_add(location=(20.0, 0.0, 0.5))
    bpy.context.object.select_set(True)
    bpy.context.view_layer.objects.active = analysed
    assert bpy.ops.hangtime.add_surfaces(role="OBSTACLE") == {"FINISHED"}
    assert not session().dragged.scene.objects
    following = Drag(analysed)._follow(bpy.context)
    for _ in range(1000):
        if len(asked.problems) == 2:
            break
        next(following)
    assert [len(problem.scene) for problem in asked.problems] == [0, 1]
    assert len(session().dragged.scene.objects) == 1


def test_a_move_of_the_mouse_looks_at_no_target_again(analysed, asked: Asked) -> None:
    truck, handle = (bpy.data.objects.new(name, None) for name in ("Truck", "Handle"))
    for each in (truck, handle):
        bpy.context.scene.collection.objects.link(each)
    handle.parent = truck
    for frame in JUMP_FRAMES:
        truck.location.x = frame
        truck.keyframe_insert("location", frame=frame)
    added(analysed, point.KIND, "LeftHand", span="ALWAYS", target=handle, name="Grab")
    complete(_prepare_drag(bpy.context))
    drag, looked_at = Drag(analysed), []
    drag._idle = False  # the mouse moves

    def note(scene: bpy.types.Scene, *_: object) -> None:
        looked_at.append(scene.frame_current_final)

    bpy.app.handlers.frame_change_post.append(note)
    try:
        next(drag._follow(bpy.context))
    finally:
        bpy.app.handlers.frame_change_post.remove(note)
    assert not looked_at
    prepared, followed = (problem.requests.points[0].path for problem in asked.problems)
    assert prepared == followed
    assert len(present(followed).frames) > 1


@pytest.mark.usefixtures("analysed", "asked")
def test_another_file_lets_go_of_the_recording() -> None:
    complete(_prepare_drag(bpy.context))
    assert session().dragged is not None
    bpy.ops.wm.read_homefile(use_empty=True)
    assert session().dragged is None


def test_what_is_asked_of_an_aimed_head_is_refused_as_the_drag_begins(
    analysed, asked: Asked
) -> None:
    complete(_prepare_drag(bpy.context))
    session().dragged = replace(present(session().dragged), aimed=("Head",))
    tuck = '[[pose]]\nname = "Tuck"\nphase = "flight 1"\n'
    ask_by_text(analysed, tuck)
    next(Drag(analysed)._follow(bpy.context))
    (pose,) = asked.problems[-1].requests.poses
    assert pose.apart == ("Head",)
    ask_by_text(analysed, f'{tuck}[[torque]]\nname = "Limp"\nbones = ["Head"]\nbound = 0\n')
    drag = Drag(analysed)
    drag._task, drag._fault = drag._follow(bpy.context), ""
    drag._look()
    assert drag._fault.startswith("Mute what aims neck and head"), "a header may be cut off"
    told = session().failure
    assert told is not None
    assert told.text.startswith("“Limp” is about the bone “Head”"), "the panel tells it, too"
    assert told.uid == analysed.session_uid
    assert len(asked.problems) == 2, "the worker follows nothing that Adapt would refuse"


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ("location", "its place"),
        ("scale", "its scale or the scene"),
        ("stretched", "Time Stretching"),
    ],
)
def test_nothing_is_dragged_of_an_armature_that_is_shown_otherwise_than_it_was_analysed(
    analysed, asked: Asked, change: str, told: str
) -> None:
    """A click chooses a handle all the same."""
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    if change == "stretched":
        bpy.context.scene.render.frame_map_new = 150
    else:
        setattr(analysed, change, 2.0 * Vector((1.0, 1.0, 1.0)))
    bpy.context.view_layer.update()
    drag, row = Drag(analysed), analysed.hangtime.contacts["Left toe 2"]
    was = Vector(row.at)
    for clicked in (True, False):
        drag.begin()
        drag._press.dragging = not clicked
        drag._task, drag._fault = drag._follow(bpy.context), ""
        drag._look()
        assert told in drag._fault
        assert drag._end() == ({"FINISHED"} if clicked else {"CANCELLED"})
        assert len(drag.refused) == (not clicked)
    assert told in drag.refused[0]
    assert tuple(row.at) == tuple(was)
    assert not asked.problems
    assert not session().running


def test_a_button_begins_no_drag_of_an_armature_that_was_moved(
    analysed, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    analysed.location.x += 1.0
    bpy.context.view_layer.update()
    by_button = Press((0.0, 0.0), slack=3.0, dragging=True)
    monkeypatch.setattr(Press, "of", lambda *_, **__: by_button)
    drag = Drag(analysed)
    drag.release_confirm = False
    assert drag.invoke(bpy.context, SimpleNamespace()) == {"CANCELLED"}
    assert "its place" in drag.refused[0]
    assert not session().running


def test_a_drag_of_what_was_not_analysed_is_put_back(analysed, asked: Asked) -> None:
    row, drag = analysed.hangtime.contacts["Left toe 2"], Drag(analysed)
    was = Vector(row.at)
    drag.begin()
    drag._press.dragging = True
    curves_of(analysed)[0].keyframe_points[150].co[1] += 0.1
    drag._task, drag._fault = drag._follow(bpy.context), ""
    for _ in range(1000):
        if drag._fault:
            break
        drag._look()
    assert drag._end() == {"CANCELLED"}
    assert tuple(row.at) == tuple(was)
    assert "changed since the analysis" in drag.refused[0]
    assert not asked.problems
    assert live().seen is None


def test_a_drag_that_blender_ends_leaves_neither_a_move_nor_a_ghost(analysed) -> None:
    row, drag = analysed.hangtime.contacts["Left toe 2"], Drag(analysed)
    was = Vector(row.at)
    drag.begin()
    assert tuple(row.at) != tuple(was)
    drag.cancel(bpy.context)
    assert tuple(row.at) == tuple(was)
    assert live().seen is None
    assert not session().running
    row.at = was + Vector((0.0, 1.0, 0.0))
    drag.cancel(bpy.context)
    assert tuple(row.at) != tuple(was), "a drag that has ended moves nothing any more"


def test_what_is_typed_leads_until_it_is_deleted(analysed) -> None:
    """The mouse, too, moves meanwhile, as a hand that types shakes it."""
    drag, led = Drag(analysed), list[object]()
    drag.put_by, drag.pull = led.append, lambda *_: led.append("mouse")
    drag._look = drag._show = lambda: None
    drag.begin()
    context = SimpleNamespace(region_data=True)
    mouse = SimpleNamespace(
        type="MOUSEMOVE", value="NOTHING", ascii="", mouse_region_x=50, mouse_region_y=50
    )
    drag.modal(context, mouse)
    for kind, character in (("ONE", "1"), ("MINUS", "-")):
        drag.modal(context, SimpleNamespace(type=kind, value="PRESS", ascii=character))
        drag.modal(context, mouse)
    for _ in range(2):
        drag.modal(context, SimpleNamespace(type="BACK_SPACE", value="PRESS", ascii=""))
    drag.modal(context, mouse)
    assert led == ["mouse", 1.0, -1.0, 0.0, "mouse", "mouse"]


def test_what_is_typed_and_deleted_over_the_sidebar_leaves_where_the_mouse_will_take_hold(
    analysed,
) -> None:
    """A turn would count from the button, and jump as the mouse comes into the view."""
    drag, led = Drag(analysed), list[object]()
    drag.put_by, drag.pull = led.append, lambda *_: led.append("mouse")
    drag._look = drag._show = lambda: None
    drag._press = Press((0.0, 0.0), slack=3.0, dragging=True, over_bar=True)
    drag.begin()
    for kind, character in (("THREE", "3"), ("BACK_SPACE", "")):
        event = SimpleNamespace(type=kind, value="PRESS", ascii=character)
        drag.modal(SimpleNamespace(region_data=True), event)
    assert led == [3.0, 0.0]


@pytest.mark.parametrize("ends", ["modal", "cancel"])
def test_a_drag_whose_armature_is_gone_leaves_no_ghost(analysed, ends: str) -> None:
    drag = Drag(analysed)
    drag.begin()
    bpy.data.objects.remove(analysed)
    if ends == "modal":
        event = SimpleNamespace(type="ESC", value="PRESS")
        drag.modal(SimpleNamespace(region_data=True), event)
    else:
        drag.cancel(bpy.context)
    assert drag.refused == [follow_mixin.TAKEN_AWAY] * (ends == "modal")
    assert live().seen is None
    assert not session().running
