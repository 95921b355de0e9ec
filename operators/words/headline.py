"""Wording of a result's headline: what its keys do not show, how it ended, how near it is, what was
accepted, what failed."""

from collections.abc import Sequence

from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.data.faults import NoFit, NoSolution
from ...solver.data.reports.certificate import CertificateItem, CertificateLine
from ...solver.data.reports.constraints import (
    CARRIES,
    AcceptedReport,
    ConstraintReport,
    FitNeeds,
    UnseenSupportReport,
)
from ...solver.data.reports.jumps import PhaseReport
from ...solver.data.reports.keys import BlendReport, BodyMiss, MissedContact
from ...solver.data.reports.report import FitQuality, Report
from ...solver.data.row_kinds import RowKind
from ...solver.data.status import Durations, Status
from .messages import length, outcome, sentence

MOST_NAMED = 3  # of the certificate's lines that fail, in a headline
MOST_MISSED = 3  # contacts
MOST_GIVEN_UP = 5  # of what is in each other, likewise
AS_RECORDED = {
    Durations.NONE_FOUND: "Durations are as recorded, as none were found for the moved landing",
    Durations.NOT_MET: "Durations are as recorded, as with those for the moved landing not all "
    "that is asked for was reached",
}
FAR_OFF = 0.05  # m, beside the take; a blend of less is hardly seen
SEEN_SLIDE = 2.0  # mm, of a loaded point; what is solved leaves one, or two where soles give
SLIDES = 0.01  # m, of feet on the way back, that shows
BLEND_SLIDES = 0.03  # m; by less those go that stand a little off the recording in the fit
LURCH = 0.5  # m/s, by which a blend's hips are faster than the take's; of less, likewise
LEAST_TURNED = 1.0  # degrees, of a loop's way; a recorded one weaves by about as much
LEAST_RETIMED = 0.0005  # s
FITS = (CertificateItem.FIT_RMS, CertificateItem.FIT_WORST_FRAME)

_BESIDE_A_STAND = {  # by whether the blend leads in
    True: "Begin the range before it comes down",
    False: "End the range when it has left",
}
WHAT_CARRIES = (
    "where hands do, let them touch (Add Contact), or hold on (a Point with Pushes Back and Grip); "
    "where a chair or a wall does, give what rests on it a Point with Pushes Back; where feet "
    "stand on something, let it be ground (World)"
)
BESIDE_HANDS = (
    "hands touch there already, but the weight is {} beside hands and feet on average, where these "
    "cannot carry it: correct the frames in which they touch, or mend the recording; where the "
    "body hangs from them, which contacts cannot hold, give them a Point with Pushes Back and Grip "
    "in place of that; where something else carries, give what rests on it a Point with Pushes Back"
)
# What may be done about keys that do not show what was solved.
SAME_SCALE = (
    "Lengths change with the scale of {}: make it one number, for all axes and at all frames"
)
UNMOVED = "Mute the constraints and drivers that move these bones or those above them"

Item = CertificateItem
CERTIFICATE = {
    Item.RESIDUAL_FORCE_RMS_SHARE: "unexplained force, rms, of the peak force",
    Item.RESIDUAL_FORCE_PEAK_SHARE: "unexplained force, peak, of the same",
    Item.RESIDUAL_MOMENT_RMS_SHARE: "unexplained moment, rms, of that × height",
    Item.RESIDUAL_MOMENT_PEAK_SHARE: "unexplained moment, peak, of the same",
    Item.RESIDUAL_FORCE_RMS: "unexplained force, rms",
    Item.RESIDUAL_FORCE_PEAK: "unexplained force, peak",
    Item.RESIDUAL_MOMENT_RMS: "unexplained moment, rms",
    Item.RESIDUAL_MOMENT_PEAK: "unexplained moment, peak",
    Item.FRICTION: "friction coefficient used",
    Item.PEAK_FORCE: "peak force",
    Item.LOADING_RATE: "loading rate",
    Item.HIP_TORQUE: "hip torque",
    Item.KNEE_TORQUE: "knee torque",
    Item.ANKLE_TORQUE: "ankle torque",
    Item.SLIDE: "a loaded point slides by",
    Item.UNDER: "a loaded point is under its surface by",
    Item.ABOVE: "a loaded point is above its surface by",
    Item.FIT_RMS: "fit off the recording, rms",
    Item.FIT_WORST_FRAME: "fit off the recording, worst frame",
}


