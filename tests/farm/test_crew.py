"""Workers that may solve cells, and sentences on those that may not."""

from dataclasses import replace

import pytest
from hangtime.batch.cluster.crew import Crew, judge
from hangtime.batch.cluster.worker_side import Build, Reach, WorkerState

OWN = Build("1.0.0", {"solver/a.py": "1", "batch/b.py": "2"}, {"numpy": "1.26.4"})
GOOD = WorkerState(OWN, Reach.SHARED, True, "node7")


def test_the_same_build_may_whatever_else_is_installed_here() -> None:
    wheel = replace(GOOD, build=replace(OWN, code={"solver/a.py": "1"}))
    assert judge("tcp://w", GOOD, OWN) == judge("tcp://w", wheel, OWN)
    assert judge("tcp://w", GOOD, OWN).usable


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (
            replace(GOOD, build=replace(OWN, version="0.9.0")),
            "has Hangtime 0.9.0 and this is 1.0.0",
        ),
        (
            replace(GOOD, build=replace(OWN, code={"solver/a.py": "3"})),
            "another build (solver/a.py",
        ),
        (
            replace(GOOD, build=replace(OWN, libraries={"numpy": "2.4"})),
            "numpy 2.4 and this is 1.26",
        ),
        (replace(GOOD, one_thread=False), "several threads"),
        (ModuleNotFoundError("No module named 'hangtime'"), "install the wheel there"),
        (TimeoutError("no word"), "does not answer (no word)"),
    ],
)
def test_another_one_is_left_out_in_a_sentence(answer: WorkerState | Exception, words: str) -> None:
    verdict = judge("tcp://w", answer, OWN)
    assert not verdict.usable
    assert verdict.words.startswith("Worker tcp://w")
    assert "is left out" in verdict.words
    assert words in verdict.words


def test_a_folder_that_is_read_only_is_told_and_the_worker_used() -> None:
    verdict = judge("tcp://w", replace(GOOD, reach=Reach.READ_ONLY), OWN)
    assert verdict.usable
    assert "may not write into the batch's folder" in verdict.words


def test_workers_are_asked_once_and_forgotten_when_they_go() -> None:
    crew = Crew(OWN, {}, set())
    assert crew.strangers(["b", "a"]) == ["a", "b"]
    told = crew.admit({"a": GOOD, "b": replace(GOOD, one_thread=False)})
    assert len(told) == 1
    assert crew.strangers(["a", "b"]) == []
    assert crew.gone(["b"]) == {"a"}
    assert crew.strangers(["a", "b"]) == ["a"]
