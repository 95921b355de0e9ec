"""Recipes: what people write becomes a MotionProblem, and back; faults name their line."""

import json
import math

import pytest
from hangtime.bridge.recipe.keys import KeyOptions
from hangtime.bridge.recipe.problem import (
    PARTS,
    locate,
    parse_recipe,
    parse_text,
    read_recipe_text,
    write_recipe,
)
from hangtime.bridge.recipe_syntax.source_lines import json_lines, toml_lines
from hangtime.bridge.rows.choices import KeyChoice
from hangtime.solver.data.faults import (
    BadRecipe,
    BesideFrames,
    BoneTaken,
    ContradictoryPins,
    MissingPart,
    NotBetweenFrames,
    NothingLeft,
    OddScale,
    UnknownContact,
    UnknownContactName,
    UnknownPhase,
    UnseenSupport,
)
from hangtime.solver.data.problem import (
    AddedContact,
    ContactEdit,
    MassTable,
    MotionProblem,
    OffsetAxes,
    Pin,
    Unseen,
)
from hangtime.tests.helpers.problem_strategies import NAMES
from hypothesis import given, settings
from hypothesis import strategies as st

FULL = """\
clip = "hop.bvh"
frames = [140, 260]
mass = 62.5
height = 1.69
mass_table = "de leva"

[bones]
"left foot" = "Fuss.L"

[[pin]]                       # the first
name = "Landing"
phase = "ground 2"
points = [
  "Left heel",
  "Left toe",
]
forward = 0.3
up = 0.2
turn = 90

[[pin]]
phase = "ground 1"
bones = ["Fuss.L"]
offset = [0.1, 0, -0.2]
place = [1, 2.5, 0]

[[contact]]
name = "Left toe 2"
start_frame = 183.5

[[contact]]
name = "Right toe 2"
remove = true
"""
PROBLEM = MotionProblem(
    frames=(140.0, 260.0),
    mass=62.5,
    height=1.69,
    mass_table=MassTable.DE_LEVA,
    bones={"left foot": "Fuss.L"},
    contacts=(
        ContactEdit("Left toe 2", start_frame=183.5),
        ContactEdit("Right toe 2", remove=True),
    ),
    pins=(
        Pin("Landing", "ground 2", ("Left heel", "Left toe"), (0.3, 0.0, 0.2), turn=math.pi / 2),
        Pin(
            "Pin 2",
            "ground 1",
            ("Fuss.L",),
            (0.1, 0.0, -0.2),
            OffsetAxes.WORLD,
            place=(1.0, 2.5, 0.0),
        ),
    ),
)


def line_of(text: str, part: str) -> int:
    """The line on which a part stands that occurs once."""
    assert text.count(part) == 1
    return text[: text.index(part)].count("\n") + 1


def refused(text: str) -> BadRecipe:
    with pytest.raises(BadRecipe) as caught:
        parse_recipe(text, "jump.toml")
    assert caught.value.path == "jump.toml"
    return caught.value


def test_every_key_is_read() -> None:
    recipe = parse_recipe(FULL)
    assert recipe.problem == PROBLEM
    assert recipe.clip == "hop.bvh"


def test_keys_are_read_and_not_asked_for_by_default() -> None:
    keys = parse_recipe('[keys]\non = "reduced"\ndistance = 0.005\nangle = 0.5\n').keys
    assert keys == KeyOptions(KeyChoice.REDUCED, 0.005, math.radians(0.5))
    assert parse_recipe("mass = 70\n").keys is None
    with pytest.raises(BadRecipe) as fault:
        parse_recipe('[keys]\non = "fewest"\n')
    assert fault.value.line == 2


def test_what_a_text_of_the_blend_file_has_no_say_in_is_refused_by_its_key() -> None:
    heard = parse_text('[keys]\non = "reduced"\n[loop]\n[result]\n[solution]\nsolid = false\n', "x")
    assert None not in (heard.keys, heard.loop, heard.result)
    assert not heard.problem.requests.solution.solid
    with pytest.raises(BadRecipe, match='"clip" counts'):
        parse_text(FULL, "Requests")
    with pytest.raises(BadRecipe, match='did you mean "pin"'):
        parse_text("[[pins]]\n", "Requests")