def headline(report: Report) -> list[str]:
    """What the keys do not show, how the solve ended, how near the fit is, what was accepted, and
    what the certificate has against the motion: lines."""
    if report.fit_failed:
        return [sentence(NoFit(report.status))]
    if report.status is not Status.SOLVED:
        fit = (line.value for line in report.failed if line.item is CertificateItem.FIT_RMS)
        return [sentence(NoSolution(report.status, fit_off_cm=next(fit, 0.0)))]
    accepted = accepted_lines(report.needs)
    near = report.fit_to_recording
    told = [nearness(near), *turned_away_lines(near), *accepted, *lifted_lines(report)]
    told += given_up_lines(report) + missed_body_lines(report.missed_bodies)
    told += blend_lines(report.blends) + turned_lines(report)
    told += slide_lines(report.slide_on_way_back_m)
    told += [AS_RECORDED[report.durations]] if report.durations in AS_RECORDED else []
    told += other_gravity_lines(report)
    told += [line_told(line) for line in most_telling(report.failed)]
    told += [line_told(line) for line in report.certificate if _is_seen_sliding(line)]
    missed = [missed_line(report.missed_contacts)] if report.missed_contacts else []
    return [*missed, _solved(report), *(f"  {line}" for line in told)]


def retimed(report: Report) -> list[PhaseReport]:
    """The phases that take another time than they took."""
    return [p for p in report.phases if abs(p.adapted_s - p.recorded_s) > LEAST_RETIMED]


def other_gravity_lines(report: Report) -> list[str]:
    """Flights that last as recorded though the body falls at another rate, if some do: a line."""
    gravity = report.figure.gravity_m_s2
    flights = {jump.flight for jump in report.jumps} - {phase.phase for phase in retimed(report)}
    if gravity == STANDARD_GRAVITY or not flights:
        return []
    as_there = "longer" if gravity < STANDARD_GRAVITY else "shorter"
    return [f"Flights last as recorded at this gravity, too; a Timing makes them {as_there}"]


def turned_lines(report: Report) -> list[str]:
    """A loop that goes elsewhere than the recorded cycle, if it is one: a line."""
    degrees = 0.0 if report.loop is None else report.loop.turned_deg
    if abs(degrees) < LEAST_TURNED:
        return []
    side = "left" if degrees > 0.0 else "right"
    return [f"The loop goes {abs(degrees):.1f}° further to the {side} than the recorded cycle"]


def missed_line(missed: Sequence[MissedContact]) -> str:
    """The first line of a result whose keys have points that stand elsewhere than solved."""
    points = ", ".join(
        f"{each.name} is up to {each.mm:.1f} mm off (frame {each.frame:g})"
        for each in missed[:MOST_MISSED]
    )
    more = len(missed) - MOST_MISSED
    others = f", and {more} more" if more > 0 else ""
    scaled = dict.fromkeys(name for each in missed for name in each.scaled)
    cure = SAME_SCALE.format(", ".join(scaled)) if scaled else UNMOVED
    return f"The keys do not show what was solved: {points}{others}. {cure}, and press Update"


def _solved(report: Report) -> str:
    """The first line of what is solved."""
    failed, count = report.failed, len(report.certificate)
    do = "does" if len(failed) == 1 else "do"
    lines = f"{len(failed)} of the certificate's {count} lines {do} not hold{_as_recorded(failed)}"
    if any(line.item in FITS for line in failed):
        return f"Solved, but the fit is far from the recording: {lines}."
    if report.fit_to_recording.is_far_somewhere:
        said = "Solved, but the fit is far from the recording in one place"
        return f"{said}: {lines}." if failed else f"{said}."
    if report.unseen_support or report.let_go:
        said = "Solved, but not with what the recording shows alone"
        return f"{said}, and {lines}." if failed else f"{said}."
    gone = len(report.given_up)
    places = "one place" if gone == 1 else f"{gone} places"
    but = [_near_enough(report.needs.accepted)] if report.needs.accepted else []
    but += [f"limbs, the floor or joints' ranges gave way in {places}"] if gone else []
    but += [lines] if failed else []
    if not but:
        return outcome(report.status)
    return f"Solved: everything asked for holds, but {', and '.join(but)}."


def _near_enough(accepted: Sequence[AcceptedReport]) -> str:
    """How many contacts miss their places, by how much at most, and what was to be accepted."""
    off, limit = max(each.off_mm for each in accepted), max(each.limit_mm for each in accepted)
    count = len(accepted)
    said = "a contact is off its place" if count == 1 else f"{count} contacts are off their places"
    by = f"by up to {length(off / 1000.0)} where {length(limit / 1000.0)} is good enough"
    return f"{said} {by}"


def _as_recorded(failed: Sequence[CertificateLine]) -> str:
    """How many of the lines are no worse than the recording's."""
    count = sum(line.as_recorded for line in failed)
    if not count:
        return ""
    return ", as in the recording" if count == len(failed) else f", {count} as in the recording"


