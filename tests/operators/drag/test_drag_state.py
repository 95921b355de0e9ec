"""Dragging pins and numbers, without Blender."""

from math import inf, radians

import pytest
from hangtime.operators.drag.drag_state import Axis, DragState, Landing, PinDrag, ValueDrag

START = (1.0, 2.0, 0.0)
STEP = radians(5.0)


def test_a_pin_goes_where_the_mouse_goes() -> None:
    drag = PinDrag(START)
    assert drag.move((0.3, -0.2, 0.0)) == pytest.approx((1.3, 1.8, 0.0))
    assert drag.shift == pytest.approx((0.3, -0.2, 0.0))
    assert drag.move((0.1, 0.0, 0.0)) == pytest.approx((1.1, 2.0, 0.0))


def test_precise_is_a_tenth_from_there_on_and_never_jumps() -> None:
    drag = PinDrag(START)
    drag.move((0.5, 0.0, 0.0))
    assert drag.move((0.5, 0.0, 0.0), precise=True) == pytest.approx((1.5, 2.0, 0.0))
    assert drag.move((0.7, 0.1, 0.0), precise=True) == pytest.approx((1.52, 2.01, 0.0))
    assert drag.move((0.7, 0.1, 0.0)) == pytest.approx((1.52, 2.01, 0.0))
    assert drag.move((0.8, 0.1, 0.0)) == pytest.approx((1.62, 2.01, 0.0))


def test_snapping_goes_in_steps_and_forgets_them_afterwards() -> None:
    drag = PinDrag(START)
    assert drag.move((0.12, -0.07, 0.0), snap=True) == pytest.approx((1.1, 1.95, 0.0))
    assert drag.move((0.12, -0.07, 0.0)) == pytest.approx((1.12, 1.93, 0.0))


def test_an_axis_holds_the_pin_until_its_key_comes_again() -> None:
    drag = PinDrag(START)
    drag.move((0.3, 0.3, 0.0))
    drag.key(Axis.Z)
    assert drag.place == START
    assert drag.move((0.2, 0.2, 0.4)) == pytest.approx((1.0, 2.0, 0.4))
    drag.key(Axis.X)
    assert drag.move((0.2, 0.2, 0.4)) == pytest.approx((1.2, 2.0, 0.0))
    drag.key(Axis.X)
    assert drag.move((0.2, 0.2, 0.0)) == pytest.approx((1.2, 2.2, 0.0))


def test_near_the_horizon_a_pin_does_not_fly_off() -> None:
    drag = PinDrag((1.0, 0.0, 0.0))
    assert drag.move((300.0, 400.0, 0.0)) == pytest.approx((7.0, 8.0, 0.0))


def test_a_drag_may_begin_on_an_axis() -> None:
    assert PinDrag(START, Axis.Z).move((9.0, 9.0, 0.1)) == pytest.approx((1.0, 2.0, 0.1))


def test_letting_go_says_whether_anything_has_moved() -> None:
    still, moved, returned = PinDrag(START), PinDrag(START), PinDrag(START)
    moved.move((0.1, 0.0, 0.0))
    returned.move((0.1, 0.0, 0.0))
    returned.move((0.0, 0.0, 0.0))
    assert [drag.let_go() for drag in (still, moved, returned)] == [False, True, False]
    assert moved.state is DragState.LET_GO
    assert moved.place == pytest.approx((1.1, 2.0, 0.0))


def test_putting_back_forgets_the_move() -> None:
    drag = PinDrag(START)
    drag.move((0.1, 0.0, 0.0))
    assert drag.put_back() == START
    assert drag.place == START


def crate(x: float, _y: float) -> Landing | None:
    """A crate of half a metre, of a metre in x and all of y."""
    return Landing(0.5, "Crate") if 1.5 < x < 2.5 else None


def test_a_pin_lands_on_what_is_below_and_comes_down_again() -> None:
    drag = PinDrag(START, lands=crate)
    assert drag.move((0.2, 0.0, 0.0)) == pytest.approx((1.2, 2.0, 0.0))
    assert drag.landing is None
    assert drag.move((0.8, 0.1, 0.0)) == pytest.approx((1.8, 2.1, 0.5))
    assert drag.landing == Landing(0.5, "Crate")
    assert drag.shift == pytest.approx((0.8, 0.1, 0.5))
    assert drag.move((0.2, 0.0, 0.0)) == pytest.approx((1.2, 2.0, 0.0))
    assert drag.landing is None


def test_stepping_lets_go_of_the_surface() -> None:
    drag = PinDrag(START, lands=crate)
    assert drag.move((0.81, 0.0, 0.0), snap=True) == pytest.approx((1.8, 2.0, 0.0))
    assert drag.landing is None


