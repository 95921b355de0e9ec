"""Ranges of recipes: what stands for a number, how ranges go together, and what is refused."""

import math
from pathlib import Path

import pytest
from hangtime.batch.planning.recipes import VariedRecipe, name_of, place_of
from hangtime.solver.data.faults import BadRecipe
from hypothesis import given
from hypothesis import strategies as st

PIN = '[[pin]]\nname = "Landing"\nphase = "ground 2"\n'
SAMPLE = '[batch]\ncombine = "sample"\ncount = {}\nseed = {}\n'


def varied(folder: Path, text: str) -> VariedRecipe:
    (folder / "recipe.toml").write_text(text, encoding="utf-8")
    return VariedRecipe.read(str(folder / "recipe.toml"))


def values_of(folder: Path, line: str, head: str = "") -> list[dict[str, object]]:
    return [dict(v) for v in varied(folder, f"{head}{PIN}{line}\n").variants()]


FORWARD = "pin.Landing.forward"


def test_steps_include_both_ends(tmp_path: Path) -> None:
    found = values_of(tmp_path, "forward = { from = 0.0, to = 0.8, steps = 5 }")
    assert found == [{FORWARD: v} for v in (0.0, 0.2, 0.4, 0.6, 0.8)]


def test_values_go_both_ways_and_zero_once(tmp_path: Path) -> None:
    found = values_of(tmp_path, "turn = { values = [0, 90], both_ways = true }")
    assert [v["pin.Landing.turn"] for v in found] == [0, 90, -90]


def test_a_list_is_a_range_only_where_one_number_stands(tmp_path: Path) -> None:
    recipe = varied(tmp_path, f"frames = [60, 330]\n{PIN}place = [0, 1, 2]\nup = [0.0, 0.1]\n")
    assert [dict(v) for v in recipe.variants()] == [{"pin.Landing.up": v} for v in (0.0, 0.1)]


def test_product_is_every_value_with_every_other_and_zip_the_first_with_the_first(
    tmp_path: Path,
) -> None:
    lines = "forward = [0.1, 0.2]\nup = [0.0, 0.3]"
    assert len(values_of(tmp_path, lines)) == 4
    zipped = values_of(tmp_path, lines, '[batch]\ncombine = "zip"\n')
    assert zipped == [
        {FORWARD: 0.1, "pin.Landing.up": 0.0},
        {FORWARD: 0.2, "pin.Landing.up": 0.3},
    ]


def test_a_value_may_stand_in_a_zip_twice_and_a_pair_does_not(tmp_path: Path) -> None:
    lines = "forward = [0, 0.1, 0, 0.1, 0]\nup = { values = [0, 0, 0.1, 0.1, 0] }"
    zipped = values_of(tmp_path, lines, '[batch]\ncombine = "zip"\n')
    pairs = [(v[FORWARD], v["pin.Landing.up"]) for v in zipped]
    assert pairs == [(0, 0), (0.1, 0), (0, 0.1), (0.1, 0.1)]
    assert len(values_of(tmp_path, lines)) == 4


@given(
    count=st.integers(1, 40),
    seed=st.integers(0, 10**6),
    low=st.floats(-1.0, 0.9),
    width=st.floats(0.01, 2.0),
)
@pytest.mark.slow
def test_a_seed_draws_the_same_samples_within_the_bounds(
    tmp_path_factory: pytest.TempPathFactory, count: int, seed: int, low: float, width: float
) -> None:
    folder = tmp_path_factory.getbasetemp()
    line = f"forward = {{ from = {low!r}, to = {low + width!r} }}"
    drawn = values_of(folder, line, SAMPLE.format(count, seed))
    assert len(drawn) == count
    slack = 1e-9 + 1e-9 * width
    assert all(low - slack <= float(str(v[FORWARD])) <= low + width + slack for v in drawn)
    assert drawn == values_of(folder, line, SAMPLE.format(count, seed))


