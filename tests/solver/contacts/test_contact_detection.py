"""Contacts that are found on made-up tracks."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.contacts.contact_detection import detect_contacts
from hangtime.solver.data.contacts import ContactPoint, PointKind

FRAME = 1 / 120
TIMES = np.arange(0, 3 + 1e-9, FRAME)


def point(
    height: FloatArray, kind: PointKind = PointKind.TOE, x: FloatArray | float = 0.0
) -> ContactPoint:
    track = np.stack([np.broadcast_to(x, height.shape), np.zeros_like(height), height], axis=1)
    return ContactPoint(kind, "Foot", np.zeros(3), track)


def leap(start: float, end: float, landing: float = 0.0) -> FloatArray:
    """Height of a point that stands, leaves the floor like a ball at `start`, stops at `end`."""
    t = np.clip(TIMES - start, 0.0, end - start)
    speed = landing / (end - start) + 9.81 * (end - start) / 2
    return speed * t - 9.81 * t**2 / 2


def test_ends_are_found_between_frames() -> None:
    s = detect_contacts(TIMES, {"Left toe": point(leap(1.003, 1.503))})
    (flight,) = s.flights
    # 27 mm up at 2.45 m/s: a toe that points is still pressed there
    assert (flight.start, flight.end) == pytest.approx((1.003, 1.503), abs=0.012)
    assert [c.name for c in s.contacts] == ["Left toe 1", "Left toe 2"]
    assert (s.contacts[0].start, s.contacts[-1].end) == (0.0, TIMES[-1])  # the clip cuts them off


def test_the_floor_need_not_be_even() -> None:
    s = detect_contacts(TIMES, {"Left toe": point(leap(1.0, 1.5, landing=0.04))})
    assert len(s.flights) == 1
    assert [c.place[2] for c in s.contacts] == pytest.approx([0.0, 0.04], abs=1e-3)


def test_a_heel_held_up_is_no_contact_but_the_toe_is() -> None:
    lifted = np.where(TIMES > 1.0, 0.08, 0.0)
    s = detect_contacts(
        TIMES,
        {"Left heel": point(lifted, PointKind.HEEL), "Left toe": point(np.zeros_like(TIMES))},
    )
    heel, toe = s.contacts
    assert heel.end == pytest.approx(1.0, abs=FRAME)
    assert (toe.start, toe.end) == (0.0, TIMES[-1])


def test_a_point_that_slides_away_stands_in_a_new_place() -> None:
    x = np.clip(TIMES - 1.0, 0.0, 0.5) * 1.0  # half a metre, along the floor
    s = detect_contacts(TIMES, {"Left toe": point(np.zeros_like(TIMES), x=x)})
    assert [c.place[0] for c in s.contacts] == pytest.approx([0.0, 0.5], abs=0.01)


def test_a_small_step_makes_a_new_contact_however_smoothly_it_is_taken() -> None:
    """As of a foot that is set anew after a landing, low-passed: slow, low, at rest on both sides.
    Of one held in one place between them the foot was recorded up to 8 cm away."""
    share = np.clip((TIMES - 1.0) / 0.2, 0.0, 1.0)
    x = 0.08 * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    s = detect_contacts(TIMES, {"Left toe": point(0.013 * np.sin(np.pi * share), x=x)})
    assert [c.place[0] for c in s.contacts] == pytest.approx([0.0, 0.08], abs=0.01)


@pytest.mark.parametrize("creep", [0.05, 0.08, 0.11])  # m/s
def test_a_foot_that_creeps_and_jerks_by_less_than_a_step_stays_one_contact(creep: float) -> None:
    """At whatever speed: of its places none is taken from a tenth of a second away."""
    jerk = 0.04 * np.clip((TIMES - 0.5) / 0.06, 0.0, 1.0)
    x = creep * np.clip(TIMES, 0.0, 1.0) + jerk
    s = detect_contacts(TIMES, {"Left toe": point(np.zeros_like(TIMES), x=x)})
    around = [c for c in s.contacts if c.start < 0.7 and c.end > 0.4]
    assert len(around) == 1


def test_a_hand_must_rest_on_the_floor() -> None:
    for height, still_s, touches in ((0.0, 0.6, True), (0.0, 0.1, False), (0.12, 0.6, False)):
        away = np.clip(np.abs(TIMES - 1.5) - still_s / 2, 0.0, None)
        s = detect_contacts(TIMES, {"Left hand": point(height + 2.0 * away, PointKind.HAND)})
        assert bool(s.contacts) is touches


def test_no_flight_without_a_fall() -> None:
    feet = {"Left toe": point(leap(1.0, 1.5))}
    falling = np.stack([np.zeros_like(TIMES), np.zeros_like(TIMES), 0.9 + leap(1.0, 1.5)], axis=1)
    hanging = np.broadcast_to([0.0, 0.0, 0.9], falling.shape)
    assert len(detect_contacts(TIMES, feet, com=falling).flights) == 1
    s = detect_contacts(TIMES, feet, com=hanging)
    assert (len(s.flights), len(s.unseen), len(s.phases)) == (0, 1, 1)


def test_a_flight_is_not_denied_by_noise_in_its_few_frames() -> None:
    """A clip ends 50 ms after its last foot left, where a millimetre of noise is some m/s²."""
    end = TIMES <= 1.05
    times = TIMES[end]
    toe = point(leap(1.0, 1.5)[end])
    com = np.stack([np.zeros_like(times), np.zeros_like(times), 0.9 + leap(1.0, 1.5)[end]], axis=1)
    noise = np.random.default_rng(5).normal(scale=0.001, size=(40, len(times)))
    for each in noise:
        s = detect_contacts(times, {"Left toe": toe}, com=com + np.outer(each, [0.0, 0.0, 1.0]))
        assert (len(s.flights), s.unseen) == (1, ())


def test_a_gap_too_short_to_be_a_flight_is_closed() -> None:
    left, right = np.where(TIMES > 1.0, 0.5, 0.0), np.where(TIMES < 1.01, 0.5, 0.0)
    s = detect_contacts(TIMES, {"Left toe": point(left), "Right toe": point(right)})
    assert s.flights == ()
    assert s.contacts[0].end == s.contacts[1].start


def test_a_clip_that_begins_as_a_foot_lands_begins_with_a_short_flight() -> None:
    height = leap(-0.4, 0.02)  # in the air in the first frames alone
    falling = 0.9 - 9.81 * TIMES**2 / 2
    body = np.stack([np.zeros_like(TIMES), np.zeros_like(TIMES), falling], axis=1)
    for reverse in (slice(None), slice(None, None, -1)):  # and one that ends as it lifts
        feet = {"Left toe": point(height[reverse])}
        s = detect_contacts(TIMES, feet, com=body[reverse])
        (flight,) = s.flights
        assert flight.end - flight.start == pytest.approx(0.03)
        assert flight.start == 0.0 or flight.end == TIMES[-1]
        hanging = np.broadcast_to([0.0, 0.0, 0.9], body.shape)
        assert detect_contacts(TIMES, feet, com=hanging).flights == ()


@pytest.mark.parametrize("rate", [24.0, 30.0, 60.0])
def test_noise_on_the_first_frame_or_the_last_makes_no_flight(rate: float) -> None:
    """Of a body that stands; one that comes down with it lands then."""
    times = np.arange(0.0, 2.0, 1.0 / rate)
    height = np.where(times > 0.0, 0.0, 0.06)
    heel = ContactPoint(
        PointKind.TOE, "Foot", np.zeros(3), np.stack([0.0 * times, 0.0 * times, height], 1)
    )
    standing = np.full_like(times, 0.9)
    landing = standing - np.minimum(times, 0.5 / rate)  # at 1 m/s
    for reverse in (slice(None), slice(None, None, -1)):
        point = replace(heel, track=heel.track[reverse])
        for com, flights in ((standing, 0), (landing, 1)):
            body = np.stack([0.0 * times, 0.0 * times, com[reverse]], axis=1)
            found = detect_contacts(times, {"Left toe": point}, com=body)
            assert len(found.flights) == flights
