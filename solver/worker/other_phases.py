"""What a problem names by phase, on a fit whose phases are others than the analysis's.

A fit that lets contacts go, or doubts a flight, joins phases; those that it has whole keep their
names. Who asked for "ground 2" saw the analysis: the same contacts and instants are meant.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

from ..analysis.pins.pinned_places import chosen_contacts, phase_of
from ..constraints.evaluation_context import touches
from ..data.contacts import Contact, ContactSchedule, Phase, PhaseKind
from ..data.faults import JoinedPhase, NothingTouches, PinLetGo, UnknownPhaseIn
from ..data.problem import MotionProblem, Pin
from ..data.recording import Recording
from ..data.requests import Lift, PhaseTiming, Requests, When


def on_phases_of(
    problem: MotionProblem, found: ContactSchedule, fitted: ContactSchedule, recording: Recording
) -> MotionProblem:
    """The problem in the phases and contacts of a fit; itself where these are those found.

    Raises PinLetGo, UnknownPhaseIn, JoinedPhase, and as `chosen_contacts` does.
    """
    same = [c.name for c in found.contacts] == [c.name for c in fitted.contacts]
    if same and found.phases == fitted.phases:
        return problem
    change = _Change(found, fitted, recording)
    return replace(
        problem,
        pins=change.pins(problem.pins),
        requests=change.requests(problem.requests),
    )


@dataclass(frozen=True)
class _Change:
    """From the schedule that the analysis found to that of the fit, on the same time."""

    found: ContactSchedule
    fitted: ContactSchedule
    recording: Recording

    def pins(self, asked: Sequence[Pin]) -> tuple[Pin, ...]:
        """Each pin on those of its contacts that are left. One that has none moves nothing, as the
        report says of its contacts, but where no other pin moves its stance either."""
        held = [(pin, self._left(pin)) for pin in asked]
        moved = {pin.phase for pin, left in held if left}
        for pin in asked:
            if pin.phase not in moved:
                raise PinLetGo(pin.name, tuple(c.name for c in self._chosen(pin)))
        return tuple(self._pin(pin, left) for pin, left in held if left)

    def _chosen(self, pin: Pin) -> list[Contact]:
        """The found contacts that a pin moves."""
        chosen = chosen_contacts(pin, phase_of(pin, self.found), self.found)
        return [self.found.contacts[i] for i in chosen]

    def _left(self, pin: Pin) -> list[Contact]:
        """Those of them that the fit has."""
        names = [contact.name for contact in self._chosen(pin)]
        return [contact for contact in self.fitted.contacts if contact.name in names]

    def _pin(self, pin: Pin, left: Sequence[Contact]) -> Pin:
        phase = self.fitted.stance(left[0])
        every = len(left) == len(self.fitted.of_phase(phase))
        all_meant = every and not pin.touching and pin.step is None
        touching = () if all_meant else tuple(c.name for c in left)
        return replace(pin, phase=phase.name, touching=touching, step=None)

    def requests(self, asked: Requests) -> Requests:
        """The requests, each in the phase or the frames that it was about."""
        lists = {f.name: getattr(asked, f.name) for f in fields(asked)}
        moved: dict[str, Any] = {
            name: tuple(self._at(request) for request in each)
            for name, each in lists.items()
            if isinstance(each, tuple)
        }
        return replace(asked, **moved)

    def _at(self, request: Any) -> Any:
        if isinstance(request, Lift):
            return self._lift(request)
        if isinstance(request, PhaseTiming):
            return replace(request, phase=self._same_phase(request))
        when = getattr(request, "when", None)
        return request if when is None else replace(request, when=self._when(when))

    def _when(self, when: When) -> When:
        phase = _named(when.phase, self.found.phases)
        if phase is None:  # throughout, by frames, or in a hold
            return when
        name = self._renamed(phase)
        if name is not None:
            return replace(when, phase=name)
        first = float(self.recording.frames[0])
        start, end = (first + t * self.recording.rate for t in (phase.start, phase.end))
        if when.frames is not None:
            start, end = max(start, when.frames[0]), min(end, when.frames[1])
        return replace(when, phase=None, frames=(start, end))

    def _lift(self, lift: Lift) -> Lift:
        """The lift of the same contacts, also where their phase is joined with others."""
        phase = _named(lift.phase, self.found.phases)
        asked = () if phase is None else self.found.of_phase(phase)
        names = [c.name for c in asked if touches(lift.touching, c)]
        if phase is not None and not names:
            raise NothingTouches(lift.name, lift.touching)
        left = [c for c in self.fitted.contacts if c.name in names]
        if phase is None or self._renamed(phase) is not None or not left:
            return replace(lift, phase=self._same_phase(lift))
        touching = tuple(c.name for c in left)
        return replace(lift, phase=self.fitted.stance(left[0]).name, touching=touching)

    def _same_phase(self, request: Lift | PhaseTiming) -> str:
        """The name in the fit of a request's phase. Raises UnknownPhaseIn, JoinedPhase."""
        phase = _named(request.phase, self.found.phases)
        if phase is None:
            raise UnknownPhaseIn(
                request.name, request.phase, tuple(p.name for p in self.found.phases)
            )
        name = self._renamed(phase)
        if name is None:
            raise JoinedPhase(request.name, request.phase, self._kept(phase.kind))
        return name

    def _kept(self, kind: PhaseKind) -> tuple[str, ...]:
        """Names of the found phases of a kind that the fit has, too."""
        alike = (p for p in self.found.phases if p.kind is kind)
        return tuple(p.name for p in alike if self._renamed(p) is not None)

    def _renamed(self, phase: Phase) -> str | None:
        """The name that a found phase has in the fit; None where it is joined or divided."""
        same = (phase.kind, phase.start, phase.end)
        return next((p.name for p in self.fitted.phases if (p.kind, p.start, p.end) == same), None)


def _named(name: str | None, phases: Sequence[Phase]) -> Phase | None:
    return next((phase for phase in phases if phase.name == name), None)