def test_along_x_a_pin_lands_and_along_z_it_does_not() -> None:
    drag = PinDrag(START, Axis.X, crate)
    assert drag.move((0.8, 0.3, 0.0)) == pytest.approx((1.8, 2.0, 0.5))
    drag.key(Axis.Z)
    assert drag.landing is None
    assert PinDrag((2.0, 0.0, 0.5), Axis.Z, crate).move((0.0, 0.0, 0.2)) == pytest.approx(
        (2.0, 0.0, 0.7)
    )


def test_beside_the_crate_that_it_stood_on_a_pin_falls_to_the_floor() -> None:
    drag = PinDrag((2.0, 0.0, 0.5), lands=crate, floor=0.01)
    assert drag.move((1.0, 0.0, 0.0)) == pytest.approx((3.0, 0.0, 0.01))
    assert drag.move((0.1, 0.0, 0.0)) == pytest.approx((2.1, 0.0, 0.5))


def test_putting_back_stands_nowhere_else() -> None:
    drag = PinDrag(START, lands=crate)
    drag.move((0.8, 0.0, 0.0))
    assert drag.put_back() == START
    assert drag.landing is None


@pytest.mark.parametrize("end", ["let_go", "put_back"])
def test_after_its_end_nothing_drags(end: str) -> None:
    pin, value = PinDrag(START), ValueDrag(0.0, -1.0, 1.0, STEP)
    getattr(pin, end)()
    getattr(value, end)()
    with pytest.raises(ValueError, match="the drag is"):
        pin.move((0.1, 0.0, 0.0))
    with pytest.raises(ValueError, match="the drag is"):
        pin.key(Axis.X)
    late_moves = (lambda: value.move(0.1), lambda: value.set(0.1), lambda: pin.set(START))
    for late in (pin.let_go, pin.put_back, value.let_go, value.put_back, *late_moves):
        with pytest.raises(ValueError, match="the drag is"):
            late()


# ---------------------------------------------------------------- one number


def test_a_value_follows_within_its_bounds() -> None:
    drag = ValueDrag(0.5, 0.0, 1.0, STEP)
    assert drag.value == 0.5
    assert drag.move(0.2) == pytest.approx(0.7)
    assert drag.move(5.0) == 1.0
    assert drag.move(-5.0) == 0.0
    assert drag.move(0.1) == pytest.approx(0.6)  # back under the mouse


def test_a_value_snaps_to_whole_steps_of_itself() -> None:
    drag = ValueDrag(radians(12.0), -inf, inf, STEP)
    assert drag.move(radians(1.0), snap=True) == pytest.approx(radians(15.0))
    assert drag.move(radians(1.0)) == pytest.approx(radians(13.0))


def test_a_precise_value_moves_a_tenth_without_a_jump() -> None:
    drag = ValueDrag(1.0, -inf, inf, STEP)
    drag.move(0.5)
    assert drag.move(0.6, precise=True) == pytest.approx(1.51)
    assert drag.move(0.6) == pytest.approx(1.51)
    assert drag.move(0.7) == pytest.approx(1.61)


def test_a_value_that_was_put_back_is_what_it_was() -> None:
    drag = ValueDrag(0.5, 0.0, 1.0, STEP)
    drag.move(0.2)
    assert drag.put_back() == 0.5
    assert drag.value == 0.5
    assert not ValueDrag(0.5, 0.0, 1.0, STEP).let_go()


@pytest.mark.parametrize(("precise", "leads"), [(False, 0.6), (True, 0.51)])
def test_a_number_moves_a_pin_wherever_the_mouse_is_which_leads_again_as_before(
    precise: bool, leads: float
) -> None:
    drag = PinDrag(START)
    drag.move((0.5, 0.5, 0.0))
    assert drag.set((0.2, 0.0, 0.0)) == pytest.approx((1.2, 2.0, 0.0))
    now = drag.move((0.6, 0.5, 0.0), precise=precise)
    assert now == pytest.approx((1.0 + leads, 2.5, 0.0))


def test_a_number_is_meant_however_far_it_leads() -> None:
    assert PinDrag(START).set((12.0, 0.0, 0.0)) == pytest.approx((13.0, 2.0, 0.0))


def test_a_number_lands_a_pin_on_what_is_there() -> None:
    drag = PinDrag(START, lands=crate)
    assert drag.set((0.8, 0.0, 0.0)) == pytest.approx((1.8, 2.0, 0.5))


def test_a_number_on_an_axis_is_of_that_alone() -> None:
    drag = PinDrag(START, Axis.Z)
    assert drag.set((0.0, 0.0, -0.1)) == pytest.approx((1.0, 2.0, -0.1))


def test_a_number_changes_a_value_by_as_much_from_its_start() -> None:
    drag = ValueDrag(radians(10.0), -inf, inf, STEP)
    drag.move(radians(33.0))
    assert drag.set(radians(-15.0)) == pytest.approx(radians(-5.0))
    assert drag.move(radians(53.0), precise=True) == pytest.approx(radians(45.0))
    assert drag.move(radians(54.0)) == pytest.approx(radians(46.0))
