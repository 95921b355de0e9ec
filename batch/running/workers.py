"""The parent's side of a worker process."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from tempfile import TemporaryDirectory
from threading import Thread
from typing import Any

from ...solver.kept_memory import KEPT_MEMORY
from ...solver.one_thread import ONE_CORE
from ..records.faults import BatchFault

PROGRAM = Path(__file__).parents[2] / "solver" / "worker" / "program.py"
MODULE = "batch.running.worker"  # what it runs
TEMPORARY = ("TMPDIR", "TEMP", "TMP")  # by which systems tell where temporary files go
_KEPT_LINES = 20
_LAST_WORDS_S = 2.0

Message = dict[str, Any]


def worker_command(*, blender: bool) -> list[str]:
    """How a worker is started. blender: whether it needs Blender's module."""
    bpy = sys.modules.get("bpy")
    binary = bpy.app.binary_path if blender and bpy is not None else ""
    if binary:
        flags = ["--background", "--factory-startup", "--python-exit-code", "1", "--python"]
        return [binary, *flags, str(PROGRAM), "--", MODULE]
    return [sys.executable, "-I", str(PROGRAM), MODULE]


class WorkerProcess:
    """One run of the worker program. What it says arrives in `news` as (self, message), None at its
    end.

    rss: bytes that it held when last heard.
    """

    def __init__(
        self,
        command: Sequence[str],
        folder: Path,
        news: SimpleQueue[tuple[WorkerProcess, Message | None]],
    ) -> None:
        try:
            # it is killed in the end, and Blender's folder for temporary files would stay
            self._scratch = TemporaryDirectory(prefix="hangtime_", ignore_cleanup_errors=True)
        except OSError as error:
            raise BatchFault(
                f"There is no room for temporary files ({error.strerror}); name a folder that has "
                "some by TMPDIR."
            ) from error
        try:
            self._popen = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env={
                    **os.environ,
                    **ONE_CORE,
                    **KEPT_MEMORY,
                    **dict.fromkeys(TEMPORARY, self._scratch.name),
                },
                start_new_session=True,  # an interrupt is the parent's, who then ends it
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except OSError as error:
            self._scratch.cleanup()
            raise BatchFault(f"{command[0]} cannot be started ({error.strerror}).") from error
        self.ready = False
        self.rss = 0
        self._news = news
        self._last_lines: deque[str] = deque(maxlen=_KEPT_LINES)
        self._listeners = [Thread(target=t, daemon=True) for t in (self._hear, self._keep_errors)]
        for listener in self._listeners:
            listener.start()
        self._say({"path": [p for p in sys.path if p], "folder": str(folder)})

    @property
    def pid(self) -> int:
        return self._popen.pid

    def solve(self, cell: str) -> None:
        """Names it the next cell."""
        self._say(cell)

    def end(self) -> str:
        """Ends it; how it ended, in words."""
        self._popen.kill()
        code = self._popen.wait()
        for listener in self._listeners:
            listener.join(_LAST_WORDS_S)
        for pipe in (self._popen.stdin, self._popen.stdout, self._popen.stderr):
            assert pipe is not None
            with suppress(OSError):
                pipe.close()
        self._scratch.cleanup()
        said = [line for line in self._last_lines if line]
        how = f"by signal {-code}" if code < 0 else f"with code {code}"
        return f"{how}; {said[-1]}" if said else how

    def how_it_ended(self) -> str:
        """After its last news."""
        with suppress(subprocess.TimeoutExpired):
            self._popen.wait(_LAST_WORDS_S)
        return self.end()

    def _say(self, message: object) -> None:
        assert self._popen.stdin is not None
        with suppress(OSError):  # one that has gone tells so by its end
            self._popen.stdin.write(json.dumps(message).encode() + b"\n")
            self._popen.stdin.flush()

    def _hear(self) -> None:
        assert self._popen.stdout is not None
        for line in self._popen.stdout:
            if line.startswith(b"{"):  # Blender greets before the worker's program runs
                self._news.put((self, json.loads(line)))
        self._news.put((self, None))

    def _keep_errors(self) -> None:
        assert self._popen.stderr is not None
        for line in self._popen.stderr:
            self._last_lines.append(line.decode(errors="replace").strip())
