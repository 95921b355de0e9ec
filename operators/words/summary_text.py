"""What the sidebar says of a result: whether it holds, how long it took, how hard it is."""

from collections.abc import Mapping

from ...solver.data.contacts import phase_title
from ...solver.data.reports.constraints import ConstraintReport, ContactReport
from ...solver.data.reports.dynamics import ForcePeak
from ...solver.worker.protocol import Adapted
from .headline import (
    accepted_lines,
    given_up_lines,
    lifted_lines,
    nearness,
    other_gravity_lines,
    retimed,
)
from .report_text import (
    amount,
    certificate_lines,
    durations_lines,
    gravity_lines,
    joint_lines,
    loop_lines,
)


def summary(answer: Adapted, roles: Mapping[str, str], retimed_frames: Mapping[str, str]) -> str:
    """Lines for the sidebar: how well it holds, how long it took, how hard the ground pushes.

    roles: what stances are to the clip, such as "Landing", by their phases' names. retimed_frames:
    what is said of when constraints hold, by their names.
    """
    report = answer.report
    worst = max(report.contacts, key=lambda contact: contact.loaded_slide_mm, default=None)
    seconds = sum(stage.seconds for stage in report.stages or ())
    peak = max(report.forces.peaks, key=lambda peak: peak.peak_bw, default=None)
    took = f"in {seconds:.1f} s"
    said = f"Solved {took}" if answer.fault is None else f"Best found {took}; not all is met"
    return "\n".join(
        [
            said,
            nearness(report.fit_to_recording),
            *accepted_lines(report.needs),
            *lifted_lines(report),
            *([] if worst is None else [_slides(worst)]),
            *(
                f"{c.name}: {_held(c, retimed_frames.get(c.name, ''))}"
                for c in report.conditions
                if not c.kind.guards
            ),
            *(
                f"{roles.get(p.phase, phase_title(p.phase))}: {p.adapted_s:.2f} s, "
                f"was {p.recorded_s:.2f} s"
                for p in retimed(report)
            ),
            *(f"Durations: {line[0].lower()}{line[1:]}" for line in durations_lines(report)),
            *(f"Gravity: {line}" for line in gravity_lines(report.figure.gravity_m_s2)),
            *other_gravity_lines(report),
            *([] if peak is None else [_peak(peak, report.forces.recorded_peak_bw)]),
            *given_up_lines(report),
            *loop_lines(report),
            *joint_lines(report),
            *certificate_lines(report),
        ]
    )


def _slides(worst: ContactReport) -> str:
    return f"Loaded points slide {worst.loaded_slide_mm:.1f} mm at most ({worst.name})"


def _peak(peak: ForcePeak, recorded: float) -> str:
    return (
        f"Peak force: {peak.peak_bw:.1f} body weights (frame {peak.frame:.0f}), "
        f"in the recording {recorded:.1f}"
    )


def _held(constraint: ConstraintReport, when: str) -> str:
    if constraint.met:
        return f"held{when}"
    return f"missed by {amount(constraint)}"