@given(sizes=st.lists(st.integers(2, 5), min_size=1, max_size=3), data=st.data())
def test_as_many_variants_as_are_counted_before_and_samples_are_all_different(
    tmp_path_factory: pytest.TempPathFactory, sizes: list[int], data: st.DataObject
) -> None:
    keys = ("forward", "up", "turn")
    lines = "\n".join(
        f"{key} = {{ from = 0, to = 1, steps = {n} }}" for key, n in zip(keys, sizes, strict=False)
    )
    folder = tmp_path_factory.getbasetemp()
    recipe = varied(folder, PIN + lines)
    assert recipe.count == len(list(recipe.variants())) == math.prod(sizes)
    count = data.draw(st.integers(1, math.prod(sizes)))
    drawn = values_of(folder, lines, SAMPLE.format(count, 1))
    assert len({tuple(v.items()) for v in drawn}) == count


@pytest.mark.slow
def test_samples_are_drawn_from_more_combinations_than_could_ever_be_counted(
    tmp_path: Path,
) -> None:
    each = "{ from = 0, to = 1, steps = 100_000 }"
    ways = "".join(f"{way} = {each}\n" for way in ("forward", "left", "up", "turn"))
    assert len(values_of(tmp_path, ways, SAMPLE.format(5, 1))) == 5


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("forward = []", "empty"),
        ("forward = { from = 1, to = 0, steps = 3 }", "reversed"),
        ("forward = { from = 1, to = 1, steps = 3 }", "empty"),
        ("forward = { from = 0, to = inf, steps = 3 }", "number, not inf"),
        ("forward = { from = 0, to = 1, steps = 1 }", "from 2 to"),
        ("forward = { from = 0, to = 1, steps = 2.5 }", "whole number"),
        ("forward = { from = 0, to = 1 }", 'no "steps"'),
        ("forward = { from = 0, steps = 3 }", '"to"'),
        ("forward = { from = 0, to = 1, stepz = 3 }", "steps"),
        ("forward = [0.1, nan]", "finite"),
        ("forward = [0.1, [0.2]]", "finite numbers or words"),
        ('phase = { values = ["a"], both_ways = true }\n', "both ways"),
    ],
)
def test_a_range_that_is_none_is_refused_at_its_line(tmp_path: Path, line: str, said: str) -> None:
    text = PIN.replace('phase = "ground 2"\n', "") if line.startswith("phase") else PIN
    with pytest.raises(BadRecipe) as caught:
        varied(tmp_path, f"{text}{line}\n").count  # noqa: B018
    assert said in caught.value.problem
    assert caught.value.line == text.count("\n") + 1


@pytest.mark.parametrize(
    ("head", "said"),
    [
        ('[batch]\ncombine = "zip"\n', "as many each"),
        ('[batch]\ncombine = "sample"\n', '"count"'),
        (SAMPLE.format(7, 0), "write at most 6"),
        ("[batch]\ncount = 3\n", "samples"),
        ('[batch]\ncombine = "cross"\n', "known: product, zip, sample"),
    ],
)
def test_a_combination_that_cannot_be_is_refused(tmp_path: Path, head: str, said: str) -> None:
    recipe = f"{head}{PIN}forward = [0.1, 0.2]\nup = [0.0, 0.1, 0.2]\n"
    with pytest.raises(BadRecipe) as caught:
        varied(tmp_path, recipe).count  # noqa: B018
    assert said in caught.value.problem


@given(names=st.lists(st.text(st.sampled_from("ab.ü 1"), min_size=1), min_size=1, unique=True))
def test_a_place_has_one_name_and_the_name_finds_it_whatever_things_are_called(
    names: list[str],
) -> None:
    values = {"pin": [{"name": name, "forward": i} for i, name in enumerate(names)]}
    for i in range(len(names)):
        place = ("pin", i, "forward")
        assert place_of(values, name_of(values, place), "r.toml") == place


def test_all_combinations_of_a_large_product_can_be_drawn(tmp_path: Path) -> None:
    """Which drawing and throwing away what was drawn before would take half a million draws for."""
    each = "{ from = 0.0, to = 1.0, steps = 200 }"
    ranges = f"forward = {each}\nup = {each}"
    drawn = values_of(tmp_path, ranges, SAMPLE.format(40_000, 1))
    product = values_of(tmp_path, ranges)
    assert drawn != product
    assert {tuple(v.values()) for v in drawn} == {tuple(v.values()) for v in product}
