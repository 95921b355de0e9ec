"""What is said of every fault of a motion that shall repeat."""

from ....solver.data import faults
from ....solver.data.faults import Fault

# Of several, `_variant` says which.
LOOPS: dict[type[Fault], str | tuple[str, ...]] = {
    faults.NothingRecurs: "Nothing repeats from frame {first:g} to {last:g}: no heel or toe lands "
    "or leaves, and does so again that many frames later. Choose frames from one landing of a foot "
    "to its next.",
    faults.EndsTouchOtherwise: "The motion repeats after {period:g} frames, but near frames "
    "{first:g} and {last:g} nowhere with the same points on the ground at both ends (at the first: "
    "{at_first:names}; at the last: {at_last:names}). Choose frames that begin elsewhere, with "
    "keys for a whole cycle.",
    faults.CycleTurns: "From the cycle's first to its last frame the body turns by {degrees:.0f}°, "
    "and only a straight cycle can repeat; choose frames in which it goes straight.",
    faults.CycleClimbs: (
        "The body is {metres:.2f} m higher at the cycle's end than at its start, and only a cycle "
        "on level ground can repeat; choose frames on one level.",
        "The body is {down:.2f} m lower at the cycle's end than at its start, and only a cycle on "
        "level ground can repeat; choose frames on one level.",
    ),
    faults.NotInLoop: "A loop cannot have {what}; take that away, or switch the loop off.",
    faults.SeamStanceMoved: "The pin moves “{name}”, which the loop's seam cuts in two, so the two "
    "parts would not meet; move all of that stance, or begin the loop where that foot is in the "
    "air.",
    faults.NoRootBone: "“{armature}” has no bone above the pelvis “{pelvis}” that could carry root "
    "motion; choose In Place or Hips, or parent the pelvis to a root bone.",
}
