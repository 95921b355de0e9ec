"""Commands that outlast their terminal: what cannot be shown any more ends no work."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr, redirect_stdout, suppress
from functools import wraps
from io import TextIOBase, TextIOWrapper
from typing import TextIO, cast

CUT_SHORT = 1
PIPE_CLOSED = 128 + 13  # as shells count a process that SIGPIPE has ended
_UNREAD = {errno.EPIPE, errno.EINVAL} if sys.platform == "win32" else {errno.EPIPE}

Command = Callable[[Sequence[str]], int]


class OutlastingStream(TextIOBase):
    """A text stream to which writing never fails; None: one that was closed from the start.

    lost: why the rest of what was written is not shown.
    """

    def __init__(self, stream: TextIO | None) -> None:
        self._stream = stream
        self.lost: OSError | None = None
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal that lacks a sign gets the rest
        if stream is None:
            self.lost = OSError(errno.EBADF, os.strerror(errno.EBADF))

    @property
    def encoding(self) -> str:  # type: ignore[override]  # an attribute, in the stubs
        return "utf-8" if self._stream is None else self._stream.encoding

    def isatty(self) -> bool:
        return self._stream is not None and self._stream.isatty()

    def writable(self) -> bool:
        return True

    def write(self, text: str) -> int:
        if self._stream is not None and self.lost is None:
            try:
                self._stream.write(text)
            except OSError as error:
                self._lose(self._stream, error)
        return len(text)

    def flush(self) -> None:
        if self._stream is not None and self.lost is None:
            try:
                self._stream.flush()
            except OSError as error:
                self._lose(self._stream, error)

    def close(self) -> None:
        """Not the stream, which is another's and may be closed by then."""

    def _lose(self, stream: TextIO, error: OSError) -> None:
        """What the stream still holds goes nowhere: it is flushed once more when Python ends."""
        self.lost = error
        with suppress(OSError), open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), stream.fileno())


def outlasting(command: Command) -> Command:
    """The command of a terminal, which goes on where the terminal, or what reads from it, is gone.

    It then ends as others do: as by SIGPIPE where nobody reads any more, else with a sentence and
    CUT_SHORT, unless it has a worse end of its own.
    """

    @wraps(command)
    def run(argv: Sequence[str]) -> int:
        _take_closed_numbers()
        out, err = OutlastingStream(sys.stdout), OutlastingStream(sys.stderr)
        with redirect_stdout(cast(TextIO, out)), redirect_stderr(cast(TextIO, err)):
            code = command(argv)
            out.flush()
            if out.lost is None or code:
                return code
            if out.lost.errno in _UNREAD:
                return PIPE_CLOSED
            print(
                f"Not all could be printed ({out.lost.strerror}); files that were asked for are "
                "written.",
                file=sys.stderr,
            )
            return CUT_SHORT

    return run


def _take_closed_numbers() -> None:
    """Else the next file that is opened would have the number of a standard stream that is closed,
    and be written over by what Blender prints."""
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass
    os.close(number)
