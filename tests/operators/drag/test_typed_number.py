"""Numbers that are typed during a drag, as Blender takes them."""

import pytest
from hangtime.operators.drag.typed_number import TypedNumber

NAMES = {"<": "BACK_SPACE"}


def typed(keys: str) -> TypedNumber:
    number = TypedNumber()
    for key in keys:
        assert number.key(NAMES.get(key, key), "" if key in NAMES else key), key
    return number


@pytest.mark.parametrize(
    ("keys", "value", "told"),
    [
        ("0.25", 0.25, "0.25"),
        (".5", 0.5, ".5"),
        ("0,5", 0.5, "0.5"),
        ("1.2.5", 1.25, "1.25"),
        ("-2", -2.0, "-2"),
        ("2-", -2.0, "-2"),
        ("2--", 2.0, "2"),
        ("-", 0.0, "-"),
        ("0.25<<3", 0.3, "0.3"),
        ("12345678901", 123456789.0, "123456789"),
    ],
)
def test_keys_make_a_number(keys: str, value: float, told: str) -> None:
    number = typed(keys)
    assert (number.value, str(number)) == (pytest.approx(value), told)
    assert number


@pytest.mark.parametrize("keys", ["1<", "-<", "-1<<"])
def test_after_the_last_backspace_the_mouse_leads_again(keys: str) -> None:
    number = typed(keys)
    assert not number
    assert not number.key("BACK_SPACE", "")


@pytest.mark.parametrize("character", ["", "x", "²", "٣", "\x08", "\r"])
def test_other_keys_are_none_of_it(character: str) -> None:
    assert not TypedNumber().key("X", character)
