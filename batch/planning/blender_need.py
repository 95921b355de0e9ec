"""Whether a cell needs Blender."""

from __future__ import annotations

from collections.abc import Collection
from importlib.util import find_spec
from pathlib import Path

from ..records.faults import WrongPlan
from ..records.manifest import Output

WITHOUT_BLENDER = (".bvh", ".amc")  # clips that are read without it


def needs_blender(clip: str, outputs: Collection[Output]) -> bool:
    """Whether a cell can only be done in Blender."""
    return Path(clip).suffix.lower() not in WITHOUT_BLENDER or any(
        output.needs_blender for output in outputs
    )


def require_blender(clip: str) -> None:
    """Of a clip that `needs_blender`. Raises WrongPlan where this process cannot load it."""
    if find_spec("bpy") is None:
        raise WrongPlan(
            f"{clip} or an output that was asked for needs Blender, which is not here; run the "
            "batch by `blender --command hangtime batch`, or take BVH or AMC clips and the outputs "
            "npz and bvh."
        )
