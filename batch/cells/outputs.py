"""Files that a cell leaves where it is done without Blender."""

from __future__ import annotations

from collections.abc import Collection

from ...bridge.formats.bvh_writer import write_bvh
from ...operators.files.outbox import Outbox, not_writable
from ...operators.headless.result_files import write_report, write_trajectory
from ...solver.data.reports.recording import Origin
from ...solver.data.reports.report import Report
from ...solver.results.posed_recording import posed_recording
from ...solver.worker.pipeline import AdaptationResult
from ..records.manifest import Output

MOTION = "motion.bvh"
CENTIMETRE = 0.01  # m


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
