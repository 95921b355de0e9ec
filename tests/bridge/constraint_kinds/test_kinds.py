"""The registry of constraint kinds: what files and recipes depend on stays as it is."""

import re
from dataclasses import fields

import pytest
from hangtime.bridge import constraint_kinds
from hangtime.bridge.constraint_kinds import KINDS, stored_fields
from hangtime.bridge.recipe import requests as recipe_requests
from hangtime.bridge.rows.kind import ConstraintKind
from hangtime.solver.data.requests import Requests

# Blender stores the number of an enum's item: a kind that had another would be another in files.
NUMBERS = {
    "POINT": 0,
    "LIFT": 1,
    "ANGLE": 2,
    "CONE": 3,
    "TWIST": 4,
    "TORQUE": 5,
    "POSE": 6,
    "ORIENTATION": 7,
    "FORCE": 8,
    "TIMING": 9,
    "HOLD": 10,
}


def test_kinds_are_stored_as_they_ever_were() -> None:
    stored = {name: kind.number for name, kind in KINDS.items()}
    assert stored.items() >= NUMBERS.items()


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda kind: kind.label)
def test_a_kind_makes_records_that_the_solver_takes(kind: ConstraintKind) -> None:
    assert kind.requests in {field.name for field in fields(Requests)}
    assert recipe_requests.RECORDS[kind.requests] is kind.recipe


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda kind: kind.label)
def test_every_recipe_key_is_documented(kind: ConstraintKind) -> None:
    text = recipe_requests.__doc__ or ""
    assert f"[[{kind.recipe.header}]]" in text
    for key in kind.recipe.keys:
        assert re.search(rf"\b{key}\b", text), key


def test_kinds_that_share_a_field_agree_on_it(monkeypatch: pytest.MonkeyPatch) -> None:
    assert stored_fields()["lower"] is KINDS["TWIST"].fields["lower"]
    other = dict(KINDS["TWIST"].fields) | {"lower": KINDS["CONE"].fields["half_angle"]}
    changed = type(KINDS["TWIST"])(**(vars(KINDS["TWIST"]) | {"fields": other}))
    monkeypatch.setattr(constraint_kinds, "KINDS", {**KINDS, "TWIST": changed})
    with pytest.raises(ValueError, match="lower"):
        stored_fields()
