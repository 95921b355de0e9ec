"""Signals that end a process politely, by Ctrl-C or otherwise."""

import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar

_came: ContextVar[Sequence[int]] = ContextVar("_came", default=())


def raise_unheard() -> None:
    """Raises KeyboardInterrupt where a signal came whose own was lost: what is raised in what
    Blender calls back, as while it saves, it prints, and goes on."""
    if _came.get():
        raise KeyboardInterrupt


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Whoever ends the process politely, by Ctrl-C or otherwise, has it clean up:
    KeyboardInterrupt, also out of Blender's operators, which make an error of their own of it."""
    came: list[int] = []

    def interrupt(number: int, _frame: object) -> None:
        came.append(number)
        raise KeyboardInterrupt

    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    for number, handler in before.items():
        if handler is not signal.SIG_IGN:  # as of what a shell runs in the background
            signal.signal(number, interrupt)
    outer = _came.set(came)
    try:
        yield
    except Exception as error:
        if came:
            raise KeyboardInterrupt from error
        raise
    finally:
        _came.reset(outer)
        for number, handler in before.items():
            # None is one that Python did not set, as Blender's own in the background: it cannot be
            # put back from here.
            signal.signal(number, signal.SIG_DFL if handler is None else handler)
