"""The worker as a process: answers, what it remembers, how it ends."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from math import pi
from pathlib import Path
from threading import Event, Thread
from typing import BinaryIO

import numpy as np
import pytest
from hangtime.bridge import worker_client
from hangtime.bridge.worker_client import RequestKind, Worker
from hangtime.bridge.worker_requests import DragStream, PendingRequest
from hangtime.solver.data.faults import (
    ClipTooShort,
    FramesReversed,
    UnknownContactName,
    UnknownPhase,
    WorkerDied,
)
from hangtime.solver.data.problem import ContactEdit, MotionProblem, Pin
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.status import DragStatus, Status
from hangtime.solver.worker.protocol import (
    Adapted,
    Analysed,
    Cancelled,
    Examined,
    Failed,
    Fitted,
    Followed,
    Halt,
    Message,
    Progress,
    send,
)
from hangtime.tests.blender.helpers.scripts import output_of
from hangtime.tests.helpers.clips import load_recording

JUMP = "forward_jump_116cm.bvh"
SPAN = (110.0, 260.0)
UP = MotionProblem(frames=SPAN, pins=(Pin("up", "ground 2", offset=(0.0, 0.0, 0.05)),))
AHEAD = MotionProblem(frames=SPAN, pins=(Pin("ahead", "ground 2", offset=(0.05, 0.0, 0.0)),))

# Starts a worker, prints its number and dies without ending it.
ORPHAN = """
import os, runpy, sys
runpy.run_path(sys.argv[1])["load"]()
from hangtime.bridge.worker_client import RequestKind, Worker
from hangtime.tests.helpers.clips import load_recording
from hangtime.solver.data.problem import MotionProblem
worker = Worker()
worker.ask(RequestKind.ANALYSE, load_recording(sys.argv[2]), MotionProblem()).wait()
print(worker.pid, flush=True)
os._exit(0)
"""


@pytest.fixture(scope="module")
def jump() -> Recording:
    return load_recording(JUMP)


@pytest.fixture
def worker() -> Iterator[Worker]:
    """A fresh one, which has to fit what it shall adapt."""
    worker = Worker()
    yield worker
    worker.close()


@dataclass(frozen=True)
class Warm:
    """A worker after its first adaptation, of UP, and what it said meanwhile."""

    worker: Worker
    told: list[Progress]
    answer: object


@pytest.fixture(scope="module")
def warm(jump: Recording) -> Iterator[Warm]:
    worker, told = Worker(), list[Progress]()
    yield Warm(worker, told, worker.ask(RequestKind.ADAPT, jump, UP).wait(told.append))
    worker.close()


@pytest.fixture
def fitted(warm: Warm) -> Iterator[Worker]:
    """One that remembers the jump's fit."""
    yield warm.worker
    if warm.worker.busy:
        warm.worker.drop()


def gone(pid: int) -> bool:
    """Whether a process ends within 5 s (a zombie has ended)."""
    status = Path(f"/proc/{pid}/stat")
    for _ in range(100):
        if not status.exists() or status.read_text().rpartition(")")[2].split()[0] == "Z":
            return True
        time.sleep(0.05)
    return False


@pytest.mark.slow
def test_the_second_adaptation_starts_from_the_stored_fit(warm: Warm, jump: Recording) -> None:
    told: list[Progress] = []
    second = warm.worker.ask(RequestKind.ADAPT, jump, AHEAD).wait(told.append)
    for problem, answer in ((UP, warm.answer), (AHEAD, second)):
        assert isinstance(answer, Adapted)
        assert answer.report.pins[0].name == problem.pins[0].name
        frames = answer.track.frames
        np.testing.assert_array_equal(frames, SPAN[0] + np.arange(len(frames)))
        assert len(frames) > SPAN[1] - SPAN[0]  # a jump that goes further or higher takes longer
    stages = [{progress.stage for progress in each} for each in (warm.told, told)]
    assert "fit" in stages[0]
    assert "fit" not in stages[1]
    assert "adapt" in stages[1]


def test_a_fault_is_an_answer_and_the_worker_lives_on(worker: Worker, jump: Recording) -> None:
    asked: list[tuple[MotionProblem, type[Exception]]] = [
        (MotionProblem(frames=(1.0, 5.0)), ClipTooShort),
        (MotionProblem(frames=(300.0, 200.0)), FramesReversed),
        (MotionProblem(frames=SPAN, contacts=(ContactEdit("Nose 1"),)), UnknownContactName),
    ]
    numbers = set()
    for problem, fault in asked:
        answer = worker.ask(RequestKind.ANALYSE, jump, problem).wait()
        assert isinstance(answer, Failed)
        assert type(answer.fault) is fault
        numbers.add(worker.pid)
    assert len(numbers) == 1
    assert None not in numbers


