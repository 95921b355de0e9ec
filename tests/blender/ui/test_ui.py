"""The sidebar's properties and operators, as a script uses them, in the bpy module."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

import hangtime
from hangtime.bridge import worker_client
from hangtime.bridge.accessors import ATTRIBUTE
from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.bridge.properties import settings
from hangtime.bridge.rows.phases import phases_of
from hangtime.operators.names import OperatorId
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.recording import BEYOND
from hangtime.tests.blender.bridge.test_read_write import curves_of, snapshot
from hangtime.tests.blender.helpers import rigs
from hangtime.ui import registration

JUMP = "forward_jump_116cm.bvh"
FIRST, LAST = 73, 325
SETTLING = 3.6  # frames, 30 ms
OFFSET = np.array([0.3, 0.1, 0.2])  # forward, left, up

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def armature(jump: bpy.types.Object) -> bpy.types.Object:
    return jump


@pytest.fixture
def _disabled() -> Iterator[None]:
    """As before the extension was enabled."""
    hangtime.unregister()
    rigs.reset()
    yield
    hangtime.register()


@dataclass(frozen=True)
class SceneState:
    """What an operator that fails must leave alone."""

    actions: tuple[str, ...]
    assigned: str | None
    fake_users: tuple[bool, ...]
    objects: tuple[str, ...]
    contacts: tuple[tuple[object, ...], ...]
    status: str
    frame: float
    mode: str

    @staticmethod
    def of(armature: bpy.types.Object) -> SceneState:
        data, settings = armature.animation_data, armature.hangtime
        return SceneState(
            tuple(a.name for a in bpy.data.actions),
            data.action.name if data is not None and data.action is not None else None,
            tuple(a.use_fake_user for a in bpy.data.actions),
            tuple(o.name for o in bpy.data.objects),
            tuple((c.name, c.used, *c.at, c.start_frame, c.end_frame) for c in settings.contacts),
            settings.status,
            bpy.context.scene.frame_current_final,
            armature.mode,
        )


def every_name() -> set[str]:
    """The identifiers of all the extension's classes."""
    operators = {o.replace("hangtime.", "HANGTIME_OT_") for o in OperatorId}
    others = [c for c in registration.classes() if not issubclass(c, bpy.types.Operator)]
    return operators | {getattr(c, "bl_idname", c.__name__) for c in others}


def names_in_blender() -> set[str]:
    """Those of them that Blender knows."""
    return {name for name in every_name() if known(name)}


def known(name: str) -> bool:
    kinds = (
        *(bpy.types.Operator, bpy.types.Panel, bpy.types.Menu),
        *(bpy.types.UIList, bpy.types.PropertyGroup, bpy.types.GizmoGroup),
    )
    return any(kind.bl_rna_get_subclass_py(name) is not None for kind in kinds)


def handlers() -> dict[str, list[object]]:
    every = {name: getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)}
    return {name: list(these) for name, these in every.items() if isinstance(these, list)}


def landing(settings: bpy.types.PropertyGroup) -> list[bpy.types.PropertyGroup]:
    return [c for c in settings.contacts if c.phase == "ground 2"]


def drift(armature: bpy.types.Object, row: bpy.types.PropertyGroup) -> float:
    """How far, m, a contact's point gets from its place in Blender's evaluated pose.

    The first and last 30 ms apart, in which its sole sinks and rises.
    """
    take = read_recorded(armature, FIRST, LAST, BEYOND)
    schedule = analyse(take, MotionProblem(frames=(FIRST, LAST))).schedule
    contact = next(c for c in schedule.contacts if c.name == row.name)
    last = row.end_frame if row.end_frame == LAST else row.end_frame - SETTLING
    shown = read_recording(armature, first=row.start_frame + SETTLING, last=last)
    bone = shown.index(row.bone)
    points = shown.heads[:, bone] + shown.rotations[:, bone] @ contact.offset
    return float(np.linalg.norm(points - np.array(row.place), axis=1).max())


