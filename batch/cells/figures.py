"""Figures of a cell: a report's main numbers under flat names that end with their units."""

from __future__ import annotations

from ...solver.data.reports.report import FitQuality, Report


def figures(report: Report) -> dict[str, float]:
    """What a table of many results compares; what a report does not have is left out."""
    found = {
        **fit_figures(report.fit_to_recording),
        "change_joint_centres_rms_cm": report.change.joint_centres_rms_cm,
        "change_joint_angles_rms_deg": report.change.joint_angles_rms_deg,
        "certificate_failed": float(len(report.failed)),
        "recorded_peak_force_bw": report.forces.recorded_peak_bw,
    }
    peaks = report.forces.peaks
    if peaks:
        found["peak_force_bw"] = max(peak.peak_bw for peak in peaks)
        found["friction_needed"] = max(peak.friction_coefficient_needed for peak in peaks)
    if report.contacts:
        found["slide_mm"] = max(contact.loaded_slide_mm for contact in report.contacts)
    for jump in report.jumps:
        name = jump.flight.replace(" ", "_")
        found[f"{name}_length_m"] = jump.adapted.flight_length_m
        found[f"{name}_apex_higher_cm"] = jump.apex_higher_cm
        found[f"{name}_s"] = jump.landing_s - jump.take_off_s
    for item in (line.item for line in report.certificate):
        lines = [line for line in report.certificate if line.item is item]
        unit = "".join(c if c.isalnum() else "_" for c in lines[0].unit)
        found[f"{_flat(item.value)}_{unit}".rstrip("_")] = max(line.value for line in lines)
    return {name: float(value) for name, value in found.items() if value == value}


def fit_figures(quality: FitQuality) -> dict[str, float]:
    """How near the fit is to the recording."""
    return {
        "fit_joint_centres_rms_cm": quality.joint_centres_rms_cm,
        "fit_worst_joint_cm": quality.worst_joint_cm,
    }


def _flat(words: str) -> str:
    return "_".join("".join(c if c.isalnum() else " " for c in words).split())
