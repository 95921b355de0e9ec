"""Actions of the scenarios by mouse and keys, and queries of the installed extension's state."""

from __future__ import annotations

import importlib
import os
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import bpy

from .driver import Actions, Driver, Until
from .screen import present, window_manager

if TYPE_CHECKING:  # the Blender with the window sees devtools and the installed zip alone
    from ....bridge.properties.action import HangtimeAction
    from ....bridge.properties.contact import HangtimeStance
    from ....bridge.properties.settings import HangtimeScene, HangtimeSettings
    from ....operators.solve.solving import Solving

PACKAGE = "bl_ext.user_default.hangtime"
FOLDER = "/user_default/hangtime/"  # in the path of each of its files
CATEGORY = "Hangtime"
CLIP = Path("/mnt/recordings/forward_jump_116cm.bvh")
RIG = "Rigify"  # in place of the clip's armature, once its file is open
SCALE = 0.05644  # metres per unit of the recording
LANDING = "ground 2"
VALUE = 0.7  # where a number's field is, in the sidebar's width
ASIDE = 0.93  # where the buttons beside a list are
ROW = 20  # pixels from one of them to the next
CHECKBOX = 0.12  # where a list's row has its checkbox, in the same


def extension_module(name: str) -> ModuleType:
    """A module of the installed extension."""
    return importlib.import_module(f"{PACKAGE}.{name}")


def armature() -> bpy.types.Object:
    """The imported recording's armature, or the rig that performs."""
    found = bpy.data.objects.get(CLIP.stem)
    return found if found is not None else bpy.data.objects[RIG]


def shown_action() -> bpy.types.Action:
    """The action that the armature performs."""
    return present(present(armature().animation_data).action)


def curves_of(action: bpy.types.Action) -> list[bpy.types.FCurve]:
    """The F-curves of a take; Blender 5.0 and later have them in slots alone."""
    found: list[bpy.types.FCurve] = extension_module("bridge.action_slots").all_curves(action)
    return found


def show_action(action: bpy.types.Action) -> None:
    """Have the armature perform an action."""
    present(armature().animation_data).action = action


def pose_bone(name: str) -> bpy.types.PoseBone:
    """A bone of the armature in its pose."""
    return present(armature().pose).bones[name]


def select_alone(name: str) -> None:
    """Make a bone the active one, and the only one that is selected in pose mode."""
    for bone in present(armature().pose).bones:  # what is selected went to the pose in Blender 5.0
        holder = bone if hasattr(bone, "select") else bone.bone
        holder.select = bone.name == name
    data = armature().data
    assert isinstance(data, bpy.types.Armature)
    data.bones.active = data.bones[name]


def active_bone() -> str | None:
    """The name of the bone that was selected last."""
    data = armature().data
    assert isinstance(data, bpy.types.Armature)
    return data.bones.active.name if data.bones.active is not None else None


def current_scene() -> bpy.types.Scene:
    """Blender's scene."""
    return present(bpy.context.scene)


def settings() -> HangtimeSettings:
    """The extension's settings of the armature."""
    found: HangtimeSettings = armature().hangtime  # type: ignore[attr-defined]  # registered by it
    return found


def origin(action: bpy.types.Action) -> HangtimeAction:
    """The extension's settings of an action: its recording, whether it was accepted."""
    found: HangtimeAction = action.hangtime  # type: ignore[attr-defined]  # registered by it
    return found


def scene_settings() -> HangtimeScene:
    """The extension's settings of the scene."""
    found: HangtimeScene = current_scene().hangtime  # type: ignore[attr-defined]  # registered by it
    return found


def landing() -> HangtimeStance:
    """The stance after the flight."""
    found: HangtimeStance = settings().stances[LANDING]
    return found


def landing_field(name: str) -> str:
    """The end of the data path of a number of the landing's stance."""
    return f"stances[{settings().stances.find(LANDING)}].{name}"


def solving() -> Solving | None:
    """The extension's solve under way."""
    found: Solving | None = extension_module("operators.solve.session").session().solving
    return found


