"""What is said of what is another than it was analysed, or changed while it was solved."""

from ....solver.data import faults
from ....solver.data.faults import Fault

# Of several, `_variant` says which.
CHANGES: dict[type[Fault], str | tuple[str, ...]] = {
    faults.RateChanged: (
        "Nothing was done, because the scene's frame rate changed from {before:.5g} to {now:.5g} "
        "frames a second since the analysis, and the recording plays at another speed; set it back "
        "to {before:.5g} (Output > Format > Frame Rate), or press Analyze again.",
        "The result was thrown away, because the scene's frame rate changed from {before:.5g} to "
        "{now:.5g} frames a second while it was solved; set it back to {before:.5g} (Output > "
        "Format > Frame Rate) and try again, or press Analyze.",
    ),
    faults.TimeStretched: "The scene shows the keys of frame {old} at its frame {new} (Output > "
    "Frame Range > Time Stretching), so neither their frames nor their speeds are those that are "
    "seen; make Old and New the same while you adapt and export.",
    faults.LostEdits: "What you changed about {contacts:names} is gone, for an analysis finds no "
    "such contact any more; look through the contacts, and move them again.",
    faults.SpanChanged: "Nothing was done, because frames {now[0]:g} to {now[1]:g} are to be "
    "adapted now, but {before[0]:g} to {before[1]:g} were analysed; press Analyze again, or choose "
    "those frames again (Frame Range, in the panel Recording).",
    faults.ChangedMeanwhile: (
        "Nothing was done, because the armature “{armature}”, its bones, place, constraints or "
        "what they follow, keys, repairs, frame range or Loop, or the scene's frame rate or unit "
        "scale changed since the analysis; press Analyze again.",
        "The result was thrown away, because the armature “{armature}”, its bones, place, "
        "constraints or what they follow, keys or repairs, or the scene's unit scale changed since "
        "the analysis; press Analyze again.",
        "Nothing was done, because the armature “{armature}” changed since the analysis "
        "({changed:names}); press Analyze again.",
        "The result was thrown away, because the armature “{armature}” changed while it was solved "
        "({changed:names}); press Analyze again.",
    ),
    faults.ArmatureGone: "The result was thrown away, because the armature “{armature}” was "
    "removed while it was solved; undo that, and try again.",
    faults.EditedMeanwhile: "The result was thrown away, because the armature “{armature}” was in "
    "edit mode when it was to be written; leave edit mode, and try again.",
    faults.UndoneMeanwhile: "The work was stopped, because something was undone or redone "
    "meanwhile, and nothing of it is left; try again.",
    faults.ActionGone: "The result was thrown away, because the action “{action}” was removed "
    "while it was written, as File > Clean Up > Purge does; undo that if it was the recording's, "
    "and try again.",
    faults.ChangedWhileRead: "Nothing was done, because the armature “{armature}” changed while it "
    "was read ({changed:names}); try again, in object or pose mode.",
}
