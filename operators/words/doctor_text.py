"""Wording of what the doctor finds: what is wrong, where, and the remedy."""

from math import sqrt

from ...bridge.recipe.recording import RECORDING
from ...bridge.recipe_syntax.toml_text import entries
from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.data.faults import Damage
from ...solver.data.recording import MIN_CLIP_DURATION
from ...solver.doctor.examination.diagnose import Diagnosis
from ...solver.doctor.finding import Finding, FindingKind
from ...solver.doctor.repairs import Repairs
from ...solver.doctor.stance.feet import FootFault

MOST_PLACES = 6
HEALTHY = "Nothing is wrong with the recording."

EXCHANGED = (
    "are exchanged {where}, as capture mistakes them: {part} leaps by {amount} where that begins "
    "or ends, and if they are exchanged back it does not."
)

# {n}: the number, {count}: of frames, with its verb, {speed} and {way}: of it, without its sign,
# and upwards or downwards, {amount}: with its unit, {part}, {where}: "at frame 12" or "in frames 3
# to 9, 40"; "" without frames.
# {clock}: how the recording is played. {end}: what hangs on the part and leaves its place.
SENTENCES = {
    FindingKind.UP_AXIS: "The figure lies: another axis than Z points from its feet to its head.",
    FindingKind.BIND_POSE: "The rest pose is held {where}, with a jump between it and the motion.",
    FindingKind.FULL_TURN: "{part} turns once around {where} and ends as it began: an angle that "
    "leaps from 180° to -180° was interpolated, as exporters do.",
    FindingKind.EXCHANGED_LEGS: f"The left and the right leg {EXCHANGED}",
    FindingKind.EXCHANGED_ARMS: f"The left and the right arm {EXCHANGED}",
    FindingKind.FLIP: "{part} is turned by half a turn {where}.",
    FindingKind.SPIKE: "Frames are far from those around them, {part} by {amount}: {where}.",
    FindingKind.CONVERTED_RATE: "The clip was made from {n:.4g} frames a second by repeating some "
    "at a steady beat, {where}: the body stops at each and hurries in between.",
    FindingKind.HELD_FRAMES: "The pose of the frame before is held {where}, amid a "
    "movement that goes on as if time had passed.",
    FindingKind.REPEATED_FRAMES: "The pose is held {where} and the movement then goes on from "
    "where it stopped: {n:.0f} frames are too many.",
    FindingKind.DROPPED_FRAMES: "About {count} missing: the whole body jumps {where}.",
    FindingKind.BONE_LENGTH: "{part} changes its length by up to {n:.1f} cm {where}{end}.",
    FindingKind.NOISE: "The joints tremble by {n:.1f} mm from frame to frame, {part} most.",
    FindingKind.LEVEL_HIPS: "The hips keep one height, though the legs below them stretch and bend "
    "by {n:.0f} % of their length: how the body rises and sinks was left out, as in an export “In "
    "Place” or in capture that tells all places from the hips, so nothing it does obeys gravity.",
    FindingKind.TIME_SCALE: "The body falls at {n:.1f} m/s² {where}, not at 9.8: {clock}.",
    FindingKind.RETIMED: "The body falls at {n:.1f} m/s² {where}, and at about 9.8 in other "
    "flights: that part was retimed, so {clock}.",
    FindingKind.SIZE: "The figure is {n:.2g} m tall, which nobody is.",
    FindingKind.TOO_SHORT: "The clip is {n:.2f} s long, too short to be adapted: a jump needs "
    f"{MIN_CLIP_DURATION:g} s at least.",
    FindingKind.MASS: "{n:.0f} kg do not go with the figure's height.",
    FindingKind.JUMP: "{part} jumps by {amount} {where}, as where two takes were joined, capture "
    "mistook something, or many frames are missing.",
    FindingKind.LEAP: "The whole body is jerked downwards at up to {n:.1f} g {where}, as capture "
    "does that had lost it: nothing pulls like this.",
    FindingKind.FLOOR: "The feet stand at a height of {n:.2f} m, not on the floor at 0.",
    FindingKind.TILTED: "The feet stand on a floor that slopes by {n:.1f}°, as that of a camera "
    "that was not level does: turn it level if the floor was, and leave it if that is a true ramp.",
    FindingKind.RISING: "The whole body drifts {way} at {speed:.2f} m/s while it stands.",
    FindingKind.SLIDING: "The whole body slides along the floor at {n:.2f} m/s while it stands.",
    FindingKind.IN_PLACE: "The hips keep their place, and the feet that carry the body slide at "
    "{n:.1f} m/s {where}: their way along the floor was left out, as exports “In Place” do, or "
    "the performer went on a treadmill, which is the same.",
    FindingKind.FLOATING: "The whole body floats about: feet that stand flat move by up to "
    "{n:.0f} cm, as capture by one camera has it.",
    FindingKind.SINKING: "The feet are up to {n:.0f} cm below the floor that they stand on "
    "elsewhere, {part} most, {where}.",
    FindingKind.SLIDING_FEET: "Feet slide while they stand, {part} most, by {n:.0f} cm: {where}. "
    "Contacts hold them.",
    FindingKind.FLICKER: "{part} and others leave the floor for moments and come back {where}.",
    FindingKind.UNSEEN_SUPPORT: "Nothing touches, yet the body does not fall {where}: something "
    "carries it that the recording does not show.",
    FindingKind.SKIDDING: "The feet that carry the body skid to another place {where}, as none "
    "does under load but on what moves.",
    FindingKind.OFF_BALANCE: "The weight is beside what touches {where}, as of who sits, leans, "
    "hangs or is on hands: something carries it that the recording does not show.",
    FindingKind.BEGINS_IN_AIR: "The clip begins in the air.",
    FindingKind.ENDS_IN_AIR: "The clip ends in the air.",
}


