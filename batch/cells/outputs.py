"""Files that a cell leaves, and whether they need Blender."""

from __future__ import annotations

from collections.abc import Collection
from importlib.util import find_spec
from pathlib import Path

from ...bridge.formats.bvh_writer import write_bvh
from ...operators.headless.outbox import Outbox, not_writable
from ...operators.headless.result_files import write_report, write_trajectory
from ...solver.data.reports.recording import Origin
from ...solver.data.reports.report import Report
from ...solver.results.posed_recording import posed_recording
from ...solver.worker.pipeline import AdaptationResult
from ..records.faults import WrongPlan
from ..records.manifest import Output
from .reading import WITHOUT_BLENDER

MOTION = "motion.bvh"
CENTIMETRE = 0.01  # m


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


def write_plain(
    result: AdaptationResult, report: Report, wanted: Collection[Output], outbox: Outbox
) -> None:
    """Trajectory and report. Raises OutputNotWritable."""
    if Output.NPZ in wanted:
        write_trajectory(result, outbox)
    write_report(report, outbox)


def write_motion(result: AdaptationResult, origin: Origin, outbox: Outbox) -> None:
    """The adapted frames on the recording's skeleton, in the clip's own unit and axes; of a clip
    that does not tell these, in centimetres, Y up. Raises OutputNotWritable.
    """
    posed = posed_recording(result.recording, result.track, result.times)
    own = origin.up is not None and origin.unit_m is not None
    try:
        write_bvh(
            posed,
            outbox.path(MOTION),
            origin.unit_m if own and origin.unit_m else CENTIMETRE,
            "Z" if origin.up == "Z" else "Y",
        )
    except OSError as error:
        raise not_writable(outbox.folder / MOTION, error) from error
