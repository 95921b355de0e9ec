"""What the scenes do with mouse and keys, and what they ask the installed extension."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import bpy

from .stage import Acting, Stage, Until

PACKAGE = "bl_ext.user_default.hangtime"
CATEGORY = "Hangtime"
CLIP = Path("/mnt/recordings/forward_jump_116cm.bvh")
SCALE = 0.05644  # metres per unit of the recording
LANDING = "ground 2"
VALUE = 0.7  # where a number's field is, in the sidebar's width
ASIDE = 0.93  # where the buttons beside a list are
ROW = 20  # pixels from one of them to the next
CHECKBOX = 0.12  # where a list's row has its checkbox, in the same


def part(name: str) -> ModuleType:
    """A module of the installed extension."""
    return importlib.import_module(f"{PACKAGE}.{name}")


def armature() -> bpy.types.Object:
    """The imported recording's armature."""
    return bpy.data.objects[CLIP.stem]


def shown_action() -> bpy.types.Action:
    """The action that the armature performs."""
    return armature().animation_data.action


def landing() -> bpy.types.PropertyGroup:
    """The stance after the flight."""
    return armature().hangtime.stances[LANDING]


def landing_field(name: str) -> str:
    """The end of the data path of a number of the landing's stance."""
    return f"stances[{armature().hangtime.stances.find(LANDING)}].{name}"


def idle() -> bool:
    """Neither the worker nor an operator of ours has anything under way."""
    modal = bpy.context.window_manager.windows[0].modal_operators
    ours = [operator for operator in modal if operator.bl_idname.startswith("HANGTIME_OT")]
    solving = part("operators.solve.session").session().solving
    return not ours and solving is None and not part("bridge.worker_client").shared().busy


def doing() -> str:
    """What a solve under way is at: "fit", "solve", "write-back"; "" while there is none."""
    solving = part("operators.solve.session").session().solving
    if solving is None:
        return ""
    state, progress = solving.state.name, solving.progress
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
            if b"solver/worker/main.py" in words:
                return int(folder.name)
    return None


def press(stage: Stage, what: str, *columns: float) -> Acting:
    """Click the sidebar's button of that command or property."""
    place = yield from stage.eyes.find_button(what, *columns)
    yield stage.hands.click(place, what)
    yield 0.1


def open_panel(stage: Stage, panel: str) -> Acting:
    """Open a closed panel that is among the last: click what is no button, from the foot upwards,
    until it is drawn. panel: its class's name."""
    yield from stage.eyes.scroll_down()
    stage.gauge.start(lambda: panel)
    for place in (yield from stage.eyes.blanks()):
        yield stage.hands.click(place, f"the panel {panel}")
        yield 0.2
        if f"{panel}.draw" in stage.gauge.stretches[panel].calls:
            break
    stage.gauge.stop()
    del stage.gauge.stretches[panel]
    stage.eyes.forget()


def choose_row(stage: Stage, row: int) -> Acting:
    """Click a row of the list of contacts."""
    x, y = yield from stage.eyes.find_button(f"contacts[{row}].used", CHECKBOX)
    yield stage.hands.click((x + 60, y), f"contact {row}")
    yield 0.2


def fill_in(stage: Stage, what: str, text: str) -> Acting:
    """Type into a number field of the sidebar."""
    place = yield from stage.eyes.find_button(what, VALUE)
    yield stage.hands.click(place, what)
    yield 0.2
    yield stage.hands.key("ctrl+a")
    yield stage.hands.type(text)
    yield stage.hands.key("Return")
    yield 0.3


def over_viewport(stage: Stage, *keys: str) -> Acting:
    """Press keys with the pointer in the viewport."""
    yield stage.hands.move(stage.eyes.free_place())
    yield 0.05
    yield stage.hands.key(*keys)
    yield 0.3


def search(stage: Stage, words: str) -> Acting:
    """Run what F3 finds first."""
    yield from over_viewport(stage, "F3")
    yield 1.0  # letters that come before it is open would go to the viewport
    yield stage.hands.type(words)
    yield 0.4
    yield stage.hands.key("Return")
    yield 0.3


def dialog(stage: Stage, path: Path, **values: object) -> Acting:
    """Fill in the open file dialog, its own settings included, and confirm it.

    By Python: typing a path into a dialog is Blender's business and tells nothing of ours.
    """
    yield Until("the file dialog", lambda: stage.eyes.has("FILE_BROWSER"))
    yield 0.5
    browser = stage.eyes.area("FILE_BROWSER").spaces[0]
    browser.params.directory = str(path.parent).encode()
    browser.params.filename = path.name
    for name, value in values.items():
        setattr(browser.active_operator.properties, name, value)
    yield 0.3
    yield stage.hands.move(stage.eyes.middle(area="FILE_BROWSER"))
    yield stage.hands.key("Return")
    yield Until("the dialog's end", lambda: not stage.eyes.has("FILE_BROWSER"), 30)
