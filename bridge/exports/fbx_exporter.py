"""What Blender's FBX exporter would have wrong in a file, put right."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

from mathutils import Vector

from .baked_rig import SCALE_NOISE

_TIME = rb"%sS\x05\x00\x00\x00KTimeS\x04\x00\x00\x00TimeS\x00\x00\x00\x00L(.{8})"


@contextmanager
def plain_scales() -> Iterator[None]:
    """Context in which the exporter writes scales that are 1 as 1; of the rounding in its matrices
    it makes curves that vary, which other programs take for animated scales."""
    wrapper: Any = import_module("io_scene_fbx.fbx_utils").ObjectWrapper
    exported = wrapper.fbx_object_tx

    def rounded(*args: Any, **options: Any) -> tuple[Any, ...]:
        place, turn, scale, *matrices = exported(*args, **options)
        plain = Vector([1.0 if abs(each - 1.0) < SCALE_NOISE else each for each in scale])
        return place, turn, plain, *matrices

    wrapper.fbx_object_tx = rounded
    try:
        yield
    finally:
        wrapper.fbx_object_tx = exported


def span_takes(path: Path) -> None:
    """Have a file's span of time end with its longest take, for programs that take their timeline
    from it. Blender writes a second; a file that tells no span is whole without."""
    said = path.read_bytes()
    ends = re.findall(_TIME % b"LocalStop", said, re.DOTALL)
    span = re.search(_TIME % b"TimeSpanStop", said, re.DOTALL)
    if span is None or not ends:
        return
    last = max(ends, key=lambda end: int.from_bytes(end, "little", signed=True))
    path.write_bytes(said[: span.start(1)] + last + said[span.end(1) :])
