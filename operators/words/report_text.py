"""Wording of the report: what changed, then how well it holds."""

from collections.abc import Iterator
from math import hypot

from ...bridge.rows.choices import KeyChoice
from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.data.contacts import PhaseKind, phase_title
from ...solver.data.reports.constraints import ConstraintReport
from ...solver.data.reports.keys import KeysReport
from ...solver.data.reports.recording import Origin
from ...solver.data.reports.report import Report
from ...solver.data.status import Durations
from .headline import (
    CERTIFICATE,
    MOST_NAMED,
    headline,
    line_place,
    line_told,
    most_telling,
    plain,
    retimed,
    turned_lines,
    with_unit,
)
from .messages import length
from .warning_text import warning_lines

LEFT_AT_MOST = {
    PhaseKind.FLIGHT: 0.001,
    PhaseKind.GROUND: 0.02,
}  # BW·m, rms; what the project promises
LEAST_TURN = 1.0  # degrees of a joint, to be told
SAME_SPEED = 0.05  # m/s
DURATIONS = {  # where they are not as one would expect
    Durations.NONE_FOUND: (
        "As recorded: for the moved landing none were found that go with it. Set a Timing, or move "
        "it less"
    ),
    Durations.NOT_MET: (
        "As recorded: with those that go with the moved landing what is asked for was not reached, "
        "or only with limbs through something or joints beyond a person's"
    ),
    Durations.MOVING_GROUND: "As recorded or asked for: ground that moves keeps its own time",
}


def as_text(report: Report) -> str:
    """A report in plain words, some forty lines."""
    lines = [*headline(report), *warning_lines(report), ""]
    lines += [*_input(report), ""]
    if report.loop is not None:
        lines += [*loop_lines(report), ""]
    lines += [*_changes(report), ""]
    lines += [*_quality(report), ""]
    lines += [*_contacts(report), ""]
    lines += [*_certificate(report), ""]
    if report.conditions:
        lines += [*_conditions(report), *_torque_limits(report), ""]
    lines += [*_objective(report), *_keys(report), *_stages(report)]
    return "\n".join(lines) + "\n"


def joint_lines(report: Report) -> list[str]:
    """The joints that changed most against the recording, and one that is too fast: lines."""
    told = [
        f"{each.bone} {each.change_deg:.0f}° (frame {each.frame:.0f})"
        for each in report.joint_changes
        if each.change_deg >= LEAST_TURN
    ]
    lines = [f"Joints changed most: {', '.join(told)}"] if told else []
    if (fast := report.fast_joint) is not None:
        speed = f"{fast.bone} {'would move' if fast.calmed else 'moves'} at {fast.speed:.0f} m/s"
        cure = ", so it was solved again with torques that change less" if fast.calmed else ""
        lines.append(f"{speed} beside the body, faster than any person's limb{cure}")
    return lines


def loop_lines(report: Report) -> list[str]:
    """A loop's frames, way and seam; none of other motions."""
    loop = report.loop
    if loop is None:
        return []
    frames = f"{loop.first_frame:g} to {loop.last_frame:g}"
    if (loop.first_frame, loop.last_frame) != (loop.asked_first, loop.asked_last):
        frames += f" (asked for {loop.asked_first:g} to {loop.asked_last:g})"
    seam = (
        with_unit(loop.seam_pose_mm, "mm"),
        with_unit(loop.seam_velocity_mm_s, "mm/s"),
        with_unit(loop.seam_force_bw, "BW"),
    )
    return [
        f"Loop: frames {frames}, {loop.travel_m:.2f} m a cycle at {loop.speed_m_s:.2f} m/s",
        f"At the seam pose, speed and force differ by {', '.join(seam)}",
        *turned_lines(report),
    ]


def certificate_lines(report: Report) -> list[str]:
    """The certificate for the sidebar: how many lines hold, and the worst that do not."""
    failed, count = report.failed, len(report.certificate)
    if not failed:
        return [f"Certificate: all {count} lines hold"]
    named = map(line_told, most_telling(failed))
    return [f"Certificate: {count - len(failed)} of {count} lines hold", *named]


def _certificate(report: Report) -> Iterator[str]:
    yield f"{'Certificate':<42}{'':>16}{'recorded':>11}{'limit':>14}  holds"
    for line in report.certificate:
        value, limit = with_unit(line.value, line.unit), with_unit(line.limit, line.unit)
        holds = "yes" if line.holds else "no"
        recorded = "" if line.recorded is None else plain(line.recorded)
        figures = f"{value:>16}{recorded:>11}{limit:>14}"
        said = f"{CERTIFICATE[line.item]:<42}{figures}  {holds:<3}  {line_place(line)}"
        yield said.rstrip()


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
    yield from (f"{'Gravity':<12}{line}" for line in gravity_lines(figure.gravity_m_s2))
    origin = Origin(r.clip, r.unit_m, r.unit_guessed, r.up_axis, r.up_axis_guessed)
    if guessed := guesses(origin):
        yield f"Guessed     {' and '.join(guessed)}"
    if r.bind_pose_frames:
        yield f"Left out    {held_at_rest(r.bind_pose_frames)}"


