"""The schedule: its phases, and instants that nearly coincide."""

from itertools import pairwise

import numpy as np
import pytest
from hangtime.solver.contacts.events import numbered, snap
from hangtime.solver.data.contacts import Contact, ContactSchedule, Interval, PhaseKind
from hypothesis import given
from hypothesis import strategies as st


def contact(point: str, start: float, end: float) -> Contact:
    return Contact(point, point, "Foot", np.zeros(3), start, end, np.zeros(3))


def schedule(*contacts: Contact, duration: float = 3.0) -> ContactSchedule:
    return ContactSchedule(numbered(contacts), duration, 0.0)


def test_phases_alternate_and_cover_the_clip() -> None:
    s = schedule(
        contact("Left toe", 2.0, 3.0), contact("Left toe", 0.0, 1.0), contact("Left heel", 0.0, 0.8)
    )
    assert [p.name for p in s.phases] == ["ground 1", "flight 1", "ground 2"]
    assert [(p.start, p.end) for p in s.phases] == [(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)]
    assert [c.name for c in s.of_phase(s.phases[0])] == ["Left heel 1", "Left toe 1"]
    assert s.of_phase(s.phases[1]) == ()
    assert [c.name for c in s.of_phase(s.phases[2])] == ["Left toe 2"]
    assert s.boundaries == (0.0, 0.8, 1.0, 2.0, 3.0)


def test_a_clip_may_begin_and_end_in_flight() -> None:
    s = schedule(contact("Left toe", 1.0, 2.0))
    assert [p.kind for p in s.phases] == [PhaseKind.FLIGHT, PhaseKind.GROUND, PhaseKind.FLIGHT]


def test_snap_joins_what_nearly_coincides_and_leaves_flights_alone() -> None:
    s = schedule(
        contact("Left toe", 0.0, 0.99),
        contact("Right toe", 0.004, 1.0),
        contact("Left toe", 2.0, 2.995),
        contact("Right toe", 2.01, 3.0),
        contact("Left heel", 2.1, 2.5),
        contact("Right heel", 2.108, 2.116),
    )
    snapped = snap(s, 0.0125)
    assert snapped.boundaries == pytest.approx((0.0, 1.0, 2.0, 2.108, 2.5, 3.0))
    assert snapped.flights == s.flights == (Interval(1.0, 2.0),)
    assert "Right heel 1" not in [c.name for c in snapped.contacts]  # nothing of it was left


@given(
    st.lists(
        st.tuples(st.integers(0, 990), st.integers(1, 200), st.sampled_from("abcd")), min_size=1
    ),
    st.sampled_from([0.005, 0.0125, 0.02]),
)
def test_snapped_instants_are_apart(spans: list[tuple[int, int, str]], tolerance: float) -> None:
    s = schedule(
        *(contact(p, a / 1000, min(a + n, 1000) / 1000) for a, n, p in spans), duration=1.0
    )
    snapped = snap(s, tolerance)
    fixed = {0.0, 1.0} | {t for f in s.flights for t in (f.start, f.end)}
    for a, b in pairwise(snapped.boundaries):
        assert b - a > tolerance or {a, b} <= fixed
    assert fixed <= set(snapped.boundaries)
