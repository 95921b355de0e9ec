"""The phases and flights of the analysed clip as the artist's contacts have them, in seconds."""

from __future__ import annotations

import numpy as np

from ...solver.analysis.leaps import Leap, Stand, leaps
from ...solver.data.contacts import Phase
from ...solver.data.recording import Recording
from ..accessors import current_scene
from ..armature.poses import frames_per_second, metres_per_unit
from ..properties.settings import HangtimeSettings
from ..rows.phases import phases_of


def timed_phases(settings: HangtimeSettings, recording: Recording) -> list[Phase]:
    """On the recording's clock, which begins at its first frame."""
    return [
        Phase(span.kind, span.number, _time(span.start, recording), _time(span.end, recording))
        for span in phases_of(settings)
    ]


def leaps_of(settings: HangtimeSettings, recording: Recording, factor: float) -> list[Leap]:
    """In true lengths. factor: these over the armature's."""
    true = factor * metres_per_unit(current_scene())
    stands = (
        Stand(
            _time(row.start_frame, recording),
            _time(row.end_frame, recording),
            true * np.array(row.found_at),
            true * np.array(row.at),
        )
        for row in settings.contacts
        if row.used
    )
    phases = timed_phases(settings, recording)
    return leaps(phases, stands, recording.times, factor * recording.heads)


def _time(frame: float, recording: Recording) -> float:
    """Seconds; contacts may begin or end a little beside the recording."""
    return (frame - float(recording.frames[0])) / frames_per_second(current_scene())