def gravity_lines(gravity: float) -> list[str]:
    """What body weights mean where gravity (m/s²) is another than the Earth's: a line."""
    if gravity == STANDARD_GRAVITY:
        return []
    return [f"{gravity:g} m/s²; body weights (BW) are those on Earth all the same"]


def guesses(origin: Origin) -> list[str]:
    """What a file does not tell, as it is taken, and the option that tells it."""
    told = []
    if origin.unit_guessed:
        told.append(f"one unit of the file is {origin.unit_m:.4g} m (else say --unit)")
    if origin.up_guessed:
        told.append(f"{origin.up} points up (else say --up)")
    return told


def held_at_rest(count: int) -> str:
    """Words on frames at the beginning of a recording."""
    if count == 1:
        return "the first frame, which holds the rest pose"
    return f"the first {count} frames, which hold the rest pose"


def _changes(report: Report) -> Iterator[str]:
    for jump in report.jumps:
        was, now = jump.fit, jump.adapted
        yield (
            f"{phase_title(jump.flight):<11} frames {jump.take_off_frame:.1f} to "
            f"{jump.landing_frame:.1f}; the body flies {now.flight_length_m:.2f} m "
            f"instead of {was.flight_length_m:.2f} m"
        )
        yield (
            f"            the pelvis rises to {now.apex_pelvis_height_m:.2f} m above the floor, "
            f"{higher(jump.apex_higher_cm)}"
        )
        if jump.crouch_deeper_cm is not None:
            yield f"            the crouch before it is {deeper(jump.crouch_deeper_cm)}"
    for line in joint_lines(report):
        yield f"{'Joints':<11} {line.removeprefix('Joints ')}"
    for phase in retimed(report):
        yield (
            f"{phase_title(phase.phase):<11} takes {phase.adapted_s:.3f} s instead of "
            f"{phase.recorded_s:.3f} s"
        )
    yield from moving_ground_lines(report)
    yield from (f"{'Durations':<12}{line}" for line in durations_lines(report))
    for peak in report.forces.peaks:
        yield (
            f"{phase_title(peak.phase):<11} what carries the body pushes with at most "
            f"{peak.peak_bw:.1f} body weights (frame {peak.frame:.0f})"
        )


def moving_ground_lines(report: Report) -> Iterator[str]:
    """Stances on ground that moves, and those that a take-off from it carries on."""
    for each in report.moving_ground:
        phase, moved = phase_title(each.phase), hypot(*each.moved_m)
        if each.object is None:
            yield f"{phase:<11} is carried on by {moved:.2f} m, with the speed of the ground left"
            continue
        first, last = each.ground_speed_m_s
        speeds = f"{first:.1f}" if abs(last - first) < SAME_SPEED else f"{first:.1f} to {last:.1f}"
        yield f"{phase:<11} rides on {each.object} at {speeds} m/s"
        if each.kept_speed_share is not None:
            yield f"            and leaves it with {100 * each.kept_speed_share:.0f} % of its speed"


def durations_lines(report: Report) -> list[str]:
    """Why phases last as long as recorded, where one would expect other durations: lines."""
    return [DURATIONS[report.durations]] if report.durations in DURATIONS else []


def _quality(report: Report) -> Iterator[str]:
    fit = report.fit_to_recording
    joints = f"joints {fit.joint_centres_rms_cm:.1f} cm from the recording (rms)"
    yield f"{'Fit':<12}{joints}{apex_words(fit.pelvis_apex_difference_cm)}"
    if fit.most_turned:
        turned = f"{fit.most_turned} by {fit.most_turned_deg:.0f}°"
        yield f"            turned away furthest: {turned}, frame {fit.most_turned_frame:.0f}"
    yield from fit_excess_lines(report)
    residuals = report.between_nodes
    for kind, left in ((PhaseKind.FLIGHT, residuals.flight), (PhaseKind.GROUND, residuals.ground)):
        if left is not None:
            yield (
                f"Physics     {kind.value}: unexplained force {left.force_rms_bw:.5f} "
                f"body weights, moment {left.moment_rms_bw_m:.5f} body weights × metre (rms)"
            )
            if left.moment_rms_bw_m > LEFT_AT_MOST[kind]:
                yield "            more than it should be between the solver's nodes: choose fewer"
                yield "            frames, or correct contacts whose feet slide"