def nearness(fit: FitQuality) -> str:
    """Such as "The fit is within 1.4 cm of the recording; worst 5 cm, left hand, frame 161"."""
    said = f"The fit is within {plain(fit.joint_centres_rms_cm)} cm of the recording (rms)"
    if not fit.worst_joint:
        return said
    worst = f"{plain(fit.worst_joint_cm)} cm, {fit.worst_joint}"
    return f"{said}; worst {worst}, frame {fit.worst_joint_frame:.0f}"


def turned_away_lines(fit: FitQuality) -> list[str]:
    """A limb that the fit turns away from the recording, if there is one: a line."""
    if not fit.is_turned:
        return []
    turned = f"{fit.turned_limb_deg:.0f}° (frame {fit.turned_limb_frame:.0f})"
    return [f"The fit turns the {fit.turned_limb} away from the recording by {turned}"]


def unseen_lines(found: Sequence[UnseenSupportReport]) -> list[str]:
    """Where something unseen carries the body, with what may be done, and where it only turns it:
    lines."""
    carried, turned = ([u for u in found if (u.force_bw > CARRIES) == on] for on in (True, False))
    on_hands, others = (
        [u for u in carried if bool(u.beside_hands_m) is on] for on in (True, False)
    )
    lines = [f"{_carried(others)}; {WHAT_CARRIES}"] if others else []
    if on_hands:
        beside = ", ".join(length(each.beside_hands_m) for each in on_hands)
        lines.append(f"{_carried(on_hands)}; {BESIDE_HANDS.format(beside)}")
    if turned:
        most = plain(max(each.moment_bw_m for each in turned))
        spans = ", ".join(map(_frames_of, turned))
        lines.append(
            "Something unseen turns the body, but carries nothing of it, by up to "
            f"{most} body weights × metre in frames {spans}"
        )
    return lines


def _carried(found: Sequence[UnseenSupportReport]) -> str:
    spans = ", ".join(
        f"{_frames_of(each)} ({plain(each.mean_bw)}, {plain(each.force_bw)})" for each in found
    )
    amounts = "by body weights, on average and at most"
    return f"Something unseen carries the body in frames ({amounts}) {spans}"


def _frames_of(each: UnseenSupportReport) -> str:
    return f"{each.first_frame:.0f} to {each.last_frame:.0f}"


def accepted_lines(needs: FitNeeds) -> list[str]:
    """What the motion needs beside what the recording shows, all frames at once: lines."""
    lines = unseen_lines(needs.unseen_support)
    lines += [
        f"In the flight that was found from frame {each.first_frame:.0f} to {each.last_frame:.0f} "
        f"the body falls at {each.acceleration:.1f} m/s², up to {length(each.off_mm / 1000.0)} off "
        "any free fall, so something unseen carries it; correct the contacts before and after it, "
        "or mend the recording there"
        for each in needs.carried_flights
    ]
    if needs.let_go:
        names = ", ".join(
            f"{each.name} ({length(each.off_mm / 1000.0)} off)" if each.off_mm else each.name
            for each in needs.let_go
        )
        why = "as they cannot be held with the others; nothing moves them"
        lines.append(f"Contacts let go, {why}: {names}")
    if needs.accepted:
        names = ", ".join(
            f"{each.name} ({length(each.off_mm / 1000.0)})" for each in needs.accepted
        )
        limit = length(max(each.limit_mm for each in needs.accepted) / 1000.0)
        counts = f"what counts as good enough ({limit} in each direction)"
        lines.append(f"Contacts off their places by {counts}: {names}")
    return lines


def lifted_lines(report: Report) -> list[str]:
    """The flights that are longer for what was lifted off the floor: lines."""
    return [
        f"Without what {' and '.join(f'“{name}”' for name in each.lifts)} "
        f"{'lifts' if len(each.lifts) == 1 else 'lift'} nothing touches from frame "
        f"{each.first_frame:.0f} to {each.last_frame:.0f}: the body flies for "
        f"{each.without_s:.2f} s there, with it for {each.with_contacts_s:.2f} s"
        for each in report.lifted_flights
    ]


def given_up_lines(report: Report) -> list[str]:
    """What is in each other, and the joints that go beyond their range, the worst first: lines."""
    ranked = sorted(report.given_up, key=_tolerances, reverse=True)
    told = [
        f"{_given_up(each)} (frame {each.worst_violation_frame:.0f}), beside what is asked for"
        for each in ranked[:MOST_GIVEN_UP]
    ]
    more = len(ranked) - len(told)
    return [*told, f"and {more} more, which the report lists"] if more else told


