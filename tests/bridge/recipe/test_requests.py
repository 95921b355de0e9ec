"""Requests in a recipe: every kind is read, written and read again."""

import math
from dataclasses import fields

import pytest
from hangtime.bridge.recipe import requests
from hangtime.bridge.recipe.problem import parse_recipe, write_recipe
from hangtime.bridge.recipe_syntax.items import TRAVEL_WORDS
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.requests import (
    AngleLimit,
    PointAxes,
    Requests,
)
from hangtime.tests.helpers.full_recipe import FULL, REQUESTS
from hangtime.tests.helpers.problem_strategies import KINDS, PROBLEMS
from hypothesis import given, settings

PUSHES_BACK = "normal = [1, 0, 0]\nenvironment = true"


def test_every_key_is_read() -> None:
    assert parse_recipe(FULL).problem.requests == REQUESTS


def test_the_recipe_in_the_documentation_is_understood() -> None:
    """Each of its keys is known: what stands together there excludes each other in part."""
    known = {key for kind in requests.NAMED for key in kind.keys}
    said = (line.split(" = ")[0] for line in requests.__doc__.splitlines() if " = " in line)
    keys = {key.strip().strip('"') for key in said}
    solving = {
        "method",
        "dynamics",
        "longest_span",
        "keep_times",
        "solid",
        "human",
        "shapes",
        "wider",
        "gravity",
        "kind",
        "dimensions",
        "matrix",
    }
    assert keys - known - solving == {"torque smoothness", "closeness"}
    alternatives = {"frame", "fixed", "at_most", "bones", "seconds", *TRAVEL_WORDS}
    assert known - keys <= alternatives


def test_every_kind_of_request_is_tried() -> None:
    assert {*KINDS, "body", "solution"} == {field.name for field in fields(Requests)}


@settings(max_examples=40)
@given(PROBLEMS)
@pytest.mark.slow
def test_what_is_written_is_read_as_the_same(problem: MotionProblem) -> None:
    assert parse_recipe(write_recipe(problem)).problem == problem


def test_the_full_recipe_comes_back() -> None:
    problem = MotionProblem(requests=REQUESTS)
    assert parse_recipe(write_recipe(problem)).problem == problem


def test_long_values_are_written_over_lines() -> None:
    text = write_recipe(MotionProblem(requests=REQUESTS))
    path = (
        "path = [\n  { frame = 100, place = [0, 0, 1] },\n  { frame = 110, place = [0, 0, 2] },\n]"
    )
    assert path in text
    assert '[solution.objectives]\n"torque smoothness" = 2\ncloseness = 0.5\n' in text
    assert text.count('\n  [{ bone = "Thigh.L"') == 1


def test_what_was_not_asked_is_not_written() -> None:
    request = AngleLimit("Knee", "Shin.L", None, math.radians(90.0))
    text = write_recipe(MotionProblem(requests=Requests(angles=(request,))))
    assert text.endswith('\n[[angle]]\nname = "Knee"\nbone = "Shin.L"\nat_most = 90\n')
    assert "[solution]" not in text
    assert "[body]" not in text


@pytest.mark.parametrize(
    ("keys", "axes", "relative"),
    [
        ("", PointAxes.WORLD, (0.0, 0.0, 0.0)),
        ("left = 2", PointAxes.TRAVEL, (0.0, 2.0, 0.0)),
        ("relative = [1, 2, 3]\nat_least = { forward = 0 }", PointAxes.TRAVEL, (1.0, 2.0, 3.0)),
        ('axes = "travel"\nrelative = [1, 2, 3]', PointAxes.TRAVEL, (1.0, 2.0, 3.0)),
        ("at_most = { z = 1 }", PointAxes.WORLD, (0.0, 0.0, 0.0)),
        ("at_most = { along = 1 }", PointAxes.SURFACE, (0.0, 0.0, 0.0)),
        (f"relative = [1, 2, 3]\n{PUSHES_BACK}", PointAxes.WORLD, (1.0, 2.0, 3.0)),
        (f"left = 2\n{PUSHES_BACK}", PointAxes.TRAVEL, (0.0, 2.0, 0.0)),
    ],
)
def test_axes_follow_from_the_names_of_axes(keys: str, axes: PointAxes, relative: tuple) -> None:
    (point,) = parse_recipe(f'[[point]]\nbone = "Hand"\n{keys}').problem.requests.points
    assert (point.axes, point.relative) == (axes, relative)
