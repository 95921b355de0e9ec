"""What the sidebar says of a result: whether it holds, how long it took, how hard it is."""

from ...solver.data.reports.constraints import ConstraintReport
from ...solver.worker.protocol import Adapted
from .report_text import (
    amount,
    certificate_lines,
    durations_lines,
    given_up_lines,
    joint_lines,
    loop_lines,
    retimed,
)


def summary(answer: Adapted) -> str:
    """Lines for the sidebar: how well it holds, how long it took, how hard the ground pushes."""
    report = answer.report
    worst = max(report.contacts, key=lambda contact: contact.loaded_slide_mm)
    seconds = sum(stage.seconds for stage in report.stages or ())
    peak = max(report.forces.peaks, key=lambda peak: peak.peak_bw)
    took = f"in {seconds:.1f} s"
    said = f"Solved {took}" if answer.fault is None else f"Best found {took}; not all is met"
    return "\n".join(
        [
            said,
            f"Loaded points slide {worst.loaded_slide_mm:.1f} mm at most ({worst.name})",
            *(f"{c.name}: {_held(c)}" for c in report.conditions if not c.kind.guards),
            *(
                f"{p.phase.capitalize()}: {p.adapted_s:.2f} s, was {p.recorded_s:.2f} s"
                for p in retimed(report)
            ),
            *(f"Durations: {line[0].lower()}{line[1:]}" for line in durations_lines(report)),
            f"Peak force: {peak.peak_bw:.1f} body weights (frame {peak.frame:.0f}), "
            f"in the recording {report.forces.recorded_peak_bw:.1f}",
            *given_up_lines(report),
            *loop_lines(report),
            *joint_lines(report),
            *certificate_lines(report),
        ]
    )


def _held(constraint: ConstraintReport) -> str:
    if constraint.met:
        return "held"
    return f"missed by {amount(constraint)}"
