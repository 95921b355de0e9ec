"""A batch on the workers of a Dask scheduler.

Each cell is a task for a worker that is named. So the run itself decides what goes where: to
workers that share the batch's folder by that folder, to others as bytes through the scheduler; what
was lost with a worker goes to another, and what is slow to an idle one as well. Whatever ends is in
the batch's folder at once, so that a run which is killed has lost nothing.
"""

from __future__ import annotations

import hashlib
import operator
import pickle
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from distributed import Client, Future, wait

from ..cells.work import InputChanged
from ..planning.blender_need import needs_blender
from ..queue.attempts import Attempt, Attempts, pair_of
from ..records.failure import write_failure
from ..records.faults import FolderGone, WrongPlan, gone
from ..records.manifest import CellPlan, Manifest, read_manifest
from ..records.result import FITS, CellResult, State, lasting_result
from .connection import FarmGone, connected
from .crew import Crew
from .late import await_results
from .parcel import deliver_cell, deliver_fits, fits_by_clip, parcel_of
from .worker_side import (
    Delivery,
    NotShared,
    Reach,
    look_around,
    own_build,
    solve_away,
    solve_in,
    tidy,
)

Tell = Callable[[str], None]
MOST_TRIES = 4  # of a cell that fails, or whose worker ends meanwhile
PATIENCE = 0.5  # s between looks at the workers
MOST_SENT = 64  # files that workers keep for later cells, the latest of them
FETCHING = 15.0  # s that a cell's files may take on their way; a lost worker's never come


def run_on_dask(
    folder: Path,
    address: str,
    tell: Tell,
    ended: Callable[[CellResult], None] = lambda _: None,
    *,
    share: bool = True,
) -> None:
    """Run all cells of a planned batch that have no result on a scheduler's workers.

    address: of the scheduler, or a scheduler file. tell: takes sentences on workers. ended: takes
    every result. share: let workers that see the folder use it.
    Raises BatchFault: FarmGone, FolderGone, WrongManifest, WrongPlan; what has ended is kept.
    """
    manifest = read_manifest(folder)
    outputs = manifest.settings.outputs
    if any(needs_blender(plan.clip, outputs) for plan in manifest.cells):
        raise WrongPlan(
            "Dask's workers have no Blender, which FBX files and outputs like pictures need; take "
            "BVH or AMC clips and the outputs npz and bvh, or run the batch here or by Flamenco."
        )
    tidy(str(folder))
    plans = [plan for plan in manifest.cells if lasting_result(folder, plan.cell) is None]
    if not plans:
        return
    with connected(address) as client:
        try:
            with token_in(folder) as token:
                Dispatch(client, folder, manifest, token, share, tell, ended).run(plans)
        except (TimeoutError, OSError) as error:
            raise FarmGone(
                f"The scheduler at {address} is gone ({error or type(error).__name__}). What has "
                "ended is kept: start it again, and give the same command."
            ) from error


@contextmanager
def token_in(folder: Path) -> Iterator[str]:
    """The name of a file in the batch's folder, by which workers know it. Raises FolderGone."""
    path = folder / f".farm-{uuid.uuid4().hex}"
    try:
        path.touch()
    except OSError as error:
        raise gone(folder, error) from error
    try:
        yield path.name
    finally:
        with suppress(OSError):
            path.unlink()


