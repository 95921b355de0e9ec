"""Mistakes in a recipe are named with their line, and so are faults about what it asks for."""

import pytest
from hangtime.bridge.recipe.problem import locate, parse_recipe
from hangtime.solver.data.faults import (
    BadDimensions,
    BadRecipe,
    DependentRows,
    Fault,
    UnknownBone,
    UnknownPhaseIn,
    UnknownReductionBone,
    WrongWeights,
)
from hangtime.tests.helpers.full_recipe import FULL, line_of


def refused(text: str) -> BadRecipe:
    with pytest.raises(BadRecipe) as caught:
        parse_recipe(text)
    return caught.value


def test_a_clip_that_no_file_can_be_called_is_refused() -> None:
    fault = refused('mass = 70\nclip = "a\\u0000.bvh"\n')
    assert fault.line == 2
    assert "holds the character NUL" in fault.problem


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('[[pin]]\nphase = "ground 2"\nforward = 1e300\n', '"forward" is 1e+300; no amount'),
        ('[[cone]]\nbone = "A"\nhalf_angle = 30\naxis = [1e200, 0, 0]\n', '"axis" is 1e+200'),
        (
            '[[cone]]\nbone = "A"\nhalf_angle = 30\naxis = [1e-200, 0, 0]\n',
            "[1e-200, 0, 0] does not",
        ),
        ('[[pin]]\nphase = "ground 2"\nturn = 1e8\n', "from -3600 to 3600 degrees"),
        ("[body]\n[body]\n", "Cannot declare [body] twice"),
        ("[body.parts]\n[body.parts]\n", "Cannot declare [body.parts] twice"),
    ],
)
def test_amounts_that_nobody_means_and_doubled_tables_are_told_in_words(
    text: str, told: str
) -> None:
    assert told in refused(text).problem


