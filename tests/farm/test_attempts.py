"""Which cell goes to which worker, without a scheduler."""

from hangtime.batch.cluster.attempts import MOST_TRIES, SLOW_LEAST, Attempt, Attempts
from hangtime.batch.records.manifest import CellPlan


def plans(count: int, clips: int = 1) -> list[CellPlan]:
    return [CellPlan(f"{n:05}", "a.bvh", str(n % clips), "r.toml", "") for n in range(1, count + 1)]


def begun(attempts: Attempts, worker: str, now: float = 0.0) -> Attempt:
    attempt = attempts.next_for(worker, now)
    assert attempt is not None
    return attempt


def test_the_others_of_a_clip_wait_for_the_first_ones_fit() -> None:
    attempts = Attempts.of(plans(4, clips=2))
    first, second = begun(attempts, "a"), begun(attempts, "b")
    assert first.plan.clip_sha256 != second.plan.clip_sha256
    assert attempts.next_for("c", 0.0) is None
    assert attempts.end(first, 1.0)
    assert begun(attempts, "a").plan.clip_sha256 == first.plan.clip_sha256


def test_a_clip_with_a_fit_waits_for_nothing() -> None:
    attempts = Attempts.of(plans(3), fitted=[("0", "r.toml")])
    assert [begun(attempts, worker).plan.cell for worker in "abc"] == ["00001", "00002", "00003"]


def test_what_is_lost_goes_first_to_another_and_fails_in_the_end() -> None:
    attempts = Attempts.of(plans(2))
    for _ in range(MOST_TRIES - 1):
        attempt = begun(attempts, "a")
        assert attempt.plan.cell == "00001"
        assert attempts.again(attempt)
    last = begun(attempts, "a")
    assert not attempts.again(last)
    assert attempts.give_up(last.plan)
    assert begun(attempts, "a").plan.cell == "00002"


def test_a_worker_that_does_not_share_the_folder_is_not_the_cells_fault() -> None:
    attempts = Attempts.of(plans(1))
    for _ in range(10 * MOST_TRIES):
        assert attempts.again(begun(attempts, "a"), blame=False)


def test_an_idle_worker_takes_a_straggler_as_well_and_the_first_result_counts() -> None:
    attempts = Attempts.of(plans(3), fitted=[("0", "r.toml")])
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
    attempts = Attempts.of(plans(2), fitted=[("0", "r.toml")])
    quick, slow = begun(attempts, "a"), begun(attempts, "b")
    attempts.end(quick, 1.0)
    twin = begun(attempts, "a", SLOW_LEAST + 1.0)
    assert attempts.again(slow)
    assert not attempts.waiting
    assert attempts.end(twin, 40.0)
    assert attempts.over
