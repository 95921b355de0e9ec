"""A file that an earlier state of the extension saved opens with all that it holds, and adapts.

tests/data/make_saved_settings.py made it and says what is in it; the .json beside it is what that
state read in it. What is stored since then may be more, but not less or other.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.repairs.analysis_key import analysis_is_of, analysis_key
from hangtime.operators.solve.adapt import read_wanted
from hangtime.tests.blender.helpers import stored
from hangtime.tests.blender.helpers.rows import asked

DATA = Path(__file__).parents[1] / "data"
STEP = 3  # frames from one look at the pose to the next
# Of joint centres, m. The stored motion is of a state that knew less of forces and soles: the
# performance is the same, the motion is not.
FURTHEST, RMS = 0.15, 0.03

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def performer() -> bpy.types.Object:
    """The armature of the saved file, which has just been opened."""
    bpy.ops.wm.open_mainfile(filepath=str(DATA / "saved_settings.blend"))
    return bpy.context.scene.hangtime.armature


def joint_centres(armature: bpy.types.Object) -> np.ndarray:
    """(T, B, 3) m, world: the bones' heads in the action that is shown, now and then."""
    first, last = armature.animation_data.action.frame_range
    frames = np.arange(first, last + 1.0, STEP)
    return np.array([heads(armature, int(frame)) for frame in frames])


def heads(armature: bpy.types.Object, frame: int) -> list[tuple[float, ...]]:
    bpy.context.scene.frame_set(frame)
    return [tuple(armature.matrix_world @ bone.head) for bone in armature.pose.bones]


def test_a_contact_still_moves_alone_where_that_was_wished(performer: bpy.types.Object) -> None:
    """By the checkbox in whose place a choice is now."""
    assert performer.hangtime.moves == "CONTACT"
    assert bpy.data.objects["Ball"].hangtime.moves == "AUTO"


def test_a_normal_still_counts_where_nobody_could_say_whether(performer: bpy.types.Object) -> None:
    """The row has no bounds along the surface, and there was no Custom Normal to choose."""
    row = performer.hangtime.constraints["Hand on wall"]
    row.used = True
    (wall,) = (each for each in asked(performer).points if each.name == row.name)
    assert wall.normal == pytest.approx((0.0, 0.6, 0.8))
    assert row.use_normal
    row.use_normal = False
    (wall,) = (each for each in asked(performer).points if each.name == row.name)
    assert wall.normal is None


@pytest.mark.usefixtures("performer")
def test_every_setting_is_read_as_it_was_saved() -> None:
    saved = json.loads((DATA / "saved_settings.json").read_text(encoding="utf-8"))
    now = stored.stored()
    different = {
        f"{path}: {name}": (value, now.get(path, {}).get(name, "not there"))
        for path, values in saved.items()
        for name, value in values.items()
        if now.get(path, {}).get(name, "not there") != value
    }
    assert different == {}


def test_renamed_bones_are_found_by_their_keys(performer: bpy.types.Object) -> None:
    (bone,) = performer.hangtime.constraints["Forearm twist"].bones
    assert bone.called not in performer.data.bones
    assert bone.name in performer.data.bones


@pytest.mark.slow
def test_it_adapts_again_to_the_same_performance(performer: bpy.types.Object) -> None:
    settings = performer.hangtime
    settings.keep_times = True  # as that state always did
    settings.keep_out = settings.human_ranges = False
    settings.result.after = "CUT"
    recording = complete(read_wanted(performer))
    if not analysis_is_of(settings, recording):
        # That state's key is of every bit of the poses, and of another processor's.
        settings.analysed = analysis_key(settings, recording)
    saved, before = settings.adapted, joint_centres(performer)
    assert performer.animation_data.action == saved
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert performer.animation_data.action == settings.adapted != saved
    assert settings.status.startswith("Solved in")
    assert "missed" not in settings.status  # nor what the text asks for
    rows = (*settings.constraints, *settings.body_changes)
    assert {row.name: row.met for row in rows} == {
        row.name: "MET" if row.used else "UNKNOWN" for row in rows
    }
    off = np.linalg.norm(joint_centres(performer) - before, axis=-1)
    assert off.max() < FURTHEST
    assert np.sqrt((off**2).mean()) < RMS