@dataclass
class Dispatch:
    """One run. bytes_sent: what workers away from the folder share, by its SHA-256."""

    client: Client
    folder: Path
    manifest: Manifest
    token: str
    share: bool
    tell: Tell
    ended: Callable[[CellResult], None]
    crew: Crew = field(default_factory=lambda: Crew(own_build(), {}, set()))
    futures: dict[Future, Attempt] = field(default_factory=dict)
    bytes_sent: dict[str, Future] = field(default_factory=dict)
    idle_told: bool = False

    def run(self, plans: list[CellPlan]) -> None:
        """Until each has a result. Raises BatchFault, and OSError where the scheduler is gone."""
        self.fits = fits_by_clip(self.folder)
        ended = {plan.cell for plan in self.manifest.cells} - {plan.cell for plan in plans}
        fitted = {pair_of(plan) for plan in self.manifest.cells if plan.cell in ended}
        self.attempts = Attempts(MOST_TRIES, fitted=fitted).add(plans)
        while not self.attempts.over:
            threads = self._meet_workers()
            now = time.monotonic()
            for worker in self.crew.reach:
                while self.attempts.load(worker) < threads[worker]:
                    attempt = self.attempts.next_for(worker, now, self.crew.reach)
                    if attempt is None:
                        break
                    self._begin(attempt)
            self._take()
        await_results(self.folder, (plan.cell for plan in plans), self.tell)
        tidy(str(self.folder))
        sharing = [worker for worker, reach in self.crew.reach.items() if reach is Reach.SHARED]
        self.client.run(tidy, self._shared_folder(), workers=sharing, on_error="ignore")

    # ------------------------------------------------------------ workers

    def _meet_workers(self) -> dict[str, int]:
        """Forget workers that are gone, ask new ones who they are; threads of each."""
        threads: dict[str, int] = self.client.nthreads()
        for address in sorted(self.crew.gone(threads)):
            self.tell(f"Worker {address} is gone; its cells go to others.")
            self._lose(address)
        strangers = self.crew.strangers(threads)
        if strangers:
            answers = self.client.run(
                *(look_around, self._shared_folder(), self.token),
                workers=strangers,
                on_error="return",
            )
            for words in self.crew.admit(answers):
                self.tell(words)
        if not self.crew.reach and not self.idle_told:
            self.tell("No worker can be used yet; the batch waits for one.")
        self.idle_told = not self.crew.reach
        return threads

    def _shared_folder(self) -> str:
        """The batch's folder, if workers may use it."""
        return str(self.folder.resolve()) if self.share else ""

    def _lose(self, address: str) -> None:
        for future, attempt in list(self.futures.items()):
            if attempt.worker == address:
                future.cancel()
                self._retry(future, "its worker ended meanwhile, as for want of memory")

    # ------------------------------------------------------------ cells

    def _begin(self, attempt: Attempt) -> None:
        cell = attempt.plan.cell
        try:
            parcel = parcel_of(attempt.plan)
        except InputChanged as changed:  # this cell's fault, and no other's
            if self.attempts.end(attempt, attempt.began):
                self.ended(write_failure(self.folder, cell, str(changed)))
            return
        if self.crew.reach[attempt.worker] is Reach.SHARED:
            paths = [str(path) for path in parcel.files.values()]
            solve = partial(solve_in, str(self.folder.resolve()), cell, paths)
            sent: list[dict[str, Future]] = []
        else:
            files = {name: self._sent(path) for name, path in parcel.files.items()}
            fits = {name: self._sent(path) for name, path in self._fits(attempt.plan)}
            solve = partial(solve_away, self.token, self.manifest.settings, parcel.plan)
            sent = [files, fits]
        self.futures[self._submitted(attempt, solve, sent)] = attempt

    def _submitted(
        self, attempt: Attempt, solve: Callable[..., Delivery], sent: list[dict[str, Future]]
    ) -> Future:
        """The cell as a task of its worker. A scheduler opens what it is given and may have no
        Hangtime: it gets bytes, and functions of Python's own."""
        name, where = f"{attempt.plan.cell}-{uuid.uuid4().hex}", [attempt.worker]
        packed = pickle.dumps(solve)
        opened = self.client.submit(pickle.loads, packed, key=f"solve-{name}", workers=where)
        return self.client.submit(operator.call, opened, *sent, key=f"cell-{name}", workers=where)

    def _fits(self, plan: CellPlan) -> Iterator[tuple[str, Path]]:
        """Files of the fits of a cell's clip that are in the batch's folder."""
        for fit in sorted(self.fits.get(plan.clip_sha256, ())):
            for path in (self.folder / FITS / fit).glob("*"):
                yield f"{fit}/{path.name}", path

    def _sent(self, path: Path) -> Future:
        """A file's bytes as a task, which the scheduler does again where a worker took them along:
        `bytes`, that workers without Hangtime may do it too. Raises FolderGone."""
        try:
            content = path.read_bytes()
        except OSError as error:
            raise gone(path, error) from error
        digest = hashlib.sha256(content).hexdigest()
        sent = self.bytes_sent.pop(digest, None)
        sent = sent or self.client.submit(bytes, content, key=f"bytes-{digest}")
        self.bytes_sent[digest] = sent
        if len(self.bytes_sent) > MOST_SENT:  # the oldest goes; who still needs it holds it
            del self.bytes_sent[next(iter(self.bytes_sent))]
        return sent

    def _take(self) -> None:
        """Wait for what ends next, but not for long, and take in all that has."""
        if not self.futures:
            time.sleep(PATIENCE)
            return
        with suppress(TimeoutError):
            wait(list(self.futures), timeout=PATIENCE, return_when="FIRST_COMPLETED")
        for future in [each for each in self.futures if each.done()]:
            attempt = self.futures[future]
            if future.status == "cancelled":
                self._retry(future, "the scheduler dropped it", blame=False)
                continue
            fault = future.exception() if future.status == "error" else None
            if fault is None:
                with suppress(TimeoutError):  # its worker ended before it was fetched: see _lose
                    delivery = future.result(timeout=FETCHING)
                    self._take_in(self.futures.pop(future), delivery)
            elif isinstance(fault, NotShared) and not Path(fault.path).is_file():
                self._retry(future, str(fault), blame=False)  # nor is it here: see _begin
            elif isinstance(fault, NotShared | FolderGone):
                where = f"Worker {attempt.worker} does not share the batch's folder"
                self.tell(f"{where} ({fault}); its results come through the scheduler.")
                self.crew.reach[attempt.worker] = Reach.NONE
                self._retry(future, str(fault))
            else:
                self._retry(future, f"{type(fault).__name__}: {fault}")

    def _take_in(self, attempt: Attempt, delivery: Delivery) -> None:
        result = delivery.result
        if result.state is State.FAILED:
            if not self.attempts.again(attempt):
                self.ended(self._delivered(delivery))
            return
        clip = attempt.plan.clip_sha256
        deliver_fits(self.folder, delivery.fits, clip)
        self.fits.setdefault(clip, set()).update(name.partition("/")[0] for name in delivery.fits)
        result = self._delivered(delivery)
        if self.attempts.end(attempt, time.monotonic()):
            self.ended(result)

    def _delivered(self, delivery: Delivery) -> CellResult:
        """The cell's result, now in the batch's folder."""
        if delivery.files:
            deliver_cell(self.folder, delivery.result.cell, delivery.files)
        return delivery.result

    def _retry(self, future: Future, why: str, *, blame: bool = True) -> None:
        """Let a cell wait anew that came to nothing; it fails where that was so too often."""
        attempt = self.futures.pop(future)
        if not self.attempts.again(attempt, blame=blame):
            sentence = f"No worker brought a result in {MOST_TRIES} tries; the last: {why}."
            self.ended(write_failure(self.folder, attempt.plan.cell, sentence))
