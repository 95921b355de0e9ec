"""The workers of a scheduler: which of them may solve cells, and why others may not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from .worker_side import Build, Reach, WorkerState


@dataclass(frozen=True)
class Judgement:
    """Whether a worker may solve cells. words: what its user should know; empty if nothing."""

    usable: bool
    words: str = ""


def judge(address: str, answer: WorkerState | Exception, own: Build) -> Judgement:
    """What a worker's answer means. own: the build that planned the batch."""
    if isinstance(answer, ImportError):
        why = f"it cannot load Hangtime ({answer}); install the wheel there and start it again"
        return Judgement(False, f"Worker {address} is left out: {why}.")
    if isinstance(answer, Exception):
        return Judgement(False, f"Worker {address} is left out: it does not answer ({answer}).")
    where = f"Worker {address} on {answer.host}"
    if why := other_build(answer.build, own):
        return Judgement(False, f"{where} is left out: {why}.")
    if not answer.one_thread:
        why = "its linear algebra takes several threads, which end in other last digits"
        how = "start it by `dask worker` with its nanny, or with OMP_NUM_THREADS=1"
        return Judgement(False, f"{where} is left out: {why}; {how} and OPENBLAS_NUM_THREADS=1.")
    if answer.reach is Reach.READ_ONLY:
        told = "may not write into the batch's folder; its results come through the scheduler"
        return Judgement(True, f"{where} {told}.")
    return Judgement(True)


def other_build(its: Build, own: Build) -> str:
    """Why results of the two may differ; empty where they may not."""
    if its.version != own.version:
        return (
            f"it has Hangtime {its.version} and this is {own.version}; install the wheel of "
            f"{own.version} there and start it again"
        )
    both = its.code.keys() & own.code.keys()
    if changed := sorted(name for name in both if its.code[name] != own.code[name]):
        return (
            f"its Hangtime {its.version} is another build ({_some(changed)} differ); install the "
            "same wheel there and start it again"
        )
    for name, number in own.libraries.items():
        if its.libraries.get(name) != number:
            return (
                f"it has {name} {its.libraries.get(name)} and this is {number}, which may end in "
                f"other last digits; install {name} {number} there and start it again"
            )
    return ""


def _some(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{names[0]} and {len(names) - 1} more"


@dataclass
class Crew:
    """Workers by address, as far as they were asked. reach: of those that may solve cells."""

    own: Build
    reach: dict[str, Reach]
    refused: set[str]

    def gone(self, present: Iterable[str]) -> set[str]:
        """Workers that may solve cells no more, as they are not there; they are forgotten."""
        lost = self.reach.keys() - set(present)
        for address in lost:
            del self.reach[address]
        self.refused &= set(present)
        return lost

    def strangers(self, present: Iterable[str]) -> list[str]:
        """Workers that were not asked yet."""
        return sorted(set(present) - self.reach.keys() - self.refused)

    def admit(self, answers: Mapping[str, WorkerState | Exception]) -> list[str]:
        """Take in who may solve cells; what there is to tell."""
        told = []
        for address, answer in answers.items():
            verdict = judge(address, answer, self.own)
            if verdict.usable and isinstance(answer, WorkerState):
                self.reach[address] = answer.reach
            else:
                self.refused.add(address)
            told.append(verdict.words)
        return [words for words in told if words]
