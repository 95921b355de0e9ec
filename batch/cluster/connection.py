"""The connection to a Dask scheduler, which leaves nothing behind."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import Any

from distributed import Client
from tornado.ioloop import IOLoop

from ..records.faults import BatchFault

ANSWERING = 10.0  # s that a scheduler may take
ENDING = 10.0  # s that what is under way on the loop may take once it is called off


class FarmGone(BatchFault):
    """A scheduler that is reached no more."""


class NoFarm(FarmGone):
    """An address at which no scheduler answers."""

    exit_code = 2


class _OwnClient(Client):  # type: ignore[misc]  # Dask has no types
    """Closed where it does not connect. Dask leaves a client half-made then, which the garbage
    collector closes: at any time, in any thread, and waiting for locks of Dask's."""

    def start(self, **kwargs: Any) -> None:
        try:
            super().start(**kwargs)
        except BaseException:
            self.close()
            raise


@contextmanager
def connected(address: str) -> Iterator[Client]:
    """A client of the scheduler at an address, or of a scheduler file. Raises NoFarm."""
    file = Path(address)
    with event_loop() as loop:
        try:
            if "://" not in address and file.is_file():
                client = _OwnClient(scheduler_file=str(file), timeout=ANSWERING, loop=loop)
            else:
                client = _OwnClient(address, timeout=ANSWERING, loop=loop)
        except (OSError, TimeoutError, ValueError) as error:
            raise NoFarm(
                f"No scheduler answers at {address} ({error or type(error).__name__}); check the "
                "address, such as tcp://host:8786, or the scheduler file, and that it runs."
            ) from error
        with client:
            yield client


@contextmanager
def event_loop() -> Iterator[IOLoop]:
    """An event loop that runs in a thread of its own as long as the block.

    Dask would start one itself, but under a lock and for 10 s at most: on a machine that stands
    still for so long, or where the new thread waits for that lock, it ends in an AssertionError.
    """
    ready: Future[tuple[IOLoop, asyncio.Event]] = Future()

    async def serve() -> None:
        over = asyncio.Event()
        ready.set_result((IOLoop.current(), over))
        await over.wait()

    thread = Thread(target=lambda: asyncio.run(serve()), name="Dask client", daemon=True)
    thread.start()
    loop, over = ready.result()
    try:
        yield loop
    finally:
        loop.add_callback(over.set)
        thread.join(ENDING)
