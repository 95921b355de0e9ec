"""Figures of a cell: a report's main numbers under flat names that end with their units.

Names are of small letters, so that no two are the same to a spreadsheet; none tells what another
tells already.
"""

from __future__ import annotations

from math import isfinite

from ...solver.data.reports.certificate import CertificateItem
from ...solver.data.reports.report import FitQuality, Report
from ..records.result import WORSE

UNITS = {  # of the certificate, as names end
    "%": "_percent",
    "N": "_n",
    "N·m": "_nm",
    "N·m/kg": "_nm_per_kg",
    "BW": "_bw",
    "BW/s": "_bw_per_s",
    "mm": "_mm",
    "cm": "_cm",
    "": "",
}


def figures(report: Report) -> dict[str, float]:
    """What a table of many results compares; what a report does not have is left out."""
    found = {
        **fit_figures(report.fit_to_recording),
        "change_joint_centres_rms_cm": report.change.joint_centres_rms_cm,
        "change_joint_angles_rms_deg": report.change.joint_angles_rms_deg,
        "certificate_failed": float(len(report.failed)),
        WORSE: float(sum(not line.as_recorded for line in report.failed)),
        "certificate_worst_times_limit": max(
            (line.value / line.limit for line in report.certificate), default=0.0
        ),
        "recorded_peak_force_bw": report.forces.recorded_peak_bw,
    }
    for jump in report.jumps:
        name = jump.flight.replace(" ", "_")
        found[f"{name}_length_m"] = jump.adapted.flight_length_m
        found[f"{name}_apex_higher_cm"] = jump.apex_higher_cm
        found[f"{name}_s"] = jump.landing_s - jump.take_off_s
    for line in report.certificate:
        if line.item is not CertificateItem.FIT_RMS:  # told by `fit_figures`
            name = f"{_flat(line.item.value)}{UNITS[line.unit]}"
            found[name] = max(line.value, found.get(name, line.value))
    return {name: float(value) for name, value in found.items() if isfinite(value)}


def fit_figures(quality: FitQuality) -> dict[str, float]:
    """How near the fit is to the recording."""
    return {
        "fit_joint_centres_rms_cm": quality.joint_centres_rms_cm,
        "fit_worst_joint_cm": quality.worst_joint_cm,
        "fit_most_turned_deg": quality.most_turned_deg,
    }


def _flat(words: str) -> str:
    return "_".join("".join(c if c.isalnum() else " " for c in words).split())