# Said after it, where there is no remedy.
ADVICE = {
    FindingKind.JUMP: " Choose frames on one side of it.",
    FindingKind.LEAP: " Choose frames without it.",
    FindingKind.IN_PLACE: " Export the recording again without “In Place”.",
    FindingKind.SINKING: " Raise the foot, or the hips, there, or choose frames without it.",
    FindingKind.RETIMED: " Give it its own speed again, or choose frames without it.",
    FindingKind.LEVEL_HIPS: " Export the recording again with the hips' height.",
}

# Of the buttons. {n}: the remedy's number.
REMEDIES = {
    FindingKind.UP_AXIS: "Turn Upright",
    FindingKind.BIND_POSE: "Leave Out",
    FindingKind.FULL_TURN: "Turn On",
    FindingKind.EXCHANGED_LEGS: "Exchange Back",
    FindingKind.EXCHANGED_ARMS: "Exchange Back",
    FindingKind.FLIP: "Turn Back",
    FindingKind.SPIKE: "Smooth Over",
    FindingKind.CONVERTED_RATE: "Even Out",
    FindingKind.HELD_FRAMES: "Fill In",
    FindingKind.REPEATED_FRAMES: "Take Out",
    FindingKind.DROPPED_FRAMES: "Put In",
    FindingKind.BONE_LENGTH: "Hold Lengths",
    FindingKind.NOISE: "Smooth",
    FindingKind.JUMP: "Keep the Longest Part",
    FindingKind.LEAP: "Keep the Longest Part",
    FindingKind.FLOOR: "Put on the Floor",
    FindingKind.TILTED: "Turn Level",
    FindingKind.RISING: "Hold Level",
    FindingKind.SLIDING: "Hold Still",
    FindingKind.LEVEL_HIPS: "Give the Height Back",
    FindingKind.IN_PLACE: "Give the Way Back",
    FindingKind.FLOATING: "Hold to the Ground",
    FindingKind.SINKING: "Lift Out",
}
REPAIR = "Repair"


def remedy_label(finding: Finding, remedy: Repairs, mass: float, rate: float) -> str:
    """What a remedy does, for its button. mass: kg, of a finding about the mass. rate: the frames a
    second that the scene has without repairs."""
    if mass:
        return f"Set {mass:.0f} kg"
    if remedy.time_scale != 1.0:
        return f"Set {rate / remedy.time_scale:.4g} fps"
    if remedy.scale != 1.0:
        if finding.kind is FindingKind.SIZE:
            return f"Scale to {finding.amount * remedy.scale:.2f} m"
        return f"Scale × {remedy.scale:.3g}"
    alone = (remedy.floor, FindingKind.FLOOR), (remedy.rise, FindingKind.RISING)
    for told, kind in (*alone, (any(remedy.tilt), FindingKind.TILTED)):
        if told:
            return REMEDIES[kind]
    return REMEDIES.get(finding.kind, REPAIR)


