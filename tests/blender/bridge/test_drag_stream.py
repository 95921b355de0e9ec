"""What a drag asks of the worker one by one, and which answers it waits for."""

from __future__ import annotations

from itertools import count
from threading import Thread, Timer
from typing import Any

import pytest
from hangtime.bridge.worker_requests import DragStream
from hangtime.solver.data.faults import WorkerDied
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.status import DragStatus
from hangtime.solver.worker.protocol import Failed, Followed, Progress, Request
from hangtime.tests.helpers.clips import load_recording


@pytest.fixture(scope="module")
def jump() -> Recording:
    return load_recording("forward_jump_116cm.bvh")


def raised(up: float) -> MotionProblem:
    return MotionProblem(pins=(Pin("up", "ground 2", offset=(0.0, 0.0, up)),))


def on_its_way(request: Request) -> Followed:
    """An answer, of which the stream looks at nothing else."""
    unread: Any = None
    return Followed(request.id, unread, DragStatus.CONVERGING, unread)


def test_a_drag_goes_on_once_its_last_answer_is_heard(jump: Recording) -> None:
    stream = DragStream(jump, count(1))
    asked = stream.requests()
    stream.want(raised(0.01))
    stream.deliver(Failed(next(asked).id, WorkerDied("for one")))
    stream.want(raised(0.02))
    later: list[Request] = []
    talk = Thread(target=lambda: later.append(next(asked)), daemon=True)
    talk.start()
    talk.join(0.2)
    assert not later, "the next was asked for before the last was heard"
    assert len(list(stream.news())) == 1
    talk.join(10.0)
    assert [each.problem for each in later] == [raised(0.02)]


def test_what_is_made_ready_before_a_drag_is_no_ghost_and_is_asked_for_once(
    jump: Recording,
) -> None:
    stream = DragStream(jump, count(1))
    asked = stream.requests()
    stream.want(raised(0.0), ahead=True)
    stream.deliver(on_its_way(next(asked)))
    assert not list(stream.news())
    later: list[Request] = []
    talk = Thread(target=lambda: later.append(next(asked)), daemon=True)
    talk.start()
    talk.join(0.2)
    assert not later, "what has not moved was asked for again"
    stream.want(raised(0.01))
    talk.join(10.0)
    stream.deliver(on_its_way(later[0]))
    assert [message.id for message in stream.news()] == [later[0].id]
    assert next(asked).problem == raised(0.01)


def test_the_first_ghost_is_waited_for_but_not_for_long(jump: Recording) -> None:
    stream = DragStream(jump, count(1))
    asked = stream.requests()
    stream.want(raised(0.01))
    request = next(asked)
    assert not list(stream.first_news(0.05))
    late = Timer(0.1, lambda: stream.deliver(on_its_way(request)))
    late.start()
    assert [message.id for message in stream.first_news(60.0)] == [request.id]
    assert not list(stream.news())


def test_the_first_ghost_is_waited_for_while_the_worker_is_made_ready(jump: Recording) -> None:
    """Where the mouse moves at once, what was asked at the press is answered first, unseen."""
    stream = DragStream(jump, count(1))
    asked = stream.requests()
    stream.want(raised(0.0), ahead=True)
    ready = next(asked)
    stream.want(raised(0.01))
    seen: list[int] = []

    def talk() -> None:
        stream.deliver(on_its_way(ready))
        moved = next(asked)
        seen.append(moved.id)
        stream.deliver(on_its_way(moved))

    Timer(0.1, talk).start()
    assert [message.id for message in stream.first_news(60.0)] == seen != []


def test_no_ghost_is_waited_for_while_the_worker_fits(jump: Recording) -> None:
    stream = DragStream(jump, count(1))
    asked = stream.requests()
    stream.want(raised(0.01))
    told = Progress(next(asked).id, "fit", 1, 9.0, "ground 1", 0.1)
    stream.deliver(told)
    late = Timer(60.0, lambda: None)
    late.start()
    assert list(stream.first_news(60.0)) == [told]
    assert late.is_alive()
    late.cancel()
