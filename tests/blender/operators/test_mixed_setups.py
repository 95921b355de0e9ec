"""Takes and files that are odd in several ways at once, drawn by chance: analysed and adapted as an
artist would, and the take is found again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.action_slots import all_curves
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.keys_digest import keys_digest
from hangtime.bridge.armature.poses import Poses, sample
from hangtime.bridge.rows.choices import WrittenAs
from hangtime.bridge.takes.takes import show_take
from hangtime.tests.helpers.clips import JUMP_FRAMES

RATE = 120.0  # frames a second of the recording
UNKEYED = ("LeftHand", "Head", "RightToeBase")
RAISED = 0.06  # m
FORMS = [form for form in WrittenAs if form is not WrittenAs.SLOT or bpy.app.version >= (4, 5)]

pytestmark = [pytest.mark.usefixtures("_enabled"), pytest.mark.slow]


@dataclass(frozen=True)
class Setup:
    """rate: frames a second. start: the scene's frame of the recording's first. unit: m per Blender
    unit. parent: "" for none. speed: of the strip that plays the take, 0 for none."""

    rate: float
    start: float
    unit: float
    parent: str
    speed: float
    keyless: bool
    written_as: WrittenAs
    keys: str
    after: str

    @staticmethod
    def drawn(seed: int) -> Setup:
        rng = np.random.default_rng(seed)

        def one(*of: object) -> object:
            return of[rng.integers(len(of))]

        return Setup(
            one(24.0, 29.97, 60.0, 240.0),
            one(0.0, -57.0, 12.5, 1000.37),
            one(1.0, 0.01, 100.0),
            one("", "scaled", "moving"),
            one(0.0, 1.0, 1.25),
            one(True, False),
            one(*FORMS),
            one("EVERY_FRAME", "REDUCED"),
            one("CARRY", "RETURN", "CUT"),
        )

    def of(self, frame: float) -> float:
        """The scene's frame of one of the recording's."""
        own = (frame - 1.0) * self.rate / RATE + self.start
        return own if self.speed == 0.0 else (own - self.start) / self.speed + self.start + 30.0

    def made(self, armature: bpy.types.Object) -> None:
        """Change a file with the recorded jump so."""
        action, scene = current_action(armature), bpy.context.scene
        for curve in all_curves(action):
            fcurves.scale_keys(curve, self.rate / RATE, 1.0)
            for key in curve.keyframe_points:
                key.co_ui.x += self.start - self.rate / RATE
            curve.update()
        if self.keyless:
            curves = fcurves.holder(armature)
            for curve in [c for c in curves.fcurves if fcurves.bone_of(c.data_path) in UNKEYED]:
                curves.fcurves.remove(curve)
        scene.unit_settings.scale_length = self.unit
        armature.scale = np.array(armature.scale) / self.unit
        armature.location = np.array(armature.location) / self.unit
        if self.parent:
            self._put_under_a_parent(armature)
        if self.speed:
            self._laid_into_a_strip(armature, action)
        shown = self.rate / (self.speed or 1.0)
        scene.render.fps, scene.render.fps_base = round(shown), round(shown) / shown

    def _put_under_a_parent(self, armature: bpy.types.Object) -> None:
        parent = bpy.data.objects.new("Cart", None)
        bpy.context.scene.collection.objects.link(parent)
        parent.rotation_euler.z, parent.location.x = 0.8, 3.0 / self.unit
        if self.parent == "scaled":
            parent.scale, armature.scale = (2.0, 2.0, 2.0), np.array(armature.scale) / 2.0
        else:
            for frame, y in zip(JUMP_FRAMES, (0.0, 0.05), strict=True):
                parent.location.y = y / self.unit
                parent.keyframe_insert("location", frame=self.of(frame))
        armature.parent = parent

    def _laid_into_a_strip(self, armature: bpy.types.Object, action: bpy.types.Action) -> None:
        data = armature.animation_data
        strip = data.nla_tracks.new().strips.new("Mine", int(self.start), action)
        data.action = None
        first, last = strip.action_frame_start, strip.action_frame_end
        strip.scale = 1.0 / self.speed
        strip.frame_start = self.start + 30.0 + (first - self.start) / self.speed
        strip.frame_end = strip.frame_start + (last - first) / self.speed


@pytest.mark.parametrize("seed", range(8))
def test_a_take_that_is_odd_in_several_ways_is_adapted_and_found_again(
    jump: bpy.types.Object, seed: int
) -> None:
    setup = Setup.drawn(seed)
    setup.made(jump)
    first, last = (setup.of(frame) for frame in JUMP_FRAMES)
    frames = np.unique(np.round(np.linspace(first - 40.0, last + 40.0, 40)))
    settings, take = jump.hangtime, current_action(jump)
    settings.first_frame, settings.last_frame = int(np.ceil(first)), int(np.floor(last))
    before, keys = sample(jump, frames), keys_digest(take)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    settings.stances["ground 2"].up = RAISED / setup.unit
    settings.result.written_as, settings.result.after = setup.written_as.name, setup.after
    settings.result_keys.on = setup.keys
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    result, adapted = current_action(jump), sample(jump, frames)
    assert result != take
    lifted = heights(adapted, setup) - heights(before, setup)
    assert lifted[frames <= last][-1] == pytest.approx(RAISED, abs=0.01)
    if setup.after != "CUT":
        blended = 0.3 * setup.rate / (setup.speed or 1.0)
        np.testing.assert_allclose(lifted[frames < first - blended], 0.0, atol=1e-5)
    show_take(jump, take)
    np.testing.assert_array_equal(sample(jump, frames).matrices, before.matrices)
    assert keys_digest(take) == keys
    show_take(jump, result)
    again = sample(jump, frames).matrices
    np.testing.assert_allclose(again, adapted.matrices, atol=1e-5 * np.abs(again).max())


def heights(poses: Poses, setup: Setup) -> np.ndarray:
    """(T,) m, of the left foot, which stands as it stood but for where it is."""
    world = poses.object_to_world @ poses.matrices[:, poses.bones.index("LeftFoot")]
    return setup.unit * world[:, 2, 3]
