"""Every fault has words of its own, which name what the fault carries."""

import ast
import dataclasses
import importlib
import inspect
import pkgutil
from string import Formatter
from types import ModuleType
from typing import get_type_hints

import hangtime.solver
import pytest
from hangtime.devtools.doctor.damages.poses import stretched
from hangtime.operators.words.failure_text import BEFORE_CURE, failure_of
from hangtime.operators.words.messages import sentence, together
from hangtime.operators.words.templates import (
    MISSED,
    OUTCOMES,
    TEMPLATES,
    changes,
    loops,
    outcomes,
    recordings,
    requests,
    rigs,
    scenes,
    solving,
)
from hangtime.solver.data.faults import (
    BadRecipe,
    Damage,
    Fault,
    MissingPart,
    NoControls,
    NoFit,
    NoSolution,
    RequestFault,
    SceneFault,
    SpanChanged,
    TextCure,
    UnseenSupport,
)
from hangtime.solver.data.problem import AddedContact, MotionProblem
from hangtime.solver.data.requests import PointRequest, When
from hangtime.solver.data.row_kinds import RowKind, Violation
from hangtime.solver.data.scene import SupportBox
from hangtime.solver.data.status import Status
from hangtime.solver.doctor.examination import suspects
from hangtime.solver.doctor.examination.suspects import damages_of
from hangtime.solver.doctor.finding import FindingKind
from hangtime.tests.helpers.clips import JUMP, load_recording


def all_faults() -> list[type[Fault]]:
    for module in pkgutil.walk_packages(hangtime.solver.__path__, "hangtime.solver."):
        importlib.import_module(module.name)
    return sorted(descendants(Fault) - {RequestFault, SceneFault}, key=lambda fault: fault.__name__)


def descendants(base: type[Fault]) -> set[type[Fault]]:
    return {f for c in base.__subclasses__() for f in {c} | descendants(c)}


def made(kind: type[Fault]) -> Fault:
    """A fault with a value of the right type in every field."""
    hints = get_type_hints(kind)
    return kind(**{field.name: filled(hints[field.name]) for field in dataclasses.fields(kind)})


def filled(hint: object) -> object:
    text = str(hint)
    if hint is Status:
        return Status.STALLED
    if "Damage" in text:
        return ()
    if "Violation" in text:
        return (Violation("Landing: Left heel 2", RowKind.PIN, 12.0),)
    if "AddedContact" in text:
        return (AddedContact("Left hand", 3.0, 9.0),)
    if "PointRequest" in text:
        return (PointRequest("Bar", "Hand", When(frames=(3.0, 9.0))),)
    if "SupportBox" in text:
        return (SupportBox((0.4, 0.3, 0.31), (0.0, 0.0, 0.0), 0.0),)
    if text.startswith("tuple[tuple[float"):
        return ((1.0, 2.0), (4.0, 7.0))
    if text.startswith("tuple[float"):
        return (1.0, 2.0, 3.0)
    if text.startswith("tuple[str"):
        return ("one", "two")
    if hint is TextCure:
        return TextCure.ANALYZE
    if text.startswith("float"):  # or None
        return 0.25
    return {float: 0.25, bool: True, str: "stalled"}.get(hint, 7 if "int" in text else "stalled")


@pytest.mark.parametrize("kind", all_faults(), ids=lambda kind: kind.__name__)
def test_every_fault_has_its_own_words(kind: type[Fault]) -> None:
    words = sentence(made(kind))
    assert words[0].isupper() or words[0] == "“"
    assert words.endswith((".", "?"))
    assert words.count(". ") <= 2
    assert not {"{", "None", "ValueError"} & set(words.split())


def templates_of(kind: type[Fault]) -> tuple[str, ...]:
    return (words,) if isinstance(words := TEMPLATES[kind], str) else words


def test_nothing_but_faults_has_a_template() -> None:
    assert set(TEMPLATES) == set(all_faults())


@pytest.mark.parametrize("kind", all_faults(), ids=lambda kind: kind.__name__)
def test_every_template_can_be_filled(kind: type[Fault]) -> None:
    fault, known = made(kind), templates_of(kind)
    for template in known:
        named = [name for _, name, _, _ in Formatter().parse(template) if name is not None]
        assert all(hasattr(fault, name.partition("[")[0]) for name in named), template
        words = sentence(fault, lambda text, t=template: t if text in known else text)
        assert "{" not in words


