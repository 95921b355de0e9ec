"""Messages to the artist: every fault and solver status in words, from the templates."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from string import Formatter
from typing import Any

from ...solver.data import faults
from ...solver.data.faults import Fault
from ...solver.data.row_kinds import RowKind, Violation
from ...solver.data.status import Status
from .doctor_text import damage_sentence
from .templates import (
    ASKED,
    AT_FRAME,
    AT_ITS_END,
    DAMAGED,
    MISSED,
    MORE_DAMAGES,
    MORE_NAMES,
    OUTCOMES,
    PLACES,
    TEMPLATES,
)

Translate = Callable[[str], str]
MOST_DAMAGES = 2  # told with a failure; the doctor tells all
FEW = 4  # names of a list that tells a rigger which bones are meant


def sentence(fault: Fault, translate: Translate = str) -> str:
    """One or two sentences about a fault. Raises TypeError for a fault without words.

    translate: of a template into the artist's language.
    """
    if (template := TEMPLATES.get(type(fault))) is None:
        raise TypeError(f"no words for {type(fault).__name__}")
    if not isinstance(template, str):
        template = template[_variant(fault)]
    return _Formatter(translate).format(translate(template), fault)


def together(found: Sequence[Fault]) -> list[Fault]:
    """Faults, those of support that is unseen and of which no more is known, or no more than that
    the body leans, in one."""
    told = [*found]
    for leaning in (False, True):
        alike = [e for e in told if isinstance(e, faults.UnseenSupport) and _variant(e) == leaning]
        if len(alike) > 1:
            spans = tuple((each.first, each.last) for each in alike)
            others = (each for each in told if each not in alike)
            told = [faults.UnseenSupports(spans, leaning), *others]
    return told


def missed(violation: Violation, translate: Translate = str) -> str:
    """What is left of a violation, without a full stop."""
    return _Formatter(translate).missed(violation)


def outcome(status: Status, translate: Translate = str) -> str:
    """The solver's termination status in words, and what to do about it."""
    return translate(OUTCOMES[status])


def recipe_place(path: str | Path, line: int | None) -> str:
    """Location of a fault in a recipe."""
    return PLACES[line is not None].format(path=path, line=line)


def _variant(fault: Fault) -> int:
    """Index of the template for a fault whose class has several."""
    match fault:
        case faults.NoArmature():
            return fault.object_name is not None
        case faults.CycleClimbs():
            return fault.metres < 0.0
        case faults.NotMirrored():
            return 2 if fault.bone and fault.bone == fault.partner else bool(fault.bone)
        case faults.MissingPart():
            return min(len(fault.tried), 2)
        case faults.ClipTooShort():
            return 0 if fault.chosen else 2 if fault.frames[0] == fault.frames[1] else 1
        case faults.UnreadableClip() | faults.BadRecipe():
            return fault.line is not None
        case faults.UnreadableText():
            return fault.cure.value
        case faults.NoSolution():
            if is_in_its_way(fault):
                return 6
            told = (2 if fault.goes_part else 1) if fault.worst else 0
            return told + (3 if _begins_far_off(fault) else 0)
        case faults.RenamedBones():
            return fault.paired
        case faults.BadTiming():
            return fault.seconds < 0.0
        case faults.NothingTouches():
            return bool(fault.touching)
        case faults.JoinedPhase():
            return bool(fault.kept)
        case faults.UnseenSupport():
            carrying = fault.leaning, bool(fault.boxes), bool(fault.hands), fault.rate is not None
            mistaken = fault.exchanged, fault.skidding, fault.lying, fault.resting
            held = bool(fault.holds), bool(fault.holds and fault.boxes)
            return _last_of(True, *carrying, *mistaken, bool(fault.walls), *held)
        case faults.OffBalance():
            on_hands = bool(fault.hands), bool(fault.touching), bool(fault.holds)
            return _last_of(True, bool(fault.resting), *on_hands)
        case faults.UnseenSupports():
            return fault.leaning
        case faults.StandsIn():
            return fault.beside
        case faults.NoFaceThere():
            return fault.reach is not None
        case faults.UnknownObject():
            return bool(fault.known)
        case faults.ChangedMeanwhile():
            return fault.while_solving + (2 if fault.changed else 0)
        case faults.RateChanged():
            return fault.while_solving
    raise TypeError(f"which words are for {type(fault).__name__}?")


