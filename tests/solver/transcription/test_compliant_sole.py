"""Compliant soles: how a touching point comes to rest and leaves."""

import numpy as np
import pytest
from hangtime.solver.data.contacts import Contact
from hangtime.solver.transcription.compliant_sole import SINKING_TIME, sole_trajectory

START, END, RISE = 0.4, 0.9, 0.008


def contact(rise: tuple[float, float], end: float = END) -> Contact:
    return Contact("Left toe 1", "Left toe", "Toe", np.zeros(3), START, end, np.ones(3), rise)


def test_a_contact_without_rise_stays_at_its_place() -> None:
    assert sole_trajectory(contact((0.0, 0.0))) is None


def test_the_sole_sinks_from_its_rise_to_rest_and_back() -> None:
    sole = sole_trajectory(contact((RISE, 0.5 * RISE)))
    assert sole is not None
    height = sole.at(np.array([START, START + SINKING_TIME, 0.65, END - SINKING_TIME, END]))[:, 2]
    assert height == pytest.approx([RISE, 0.0, 0.0, 0.0, 0.5 * RISE], abs=1e-9)


@pytest.mark.parametrize("end", [0.43, 0.5, 0.9, 4.0])
def test_it_never_overshoots_however_long_the_contact(end: float) -> None:
    sole = sole_trajectory(contact((RISE, RISE), end))
    assert sole is not None
    moves = sole.at(np.linspace(START, end, 2000))
    assert not moves[:, :2].any()
    assert moves[:, 2].min() >= -5e-5  # of the cubic between its samples
    assert moves[:, 2].max() <= RISE + 1e-9


def test_it_is_at_rest_between() -> None:
    sole = sole_trajectory(contact((RISE, RISE)))
    assert sole is not None
    sunk = 1.25 * SINKING_TIME
    inside = np.linspace(START + sunk, END - sunk, 50)
    assert np.abs(sole.velocity(inside)).max() < 1e-6
