"""What others left in a property is not taken for what Hangtime keeps there."""

from __future__ import annotations

import pytest
from hangtime.bridge.hidden_texts import spans_text

SPANS = spans_text("spans")


@pytest.mark.parametrize(
    ("stored", "spans"),
    [("", ()), (None, ()), ("[]", ()), ("[[1, 2.5], [4, 4]]", ((1.0, 2.5), (4.0, 4.0)))],
)
def test_what_was_written_is_read(stored, spans) -> None:
    assert SPANS.of(stored) == spans
    assert SPANS.is_ours(stored)


@pytest.mark.parametrize(
    "stored",
    [
        *("骨", "3", "null", '"ab"', '["ab"]', '{"1": 2}', "[[1]]", "[[1, 2, 3]]", "[[2, 1]]"),
        *("[[NaN, 2]]", "[[1, Infinity]]", "[[1, 1e999]]", '[["1", 2]]', "[[true, 2]]"),
        *("[" * 100_000, f"[[1, {10**400}]]", 3, b"[]", [1.0, 2.0]),
    ],
    ids=lambda stored: repr(stored)[:20],
)
def test_what_is_no_text_of_spans_is_none(stored) -> None:
    assert SPANS.of(stored) == ()
    assert not SPANS.is_ours(stored)