def missed_body_lines(missed: Sequence[BodyMiss]) -> list[str]:
    """The bones that controls leave elsewhere than solved, if there are any: a line."""
    bones = ", ".join(f"{each.bone} is up to {_off(each)} off" for each in missed)
    return [f"The rig's controls do not reach what was solved: {bones}"] if bones else []


def _off(miss: BodyMiss) -> str:
    """What a bone misses, but for what is nothing in whole millimetres or degrees."""
    far = [f"{miss.mm:.0f} mm (frame {miss.far_frame:g})"] * bool(round(miss.mm))
    turned = [f"{miss.degrees:.0f}° (frame {miss.turned_frame:g})"] * bool(round(miss.degrees))
    return " and ".join(far + turned)


def blend_lines(blends: Sequence[BlendReport]) -> list[str]:
    """The blends that have the hips far to go, or have feet slide that stand, with what may be
    done: lines."""
    return [
        f"The hips are {length(each.off_m)} beside the take at frame {_seam(each):g}: "
        f"the blend {'in' if each.into else 'out'} (frames {each.first_frame:g} to "
        f"{each.last_frame:g}) moves them at up to {each.speed_m_s:.1f} m/s (frame "
        f"{each.frame:g}), the take at {each.take_speed_m_s:.1f}, and feet slide. "
        f"{'Begin the range earlier' if each.into else 'End the range later'}, or blend over more "
        "frames"
        for each in blends
        if each.off_m > FAR_OFF and each.speed_m_s > each.take_speed_m_s + LURCH
    ] + [
        f"{each.slide_bone} slides by {1000.0 * each.slide_m:.0f} mm in the blend "
        f"{'in' if each.into else 'out'} (frames {each.first_frame:g} to {each.last_frame:g}), "
        "while it stands in the take. "
        f"{_BESIDE_A_STAND[each.into]}"
        for each in blends
        if each.slide_m > BLEND_SLIDES
    ]


def slide_lines(slide: float) -> list[str]:
    """Standing feet that slide, m, as a take goes back to where it was, if they do: a line."""
    if slide <= SLIDES:
        return []
    return [
        f"Standing feet slide by {1000.0 * slide:.0f} mm on the way back to where the take was; "
        "let the range end earlier, or what follows be carried along"
    ]


def _seam(blend: BlendReport) -> float:
    return blend.last_frame if blend.into else blend.first_frame


def _tolerances(each: ConstraintReport) -> float:
    """By how many of its tolerances it goes too far: millimetres and degrees compare."""
    return each.worst_violation / each.kind.reported(each.kind.tolerance, weight=1.0)


def _given_up(each: ConstraintReport) -> str:
    if each.kind is RowKind.RANGE:
        return f"{each.name} {each.worst_violation:.0f}° beyond its range"
    return f"{each.name}: {each.worst_violation:.0f} mm"


def most_telling(failed: tuple[CertificateLine, ...]) -> list[CertificateLine]:
    """A bad fit, and the few that are furthest beyond their limits, what is as recorded last."""
    fit = [line for line in failed if line.item in FITS]
    others = [line for line in failed if line.item not in FITS]
    others.sort(key=lambda line: (not line.as_recorded, line.value / line.limit), reverse=True)
    return [*fit, *others[:MOST_NAMED]]


def _is_seen_sliding(line: CertificateLine) -> bool:
    """Whether a loaded point slides by more than a viewer may see, though its line holds."""
    return line.item is Item.SLIDE and line.holds and line.value > SEEN_SLIDE


def line_told(line: CertificateLine) -> str:
    """Such as "a loaded point slides by 45 mm (Left toe 2, frame 231): limit 5 mm, recorded 2"."""
    where = f" ({line_place(line)})" if line_place(line) else ""
    recorded = "" if line.recorded is None else f", recorded {plain(line.recorded)}"
    said = f"{CERTIFICATE[line.item]} {with_unit(line.value, line.unit)}{where}"
    return f"{said}: limit {with_unit(line.limit, line.unit)}{recorded}"


def line_place(line: CertificateLine) -> str:
    frame = "" if line.frame is None else f"frame {line.frame:.0f}"
    return ", ".join(word for word in (line.where, frame) if word)


def with_unit(amount: float, unit: str) -> str:
    return f"{plain(amount)} {unit}".rstrip()


def plain(amount: float) -> str:
    """To three digits, or two places where there is less; without an exponent."""
    return f"{amount:.0f}" if amount >= 100.0 else f"{amount:.3g}" if amount >= 0.01 else "0"
