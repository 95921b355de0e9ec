"""What is said of every fault of a run: its recipe, its output, its pins together, and solves that
failed."""

from ....solver.data import faults
from ....solver.data.faults import Fault

PLACES = ("Recipe {path}", "Recipe {path}, line {line}")

# Of several, `_variant` says which.
SOLVING: dict[type[Fault], str | tuple[str, ...]] = {
    faults.BadRecipe: (
        "Recipe {path}: {problem:ended}",
        "Recipe {path}, line {line}: {problem:ended}",
    ),
    faults.BadBonePreset: (
        "Bone preset {path}: {problem:ended}",
        "Bone preset {path}, line {line}: {problem:ended}",
    ),
    faults.OutputNotWritable: "Nothing can be written to {path} ({problem}); choose another place "
    "or allow writing there.",
    faults.NotWrittenOver: "“{path}” exists already and is not written over; delete it, or choose "
    "another name.",
    faults.OutputFolderBusy: "Another adaptation or batch is writing into {path}; wait until "
    "it ends, or choose another folder with --out.",
    faults.WouldReplaceInput: "The result would be written over {path}, from which it is made; "
    "choose another folder with --out.",
    faults.ContradictoryPins: "“{first}” and “{second}” contradict each other by {metres:length}, "
    "and no pose holds both; move one of them, or move them together.",
    faults.NoSolution: (
        "{reason:outcome}{asked:asked}{damages:damages}",
        "{reason:outcome}{asked:asked}{damages:damages} Furthest off: {worst:missed}.",
        "{reason:outcome}{asked:asked}{damages:damages} The best found goes {reached:percent} of "
        "the way; furthest off: {worst:missed}.",
        "No motion was found, and the fit that it begins from is {fit_off_cm:.3g} cm off the "
        "recording (rms). Correct the contacts' frames, or mend the recording, before you ask for "
        "less.{damages:damages}",
        "No motion was found, and the fit that it begins from is {fit_off_cm:.3g} cm off the "
        "recording (rms). Correct the contacts' frames, or mend the recording, before you ask for "
        "less.{damages:damages} Furthest off: {worst:missed}.",
        "No motion was found, and the fit that it begins from is {fit_off_cm:.3g} cm off the "
        "recording (rms). Correct the contacts' frames, or mend the recording, before you ask for "
        "less.{damages:damages} The best found goes {reached:percent} of the way; furthest off: "
        "{worst:missed}.",
        "Nothing was asked for, and the recording itself goes through what is around it, deeper "
        "than can be mended: {worst:missed}. Lower or move the object, or mend these poses; or, "
        "where it stands on the object or leans on it, let a contact touch at its top (Add "
        "Contact), and it may be in it as it was.",
    ),
    faults.NoFit: (
        "The recording's own contacts cannot be held by a motion that obeys physics."
        "{damages:damages} Choose frames that begin earlier and end later, or correct the "
        "contacts' frames.",
        "The recording's own contacts cannot be held by a motion that obeys physics."
        "{damages:damages} Choose frames that begin earlier and end later, or correct the "
        "contacts' frames. Furthest off: {worst:missed}.",
        "The recording's own contacts cannot be held by a motion that obeys physics."
        "{damages:damages} Choose frames that begin earlier and end later, or correct the "
        "contacts' frames. The best found goes {reached:percent} of the way; furthest off: "
        "{worst:missed}.",
    ),
    faults.NotComputable: "What is asked for is too large or too small to compute with; give "
    "masses, gravity, lengths, times and weights as they are in the world.",
    faults.WorkerDied: "The solver stopped without an answer ({detail}), and nothing was changed; "
    "try again, and report it if it happens twice.",
    faults.PinLetGo: "The pin “{pin}” moves {contacts:names}, which cannot be held beside the "
    "recording's other contacts, so the fit let go of what it moves; correct these contacts' "
    "frames, or pin others.",
}