def _last_of(*told: bool) -> int:
    """Index of the last that is true."""
    return max(i for i, each in enumerate(told) if each)


def is_in_its_way(fault: faults.NoSolution) -> bool:
    """Whether a recording of which nothing was asked goes through something."""
    through = bool(fault.worst) and fault.worst[0].kind is RowKind.SOLID
    return fault.reason is Status.NO_BODY and through and not fault.asked


def _begins_far_off(fault: faults.NoSolution) -> bool:
    """Whether the advice is about the fit that the solve begins from."""
    is_fit, stopped = isinstance(fault, faults.NoFit), fault.reason is Status.STOPPED
    return fault.fit_off_cm > 0.0 and not is_fit and not stopped


class _Formatter(Formatter):
    """`str.format`, whose fields are the attributes of what it is given."""

    def __init__(self, translate: Translate) -> None:
        self._translate = translate

    def get_value(self, key: int | str, args: Sequence[Any], _: Mapping[str, Any]) -> Any:
        return getattr(args[0], str(key))

    def format_field(self, value: Any, format_spec: str) -> Any:
        match format_spec:
            case "names":
                return ", ".join(value) or "none"
            case "few":
                return _few(value, self._translate)
            case "spans":
                return ", ".join(f"{first:g} to {last:g}" for first, last in value)
            case "contacts":
                return ", ".join(
                    f"{each.point} {each.start_frame:g} to {each.end_frame:g}" for each in value
                )
            case "held":
                return ", ".join(
                    f"{each.bone} {each.when.frames[0]:g} to {each.when.frames[1]:g}"
                    for each in value
                )
            case "numbers":
                return ", ".join(f"{number:g}" for number in value)
            case "plain":  # 100, not 1e+02
                return f"{float(f'{value:.2g}'):g}"
            case "digits":  # four, likewise
                return f"{float(f'{value:.4g}'):.10g}"
            case "percent":
                return f"{100.0 * value:.0f} %"
            case "length":
                return length(value)
            case "millimetres":
                return length(value / 1000.0)
            case "ended":
                return value if value.endswith("?") else f"{value}."
            case "outcome":
                return outcome(value, self._translate)
            case "asked":
                told = _few([f"“{name}”" for name in value], self._translate)
                return f" {self._translate(ASKED).format(told)}" if value else ""
            case "at":
                return "" if value is None else self._translate(AT_FRAME).format(value)
            case "damages":
                return _damages(value, self._translate)
            case "missed":
                return "; ".join(self.missed(each) for each in value)
        return super().format_field(value, format_spec)

    def missed(self, violation: Violation) -> str:
        """A violation in words."""
        at_end = violation.kind is RowKind.RANGE and violation.amount == 0.0
        template = AT_ITS_END if at_end else MISSED[violation.kind]
        return self.format(self._translate(template), violation)


def _few(names: Sequence[str], translate: Translate) -> str:
    """The first names of a list, and how many more there are."""
    told = ", ".join(names[:FEW])
    more = len(names) - FEW
    return translate(MORE_NAMES).format(told, more) if more > 0 else told


def _damages(found: Sequence[faults.Damage], translate: Translate) -> str:
    """What is wrong with a recording that may be why it cannot be held, and what to do about it,
    after a sentence; nothing of none."""
    if not found:
        return ""
    told = " ".join(damage_sentence(each) for each in found[:MOST_DAMAGES])
    more = len(found) - MOST_DAMAGES
    rest = translate(MORE_DAMAGES).format(more) if more > 0 else ""
    return f" {translate(DAMAGED).format(told)}{rest}"


def length(metres: float) -> str:
    """A length in the unit that suits it: "3.2 mm", "42.0 cm", "1.25 m"."""
    if metres < 0.02:
        return f"{1000 * metres:.3g} mm"
    return f"{100 * metres:.1f} cm" if metres < 1.0 else f"{metres:.2f} m"
