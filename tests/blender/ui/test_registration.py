"""The extension is enabled and disabled, in the bpy module."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

import hangtime
from hangtime.bridge import worker_client
from hangtime.bridge.accessors import ATTRIBUTE
from hangtime.bridge.properties.attached_groups import CARRIERS, ensure_groups
from hangtime.operators.names import OperatorId
from hangtime.tests.blender.helpers import rigs
from hangtime.ui import registration

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def _disabled() -> Iterator[None]:
    """As before the extension was enabled."""
    hangtime.unregister()
    rigs.reset()
    yield
    hangtime.register()


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


@pytest.mark.usefixtures("_disabled")
def test_it_is_enabled_after_a_command_ran_without_it() -> None:
    """A script may run a command, which reads and writes settings, and enable it afterwards."""
    ensure_groups()
    scene = bpy.context.scene
    armature = bpy.data.objects.new("Jumper", bpy.data.armatures.new("Jumper"))
    scene.collection.objects.link(armature)
    armature.hangtime.mass = 63.0
    hangtime.register()
    assert armature.hangtime.mass == 63.0
    assert names_in_blender() == every_name()
    hangtime.unregister()
    assert not names_in_blender()


@pytest.mark.usefixtures("_disabled")
@pytest.mark.slow
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
        for carrier in CARRIERS:
            assert not hasattr(carrier, ATTRIBUTE)


@pytest.mark.usefixtures("_disabled")
def test_a_script_that_empties_blenders_handlers_does_not_keep_it_from_being_disabled() -> None:
    hangtime.register()
    for name in ("depsgraph_update_post", "load_post", "save_pre"):
        getattr(bpy.app.handlers, name).clear()
    hangtime.unregister()
    assert names_in_blender() == set()


ENABLE = """
import runpy, sys
runpy.run_path(sys.argv[1])["load"]().register()
from hangtime.operators.words import messages, report_text
print({"casadi", "scipy_openblas32"} & set(sys.modules), flush=True)
import os
os._exit(0)
"""


def test_the_solver_stays_out_of_blenders_own_process() -> None:
    """Loading CasADi takes a third of a second, in which Blender would stand still."""
    loader = Path(__file__).parents[3] / "devtools" / "package.py"
    command = [sys.executable, "-c", ENABLE, str(loader)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.stdout.splitlines()[-1] == "set()", done.stderr


@pytest.mark.slow
def test_unregistering_ends_the_worker(jump: bpy.types.Object) -> None:
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert len(jump.hangtime.contacts) > 0
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