WRONG = [  # what stands in FULL, and what it is replaced by, whose last line is refused
    ('moment = "apex"', 'moment = "top"'),
    ('moment = "apex"', 'moment = "apex"\nframe = 3'),
    ("frames = [100, 120]", "frames = [120, 100]"),
    ("frames = [100, 120]", "frames = [100, 120]\nframe = 3"),
    ("frames = [100, 120]", 'moment = "start"'),
    ("frames = [100, 120]", "framse = [100, 120]"),
    ("place = [1, 2, 3]", "place = [1, 2]"),
    ("place = [1, 2, 3]", "place = [1, 2, 3]\npath = [{ frame = 1, place = [0, 0, 0] }]"),
    ("environment = true\n", "environment = 1\n"),
    ("environment = true\ngrip = true", "grip = true"),
    ("forward = 0.5", 'forward = 0.5\naxes = "wrold"'),
    ("forward = 0.5", 'axes = "world"\nforward = 0.5'),
    ("forward = 0.5", "forward = 0.5\nrelative = [1, 2, 3]"),
    ("at_least = { up = 0.3 }", "at_least = { x = 0.3 }"),
    ("at_least = { up = 0.3 }", "at_least = { upp = 0.3 }"),
    ("at_least = { up = 0.3 }", "at_least = 0.3"),
    ("at_least = { up = 0.3 }", "at_least = {}"),
    ("at_most = { left = 0.2, up = 0.9 }", "at_most = { left = 0.2, up = 0.2 }"),
    ("at_most = { left = 0.2, up = 0.9 }", 'at_most = { left = "0.2" }'),
    ("normal = [0, -1, 0]", "normal = [0, 0, 0]"),
    ("normal = [0, -1, 0]\nat_most = { out = 0.01 }", "relative = [1, 2, 3]\nnormal = [0, -1, 0]"),
    ("{ frame = 110, place = [0, 0, 2] }", "{ frame = 90, place = [0, 0, 2] }"),
    ("{ frame = 110, place = [0, 0, 2] }", "{ frame = 110 }"),
    ("{ frame = 110, place = [0, 0, 2] }", "{ place = [0, 0, 2] }"),
    ("{ frame = 110, place = [0, 0, 2] }", "{ frame = 110, plaec = [0, 0, 2] }"),
    ('points = ["Left heel"]', 'points = ["Left heel"]\nbones = ["Foot.L"]'),
    ('points = ["Left heel"]', "points = []"),
    ("at_most = 90", "at_most = 5"),
    ("at_most = 90", "at_most = 90\nfixed = 45"),
    ("fixed = 45", "fixed = 45\nat_least = 3"),
    ("weights = [1, 0, 0]", "weights = [1e300]"),
    ("fixed = 45", 'fixed = "straight"'),
    ("fixed = 45", "fixed = 500"),
    ("at_most = 90", "at_most = 361"),
    ("half_angle = 40", "half_angle = 0"),
    ("half_angle = 40", "half_angle = 180"),
    ("axis = [0, 0, -1]", "axis = [0, 0, 0]"),
    ("stretch = [1, 1.5]", "stretch = [1, 0]"),
    ("stretch = [1, 1.5]", "stretch = 1.5"),
    ("bound = 0", "bound = -1"),
    ("bound = 0", "share = -0.1"),
    ("bound = 0", "bound = 0\nshare = 0"),
    ("dof = 1", "dof = 3"),
    ("dof = 1", "dof = 0.5"),
    ('  "Shin.L",', "  7,"),
    ('reference = "rest"', 'reference = "resting"'),
    ("slack = 2", "slack = -2"),
    ("slack = 2", "slack = 2\nweight = 1"),
    ("slack = 2", "weight = 0"),
    ("turn = 180", 'turn = "left"'),
    ("friction = 0.8", "friction = -0.8"),
    ('shape = "pyramid"', 'shape = "square"'),
    ("peak = 3", "peak = 0"),
    ("match = 10", "match = -1"),
    ("mass = 80", "mass = 0"),
    ("gravity = 1.62", "gravity = 0"),
    ("gravity = 1.62", "gravitation = 1.62"),
    ("share = 0.2", "share = 0"),
    ("share = 0.2", "share = 0.2\nmass = 3"),
    ("length = 0.8", "length = 0"),
    ("factor = 1.5", "factor = 0"),
    ("factor = 1.5", "seconds = -1"),
    ("factor = 1.5", "factor = 1.5\nseconds = 1"),
    ("seconds = 1\n", "seconds = 0\n"),
    ("ends = true", 'ends = "yes"'),
    ('method = "explicit"', 'method = "quick"'),
    ('dynamics = "standard"', 'dynamics = "full"'),
    ("longest_span = 0.1", "longest_span = 0"),
    ("longest_span = 0.1", "longest_span = 1e-6"),
    ("torque_span = 0.2", "torque_span = -1"),
    ("torque_span = 0.2", "torque_span = 1e-6"),
    ("closeness = 0.5", "closenes = 0.5"),
    ("closeness = 0.5", "closeness = -0.5"),
    ('kind = "matrix"', 'kind = "svd"'),
    ('kind = "matrix"', 'kind = "matrix"\ndimensions = 3'),
    ('kind = "matrix"', 'kind = "matrix"\ndimensions = 3.5'),
    ('kind = "matrix"', 'kind = "matrix"\nexplained = 1.1'),
    ('kind = "matrix"', 'kind = "matrix"\nexplained = 0.9'),
]


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("forward = .1", "not TOML at “.1” (Invalid value); correct it (a number begins"),
        ("phase = ground 2", "not TOML at “ground 2” (Invalid value); correct it (a text needs"),
        ("grip = True", "at “True” (Invalid value); correct it (a text needs quotes, and true"),
        ("frames = [1, 2", "not TOML (Unclosed array); correct the line"),
        ("up 0.3", "not TOML at “0.3” (Expected '=' after a key in a key/value pair); correct it"),
    ],
)
def test_what_is_no_toml_is_quoted_with_what_was_probably_meant(line: str, told: str) -> None:
    fault = refused(f"frames = [1, 9]\n[[pin]]\n{line}")
    assert (fault.line, told in fault.problem) == (3, True)


