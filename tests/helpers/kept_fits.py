"""Fits that several jobs of a test module share, as requests to one worker do."""

from dataclasses import replace

from hangtime.solver.data.recording import digest
from hangtime.solver.data.requests import Requests
from hangtime.solver.fitting.fit import Fit
from hangtime.solver.worker.pipeline import FITTING, Subject, fit_subject
from hangtime.solver.worker.stage_clock import StageClock


class KeptFits:
    """In place of `fit_subject`: fits what is new, and remembers it by what the fit depends on."""

    def __init__(self) -> None:
        self._fits: dict[tuple[str, str], Fit] = {}

    def __call__(self, subject: Subject, clock: StageClock) -> Fit:
        asked = replace(subject.problem, pins=(), requests=Requests(), scene=())
        key = digest(subject.recording), repr((asked, subject.analysis.schedule))
        if key not in self._fits:
            self._fits[key] = fit_subject(subject, clock)
            return self._fits[key]
        with clock.stage(FITTING):
            return self._fits[key]