def test_json_says_the_same() -> None:
    text = json.dumps(
        {
            "frames": [140, 260],
            "mass_table": "de leva",
            "pin": [{"phase": "ground 2", "left": -0.1}],
        },
        indent=1,
    )
    problem = parse_recipe(text).problem
    assert problem.frames == (140.0, 260.0)
    assert problem.pins == (Pin("Pin 1", "ground 2", offset=(0.0, -0.1, 0.0)),)


def test_an_empty_recipe_changes_nothing() -> None:
    assert parse_recipe("").problem == MotionProblem()


NUMBERS = st.floats(-1e6, 1e6)
POSITIVE = st.floats(1e-3, 1e3)
PLACES = st.tuples(NUMBERS, NUMBERS, NUMBERS)
PINS = st.builds(
    Pin,
    name=NAMES,
    phase=NAMES,
    touching=st.lists(NAMES, max_size=3).map(tuple),
    offset=PLACES,
    axes=st.sampled_from(OffsetAxes),
    place=st.none() | PLACES,
    turn=st.integers(-720, 720).map(math.radians),
)
EDITS = st.builds(ContactEdit, name=NAMES, start_frame=st.none() | NUMBERS) | st.builds(
    ContactEdit, name=NAMES, remove=st.just(True)
)
PROBLEMS = st.builds(
    MotionProblem,
    frames=st.none() | st.tuples(NUMBERS, NUMBERS).filter(lambda f: f[0] < f[1]),
    mass=POSITIVE,
    height=st.none() | st.floats(0.3, 3.0),
    mass_table=st.sampled_from(MassTable),
    unseen=st.sampled_from(Unseen),
    bones=st.dictionaries(st.sampled_from(PARTS), NAMES, max_size=3),
    contacts=st.lists(EDITS, max_size=3).map(tuple),
    pins=st.lists(PINS, max_size=3, unique_by=lambda pin: pin.name).map(tuple),
)


@settings(max_examples=40)
@given(PROBLEMS)
def test_what_is_written_is_read_as_the_same(problem: MotionProblem) -> None:
    assert parse_recipe(write_recipe(problem)).problem == problem


@given(st.floats(-10.0, 10.0))
def test_a_turn_comes_back_to_the_last_digits(turn: float) -> None:
    problem = MotionProblem(pins=(Pin("a", "ground 1", turn=turn),))
    (pin,) = parse_recipe(write_recipe(problem)).problem.pins
    assert pin.turn == pytest.approx(turn, rel=1e-15)


