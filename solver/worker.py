"""The worker process: solves what its parent asks until the parent closes the pipe.

Run as a program (`python -I worker.py`); bridge/worker.py starts it and holds the other end.
"""

import importlib
import importlib.util
import os
import sys
from pathlib import Path
from typing import BinaryIO

NAME = "hangtime"
FOREIGN, PROTOCOL_FAULT = 3, 4  # exit codes


def main() -> int:
    """Exit code: 0 when the parent has gone."""
    requests, answers = sys.stdin.buffer, _private_stdout()
    try:
        return _serve(requests, answers)
    except BrokenPipeError:
        return 0


def _serve(requests: BinaryIO, answers: BinaryIO) -> int:
    from .messages import PROTOCOL, Hello, Progress, Ready, Request, receive, send

    hello = receive(requests)
    if hello is None:
        return 0
    send(answers, Ready(PROTOCOL))
    if not isinstance(hello, Hello) or hello.protocol != PROTOCOL:
        return FOREIGN
    sys.path[:] = hello.path
    from .service import Service

    def tell(progress: Progress) -> None:
        send(answers, progress)

    service = Service()
    while (request := receive(requests)) is not None:
        if not isinstance(request, Request):
            return PROTOCOL_FAULT
        send(answers, service.answer(request, tell))
    return 0


def _private_stdout() -> BinaryIO:
    """The pipe to the parent; whatever a library prints goes to the error stream instead."""
    private = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return private


def _load_package() -> None:
    """Makes the folder above importable as a package, whatever it is called."""
    root = Path(__file__).resolve().parents[1]
    spec = importlib.util.spec_from_file_location(
        NAME, root / "__init__.py", submodule_search_locations=[str(root)]
    )
    assert spec is not None
    assert spec.loader is not None
    package = importlib.util.module_from_spec(spec)
    sys.modules[NAME] = package
    spec.loader.exec_module(package)


if __name__ == "__main__":
    _load_package()
    sys.exit(importlib.import_module(f"{NAME}.solver.worker").main())
