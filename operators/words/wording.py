"""Every fault and outcome in the artist's words: what is wrong, where, and what to do."""

from collections.abc import Sequence
from difflib import get_close_matches
from functools import singledispatch
from pathlib import Path

from ...solver.data import faults
from ...solver.data.faults import UnknownContact, UnknownPhase
from ...solver.data.row_kinds import RowKind, Violation
from ...solver.data.status import Status

OUTCOMES = {
    Status.SOLVED: "Solved: the motion obeys physics and everything asked for holds.",
    Status.STALLED: "No motion was found that obeys physics and holds all that is asked for. "
    "Ask for less of what is named here, move pins less, or check the contacts' frames.",
    Status.TOO_MANY_STEPS: "No motion was found within the allowed number of steps. "
    "Ask for less of what is named here, move pins less, or check the contacts' frames.",
    Status.MISSED: "The motion obeys physics, but between the solver's instants something asked "
    "for is missed by more than is promised. Loosen what is named here a little.",
    Status.STOPPED: "Stopped before everything was met; the motion is as the solver left it.",
}


@singledispatch
def sentence(fault: faults.Fault) -> str:
    """One or two sentences about a fault. Raises TypeError for a fault without words."""
    raise TypeError(f"no words for {type(fault).__name__}")


@sentence.register
def _(fault: faults.NoArmature) -> str:
    if fault.object_name is None:
        return "No armature is chosen; select the armature that carries the recording."
    return f"{_quoted(fault.object_name)} is or holds no armature; choose one with a recording."


@sentence.register
def _(fault: faults.NoAction) -> str:
    return (
        f"The armature {_quoted(fault.armature)} has no keyframes; "
        "assign it the action that holds the recording."
    )


@sentence.register
def _(fault: faults.NoBones) -> str:
    return f"The armature {_quoted(fault.armature)} has no bones; choose the recorded figure's."


@sentence.register
def _(fault: faults.ClipTooShort) -> str:
    return (
        f"Only {fault.seconds:.2f} s of the recording lie in the chosen frames, and a jump needs "
        f"{fault.minimum_s:g} s at least; choose more frames."
    )


@sentence.register
def _(fault: faults.NoFlight) -> str:
    return (
        "No flight was found: in the chosen frames the feet are never off the ground together "
        f"(the lower foot comes {max(fault.lowest_cm, 0.0):.1f} cm up at most). "
        "Choose frames that hold a jump; if they do, check the scale and the up axis."
    )


@sentence.register
def _(fault: faults.ZeroLengthBone) -> str:
    return (
        f"The bone {_quoted(fault.bone)} has no length, so it cannot carry mass; "
        "give it one in edit mode, or choose another bone for that part of the body."
    )


@sentence.register
def _(fault: faults.MissingPart) -> str:
    if len(fault.tried) == 1:
        tried = f" (no bone {_quoted(fault.tried[0])} is there)"
    else:
        tried = f" (looked for {', '.join(fault.tried)})" if fault.tried else ""
    return f"No bone was found for the {fault.part}{tried}; say which bone it is."


@sentence.register
def _(fault: faults.NonFiniteKey) -> str:
    return (
        f"The bone {_quoted(fault.bone)} has a value at frame {fault.frame:g} that is no number; "
        "delete or mend that key."
    )


@sentence.register
def _(fault: faults.BadScale) -> str:
    scale = ", ".join(f"{s:g}" for s in fault.scale)
    return (
        f"The scale of {_quoted(fault.object_name)} is ({scale}), but it must be the same, and "
        "above zero, along all three axes; apply the scale or make it even."
    )


@sentence.register
def _(fault: faults.UnreadableClip) -> str:
    line = "" if fault.line is None else f", line {fault.line}"
    return (
        f"The recording {fault.path}{line}: {fault.problem}; "
        "mend the file or export it again from where it came."
    )


@sentence.register
def _(fault: faults.BadRecipe) -> str:
    end = "" if fault.problem.endswith("?") else "."
    return f"{recipe_place(fault.path, fault.line)}: {fault.problem}{end}"


@sentence.register
def _(fault: faults.OutputNotWritable) -> str:
    return (
        f"Nothing can be written to {fault.path} ({fault.problem}); "
        "choose another folder or allow writing there."
    )


@sentence.register
def _(fault: faults.ContradictoryPins) -> str:
    return (
        f"{_quoted(fault.first)} and {_quoted(fault.second)} contradict each other by "
        f"{_length(fault.metres)}; no pose holds both, so move one of them or move them together."
    )


@sentence.register
def _(fault: faults.NoSolution) -> str:
    return outcome(fault.reason) + _furthest_off(fault)


@sentence.register
def _(fault: faults.NoFit) -> str:
    return (
        "The recording's own contacts cannot be held by a motion that obeys physics. "
        "Choose frames that begin earlier and end later, or correct the contacts' frames."
    ) + _furthest_off(fault)


