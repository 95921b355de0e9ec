"""Wording of the report: what changed, then how well it holds."""

from collections.abc import Iterator

from ...solver.data.contacts import PhaseKind
from ...solver.data.report import Report
from .messages import outcome

LEFT_AT_MOST = {
    PhaseKind.FLIGHT: 0.001,
    PhaseKind.GROUND: 0.02,
}  # BW·m, rms; what the project promises
GRIPPING = 1.2  # friction coefficient of sports shoes on a good floor, at most
BEARABLE = 12.0  # times the body's weight; the hardest landings of gymnasts


def as_text(report: Report) -> str:
    """A report in plain words, some twenty lines."""
    lines = [outcome(report.status), ""]
    lines += [*_input(report), ""]
    lines += [*_changes(report), ""]
    lines += [*_quality(report), ""]
    lines += [*_contacts(report), ""]
    if report.conditions:
        lines += [*_conditions(report), *_torque_limits(report), ""]
    lines += [*_objective(report), *_stages(report)]
    return "\n".join(lines) + "\n"


def _input(report: Report) -> Iterator[str]:
    r, figure = report.recording, report.figure
    yield (
        f"Recording   {r.clip}, frames {r.first_frame:g} to {r.last_frame:g} "
        f"({r.seconds:.2f} s at {r.frames_per_second:.4g} frames a second)"
    )
    yield (
        f"Figure      {figure.height_m:.2f} m, {figure.mass_kg:g} kg, "
        f"{figure.bodies} bodies, {figure.degrees_of_freedom} degrees of freedom"
    )
    guesses = []
    if r.unit_guessed:
        guesses.append(f"one unit of the file is {r.unit_m:.4g} m (--unit)")
    if r.up_axis_guessed:
        guesses.append(f"{r.up_axis} points up (--up)")
    if guesses:
        yield f"Guessed     {' and '.join(guesses)}"


def _changes(report: Report) -> Iterator[str]:
    for jump in report.jumps:
        was, now = jump.fit, jump.adapted
        yield (
            f"{jump.flight.capitalize():<11} frames {jump.take_off_frame:.1f} to "
            f"{jump.landing_frame:.1f}; the body flies {now.flight_length_m:.2f} m "
            f"instead of {was.flight_length_m:.2f} m"
        )
        yield (
            f"            the pelvis rises to {now.apex_pelvis_height_m:.2f} m above the floor "
            f"({_signed(jump.apex_higher_cm)} cm)"
        )
        if jump.crouch_deeper_cm is not None:
            deeper = jump.crouch_deeper_cm
            way = "deeper" if deeper >= 0.0 else "less deep"
            yield f"            the crouch before it is {abs(deeper):.1f} cm {way}"
    for peak in report.forces.peaks:
        beyond = ": more than people can bear" if peak.peak_bw > BEARABLE else ""
        yield (
            f"{peak.phase.capitalize():<11} what carries the body pushes with at most "
            f"{peak.peak_bw:.1f} times the body's weight (frame {peak.frame:.0f}){beyond}"
        )
        grip = peak.friction_coefficient_needed
        if grip > GRIPPING:
            yield f"            it must grip with a friction of {grip:.1f}: more than shoes have"


def _quality(report: Report) -> Iterator[str]:
    fit = report.fit_to_recording
    yield (
        f"Fit         joints {fit.joint_centres_rms_cm:.1f} cm from the recording (rms), "
        f"apex {_signed(fit.pelvis_apex_difference_cm)} cm"
    )
    residuals = report.between_nodes
    for kind, left in ((PhaseKind.FLIGHT, residuals.flight), (PhaseKind.GROUND, residuals.ground)):
        if left is not None:
            yield (
                f"Physics     {kind.value}: unexplained force {left.force_rms_bw:.1e} "
                f"of the weight, moment {left.moment_rms_bw_m:.1e} of weight × metre (rms)"
            )
            if left.moment_rms_bw_m > LEFT_AT_MOST[kind]:
                yield "            more than it should be between the solver's nodes: choose fewer"
                yield "            frames, or correct contacts whose feet slide"


def _contacts(report: Report) -> Iterator[str]:
    yield f"{'Contact':<20}{'frames':>18}{'off its place':>16}  pin"
    for contact in report.contacts:
        span = f"{contact.start_frame:.1f} to {contact.end_frame:.1f}"
        off = f"{contact.worst_violation_mm:.2f} mm"
        yield f"{contact.name:<20}{span:>18}{off:>16}  {contact.pin or ''}".rstrip()


def _conditions(report: Report) -> Iterator[str]:
    yield f"{'Request':<24}{'':<14}held"
    for each in report.conditions:
        held = "yes"
        if not each.met:
            held = (
                f"missed by {each.worst_violation:.3g} {each.kind.reported_unit} "
                f"(frame {each.worst_violation_frame:.0f})"
            )
        yield f"{each.name:<24}{each.kind.label:<14}{held}"


def _torque_limits(report: Report) -> Iterator[str]:
    for each in report.torque_limits:
        yield (
            f"{each.name:<24}muscles at most {each.muscles_peak_nm:.3g} N·m "
            f"(rms {each.muscles_rms_nm:.2g}), passive tissue {each.passive_peak_nm:.2g} N·m"
        )


def _objective(report: Report) -> Iterator[str]:
    left = report.objective_end_over_start
    if left is None:
        return
    if left < 1.0:
        yield f"Objective   {100.0 * left:.0f} % of what it was before it was lessened"
    else:
        yield "Objective   no motion was found with less of it; the one before stands"


def _stages(report: Report) -> Iterator[str]:
    steps: dict[str, int] = {}
    for solve in report.solves:
        steps[solve.name] = steps.get(solve.name, 0) + solve.iterations
    counted = ", ".join(f"{name} {count}" for name, count in steps.items())
    yield f"Steps       {counted} ({report.unknowns} unknowns, {report.rows} equations)"
    for i, stage in enumerate(report.stages or ()):
        yield f"{'' if i else 'Time':<12}{stage.name} {stage.seconds:.1f} s"


def _signed(amount: float) -> str:
    return f"{amount:+.1f}".replace("-", "−")
