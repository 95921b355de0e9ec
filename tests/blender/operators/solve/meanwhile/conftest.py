"""Work is under way, and has ended."""

from __future__ import annotations

from collections.abc import Iterator

import pytest


@pytest.fixture
def _solving() -> Iterator[None]:
    import bpy
    from hangtime.operators.solve.session import session
    from hangtime.operators.solve.solving import Solving

    session().solving = Solving()
    yield
    session().solving = None
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
