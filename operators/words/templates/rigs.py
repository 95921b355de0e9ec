"""What is said of every fault of a rig that poses bones whatever keys they have."""

from ....solver.data import faults
from ....solver.data.faults import Fault

MORE_NAMES = "{} and {} more"

RIGS: dict[type[Fault], str | tuple[str, ...]] = {
    faults.PosedByOthers: "The armature “{armature}” has no keyframes: constraints pose it after "
    "{others:names}; bake it (Pose > Animation > Bake Action, with Visual Keying and Clear "
    "Constraints).",
    faults.NoControls: "The bones {bones:few} follow constraints, and no bone that you can pose "
    "turns them by itself, so a result could not be written; bake them (pose mode, Pose > "
    "Animation > Bake Action, Visual Keying) and mute the constraints, or choose other bones "
    "under Bones.",
    faults.PulledFromOutside: "Constraints ({constraints:names}) pull {bones:few} towards "
    "{targets:names}, and no bone of the armature moves that, so a result could not be written; "
    "bake the action with Visual Keying (Object > Animation > Bake Action), then mute the "
    "constraints.",
    faults.DrivenBones: "Drivers pose the bones {bones:few} whatever keys they have, so a result "
    "could not be written; bake the action and delete these drivers, or choose other bones under "
    "Bones.",
    faults.HeldBones: "Constraints pose the bones {bones:few} otherwise than their keys say "
    "(frame {frame:g}), so a result could not be written; bake the action and mute these "
    "constraints.",
    faults.RenamedBones: (
        "“{action}” has no keys for {unkeyed:few}, but for {bones:few}, which the armature does "
        "not have: bones were renamed while the action was not shown, or in another armature that "
        "shares it; give them the names that the keys have, or delete these keys if they are a "
        "deleted bone's or another armature's (Dope Sheet, Only Show Errors).",
        "“{action}” has no keys for {unkeyed:few}, but for {bones:few}, which the armature does "
        "not have: bones were renamed while the action was not shown, or in another armature that "
        "shares it; press Rename Keys, and Analyze again, or delete these keys if they are a "
        "deleted bone's or another armature's (Dope Sheet, Only Show Errors).",
    ),
    faults.DeadKeys: "“{action}” has keys for {bones:few}, which the armature does not have; if "
    "one was renamed while the action was not shown, or in another armature that shares it, give "
    "it that name again.",
}