def test_nothing_is_guessed_of_what_stands_behind_a_value() -> None:
    assert refused("frames = [1, 9] m").problem.endswith("correct it")


def test_a_normal_that_would_do_nothing_is_refused_with_what_it_is_of() -> None:
    """Of earlier versions it turned "relative" along a surface."""
    point = '[[point]]\nbone = "a"\nrelative = [0, 0, 0.1]\nnormal = [0, 1, 0]'
    assert 'add axes = "surface"' in refused(point).problem
    for use in ("environment = true", 'axes = "surface"'):
        assert parse_recipe(f"{point}\n{use}").problem.requests.points[0].normal == (0, 1, 0)


@pytest.mark.parametrize(("old", "new"), WRONG)
def test_what_is_wrong_is_named_with_its_line(old: str, new: str) -> None:
    assert FULL.count(old) == 1
    start = FULL.index(old)
    text = FULL.replace(old, new)
    line = text[:start].count("\n") + 1 + new.rstrip("\n").count("\n")
    assert refused(text).line == line


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ('[[point]]\nframe = 3\n[[point]]\nbone = "a"', 1),
        ('[[lift]]\npoints = ["a"]', 1),
        ('\n[[angle]]\nbone = "a"', 2),
        ("\n[[angle]]\nfixed = 3", 2),
        ('[[twist]]\nbone = "a"', 1),
        ('[[cone]]\nbone = "a"', 1),
        ("[[cone]]\nhalf_angle = 3", 1),
        ('[[torque]]\nbones = ["a"]', 1),
        ("[[torque]]\nbound = 3", 1),
        ("[[orientation]]\nturn = 3", 1),
        ('[[force]]\npoints = ["a"]', 1),
        ('[[load]]\nbone = "a"', 1),
        ("[[load]]\nmass = 3", 1),
        ("[[limb]]\nlength = 3", 1),
        ("[[shape]]\nthickness = 3", 1),
        ('[[shape]]\nbones = ["a"]\nthrough = "walls"', 3),
        ('[solution]\nhuman = "soft enough"', 2),
        ("[solution]\nhuman = 3", 2),
        ("[solution]\nwider = -3", 2),
        ('[[timing]]\nphase = "a"', 1),
        ("[[timing]]\nfactor = 3", 1),
        ("[[hold]]\nseconds = 3", 1),
        ("[[hold]]\nframe = 3", 1),
        ("\n[solution.reduction]\ndimensions = 3", 2),
        ('\n[solution.reduction]\nkind = "pca"\nmatrix = [[{ bone = "a", weights = [1] }]]', 4),
        ('\n[solution.reduction]\nkind = "matrix"', 3),
        ('\n[solution.reduction]\nkind = "mirror legs"\ndimensions = 3', 4),
        ('\n[solution.reduction]\nkind = "pca"\ndimensions = 3\nexplained = 0.9', 5),
        ("\n[solution]\nobjectives = {}", 3),
    ],
)
def test_what_is_missing_or_too_much_is_named_with_its_table(text: str, line: int) -> None:
    assert refused(text).line == line


@pytest.mark.parametrize(
    "matrix",
    [
        "[]",
        "3",
        "[[]]",
        "[3]",
        "[[3]]",
        '[[{ bone = "a" }]]',
        "[[{ weights = [1] }]]",
        '[[{ bone = "a", weights = [] }]]',
        '[[{ bone = "a", weights = 1 }]]',
        '[[{ bone = "a", weights = [nan] }]]',
        '[[{ bone = "a", wieghts = [1] }]]',
    ],
)
def test_a_matrix_of_another_form_is_refused(matrix: str) -> None:
    assert refused(f'[solution.reduction]\nkind = "matrix"\nmatrix = {matrix}').line == 3


