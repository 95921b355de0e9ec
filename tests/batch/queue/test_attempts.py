"""Which cell goes to which worker, without processes or a scheduler."""

from hangtime.batch.queue.attempts import SLOW_LEAST, Attempt, Attempts
from hangtime.batch.records.manifest import CellPlan

MOST_TRIES = 4
FIT = ("0", "r.toml")


def plans(count: int, clips: int = 1) -> list[CellPlan]:
    return [CellPlan(f"{n:05}", "a.bvh", str(n % clips), "r.toml", "") for n in range(1, count + 1)]


def queue(cells: list[CellPlan], *fitted: tuple[str, str], eager: bool = False) -> Attempts:
    return Attempts(MOST_TRIES, eager, fitted=set(fitted)).add(cells)


def begun(attempts: Attempts, worker: str, now: float = 0.0) -> Attempt:
    attempt = attempts.next_for(worker, now)
    assert attempt is not None
    return attempt


def test_the_others_of_a_clip_wait_for_the_first_ones_fit() -> None:
    attempts = queue(plans(4, clips=2))
    first, second = begun(attempts, "a"), begun(attempts, "b")
    assert first.plan.clip_sha256 != second.plan.clip_sha256
    assert attempts.next_for("c", 0.0) is None
    assert attempts.end(first, 1.0)
    assert begun(attempts, "a").plan.clip_sha256 == first.plan.clip_sha256


def test_a_clip_with_a_fit_waits_for_nothing() -> None:
    attempts = queue(plans(3), FIT)
    assert [begun(attempts, worker).plan.cell for worker in "abc"] == ["00001", "00002", "00003"]


def test_what_is_lost_goes_first_to_another_and_fails_in_the_end() -> None:
    attempts = queue(plans(2))
    for _ in range(MOST_TRIES - 1):
        attempt = begun(attempts, "a")
        assert attempt.plan.cell == "00001"
        assert attempts.again(attempt)
    last = begun(attempts, "a")
    assert not attempts.again(last)
    assert begun(attempts, "a").plan.cell == "00002"


def test_a_worker_that_does_not_share_the_folder_is_not_the_cells_fault() -> None:
    attempts = queue(plans(1))
    for _ in range(10 * MOST_TRIES):
        assert attempts.again(begun(attempts, "a"), blame=False)


def test_an_idle_worker_takes_a_straggler_as_well_and_the_first_result_counts() -> None:
    attempts = queue(plans(3), FIT)
    quick, slow, other = (begun(attempts, worker) for worker in "abc")
    attempts.end(quick, 1.0)
    attempts.end(other, 1.0)
    assert attempts.next_for("a", SLOW_LEAST - 1.0) is None
    twin = begun(attempts, "a", SLOW_LEAST + 1.0)
    assert twin.plan == slow.plan
    assert attempts.next_for("b", SLOW_LEAST + 2.0) is None  # two are enough
    assert attempts.end(twin, SLOW_LEAST + 2.0)
    assert attempts.over  # whatever the straggler does
    assert not attempts.end(slow, 100.0)


def test_a_straggler_whose_worker_ends_is_not_begun_again_while_its_twin_runs() -> None:
    attempts = queue(plans(2), FIT)
    quick, slow = begun(attempts, "a"), begun(attempts, "b")
    attempts.end(quick, 1.0)
    twin = begun(attempts, "a", SLOW_LEAST + 1.0)
    assert attempts.again(slow)
    assert not attempts.waiting
    assert attempts.end(twin, 40.0)
    assert attempts.over


def test_a_worker_goes_on_with_its_clip_and_new_ones_begin_with_clips_that_nobody_fits() -> None:
    attempts = queue(plans(6, clips=2))
    first, second = begun(attempts, "a"), begun(attempts, "b")
    attempts.end(second, 1.0)
    assert begun(attempts, "b").plan.clip_sha256 == second.plan.clip_sha256
    attempts.end(first, 2.0)
    assert begun(attempts, "a").plan.clip_sha256 == first.plan.clip_sha256


def test_an_eager_worker_waits_for_a_fit_itself_but_only_where_there_is_nothing_else() -> None:
    attempts = queue(plans(4, clips=2), eager=True)
    found = [begun(attempts, worker).plan.clip_sha256 for worker in "abc"]
    assert set(found[:2]) == {"0", "1"}
    assert found[2] in "01"


def test_a_cell_that_failed_too_often_has_not_ended_while_its_twin_runs() -> None:
    attempts = queue(plans(2), FIT)
    quick, slow = begun(attempts, "a"), begun(attempts, "b")
    attempts.end(quick, 1.0)
    for _ in range(MOST_TRIES):
        twin = begun(attempts, "a", SLOW_LEAST + 1.0)
        assert attempts.again(twin)
    assert not attempts.over
    assert attempts.end(slow, 40.0)
    assert attempts.over


def test_twins_that_both_fail_too_often_end_once() -> None:
    attempts = queue(plans(2), FIT)
    quick, slow = begun(attempts, "a"), begun(attempts, "b")
    attempts.end(quick, 1.0)
    for _ in range(MOST_TRIES):
        assert attempts.again(begun(attempts, "a", SLOW_LEAST + 1.0))
    assert not attempts.again(slow)
    assert attempts.over
    assert not attempts.waiting


def test_a_twin_that_comes_late_is_neither_told_again_nor_begun_again() -> None:
    attempts = queue(plans(2), FIT)
    quick, slow = begun(attempts, "a"), begun(attempts, "b")
    attempts.end(quick, 1.0)
    twin = begun(attempts, "a", SLOW_LEAST + 1.0)
    assert attempts.end(slow, 40.0)
    assert attempts.again(twin)
    assert attempts.over
    assert not attempts.waiting
