"""A take that is to be back by a frame of the range, of which only a part is adapted."""

from __future__ import annotations

import re

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.files.import_clip import import_clip
from hangtime.devtools.recordings import HOPS
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import snapshot
from hangtime.tests.helpers.clips import mocap_path

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.mark.slow
def test_it_is_back_by_a_frame_after_those_that_are_adapted() -> None:
    rigs.reset()
    armature = import_clip(mocap_path(HOPS)).armature
    settings, recorded = armature.hangtime, current_action(armature)
    keys = snapshot(recorded, armature)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    settings.stances["ground 3"].forward = 0.2
    settings.result.after, settings.result.use_return_frame = "RETURN", True
    settings.result.return_frame = 900
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    back = re.search(r"back where it was at frame (\d+)", settings.status)
    assert back is not None, settings.status
    assert 900 <= int(back[1]) < 950  # the recording's 900, as durations grew
    first = settings.adapted
    settings.result.return_frame = 450
    with pytest.raises(RuntimeError, match="is to be back by frame 450, but is adapted until"):
        bpy.ops.hangtime.adapt()
    assert settings.adapted == first
    assert snapshot(recorded, armature) == keys