def fit_excess_lines(report: Report) -> Iterator[str]:
    """What the fit has in each other or beyond a person's ranges, as the recording has it or as the
    fit is off it: the adapted motion may keep it."""
    for each in report.recorded_overlaps[:MOST_NAMED]:
        yield (
            f"            it has {each.name[0].lower()}{each.name[1:]} by {each.deepest_mm:.0f} mm "
            f"(frame {each.frame:.0f}), which the result may keep"
        )
    for beyond in report.recorded_ranges[:MOST_NAMED]:
        yield (
            f"            its {beyond.name[0].lower()}{beyond.name[1:]} {beyond.beyond_deg:.0f}° "
            f"beyond a person's range (frame {beyond.frame:.0f}), which the result may keep"
        )


def _contacts(report: Report) -> Iterator[str]:
    yield f"{'Contact, loaded':<20}{'frames':>18}{'slides':>11}{'under':>9}{'above':>9}  pin"
    for contact in report.contacts:
        span = f"{contact.start_frame:.1f} to {contact.end_frame:.1f}"
        slide, under, above = (
            f"{amount:.1f} mm"
            for amount in (
                contact.loaded_slide_mm,
                contact.loaded_under_mm,
                contact.loaded_above_mm,
            )
        )
        said = f"{contact.name:<20}{span:>18}{slide:>11}{under:>9}{above:>9}  {contact.pin or ''}"
        yield said.rstrip()


def _conditions(report: Report) -> Iterator[str]:
    width = max([24, *(len(each.name) + 1 for each in report.conditions)])
    yield f"{'Request':<{width}}{'':<14}held"
    for each in report.conditions:
        held = "yes"
        if not each.met:
            held = f"missed by {amount(each)} (frame {each.worst_violation_frame:.0f})"
        yield f"{each.name:<{width}}{each.kind.label:<14}{held}"


def amount(missed: ConstraintReport) -> str:
    """By how much a constraint is missed, with its unit: "91.2 cm", "2.5°"."""
    much, unit = missed.worst_violation, missed.kind.reported_unit
    match unit:
        case "mm":
            return length(much / 1000.0)
        case "degrees":
            return f"{much:.1f}°" if much < 10.0 else f"{much:.0f}°"
    return f"{plain(much)} {unit}"


def _torque_limits(report: Report) -> Iterator[str]:
    for each in report.torque_limits:
        yield (
            f"{each.name:<23} muscles at most {each.muscles_peak_nm:.3g} N·m "
            f"(rms {each.muscles_rms_nm:.2g}), passive tissue {each.passive_peak_nm:.2g} N·m"
        )


def _objective(report: Report) -> Iterator[str]:
    left = report.objective_end_over_start
    if left is None:
        return
    if left < 1.0:
        yield f"Objective   {100.0 * left:.0f} % of what it was before it was minimized"
    else:
        yield "Objective   no motion was found with less of it; the one before stands"


def keys_line(keys: KeysReport) -> str:
    """How many keys a result has, and what they leave; and that they are no fewer than frames."""
    every = "a key on every frame, as fewer do not keep the error: "
    return (
        f"{every if keys.choice == KeyChoice.EVERY_FRAME.value else ''}"
        f"{keys.keys} keys, {keys.rate:.1f} a second and channel; joints at most "
        f"{keys.largest_error_mm:.2f} mm off ({keys.error_bone}, frame {keys.error_frame:.0f}), "
        f"bones {keys.largest_turn_deg:.2f}° ({keys.turn_bone}, frame {keys.turn_frame:.0f})"
    )


def _keys(report: Report) -> Iterator[str]:
    if report.keys is not None:
        yield f"Keys        {keys_line(report.keys)}"


def _stages(report: Report) -> Iterator[str]:
    steps: dict[str, int] = {}
    for solve in report.solves:
        steps[solve.name] = steps.get(solve.name, 0) + solve.iterations
    counted = ", ".join(f"{name} {count}" for name, count in steps.items())
    yield f"Steps       {counted} ({report.unknowns} unknowns, {report.rows} equations)"
    for i, stage in enumerate(report.stages or ()):
        yield f"{'' if i else 'Time':<12}{stage.name} {stage.seconds:.1f} s"


def higher(centimetres: float) -> str:
    """How much higher than recorded, such as "1.3 cm lower"."""
    amount = f"{abs(centimetres):.1f}"
    if not float(amount):
        return "as high as recorded"
    return f"{amount} cm {'higher' if centimetres > 0.0 else 'lower'}"


def apex_words(centimetres: float | None) -> str:
    """The end of a sentence on how near a fit is; empty where no flight is whole in the clip."""
    return "" if centimetres is None else f", apex {higher(centimetres)}"


def deeper(centimetres: float) -> str:
    """A difference of a crouch, such as "1.3 cm less deep"."""
    return f"{abs(centimetres):.1f} cm {'deeper' if centimetres >= 0.0 else 'less deep'}"