# ---------------------------------------------------------------- registration


@pytest.mark.usefixtures("_disabled")
def test_registering_five_times_leaves_nothing_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    commands: list[object] = []
    add, remove = bpy.utils.register_cli_command, bpy.utils.unregister_cli_command

    def added(name: str, execute: Callable[[list[str]], int]) -> object:
        commands.append(add(name, execute))
        return commands[-1]

    def removed(handle: object) -> None:
        commands.remove(handle)
        remove(handle)

    monkeypatch.setattr(bpy.utils, "register_cli_command", added)
    monkeypatch.setattr(bpy.utils, "unregister_cli_command", removed)
    before = handlers()
    for _ in range(5):
        hangtime.register()
        assert names_in_blender() == every_name()
        assert len(commands) == 1
        hangtime.unregister()
        assert names_in_blender() == set()
        assert commands == []
        assert handlers() == before
        for carrier in settings.CARRIERS:
            assert not hasattr(carrier, ATTRIBUTE)


ENABLE = """
import runpy, sys
runpy.run_path(sys.argv[1])["load"]().register()
from hangtime.operators.words import messages, report_text
print("casadi" in sys.modules, flush=True)
import os
os._exit(0)
"""


def test_the_solver_stays_out_of_blenders_own_process() -> None:
    """Loading CasADi takes a third of a second, in which Blender would stand still."""
    loader = Path(__file__).parents[3] / "devtools" / "package.py"
    command = [sys.executable, "-c", ENABLE, str(loader)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.stdout.split()[-1] == "False", done.stderr


def test_unregistering_ends_the_worker(analysed: bpy.types.Object) -> None:
    assert len(analysed.hangtime.contacts) > 0
    pid = worker_client.shared().pid
    assert pid is not None
    hangtime.unregister()
    try:
        assert worker_client.shared().pid is None
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)
    finally:
        hangtime.register()


@pytest.mark.usefixtures("_disabled")
def test_a_part_that_cannot_be_registered_takes_the_others_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refuse(*_: object) -> None:
        raise RuntimeError("no commands today")

    monkeypatch.setattr(bpy.utils, "register_cli_command", refuse)
    before = handlers()
    with pytest.raises(RuntimeError, match="no commands today"):
        hangtime.register()
    assert names_in_blender() == set()
    assert handlers() == before
    hangtime.unregister()  # has nothing to do, and does not fail


# ---------------------------------------------------------------- the main job


def test_the_landing_moves_and_the_recording_stays(analysed: bpy.types.Object) -> None:
    settings, recorded = analysed.hangtime, analysed.animation_data.action
    keys = snapshot(recorded, analysed)
    stance = settings.stances["ground 2"]
    stance.forward, stance.left, stance.up = OFFSET
    settings.keep_times = True  # so that the contacts' frames are still those of the rows
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    adapted = analysed.animation_data.action
    assert adapted != recorded
    assert adapted.hangtime.recording == recorded
    assert recorded.use_fake_user
    assert snapshot(recorded, analysed) == keys
    for row in landing(settings):
        moved = np.array(row.place) - np.array(row.found_at)
        assert np.linalg.norm(moved) == pytest.approx(np.linalg.norm(OFFSET), abs=1e-4)
        assert drift(analysed, row) < 0.002
    assert settings.status.startswith("Solved in")
    assert bpy.ops.hangtime.show_recording() == {"FINISHED"}
    assert analysed.animation_data.action == recorded
    assert bpy.ops.hangtime.show_adapted() == {"FINISHED"}
    assert analysed.animation_data.action == adapted


