"""Every test begins with an empty scene."""

from __future__ import annotations

import pytest

pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.tests.blender.helpers import rigs


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    rigs.reset()