@pytest.mark.parametrize("path", ["[]", "3", "[3]", "{ frame = 3, place = [0, 0, 0] }"])
def test_a_path_of_another_form_is_refused(path: str) -> None:
    assert refused(f'[[point]]\nbone = "a"\npath = {path}').line == 3


def test_a_request_outside_an_array_is_refused() -> None:
    assert "[[angle]]" in refused('mass = 3\n[angle]\nbone = "a"').problem


def test_a_carried_mass_has_another_name() -> None:
    fault = refused('height = 1.7\n[[mass]]\nbone = "Hand.R"\nshare = 0.2')
    assert "[[load]]" in fault.problem
    assert fault.line == 2


def test_an_unknown_kind_is_named_with_its_first_line() -> None:
    assert refused("mass = 3\n[[cones]]\nhalf_angle = 3\n[[cones]]").line == 2


@pytest.mark.parametrize(
    ("wrong", "hint"),
    [
        ('[[poin]]\nbone = "a"', '"point"'),
        ("[[cone]]\nhalf_angel = 3", '"half_angle"'),
        ('[[angle]]\nbone = "a"\nlimit = 3', "at_least, at_most, fixed"),
        ('[solution]\nmethod = "quick"', "implicit, implicit with torques, explicit"),
        ("[solution.objectives]\nsmoothness = 1", '"angle smoothness"'),
        ('[[point]]\nbone = "a"\nat_least = { outt = 1 }', '"out"'),
        ('[[point]]\nbone = "a"\nat_least = { up = 1, x = 1 }', "forward, left, up"),
    ],
)
def test_a_mistake_gets_a_hint(wrong: str, hint: str) -> None:
    assert hint in refused(wrong).problem


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("pin", "point"),
        ("hold", "angle"),
        ("load", "pin"),
        ("limb", "limb"),
    ],
)
def test_two_records_of_one_name_are_refused(first: str, second: str) -> None:
    rest = {
        "pin": 'phase = "ground 1"',
        "point": 'bone = "a"',
        "hold": "frame = 1\nseconds = 1",
        "angle": 'bone = "a"\nfixed = 1',
        "load": 'bone = "a"\nmass = 1',
        "limb": 'bones = ["a"]',
    }
    text = "\n".join(f"[[{kind}]]\n{rest[kind]}\nname = 'Twice'" for kind in (first, second))
    assert refused(text).line == len(text.splitlines())


def test_a_default_name_is_a_name_too() -> None:
    text = '[[cone]]\nname = "Angle 1"\nbone = "a"\nhalf_angle = 3\n[[angle]]\nbone="a"\nfixed = 3'
    assert refused(text).line == 5


# ---------------------------------------------------------------- faults raised later


@pytest.mark.parametrize(
    ("fault", "part"),
    [
        (UnknownBone("Reach", "Hand.L"), 'bone = "Hand.L"'),
        (UnknownBone("Limp", "Shin.L"), '  "Shin.L",'),
        (UnknownBone("Point 2", "Hand.L"), "# toe"),
        (UnknownBone("Angle 2", ""), "# stiff"),
        (UnknownBone("Hanging", ""), "[[hold]]"),
        (UnknownBone("Load 1", ""), "[[load]]"),
        (UnknownBone("Landing", ""), "[[pin]]"),
        (UnknownPhaseIn("Lift 1", "ground 1", ()), 'phase = "ground 1"'),
        (UnknownReductionBone(1, "Thigh.L", ()), '  [{ bone = "Thigh.L"'),
        (WrongWeights(1, "Thigh.R", 1, 3), '  [{ bone = "Thigh.L"'),
        (DependentRows(2, 1), "matrix = ["),
        (BadDimensions(60, 40), "[solution.reduction]"),
    ],
)
def test_faults_about_a_request_are_found_in_the_recipe(fault: Fault, part: str) -> None:
    assert locate(FULL, fault) == line_of(FULL, part)


def test_faults_about_no_request_have_no_line() -> None:
    assert locate(FULL, UnknownBone("Left heel", "Hand.L")) is None