def _furthest_off(fault: faults.NoSolution) -> str:
    worst = "; ".join(map(_missed, fault.worst))
    if not worst:
        return ""
    way = f"The best found goes {100.0 * fault.reached:.0f} % of the way; furthest off"
    return f" {way if fault.reached else 'Furthest off'}: {worst}."


@sentence.register
def _(fault: faults.UnseenSupport) -> str:
    return (
        f"From frame {fault.first:g} to {fault.last:g} neither foot touches the ground, yet the "
        "body does not fall, so something unseen carries it (a box, a rail, a hand); "
        "choose frames without it. If nothing does, give the scene the recording's frame rate."
    )


@sentence.register
def _(fault: faults.OddHeight) -> str:
    factor = float(f"{fault.factor:.2g}")  # 100, not 1e+02
    return (
        f"{_quoted(fault.armature)} is {fault.metres:.3g} m tall, so gravity does not fit its "
        f"motion; import it again at {factor:g} times the scale, or scale its object so."
    )


@sentence.register
def _(fault: faults.OutsideKeys) -> str:
    return (
        f"In the chosen frames {_quoted(fault.armature)} has no keys; they lie from frame "
        f"{fault.first:g} to {fault.last:g}, so choose frames there."
    )


@sentence.register
def _(fault: faults.UnknownContactName) -> str:
    return (
        f"There is no contact {_quoted(fault.name)} in these frames; "
        f"there are {_names(fault.known)}."
    )


@sentence.register
def _(fault: faults.UnknownBone) -> str:
    return (
        f"{_quoted(fault.request)} names the bone {_quoted(fault.bone)}, which the armature does "
        "not have; choose one of its bones."
    )


@sentence.register
def _(fault: faults.NotAboveZero) -> str:
    return (
        f"{_quoted(fault.request)} asks for a mass or a factor of {fault.amount:g}; "
        "give it one above zero."
    )


@sentence.register
def _(fault: faults.UnknownPhaseIn) -> str:
    return (
        f"{_quoted(fault.request)} is about the phase {_quoted(fault.phase)}, which the clip does "
        f"not have; it has {_names(fault.known)}."
    )


@sentence.register
def _(fault: faults.StillBone) -> str:
    # All of them would run off the screen.
    near = get_close_matches(fault.bone, fault.known, n=4, cutoff=0.0)
    return (
        f"{_quoted(fault.request)} names the bone {_quoted(fault.bone)}, which is none of those "
        f"that physics moves; those most like it are {_names(tuple(near))}."
    )


@sentence.register
def _(fault: faults.BadTiming) -> str:
    return (
        f"{_quoted(fault.request)} would last {fault.seconds:.3f} s, or lies outside the clip; "
        "change its frames, phase or duration."
    )


@sentence.register
def _(fault: faults.RootHasNoJoint) -> str:
    return (
        f"{_quoted(fault.request)} limits the joint of {_quoted(fault.bone)}, but that is the "
        "root, which has no joint; choose a bone that hangs on another."
    )


@sentence.register
def _(fault: faults.NeedsTorques) -> str:
    return (
        f"{_quoted(fault.request)} is about torques, but the reduced dynamics have none; "
        'choose "automatic" or "standard" dynamics.'
    )


@sentence.register
def _(fault: faults.NothingTouches) -> str:
    who = _names(fault.touching) if fault.touching else "nothing"
    return (
        f"{_quoted(fault.request)} is about {who}, which does not touch then; "
        "name contacts, points or bones that the analysis lists."
    )


@sentence.register
def _(fault: faults.WrongAngle) -> str:
    return (
        f"{_quoted(fault.request)} names an angle that the joint of {_quoted(fault.bone)} does "
        f"not have; it has {fault.count}, counted from 0."
    )


@sentence.register
def _(fault: faults.FreePoint) -> str:
    return (
        f"{_quoted(fault.request)} is pushed by the world but held in no direction; "
        "hold it in one at least, or let it be no part of the environment."
    )


@sentence.register
def _(fault: faults.TakenName) -> str:
    return (
        f"{_quoted(fault.request)} is called like a contact that was found; "
        "give it a name of its own."
    )


@sentence.register
def _(fault: faults.TimedTwice) -> str:
    return (
        f"{_quoted(fault.request)} is the second to say how long {_quoted(fault.phase)} takes; "
        "keep one."
    )


@sentence.register
def _(fault: faults.NoBoneChosen) -> str:
    return f"{_quoted(fault.request)} is about no bone yet; choose one, or switch it off."


@sentence.register
def _(fault: faults.NoPhaseChosen) -> str:
    return (
        f"{_quoted(fault.request)} holds in a phase, but none is chosen; "
        f"there are {_names(fault.known)}."
    )


@sentence.register
def _(fault: faults.EmptyRange) -> str:
    return (
        f"{_quoted(fault.request)} ends at frame {fault.last:g}, before it begins at frame "
        f"{fault.first:g}; swap them."
    )


@sentence.register
def _(fault: faults.CrossedBounds) -> str:
    return (
        f"{_quoted(fault.request)} asks for at least {fault.at_least:.4g} {fault.unit} and at most "
        f"{fault.at_most:.4g} {fault.unit}, which nothing is; raise the one or lower the other."
    )


