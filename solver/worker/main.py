"""The worker process: solves what its parent asks until the parent closes the pipe.

program.py runs it; bridge/worker_client.py starts that and holds the other end.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from queue import SimpleQueue
from threading import Lock, Thread
from typing import TYPE_CHECKING, BinaryIO

from .program import bounded_loading, end_by_exception, private_stdout

if TYPE_CHECKING:
    from .protocol import Ending, Halted, Message, Request

FAILED, FOREIGN, PROTOCOL_FAULT, DEAF = 1, 3, 4, 5  # exit codes


def main() -> int:
    """Exit code: 0 when the parent has gone."""
    requests, answers = sys.stdin.buffer, private_stdout()
    try:
        return _serve(requests, answers)
    except BrokenPipeError:
        return 0


def _serve(requests: BinaryIO, answers: BinaryIO) -> int:
    from .protocol import PROTOCOL, Hello, Ready, receive, send

    hello = receive(requests)
    if hello is None:
        return 0
    send(answers, Ready(PROTOCOL))
    if not isinstance(hello, Hello) or hello.protocol != PROTOCOL:
        return FOREIGN
    sys.path[:] = hello.path
    with bounded_loading():
        from .service import Service

    sending = Lock()

    def tell(message: Message) -> None:
        with sending:
            send(answers, message)

    inbox = Inbox(requests, tell)
    service = Service(inbox.ending)
    Thread(target=inbox.listen, daemon=True).start()
    try:
        while True:
            tell(service.answer(inbox.next(), tell))
    except BrokenPipeError:
        os._exit(0)  # the parent has gone
    finally:  # by an exception
        end_by_exception(FAILED)


class Inbox:
    """Requests in the order they came, and which of them shall end: heard on a thread of its own,
    for a request is halted while the one that solves is busy."""

    def __init__(self, stream: BinaryIO, tell: Callable[[Message], None]) -> None:
        self._stream = stream
        self._tell = tell
        self._requests: SimpleQueue[Request] = SimpleQueue()
        self._endings: dict[int, Ending] = {}

    def next(self) -> Request:
        """The next request; waits for it."""
        return self._requests.get()

    def ending(self, request: int) -> Ending | None:
        """The ending asked for the request with this id; None if it may go on."""
        return self._endings.get(request)

    def listen(self) -> None:
        """Hears the parent out. Ends the process where the parent goes or talks nonsense, and where
        it cannot listen any more: the next request would be waited for, for ever."""
        try:
            self._listen()
        finally:  # by an exception; every other end of it is the process's
            end_by_exception(DEAF)

    def _listen(self) -> None:
        from .protocol import Halt, Halted, ProtocolError, Request, receive

        while True:
            try:
                message = receive(self._stream)
            except ProtocolError:
                os._exit(PROTOCOL_FAULT)
            if message is None:
                os._exit(0)  # nobody waits for what is being solved
            if isinstance(message, Halt):
                self._endings[message.id] = message.how
                self._acknowledge(Halted(message.id))
            elif isinstance(message, Request):
                self._requests.put(message)
            else:
                os._exit(PROTOCOL_FAULT)

    def _acknowledge(self, halted: Halted) -> None:
        try:
            self._tell(halted)
        except OSError:
            os._exit(0)  # the parent has gone