def test_a_quarter_turn_is_written_as_90() -> None:
    text = write_recipe(MotionProblem(pins=(Pin("a", "ground 1", turn=math.radians(90.0)),)))
    assert "turn = 90\n" in text


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("forward = 0.3", "foward = 0.3"),
        ("height = 1.69", "Height = 1.69"),
        ("height = 1.69", "height = 500"),
        ("height = 1.69", "height = 0.001"),
        ('"left foot" =', '"left fot" ='),
        ("start_frame = 183.5", "start = 183.5"),
        ("up = 0.2", 'up = "high"'),
        ("up = 0.2", "up = nan"),
        ("turn = 90", "turn = -inf"),
        ("turn = 90", "turn = true"),
        ("mass = 62.5", "mass = 0"),
        ("mass = 62.5", "mass = 1979-05-27 07:32:00"),
        ("frames = [140, 260]", "frames = [260, 140]"),
        ("frames = [140, 260]", "frames = [140]"),
        ('mass_table = "de leva"', 'mass_table = "leva"'),
        ("place = [1, 2.5, 0]", "place = [1, 2.5]"),
        ("place = [1, 2.5, 0]", 'place = [1, 2.5, "z"]'),
        ("offset = [0.1, 0, -0.2]", "offset = [0.1, 0, -0.2]\nleft = 1"),
        ('bones = ["Fuss.L"]', 'bones = ["Fuss.L"]\npoints = ["Left heel"]'),
        ('bones = ["Fuss.L"]', 'bones = "Fuss.L"'),
        ("remove = true", 'remove = "yes"'),
        ("remove = true", "remove = true\nend_frame = 3"),
        ("start_frame = 183.5", "start_frame = 183.5\nend_frame = 100"),
        ('clip = "hop.bvh"', "clip = 3"),
        ("height = 1.69", "height = "),
        ("height = 1.69", "height = 1.69\nheight = 1.7"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(old: str, new: str) -> None:
    text = FULL.replace(old, new)
    assert refused(text).line == line_of(text, new.rpartition("\n")[2])


def test_a_pin_of_one_footfall_comes_back_as_it_was_written() -> None:
    problem = parse_recipe('[[pin]]\nphase = "ground 1"\nstep = "Left heel 2"\n').problem
    assert problem.pins == (Pin("Pin 1", "ground 1", step="Left heel 2"),)
    assert parse_recipe(write_recipe(problem)).problem == problem
    text = FULL.replace('bones = ["Fuss.L"]', 'bones = ["Fuss.L"]\nstep = "Left heel 1"')
    assert refused(text).line == line_of(text, "step =")


def test_two_pins_of_one_name_are_refused() -> None:
    text = FULL.replace('name = "Landing"', 'name = "Pin 2"')  # as the second is called by default
    assert refused(text).line == line_of(text, "[[pin]]\nphase")


def test_an_element_is_named_with_its_own_line() -> None:
    text = FULL.replace('"Left toe",', "7,")
    assert refused(text).line == line_of(text, "  7,")


def test_a_missing_key_is_named_with_its_table() -> None:
    text = FULL.replace('phase = "ground 1"\n', "")
    assert refused(text).line == line_of(text, "[[pin]]\nbones")


def test_an_unknown_key_gets_a_hint() -> None:
    assert 'did you mean "forward"' in refused(FULL.replace("forward", "foward")).problem


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ('{"mass": 70,\n "mas": 3}', 2),
        ('{"mass": 70,\n "mass": 3}', 2),
        ('{"mass": 70,\n "height": NaN}', 2),
        ('{"pin": [\n {"phase": "ground 1"},\n {"phase": "ground 2",\n "turn": []}]}', 4),
        ('{"mass": 70,\n "height": }', 2),
        ('{"mass": 70,\n', 2),
    ],
)
def test_json_faults_name_their_line(text: str, line: int) -> None:
    assert refused(text).line == line


def test_what_no_parser_bears_is_refused() -> None:
    assert refused("mass = " + "[" * 5000 + "]" * 5000).line is None
    assert refused('{"mass": ' + "[" * 100_000 + "]" * 100_000 + "}").line is None
    assert refused('{"mass": ' + "1" * 5000 + "}").line is None


def test_a_number_too_large_for_a_float_is_refused() -> None:
    assert refused("height = 1.8\nmass = " + "9" * 400).line == 2