@pytest.mark.parametrize(
    "templates", [changes, loops, outcomes, recordings, requests, rigs, scenes, solving]
)
def test_every_template_is_one_literal_for_translators(templates: ModuleType) -> None:
    body = ast.parse(inspect.getsource(templates)).body
    tables = [each.value for each in body if isinstance(each, ast.Assign | ast.AnnAssign)]
    built = ast.JoinedStr, ast.BinOp, ast.Call
    assert not [node for table in tables for node in ast.walk(table) if isinstance(node, built)]


def test_templates_are_translated_before_they_are_filled() -> None:
    german = {templates_of(MissingPart)[0]: "Kein Knochen für „{part}“."}
    assert sentence(MissingPart("head"), german.__getitem__) == "Kein Knochen für „head“."


def test_what_is_left_is_translated_as_well() -> None:
    pin = Violation("Landing", RowKind.PIN, 12.3)
    fault = NoSolution(Status.STALLED, (pin,), reached=0.25)
    seen: list[str] = []
    sentence(fault, lambda template: seen.append(template) or template)
    assert seen[1:] == [OUTCOMES[Status.STALLED], MISSED[RowKind.PIN]]


@pytest.mark.parametrize(("reached", "told"), [(0.25, True), (0.99, True), (1.0, False)])
def test_only_a_part_of_the_way_is_told(reached: float, told: bool) -> None:
    elbow = Violation("Right elbow bends", RowKind.RANGE, 178.0)
    fault = NoSolution(Status.NO_BODY, (elbow,), reached=reached)
    text = sentence(fault)
    assert "Right elbow bends" in text
    assert ("of the way" in text) is told
    assert ("of the way" in failure_of(fault, 1, "adapt").text) is told


def test_a_line_that_may_be_cut_off_begins_with_the_cure() -> None:
    line = failure_of(SpanChanged(before=(1, 90), now=(1, 60)), 1, "adapt").cure_first
    assert line.startswith("Press Analyze again, or choose")
    assert line.endswith(
        ". Nothing was done, because frames 1 to 60 are to be adapted now, but 1 "
        "to 90 were analysed."
    )


def test_a_remark_in_brackets_is_no_cure() -> None:
    lying = failure_of(UnseenSupport(1.0, 9.0, lying=True), 1, "analyze")
    assert lying.cure_first.startswith("Import the clip again with other axes, or turn it upright")
    assert lying.cure_first.endswith("neither foot touches the ground.")
    assert lying.short.startswith("The figure lies")


@pytest.mark.parametrize(
    "template",
    [
        each
        for fault, told in TEMPLATES.items()
        if not issubclass(fault, NoSolution)  # whose rows are told in its place
        for each in ([told] if isinstance(told, str) else told)
    ],
)
def test_it_is_clear_where_the_cure_begins(template: str) -> None:
    """A header shows it first, and may cut off the rest."""
    assert len(BEFORE_CURE.split(template)) <= 2


def test_a_fault_without_words_is_noticed() -> None:
    class Wordless(Fault):
        pass

    with pytest.raises(TypeError, match="Wordless"):
        sentence(Wordless())


def test_every_status_has_words() -> None:
    assert set(OUTCOMES) == set(Status)
    assert len(set(OUTCOMES.values())) == len(Status)


def test_a_failed_solve_names_what_is_off() -> None:
    pin = Violation("Landing: Left heel 2", RowKind.PIN, 12.3)
    fault = NoSolution(Status.STALLED, (pin, Violation("flight 1", RowKind.BALANCE, 0.1)))
    assert "“Landing: Left heel 2” stays 12.3 mm from its place" in sentence(fault)
    assert "in flight 1" in sentence(fault)


def test_a_failed_solve_names_what_was_asked() -> None:
    row = Violation("ground 1", RowKind.BALANCE, 18.3)
    told = sentence(NoSolution(Status.STALLED, (row,), asked=("Timing 1", "Briefcase")))
    assert "named here, or check the contacts' frames. Asked for: “Timing 1”, “Briefcase”." in told
    assert "pin" not in told


def test_a_solve_that_begins_from_a_far_fit_points_there_and_not_to_what_was_asked() -> None:
    near, far = (sentence(NoSolution(Status.NO_BODY, fit_off_cm=cm)) for cm in (0.0, 26.5))
    assert near == OUTCOMES[Status.NO_BODY]
    assert "the fit that it begins from is 26.5 cm off the recording (rms). Correct the" in far
    stopped = NoSolution(Status.STOPPED, fit_off_cm=26.5)
    assert sentence(stopped) == OUTCOMES[Status.STOPPED]