@pytest.mark.slow
def test_the_stated_height_leaves_places_in_the_recordings_lengths(
    worker: Worker, jump: Recording
) -> None:
    measured, stated = (
        worker.ask(RequestKind.ANALYSE, jump, MotionProblem(frames=SPAN, height=height)).wait()
        for height in (None, 1.75)
    )
    assert isinstance(measured, Analysed)
    assert isinstance(stated, Analysed)
    assert measured.height == pytest.approx(stated.height) != pytest.approx(1.75, abs=0.01)
    places = {contact.name: contact.place for contact in measured.schedule.contacts}
    assert places.keys() == {contact.name for contact in stated.schedule.contacts}
    for contact in stated.schedule.contacts:
        np.testing.assert_allclose(contact.place, places[contact.name], atol=0.01)


def started(worker: Worker, recording: Recording, problem: MotionProblem) -> PendingRequest:
    """An adaptation of which a first step has been told."""
    job = worker.ask(RequestKind.ADAPT, recording, problem)
    while not list(job.news()):
        time.sleep(0.01)
    return job


@pytest.mark.slow
def test_a_request_that_is_dropped_costs_neither_worker_nor_fit(
    fitted: Worker, jump: Recording
) -> None:
    pid = fitted.pid
    started(fitted, jump, UP)
    fitted.drop()
    assert not fitted.busy
    told: list[Progress] = []
    answer = fitted.ask(RequestKind.ADAPT, jump, AHEAD).wait(told.append)
    assert isinstance(answer, Adapted)
    assert fitted.pid == pid
    assert "fit" not in {progress.stage for progress in told}


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="no processes are stopped here")
def test_a_process_that_was_stopped_once_it_had_answered_is_replaced(
    worker: Worker, jump: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its answer, which nobody had polled, is no sign that it still hears."""
    monkeypatch.setattr("hangtime.bridge.worker_client._PATIENCE_S", 0.2)
    worker.ask(RequestKind.ANALYSE, jump, MotionProblem(frames=SPAN)).wait()
    worker.ask(RequestKind.ANALYSE, jump, MotionProblem(frames=SPAN))
    time.sleep(2.0)  # it answers in some tenths
    pid = worker.pid
    assert pid is not None
    os.kill(pid, signal.SIGSTOP)
    os.waitpid(pid, os.WUNTRACED)  # until then it may still hear
    worker.drop()
    time.sleep(0.3)
    answer = worker.ask(RequestKind.ANALYSE, jump, MotionProblem(frames=SPAN)).wait()
    assert isinstance(answer, Analysed)
    assert worker.pid != pid


@pytest.mark.slow
def test_a_solve_that_is_stopped_gives_the_motion_as_it_stands(
    fitted: Worker, jump: Recording
) -> None:
    turned = Pin("turned", "ground 2", offset=(0.5, 0.0, 0.3), turn=0.5 * pi)  # of many steps
    job = started(fitted, jump, MotionProblem(frames=SPAN, pins=(turned,)))
    fitted.as_it_stands()
    answer = job.wait()
    assert isinstance(answer, Adapted)
    assert answer.fault is not None
    assert answer.fault.reason is Status.STOPPED
    assert len(answer.track.frames) == len(answer.traces.frames)


@pytest.mark.slow
def test_a_fit_tells_how_near_it_is_and_what_it_looks_like(fitted: Worker, jump: Recording) -> None:
    answer = fitted.ask(RequestKind.FIT, jump, UP).wait()
    assert isinstance(answer, Fitted)
    assert 0.0 < answer.quality.joint_centres_rms_cm < 2.5
    assert len(answer.traces.frames) == SPAN[1] - SPAN[0] + 1


@pytest.mark.slow
def test_how_much_is_done_is_told_from_the_first_step_of_the_fit_on(warm: Warm) -> None:
    shares = [progress.share for progress in warm.told]
    assert shares == sorted(shares)
    assert 0.0 <= shares[0] < shares[-1] < 1.0
    assert warm.told[0].stage == "fit"
    assert warm.told[0].worst


def raised(up: float) -> MotionProblem:
    pin = Pin("up", "ground 2", offset=(0.0, 0.0, up))
    return MotionProblem(frames=SPAN, pins=(pin,))


def followed(stream: DragStream) -> Iterator[Followed]:
    """The motions that come, for at most a minute."""
    until = time.monotonic() + 60.0
    while time.monotonic() < until:
        for message in stream.news():
            if not isinstance(message, Progress):
                assert isinstance(message, Followed), message
                yield message
        time.sleep(0.005)


@pytest.mark.slow
def test_a_dragged_pin_is_followed_from_what_was_prepared(worker: Worker, jump: Recording) -> None:
    prepared = worker.prepare(jump, MotionProblem(frames=SPAN))
    assert not worker.busy
    stream = worker.follow(jump)
    assert worker.busy
    apexes = []
    for up in (0.01, 0.05):
        stream.want(raised(up))
        reached = (seen for seen in followed(stream) if seen.status is DragStatus.CONVERGED)
        seen = next(s for s in reached if abs(s.summary.moved_cm - 100.0 * up) < 0.1)
        apexes.append(seen.traces.heads[:, 0, 2].max())
    assert apexes[1] > apexes[0] + 0.01
    worker.drop()
    assert not worker.busy
    told: list[Progress] = []
    adapted = worker.ask(RequestKind.ADAPT, None, raised(0.05)).wait(told.append)
    assert isinstance(adapted, Adapted)
    assert isinstance(prepared.wait(), Followed)
    assert "fit" not in {progress.stage for progress in told}


@pytest.mark.slow
def test_a_request_about_another_fit_ends_what_is_prepared(worker: Worker, jump: Recording) -> None:
    prepared = worker.prepare(jump, MotionProblem(frames=SPAN))
    other = MotionProblem(frames=(SPAN[0], SPAN[1] - 20.0))
    assert isinstance(worker.ask(RequestKind.ANALYSE, jump, other).wait(), Analysed)
    assert isinstance(prepared.wait(), Cancelled)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [RequestKind.EXAMINE, RequestKind.ANALYSE])
def test_what_needs_no_fit_does_not_wait_for_one(
    worker: Worker, jump: Recording, kind: RequestKind
) -> None:
    problem = MotionProblem(frames=SPAN)
    prepared = worker.prepare(jump, problem)
    answer = worker.ask(kind, jump, problem).wait()
    assert isinstance(answer, Analysed | Examined), answer
    assert isinstance(prepared.wait(), Cancelled)


@pytest.mark.slow
def test_what_cannot_be_followed_is_said_and_the_drag_goes_on(
    fitted: Worker, jump: Recording
) -> None:
    stream = fitted.follow(jump)
    nowhere = MotionProblem(frames=SPAN, pins=(Pin("Nowhere", "ground 9"),))
    stream.want(nowhere)
    failed = None
    while failed is None:
        failed = next((m for m in stream.news() if isinstance(m, Failed)), None)
        time.sleep(0.005)
    assert isinstance(failed.fault, UnknownPhase)
    stream.want(raised(0.01))
    assert next(followed(stream)).summary.moved_cm == pytest.approx(1.0, abs=0.1)


@pytest.mark.slow
def test_a_worker_that_is_killed_answers_so_and_another_takes_over(
    worker: Worker, jump: Recording
) -> None:
    job = worker.ask(RequestKind.ADAPT, jump, UP)
    assert worker.busy
    job.wait(lambda progress: kill(worker) if progress.step == 1 else None)
    assert isinstance(job.answer, Failed)
    assert isinstance(job.answer.fault, WorkerDied)
    assert job.answer.fault.detail == "exit code -9"
    assert not worker.busy
    assert isinstance(worker.ask(RequestKind.ANALYSE, jump, UP).wait(), Analysed)


def kill(worker: Worker) -> None:
    assert worker.pid is not None
    os.kill(worker.pid, 9)


def test_without_a_python_there_is_a_fault(
    worker: Worker, jump: Recording, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(sys, "executable", str(tmp_path / "no python"))
    with pytest.raises(WorkerDied) as caught:
        worker.ask(RequestKind.ANALYSE, jump, UP)
    assert "no python" in caught.value.detail


def test_one_request_at_a_time(worker: Worker, jump: Recording) -> None:
    worker.ask(RequestKind.ADAPT, jump, UP)
    with pytest.raises(RuntimeError, match="one request"):
        worker.ask(RequestKind.ANALYSE, jump, UP)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="looks processes up in /proc")
def test_closing_ends_the_process_whatever_it_does(worker: Worker, jump: Recording) -> None:
    job = worker.ask(RequestKind.ADAPT, jump, UP)
    pid = worker.pid
    assert pid is not None
    while not list(job.news()):
        time.sleep(0.01)
    worker.close()
    assert worker.pid is None
    assert not worker.busy
    assert gone(pid)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="looks processes up in /proc")
def test_a_pipe_is_kept_open_while_something_is_being_sent_into_it(
    worker: Worker, jump: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else the next file that is opened may get its number, and what is sent: a new worker did,
    and ended, for it is greeted first."""
    halting, go_on = Event(), Event()
    open_to_the_end = []

    def slowly(stream: BinaryIO, message: Message) -> None:
        if isinstance(message, Halt):
            halting.set()
            go_on.wait(5.0)
            open_to_the_end.append(not stream.closed)
        send(stream, message)

    monkeypatch.setattr(worker_client, "send", slowly)
    worker.ask(RequestKind.FIT, jump, MotionProblem(frames=SPAN))
    worker.drop()
    assert halting.wait(60.0)
    closing = Thread(target=worker.close)
    closing.start()
    closing.join(0.3)
    go_on.set()
    closing.join()
    assert open_to_the_end == [True]


@pytest.mark.slow
def test_the_worker_ends_with_its_parent(jump: Recording) -> None:
    assert len(jump.frames) > 0
    assert gone(int(output_of(ORPHAN, JUMP)))