def test_a_missing_or_binary_file_is_refused(tmp_path) -> None:
    with pytest.raises(BadRecipe):
        read_recipe_text(tmp_path / "none.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(BadRecipe):
        read_recipe_text(tmp_path / "binary.toml")


@pytest.mark.parametrize(
    ("fault", "part"),
    [
        (UnknownPhase("Landing", "ground 2", ()), 'phase = "ground 2"'),
        (UnknownPhase("Pin 2", "ground 1", ()), 'phase = "ground 1"'),
        (UnknownContact("Landing", "Left toe", ()), '  "Left toe",'),
        (UnknownContact("Pin 2", "Fuss.L", ()), 'bones = ["Fuss.L"]'),
        (UnknownContactName("Right toe 2", ()), 'name = "Right toe 2"'),
        (MissingPart("left foot", ("Fuss.L",)), '"left foot" ='),
        (BoneTaken("head", bone="Fuss.L", by="left foot"), '"left foot" ='),
        (ContradictoryPins("Left heel 1", "Landing", 0.1), "[[pin]]                       #"),
    ],
)
def test_faults_of_the_solver_are_found_in_the_recipe(fault, part: str) -> None:
    assert locate(FULL, fault) == line_of(FULL, part)


ADDED = """[[add_contact]]
point = "left  TOE"
start_frame = 300
end_frame = 350
"""


def test_a_point_to_add_is_called_with_any_capitals() -> None:
    assert parse_recipe(ADDED).problem.added == (AddedContact("Left toe", 300.0, 350.0),)


def test_a_contact_to_add_that_ends_before_it_begins_is_refused() -> None:
    with pytest.raises(BadRecipe, match="must come after the start") as caught:
        parse_recipe(ADDED.replace("350", "250"))
    assert caught.value.line == 4


@pytest.mark.parametrize(
    ("fault", "line"),
    [
        (UnknownContactName("Left toe", ()), 2),
        (BesideFrames("Left toe", 300.0, 1.0, 200.0), 3),
        (BesideFrames("Left toe", 350.0, 400.0, 500.0), 4),
        (BesideFrames("Right toe", 350.0, 400.0, 500.0), None),
    ],
)
def test_faults_of_contacts_to_add_are_found_in_the_recipe(fault, line) -> None:
    assert locate(ADDED, fault) == line


@pytest.mark.parametrize(
    ("fault", "line"),
    [
        (NotBetweenFrames(999.0, 1.0, 200.0), 2),
        (NothingLeft(300, 60, 200), 3),
        (NothingLeft(30, 190, 200), 4),
        (OddScale(90.0, 100.0, 1.0), 5),
    ],
)
def test_remedies_of_a_recording_that_do_not_fit_it_are_found_in_the_recipe(fault, line) -> None:
    text = "[recording]\nmissing = { 999 = 4 }\ntrim = 30\ntrim_end = 60\nscale = 90\n"
    assert locate(text, fault) == line


def test_faults_that_the_recipe_is_not_about_have_no_line() -> None:
    assert locate(FULL, UnseenSupport(1.0, 5.0)) is None
    assert locate(FULL, MissingPart("head")) is None
    assert locate(FULL, UnknownPhase("another", "ground 1", ())) is None


def test_lines_of_everything_that_toml_can_write() -> None:
    text = (
        'a.b = 1 # "c" = 2\n'
        "'d e' = '''\nx = 1\n'''\n"
        'f = """\\"""\ny = 1"""\n'
        "g = { h = [1,\n 2], \"i\\u0041\" = 'j' }\n"
        "[k.l]\n"
        "m = 1979-05-27 07:32:00\n"
        "[[n]]\n"
        "[[n]]\n"
        "[n.o]\n"
        "p = 1e-3\n"
    )
    assert dict(toml_lines(text)) == {
        ("a", "b"): 1,
        ("d e",): 2,
        ("f",): 5,
        ("g",): 7,
        ("g", "h"): 7,
        ("g", "h", 0): 7,
        ("g", "h", 1): 8,
        ("g", "iA"): 8,
        ("k", "l"): 9,
        ("k", "l", "m"): 10,
        ("n", 0): 11,
        ("n", 1): 12,
        ("n", 1, "o"): 13,
        ("n", 1, "o", "p"): 14,
    }


def test_lines_of_json() -> None:
    text = '\n{"a": [1,\n{"b": "}"}],\n"c": {}}'
    lines = {("a",): 2, ("a", 0): 2, ("a", 1): 3, ("a", 1, "b"): 3, ("c",): 4}
    assert dict(json_lines(text)) == lines


def test_the_other_way_has_words_of_its_own() -> None:
    words = '[[pin]]\nphase = "GROUND  2"\nback = 0.3\nright = 0.1\ndown = 0.2\n'
    (pin,) = parse_recipe(words).problem.pins
    assert (pin.offset, pin.phase) == ((-0.3, -0.1, -0.2), "ground 2")
    (again,) = parse_recipe(write_recipe(parse_recipe(words).problem)).problem.pins
    assert again == pin
    words = '[[point]]\nbone = "Hand.L"\nphase = "Flight 1"\nright = 0.3\n'
    (point,) = parse_recipe(words).problem.requests.points
    assert (point.relative, point.axes.value) == ((0.0, -0.3, 0.0), "travel")
    assert point.when.phase == "flight 1"


def test_both_ways_at_once_exclude_each_other() -> None:
    problem = refused('[[pin]]\nphase = "ground 2"\nforward = 0.3\nback = 0.1\n').problem
    assert '"forward" and "back" exclude each other' in problem
