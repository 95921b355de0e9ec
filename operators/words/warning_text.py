"""Wording of what is beyond reason in a result that counts as solved, or was taken as it stood."""

from ...solver.data.reports.report import Report
from ...solver.data.status import Status

# Body weights. Landings from 0.3 m take 4.5 (McNair & Prapavessis 1999); those of double
# somersaults 8.8 and more (Panzer 1987), which a recording of one then has as well.
HARDEST = 8.0
HARDER = 2.0  # times the recording's peak

NOT_MET = "Not all that was asked for is met"


def warnings_of(report: Report) -> list[str]:
    """Lines about what a person would hardly do; none where the result is as one would expect."""
    told = [] if report.status is Status.SOLVED else [NOT_MET]
    peak = max(report.forces.peaks, key=lambda each: each.peak_bw, default=None)
    recorded = report.forces.recorded_peak_bw
    if peak is not None and peak.peak_bw > max(min(HARDEST, HARDER * recorded), recorded):
        told.append(
            f"The ground pushes with {peak.peak_bw:.1f} body weights at frame {peak.frame:.0f}; "
            f"in the recording {recorded:.1f} at most"
        )
    return told


def warning_lines(report: Report) -> list[str]:
    """The same, as they stand among lines that are none."""
    return [f"Warning: {each}" for each in warnings_of(report)]
