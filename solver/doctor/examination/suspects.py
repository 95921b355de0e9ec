"""What is wrong with a recording whose fit failed: it may be the cause."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ...data.faults import Damage, Fault
from ...data.recording import Recording
from ...data.scene import SceneObject
from ..finding import Finding
from ..repairs import Repairs
from .diagnose import diagnose


def damages_of(
    recording: Recording, chosen: Mapping[str, str], scene: Sequence[SceneObject]
) -> tuple[Damage, ...]:
    """All that the doctor finds but notes; none where it cannot look, which then is no cause.
    chosen: bones by parts of the body, as in a problem. scene: what it may stand on."""
    try:
        found = diagnose(recording, chosen, scene=scene).findings
    except Fault:
        return ()
    return tuple(_damage(each) for each in found if not each.kind.note)


def _damage(finding: Finding) -> Damage:
    remedy = finding.remedy or Repairs()
    about = finding.frames, finding.part, finding.end, remedy.mend, remedy.time_scale
    return Damage(finding.kind.value, finding.amount, finding.unit, *about)