@pytest.mark.slow
def test_a_failed_solve_names_what_is_wrong_with_the_recording_and_what_mends_it() -> None:
    """A shank that grows by 5 %, unrepaired."""
    clip = stretched(0.05).of(load_recording(JUMP)).recording
    damages = damages_of(clip, MotionProblem())
    for fault in (
        NoFit(Status.STALLED, damages=damages),
        NoSolution(Status.STALLED, (), 0.0, damages),
    ):
        words = sentence(fault)
        assert "LeftLeg changes its length by up to 2.2 cm in frames" in words
        assert "LeftFoot leaves its place on it" in words
        assert '“Hold Lengths”, or repair = ["bone lengths"] in a recipe, mends it.' in words
    assert damages_of(load_recording(JUMP), MotionProblem()) == ()


def test_what_goes_wrong_in_looking_for_a_cause_hides_no_fault(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ValueError

    monkeypatch.setattr(suspects, "diagnose", broken)
    assert damages_of(load_recording(JUMP), MotionProblem()) == ()
    assert [record.exc_info[0] for record in caplog.records if record.exc_info] == [ValueError]


@pytest.mark.parametrize("kind", FindingKind)
def test_of_many_damages_two_are_told_and_the_others_counted(kind: FindingKind) -> None:
    damage = Damage(kind.value, 1.0, "", ((3.0, 9.0),), "Knee", "", (), 0.8)
    words = sentence(NoFit(Status.STALLED, damages=(damage,) * 5))
    assert "{" not in words
    assert "And 3 more." in words


@pytest.mark.parametrize("kind", RowKind)
def test_every_kind_of_violation_has_words(kind: RowKind) -> None:
    words = sentence(NoSolution(Status.STALLED, (Violation("Knee", kind, 0.25),)))
    assert "Knee" in words
    assert "0.25" in words
    assert "{" not in words


def test_where_a_limb_stays_in_something_is_told() -> None:
    deep = Violation("Left foot in Roof", RowKind.SOLID, 118.0, 203.4)
    words = sentence(NoSolution(Status.NO_BODY, (deep,)))
    assert "Left foot in Roof stays in by 11.8 cm (frame 203)" in words
    assert words.startswith("Nothing was asked for, and the recording itself")
    assert words == failure_of(NoSolution(Status.NO_BODY, (deep,)), 1, "hangtime.adapt").text
    assert "Ask for less" in sentence(NoSolution(Status.NO_BODY, (deep,), asked=("Landing",)))


def test_support_of_which_nothing_is_known_is_told_at_once() -> None:
    box = UnseenSupport(3.0, 9.0, (SupportBox((0.3, 0.3, 0.1), (0.0, 0.0, 0.0), 0.0),))
    bare = [UnseenSupport(20.0, 31.0), UnseenSupport(40.0, 55.0)]
    first, second = map(sentence, together([box, *bare]))
    assert "In frames 20 to 31, 40 to 55 neither foot" in first
    assert "as on a box" in second
    assert together([box, bare[0]]) == [box, bare[0]]
    crawls = [UnseenSupport(80.0, 91.0, leaning=True), UnseenSupport(95.0, 99.0, leaning=True)]
    first, second = map(sentence, together([*bare, *crawls]))
    assert "In frames 80 to 91, 95 to 99 neither foot" in first
    assert "for hands, knees or the trunk are on it" in first
    assert "20 to 31, 40 to 55" in second
    assert "hands, knees" in sentence(crawls[0])
    walls = UnseenSupport(60.0, 75.0, walls=(AddedContact("Left toe", 61.0, 70.0),))
    assert "as on a wall. Let them touch in these frames (Left toe" in sentence(walls)
    legs = UnseenSupport(60.0, 70.0, exchanged=True)
    assert together([legs, bare[0]]) == [legs, bare[0]]
    assert "the left leg for the right one; exchange them back" in sentence(legs)


def test_of_many_bones_the_first_are_named_and_the_others_counted() -> None:
    bones = tuple(f"Bone{i}" for i in range(23))
    told = sentence(NoControls(bones))
    assert "The bones Bone0, Bone1, Bone2, Bone3 and 19 more follow constraints" in told
    assert "Bone4" not in told
    assert "The bones Bone0, Bone1 follow" in sentence(NoControls(bones[:2]))
    german = sentence(NoControls(bones), lambda text: text.replace("and {} more", "u. {} weitere"))
    assert "Bone3 u. 19 weitere follow" in german


def test_a_recipe_fault_names_its_line() -> None:
    assert sentence(BadRecipe("a.toml", 3, 'unknown key "x"')).startswith("Recipe a.toml, line 3:")