def idle() -> bool:
    """Neither the worker nor an operator of ours has anything under way."""
    modal = window_manager().windows[0].modal_operators
    ours = [operator for operator in modal if operator.bl_idname.startswith("HANGTIME_OT")]
    worker = extension_module("bridge.worker_client").shared()
    return not (ours or solving() is not None or worker.busy)


def solve_stage() -> str:
    """Stage of the solve under way: "fit", "solve", "write-back"; "" while there is none."""
    now = solving()
    if now is None:
        return ""
    state, progress = now.state.name, now.progress
    if state in ("CHECKING", "WRITING", "ENDED"):
        return "write-back"
    early = progress is None or progress.stage in ("fit", "refine")
    return "fit" if early and state != "STOPPING" else "solve"


def worker_pid() -> int | None:
    """The worker's process, which is Blender's only child that runs our program."""
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                words = (folder / "cmdline").read_bytes()
            except OSError:  # it has just ended
                continue
            if b"solver/worker/program.py" in words:
                return int(folder.name)
    return None


def worker_seconds() -> float:
    """Processor time, s, that the worker has taken so far."""
    user, system = Path(f"/proc/{worker_pid()}/stat").read_text().rpartition(")")[2].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


def press(driver: Driver, what: str, *columns: float) -> Actions:
    """Click the sidebar's button of that command or property."""
    place = yield from driver.screen.find_button(what, *columns)
    yield driver.input.click(place, what)
    yield 0.1


def open_panel(driver: Driver, panel: str) -> Actions:
    """Open a closed panel that is among the last: click what is no button, from the foot upwards,
    until it is drawn. panel: its class's name."""
    yield from driver.screen.scroll_down()
    driver.profiler.start(lambda: panel)
    for place in (yield from driver.screen.blanks()):
        yield driver.input.click(place, f"the panel {panel}")
        yield 0.2
        if f"{panel}.draw" in driver.profiler.profiles[panel].calls:
            break
    driver.profiler.stop()
    del driver.profiler.profiles[panel]
    driver.screen.forget()


def choose_row(driver: Driver, row: int) -> Actions:
    """Click a row of the list of contacts."""
    x, y = yield from driver.screen.find_button(f"contacts[{row}].used", CHECKBOX)
    yield driver.input.click((x + 60, y), f"contact {row}")
    yield 0.2


def fill_in(driver: Driver, what: str, text: str) -> Actions:
    """Type into a number field of the sidebar."""
    place = yield from driver.screen.find_button(what, VALUE)
    yield driver.input.click(place, what)
    yield 0.2
    yield driver.input.key("ctrl+a")
    yield driver.input.type(text)
    yield driver.input.key("Return")
    yield 0.3


def over_viewport(driver: Driver, *keys: str) -> Actions:
    """Press keys with the pointer in the viewport."""
    yield driver.input.move(driver.screen.free_place())
    yield 0.05
    yield driver.input.key(*keys)
    yield 0.3


def search(driver: Driver, words: str) -> Actions:
    """Run what F3 finds first."""
    yield from over_viewport(driver, "F3")
    yield 1.0  # letters that come before it is open would go to the viewport
    yield driver.input.type(words)
    yield 0.4
    yield driver.input.key("Return")
    yield 0.3


def dialog(driver: Driver, path: Path, **values: object) -> Actions:
    """Fill in the open file dialog, its own settings included, and confirm it.

    By Python: typing a path into a dialog is Blender's business and tells nothing of ours.
    """
    yield Until("the file dialog", lambda: driver.screen.has("FILE_BROWSER"))
    yield 0.5
    browser = driver.screen.area("FILE_BROWSER").spaces[0]
    assert isinstance(browser, bpy.types.SpaceFileBrowser)
    file, operator = present(browser.params), present(browser.active_operator)
    file.directory = str(path.parent).encode()
    file.filename = path.name
    for name, value in values.items():
        setattr(operator.properties, name, value)
    yield 0.3
    yield driver.input.move(driver.screen.middle(area="FILE_BROWSER"))
    yield driver.input.key("Return")
    yield Until("the dialog's end", lambda: not driver.screen.has("FILE_BROWSER"), 30)