def finding_sentence(finding: Finding) -> str:
    """What is wrong and where."""
    sentence = SENTENCES[finding.kind]
    told = sentence.format(
        n=finding.amount,
        count="1 frame is" if round(finding.amount) == 1 else f"{finding.amount:.0f} frames are",
        speed=abs(finding.amount),
        way="upwards" if finding.amount > 0.0 else "downwards",
        amount=amount_text(finding),
        part=finding.part or "the whole body",
        where=_where(finding),
        clock=_clock(finding),
        end=f": {finding.end} leaves its place on it" if finding.end else "",
    )
    advice = ADVICE.get(finding.kind, "") if finding.remedy is None else ""
    named = finding.part and sentence.startswith("{part}")  # a bone is called as it is
    return f"{told if named else told[0].upper() + told[1:]}{advice}"


def damage_sentence(damage: Damage) -> str:
    """What is wrong with a recording that cannot be held, and how its poses are mended."""
    kind = FindingKind(damage.kind)
    mends = Repairs(mend=damage.mend, time_scale=damage.time_scale)
    remedy = None if mends == Repairs() else mends
    about = damage.amount, damage.unit, damage.frames, damage.part
    told = finding_sentence(Finding(kind, *about, remedy, end=damage.end))
    if not damage.mend:
        return told
    key = remedy_text(Repairs(mend=damage.mend))
    return f"{told} “{REMEDIES[kind]}”, or {key} in a recipe, mends it."


def amount_text(finding: Finding) -> str:
    """Such as "35°" and "40 cm"; "5.64e+38 cm" of a slip of the file."""
    number = f"{finding.amount:.0f}" if finding.amount < 1e6 else f"{finding.amount:.3g}"
    return f"{number}{'' if finding.unit == '°' else ' '}{finding.unit}"


def foot_fault_words(fault: FootFault) -> str:
    """Such as "Left toe slides 8 cm"."""
    return f"{fault.point} {fault.kind.value} {100.0 * fault.amount:.0f} cm"


def diagnosis_text(diagnosis: Diagnosis) -> str:
    """A paragraph a finding: the sentence, then the recipe's lines that are its remedy."""
    lines = [] if any(not f.kind.note for f in diagnosis.findings) else [HEALTHY]
    for finding in diagnosis.findings:
        lines.append(f"{'note: ' if finding.kind.note else ''}{finding_sentence(finding)}")
        if finding.kind is FindingKind.MASS and diagnosis.mass is not None:
            lines.append(f"    remedy: mass = {diagnosis.mass:.0f}")
        if finding.remedy is not None:
            lines.append(f"    remedy: {remedy_text(finding.remedy)}")
        if finding.alternative is not None:
            lines.append(f"    or else: {remedy_text(finding.alternative)}")
    return "\n".join(lines) + "\n"


def remedy_text(remedy: Repairs) -> str:
    """The keys of a recipe's [recording] that are the remedy, in one line."""
    return ", ".join(entries(RECORDING.write(rounded(remedy))).splitlines())


def rounded(repairs: Repairs) -> Repairs:
    """To as many digits as mean something."""
    return Repairs(
        repairs.up,
        repairs.missing,
        repairs.trim,
        repairs.mend,
        float(f"{repairs.time_scale:.4g}"),
        float(f"{repairs.scale:.4g}"),
        (round(repairs.drift[0], 4), round(repairs.drift[1], 4)),
        round(repairs.floor, 4),
        repairs.trim_end,
        round(repairs.rise, 4),
        (round(repairs.tilt[0], 2), round(repairs.tilt[1], 2)),
    )


def _where(finding: Finding) -> str:
    spans = [f"{a:g}" if a == b else f"{a:g} to {b:g}" for a, b in finding.frames]
    if not spans:
        return ""
    more = len(spans) - MOST_PLACES
    others = f" and {more} more place{'s' if more > 1 else ''}" if more > 0 else ""
    listed = ", ".join(spans[:MOST_PLACES]) + others
    one = len(spans) == 1 and finding.frames[0][0] == finding.frames[0][1]
    return f"at frame {listed}" if one else f"in frames {listed}"


def _clock(finding: Finding) -> str:
    scale = finding.remedy.time_scale if finding.remedy is not None else 1.0
    if finding.kind is FindingKind.RETIMED:
        scale = sqrt(finding.amount / STANDARD_GRAVITY)
    if scale < 1.0:
        return f"it is played {1.0 / scale:.2f} times too slowly"
    return f"it is played {scale:.2f} times too fast"