@sentence.register
def _(fault: faults.AsksNothing) -> str:
    return f"{_quoted(fault.request)} asks for nothing; switch on one of its options, or it off."


@sentence.register
def _(fault: faults.NoDirection) -> str:
    return f"{_quoted(fault.request)} has an axis that points nowhere; give it a direction."


@sentence.register
def _(fault: faults.NamedTwice) -> str:
    return (
        f"{_quoted(fault.request)} is the name of two constraints, body changes or contacts; "
        "rename one, so that the report can tell them apart."
    )


@sentence.register
def _(fault: faults.NameMissing) -> str:
    return f"A constraint ({fault.kind}) has no name; give it one in the list."


@sentence.register
def _(fault: faults.WorkerDied) -> str:
    return (
        f"The solver stopped without an answer ({fault.detail}); "
        "nothing was changed. Try again, and report it if it happens twice."
    )


@sentence.register
def _(fault: faults.ChangedMeanwhile) -> str:
    what = "The result was thrown away" if fault.while_solving else "Nothing was done"
    return (
        f"{what}, because the armature {_quoted(fault.armature)} or its keys changed since the "
        "analysis; press Analyze again."
    )


@sentence.register
def _(fault: faults.BadDimensions) -> str:
    return (
        f"The figure cannot be reduced to {fault.given} dimensions; "
        f"choose from 1 to {fault.most}, or leave them out to have them chosen."
    )


@sentence.register
def _(fault: faults.UnknownReductionBone) -> str:
    return (
        f"Row {fault.row} of the reduction's matrix names {_quoted(fault.bone)}, whose joint "
        f"cannot be tied to others; those that can are {_names(fault.known)}."
    )


@sentence.register
def _(fault: faults.WrongWeights) -> str:
    return (
        f"Row {fault.row} of the reduction's matrix gives {_quoted(fault.bone)} a list of "
        f"{fault.given} weights, but its joint has {fault.needed} angles; give one weight each."
    )


@sentence.register
def _(fault: faults.DependentRows) -> str:
    return (
        f"Of the {fault.rows} rows of the reduction's matrix only {fault.rank} say something that "
        "the others do not; leave out the empty and the repeated ones."
    )


@sentence.register
def _(fault: UnknownPhase) -> str:
    return (
        f"The pin {_quoted(fault.pin)} names the phase {_quoted(fault.phase)}, on which nothing "
        f"touches the ground; there are {_names(fault.known)}."
    )


@sentence.register
def _(fault: UnknownContact) -> str:
    return (
        f"The pin {_quoted(fault.pin)} names {_quoted(fault.what)}, which does not touch in its "
        f"phase; what touches is {_names(fault.known)}."
    )


def outcome(status: Status) -> str:
    """How a solve ended, and what to do about it."""
    return OUTCOMES[status]


def recipe_place(path: str | Path, line: int | None) -> str:
    """Where in a recipe something is wrong."""
    return f"Recipe {path}" if line is None else f"Recipe {path}, line {line}"


# What of a constraint is left, by its type; with its name, quoted or bare, and how much.
MISSED = {
    RowKind.BALANCE: "in {name}, {amount:.3g} of the body's weight is not carried as it must be",
    RowKind.MOMENT: "in {name}, the body turns without cause ({amount:.3g} BW·m)",
    RowKind.PIN: "{quoted} stays {length} from its place",
    RowKind.PIN_SPEED: "{quoted} still slides at {amount:.3g} m/s",
    RowKind.POINT: "{quoted} stays {length} from its place",
    RowKind.BEND: "{quoted} is missed by {amount:.3g}°",
    RowKind.CONE: "{quoted} is missed by {amount:.3g}°",
    RowKind.TWIST: "{quoted} is missed by {amount:.3g}°",
    RowKind.ORIENTATION: "{quoted} is missed by {amount:.3g}°",
    RowKind.POSE: "{quoted} is missed by {amount:.3g}°",
    RowKind.PUSH: "{quoted} would have to pull with {amount:.3g} of the body's weight",
    RowKind.FRICTION: "{quoted} slips: {amount:.3g} of the body's weight beyond its friction",
    RowKind.PEAK: "{quoted} is exceeded by {amount:.3g} of the body's weight",
    RowKind.TORQUE: "{quoted} needs {amount:.3g} N·m more than its limit",
}


def _missed(violation: Violation) -> str:
    name, amount = violation.name, violation.amount
    words = {"name": name, "quoted": _quoted(name), "amount": amount}
    return MISSED[violation.kind].format(**words, length=_length(amount / 1000.0))


def _quoted(name: str) -> str:
    return f"“{name}”"


def _names(names: Sequence[str]) -> str:
    return ", ".join(names) if names else "none"


def _length(metres: float) -> str:
    if metres < 0.02:
        return f"{1000 * metres:.3g} mm"
    return f"{100 * metres:.1f} cm" if metres < 1.0 else f"{metres:.2f} m"
