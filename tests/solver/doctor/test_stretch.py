"""Of a recording that is cut, the part that is worth keeping, and what belongs to a part."""

from math import inf

from hangtime.solver.doctor.finding import Finding, FindingKind
from hangtime.solver.doctor.stretch import belonging

CUTS = (
    Finding(FindingKind.LEAP, 5.0, "g", ((8.0, 13.0), (80.0, 82.0))),
    Finding(FindingKind.JUMP, 5.0, "cm", ((40.0, 41.0),)),
)


def test_frames_beyond_a_cut_do_not_belong() -> None:
    assert belonging((20.0, 35.0), CUTS) == (14.0, 40.0)
    assert belonging((41.0, 79.0), CUTS) == (41.0, 79.0)
    assert belonging((14.0, 60.0), CUTS) == (14.0, 79.0)  # a cut within is kept as it is asked for
    assert belonging((90.0, 95.0), CUTS) == (83.0, inf)
    assert belonging((90.0, 95.0), ()) == (-inf, inf)