def test_settings_survive_saving_and_still_adapt(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    settings = analysed.hangtime
    settings.mass, settings.mass_table = 62.0, "DE_LEVA"
    settings.contacts[0].used = False
    settings.stances["ground 2"].up = 0.05
    name = analysed.name
    stored = SceneState.of(analysed)
    path = str(tmp_path / "jump.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    loaded = bpy.data.objects[name]
    assert SceneState.of(loaded) == stored
    assert (loaded.hangtime.mass, loaded.hangtime.mass_table) == (62.0, "DE_LEVA")
    assert bpy.context.scene.hangtime.armature == loaded
    loaded.hangtime.contacts[0].used = True
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}


def test_what_was_changed_is_kept_by_another_analysis(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    settings.contacts["Right heel 1"].used = False
    settings.contacts["Left heel 1"].end_frame = 120.0
    settings.stances["ground 2"].forward = 0.3
    settings.stances["ground 2"].turn = 0.2
    changed = SceneState.of(analysed).contacts
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    again = SceneState.of(analysed).contacts
    for one, other in zip(changed, again, strict=True):
        assert one[:2] == other[:2]
        np.testing.assert_allclose(one[2:], other[2:], atol=1e-5)
    assert settings.stances["ground 2"].forward == pytest.approx(0.3, abs=1e-5)
    assert settings.stances["ground 2"].turn == pytest.approx(0.2, abs=1e-5)


# ---------------------------------------------------------------- moving contacts


def test_a_contact_takes_its_stance_along(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    moved = landing(settings)[0]
    moved.place = np.add(moved.found_at, (0.1, -0.2, 0.3))
    for row in settings.contacts:
        shift = np.subtract(row.place, row.found_at)
        wanted = (0.1, -0.2, 0.3) if row.phase == "ground 2" else (0.0, 0.0, 0.0)
        np.testing.assert_allclose(shift, wanted, atol=1e-6)
    stance = settings.stances["ground 2"]
    forward = np.array(stance.forward_axis)
    assert stance.forward == pytest.approx(forward @ [0.1, -0.2, 0.3], abs=1e-6)
    assert stance.left == pytest.approx(np.cross([0, 0, 1], forward) @ [0.1, -0.2, 0.3], abs=1e-6)
    assert stance.up == pytest.approx(0.3, abs=1e-6)
    assert stance.turn == pytest.approx(0.0, abs=1e-6)


def test_a_contact_moves_alone_where_that_is_wished(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    settings.whole_stance = False
    moved, *others = landing(settings)
    moved.place = np.add(moved.found_at, (0.0, 0.0, 0.1))
    assert all(tuple(row.place) == tuple(row.found_at) for row in others)


def test_a_stance_turns_about_its_middle(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    stance, rows = settings.stances["ground 2"], landing(settings)
    stance.turn = np.pi / 2
    was = np.array([row.found_at for row in rows])
    now = np.array([row.place for row in rows])
    x, y, z = (was - was.mean(axis=0)).T
    np.testing.assert_allclose(now - now.mean(axis=0), np.stack([-y, x, z], axis=1), atol=1e-6)
    np.testing.assert_allclose(now.mean(axis=0), was.mean(axis=0), atol=1e-6)
    assert bpy.ops.hangtime.put_back.poll()
    settings.active_contact = settings.contacts.find(rows[0].name)
    assert bpy.ops.hangtime.put_back() == {"FINISHED"}
    assert stance.turn == 0.0
    assert all(tuple(row.place) == tuple(row.found_at) for row in rows)


def test_an_empty_carries_its_stance(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    first, second = landing(settings)[:2]
    for row in (first, second):
        settings.active_contact = settings.contacts.find(row.name)
        assert bpy.ops.hangtime.place_by_empty() == {"FINISHED"}
    np.testing.assert_allclose(first.empty.location, first.place, atol=1e-6)
    first.empty.location.x += 0.25
    bpy.context.view_layer.update()
    for row in landing(settings):
        np.testing.assert_allclose(np.subtract(row.place, row.found_at), (0.25, 0, 0), atol=1e-6)
    np.testing.assert_allclose(second.empty.location, second.place, atol=1e-6)
    second.place = second.found_at
    np.testing.assert_allclose(first.empty.location, first.found_at, atol=1e-6)
    first.empty.location.x += 0.25  # which the operator has to look at itself
    settings.keep_times = True
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    for row in landing(settings):
        np.testing.assert_allclose(np.subtract(row.place, row.found_at), (0.25, 0, 0), atol=1e-6)
        assert drift(analysed, row) < 0.002


def test_an_empty_that_was_deleted_is_replaced(analysed: bpy.types.Object) -> None:
    row = landing(analysed.hangtime)[0]
    analysed.hangtime.active_contact = analysed.hangtime.contacts.find(row.name)
    bpy.ops.hangtime.place_by_empty()
    for collection in row.empty.users_collection:
        collection.objects.unlink(row.empty)
    bpy.ops.hangtime.place_by_empty()
    assert row.empty.name in bpy.context.view_layer.objects
    np.testing.assert_allclose(row.empty.location, row.place, atol=1e-6)


def pins(armature: bpy.types.Object) -> dict[str, Pin]:
    """The pins that the settings ask for, by name."""
    recording = read_recorded(armature, FIRST, LAST)
    return {pin.name: pin for pin in problem_of(armature.hangtime, recording).pins}


def test_pins_call_contacts_what_they_are_called_after_the_corrections(
    analysed: bpy.types.Object,
) -> None:
    settings = analysed.hangtime
    settings.stances["ground 2"].up = 0.1
    assert pins(analysed)["Left heel 2"].touching == ("Left heel 2",)
    settings.contacts["Left heel 1"].used = False
    settings.contacts["Right toe 2"].start_frame = 236.0
    problem = problem_of(settings, read_recorded(analysed, FIRST, LAST))
    removed, later = problem.contacts
    assert (removed.name, removed.remove) == ("Left heel 1", True)
    assert (later.name, later.start_frame, later.end_frame) == ("Right toe 2", 236.0, None)
    pin = pins(analysed)["Left heel 2"]
    assert pin.touching == ("Left heel 1",)
    schedule = analyse(read_recorded(analysed, FIRST, LAST), problem).schedule
    assert "Left heel 1" in {c.name for c in schedule.contacts if c.start > 1.0}
    np.testing.assert_allclose(pin.place, settings.contacts["Left heel 2"].at, atol=1e-6)


def test_a_scene_of_other_units_is_read_in_metres(analysed: bpy.types.Object) -> None:
    bpy.context.scene.unit_settings.scale_length = 0.5
    settings = analysed.hangtime
    settings.stances["ground 2"].up = 0.1
    place = pins(analysed)["Left heel 2"].place
    np.testing.assert_allclose(place, 0.5 * np.array(settings.contacts["Left heel 2"].at))


# ---------------------------------------------------------------- what cannot be done


def no_armature(_armature: bpy.types.Object) -> None:
    bpy.context.view_layer.objects.active = None


def another_object(_armature: bpy.types.Object) -> None:
    empty = bpy.data.objects.new("Cube", None)
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.objects.active = empty


def no_action(armature: bpy.types.Object) -> None:
    armature.animation_data.action = None


def empty_action(armature: bpy.types.Object) -> None:
    armature.animation_data.action = bpy.data.actions.new("Nothing")


def edit_mode(_armature: bpy.types.Object) -> None:
    bpy.ops.object.mode_set(mode="EDIT")


def too_short(armature: bpy.types.Object) -> None:
    armature.hangtime.last_frame = FIRST + 10


def bad_scale(armature: bpy.types.Object) -> None:
    armature.scale = (1.0, 1.0, -1.0)


def infinite_key(armature: bpy.types.Object) -> None:
    snapshot_curve(armature).keyframe_points[90].co.y = float("nan")


def snapshot_curve(armature: bpy.types.Object) -> bpy.types.FCurve:
    return next(c for c in curves_of(armature) if "LeftUpLeg" in c.data_path)


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (no_armature, "No armature is chosen"),
        (another_object, "“Cube” is or holds no armature"),
        (no_action, "has no keyframes"),
        (empty_action, "has no keyframes"),
        (edit_mode, "Leave edit mode first"),
        (too_short, "Only 0.08 s of the recording"),
        (bad_scale, "must be the same, and above zero"),
        (infinite_key, "LeftUpLeg” has a value at frame"),
    ],
)
def test_what_cannot_be_analysed_is_said_and_changes_nothing(
    armature: bpy.types.Object, spoil: Callable[[bpy.types.Object], None], says: str
) -> None:
    spoil(armature)
    before = SceneState.of(armature)
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.hangtime.analyze()
    assert says in str(caught.value)
    assert "Traceback" not in str(caught.value)
    assert SceneState.of(armature) == before


def test_a_clip_without_a_flight_is_analysed(armature: bpy.types.Object) -> None:
    armature.hangtime.last_frame = 150
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert [phase.name for phase in phases_of(armature.hangtime)] == ["ground 1"]


def contradiction(armature: bpy.types.Object) -> None:
    armature.hangtime.whole_stance = False
    row = landing(armature.hangtime)[0]
    row.place = np.add(row.place, (0.0, 0.0, 0.2))


def moved_armature(armature: bpy.types.Object) -> None:
    armature.location.x += 1.0


def other_range(armature: bpy.types.Object) -> None:
    armature.hangtime.last_frame += 5


def no_contacts(armature: bpy.types.Object) -> None:
    armature.hangtime.contacts.clear()


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (edit_mode, "Leave edit mode first"),
        (no_contacts, "Press Analyze first"),
        (contradiction, "contradict each other by"),
        (moved_armature, "press Analyze again"),
        (other_range, "press Analyze again"),
    ],
)
def test_what_cannot_be_adapted_is_said_and_changes_nothing(
    analysed: bpy.types.Object, spoil: Callable[[bpy.types.Object], None], says: str
) -> None:
    spoil(analysed)
    before = SceneState.of(analysed)
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.hangtime.adapt()
    assert says in str(caught.value)
    assert "Traceback" not in str(caught.value)
    assert SceneState.of(analysed) == before


def test_a_worker_killed_in_the_middle_is_told(analysed: bpy.types.Object) -> None:
    before = SceneState.of(analysed)

    def kill() -> None:
        while not worker_client.shared().busy:
            time.sleep(0.01)
        os.kill(worker_client.shared().pid, 9)

    killer = threading.Thread(target=kill)
    killer.start()
    with pytest.raises(RuntimeError, match="solver stopped without an answer"):
        bpy.ops.hangtime.adapt()
    killer.join()
    assert SceneState.of(analysed) == before


def test_a_result_for_keys_that_changed_meanwhile_is_thrown_away(
    analysed: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    def edited_while_waiting(job: worker_client.PendingRequest) -> object:
        answer = wait(job)
        snapshot_curve(analysed).keyframe_points[120].co.y += 0.1
        return answer

    wait = worker_client.PendingRequest.wait
    monkeypatch.setattr(worker_client.PendingRequest, "wait", edited_while_waiting)
    before = SceneState.of(analysed)
    with pytest.raises(RuntimeError, match="The result was thrown away"):
        bpy.ops.hangtime.adapt()
    assert SceneState.of(analysed) == before


# ---------------------------------------------------------------- requests


def ask_by_text(armature: bpy.types.Object, text: str) -> None:
    asked = bpy.data.texts.new("Requests")
    asked.from_string(text)
    armature.hangtime.requests = asked


def test_a_text_of_requests_is_met(analysed: bpy.types.Object) -> None:
    ask_by_text(
        analysed,
        '[[torque]]\nname = "Weak ankle"\nbones = ["RightFoot"]\nbound = 60\n'
        'phase = "ground 1"\n[[load]]\nname = "Briefcase"\nbone = "RightHand"\nshare = 0.1\n',
    )
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert analysed.animation_data.action.name.endswith("adapted")
    problem = problem_of(analysed.hangtime, read_recorded(analysed, FIRST, LAST))
    assert [limit.name for limit in problem.requests.torques] == ["Weak ankle"]
    assert [load.share for load in problem.requests.body.added] == [0.1]


def test_a_longer_jump_has_more_frames(analysed: bpy.types.Object) -> None:
    analysed.hangtime.stances["ground 2"].forward = 0.2
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    adapted = analysed.animation_data.action
    assert adapted.frame_range[1] > LAST + 3
    assert "Flight 1: 0.5" in analysed.hangtime.status
    assert "Flight 1    takes 0." in adapted.hangtime.report


def test_times_are_kept_where_that_is_chosen(analysed: bpy.types.Object) -> None:
    recording = read_recorded(analysed, FIRST, LAST)
    assert not problem_of(analysed.hangtime, recording).requests.solution.keep_times
    analysed.hangtime.keep_times = True
    ask_by_text(analysed, "[solution]\nlongest_span = 0.1\n")
    solution = problem_of(analysed.hangtime, recording).requests.solution
    assert (solution.keep_times, solution.longest_span) == (True, 0.1)


def test_limbs_keep_out_unless_switched_off(analysed: bpy.types.Object) -> None:
    recording = read_recorded(analysed, FIRST, LAST)
    assert problem_of(analysed.hangtime, recording).requests.solution.solid
    analysed.hangtime.keep_out = False
    assert not problem_of(analysed.hangtime, recording).requests.solution.solid
    analysed.hangtime.keep_out = True
    ask_by_text(analysed, "[solution]\nsolid = false\n")
    assert not problem_of(analysed.hangtime, recording).requests.solution.solid


def test_joints_are_a_person_s_unless_switched_off(analysed: bpy.types.Object) -> None:
    recording = read_recorded(analysed, FIRST, LAST)
    assert problem_of(analysed.hangtime, recording).requests.solution.human
    analysed.hangtime.human_ranges = False
    assert not problem_of(analysed.hangtime, recording).requests.solution.human
    analysed.hangtime.human_ranges = True
    ask_by_text(analysed, "[solution]\nhuman = false\n")
    assert not problem_of(analysed.hangtime, recording).requests.solution.human


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[[torque]]\nname = "Weak"\nbones = ["Tail"]\nbound = 5\n', "Weak.*Tail"),
        ('[[cone]]\nbone = "LeftArm"\n', "line 1"),
        ('[[pose]]\nname = "Tuck"\nphase = "flight 7"\n', "Tuck.*flight 7"),
    ],
)
def test_a_wrong_request_is_said_and_changes_nothing(
    analysed: bpy.types.Object, text: str, words: str
) -> None:
    ask_by_text(analysed, text)
    before = SceneState.of(analysed)
    with pytest.raises(RuntimeError, match=words):
        bpy.ops.hangtime.adapt()
    assert SceneState.of(analysed) == before


def test_longer_limbs_perform_on_an_armature_of_their_own(analysed: bpy.types.Object) -> None:
    bones = '["LeftUpLeg", "RightUpLeg", "LeftLeg", "RightLeg"]'
    ask_by_text(analysed, f'[[limb]]\nname = "Long legs"\nbones = {bones}\nlength = 1.15\n')
    recorded = analysed.animation_data.action
    keys = snapshot(recorded, analysed)
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert snapshot(recorded, analysed) == keys
    other = bpy.data.objects[f"{analysed.name} changed"]
    longer = other.data.bones["LeftLeg"].length / analysed.data.bones["LeftLeg"].length
    scale = analysed.matrix_world.median_scale
    assert longer == pytest.approx(1.15 * scale, rel=0.01)
    assert other.animation_data.action is not None
