"""What is said of every fault of a recording: the armature, its action, its keys, and what cannot
be a person's."""

from ....solver.data import faults
from ....solver.data.faults import Fault

# Of several, `_variant` says which.
RECORDINGS: dict[type[Fault], str | tuple[str, ...]] = {
    faults.NoArmature: (
        "No armature is chosen; select the armature that carries the recording.",
        "“{object_name}” is or holds no armature; choose one with a recording.",
    ),
    faults.NotInScene: "“{armature}” is not in scene “{scene}”; link it there, go to its own, "
    "or select another armature.",
    faults.NoAction: "The armature “{armature}” has no keyframes; assign it the action that holds "
    "the recording.",
    faults.UnreadStrips: "The NLA strips that “{armature}” performs cannot be read: {strips:names} "
    "{why}. Leave one strip unmuted that plays its action once (any start, any scale), or assign "
    "the action.",
    faults.StripsOff: "The nonlinear animation of “{armature}” is switched off, so that nothing in "
    "its strips ({strips:names}) plays; switch it on (Nonlinear Animation editor, the tick beside "
    "the armature's name), or assign the action.",
    faults.BlendedAction: "The action “{action}” is blended with the NLA strips below it "
    "({strips:names}), and what they make together has no keys of its own; in the Nonlinear "
    "Animation editor give the action Blending Replace and Influence 1, or mute these strips.",
    faults.NoBones: "The armature “{armature}” has no bones; choose the recorded figure's.",
    faults.LibraryMissing: "“{file}” is missing, from which “{linked}” is linked; find it (File > "
    "External Data > Find Missing Files), save this file and open it again.",
    faults.ClipTooShort: (
        "The chosen frames, {frames[0]:g} to {frames[1]:g}, are only {seconds:.2f} s of the "
        "recording, and a motion needs {minimum_s:g} s at least; choose more frames.",
        "The recording lasts only {seconds:.2f} s (frames {frames[0]:g} to {frames[1]:g}), and a "
        "motion needs {minimum_s:g} s at least; take a longer one, or mend its frame rate.",
        "The recording has only one frame ({frames[0]:g}), which is a pose and no motion; take a "
        "recording of {minimum_s:g} s at least.",
    ),
    faults.FramesFarApart: "The recording's frames lie {seconds:.3g} s apart, and a motion needs "
    "one every {maximum_s:g} s at least; set the frame rate at which it was recorded.",
    faults.FramesReversed: "The chosen frames end at {last:g}, before they begin at {first:g}; "
    "swap them.",
    faults.ZeroLengthBone: "The bone “{bone}” has no length, so it cannot carry mass; give it one "
    "in edit mode, or choose another bone for that part of the body.",
    faults.MissingPart: (
        "No bone was found for the {part}; say which bone it is, or add one in edit mode.",
        "No bone was found for the {part} (no bone “{tried[0]}” is there); say which bone it is, "
        "or add one in edit mode.",
        "No bone was found for the {part} (looked for {tried:names}); say which bone it is, or add "
        "one in edit mode.",
    ),
    faults.NotMirrored: (
        "The clip cannot be mirrored: no bone's name tells its side; name them such as “LeftFoot” "
        "and “RightFoot”.",
        "The clip cannot be mirrored: “{bone}” has no “{partner}” in the same place on the other "
        "side; give the bones of both sides the same names but for the side.",
        "The clip cannot be mirrored: “{bone}” is on one side of the body, which its name does not "
        "tell; name it such as “LeftFoot” or “foot.L”, and its partner likewise.",
    ),
    faults.MirroredInBlender: "A clip is mirrored without Blender only, whose armature would keep "
    "its own sides' lengths; take a BVH or AMC clip and the batch's outputs npz and bvh, or take "
    "“mirrored” away.",
    faults.BoneTaken: "No bone is left for the {part}, for “{bone}” was chosen for the {by}; "
    "choose another bone for one of them.",
    faults.NotJoined: "The bones {bones:names} have no common bone above them, so that legs and "
    "trunk do not hang together; parent them to one bone in edit mode, or choose others under "
    "Bones.",
    faults.NoSpine: "No bone of the spine was found: between “{pelvis}” (pelvis) and “{head}” "
    "(head) there must be one that the arms hang on; choose other bones for pelvis, head and arms "
    "under Bones, or parent the arms to a bone of the spine in edit mode.",
    faults.NonFiniteKey: "The bone “{bone}” has a value at frame {frame:g} that is no number; "
    "delete or mend that key.",
    faults.NotBetweenFrames: "Frames are said to be missing after frame {frame:g}, but the "
    "recording goes from frame {first:g} to {last:g}; name one that another comes after under "
    "“missing”.",
    faults.NothingLeft: "“trim = {trim}” and “trim_end = {trim_end}” leave nothing of the {frames} "
    "frames of the recording; leave out fewer at its beginning and end.",
    faults.NotPutIn: "Missing frames cannot be put into “{action}”: {why}.",
    faults.BadScale: "The scale of “{object_name}” is ({scale:numbers}), but it must be the same, "
    "and above zero, along all three axes; type one such number for all three (of the parent, "
    "where it has the scale), and press Examine, which tells the size. Do not apply the scale: "
    "bones' keys would stay, and joints move.",
    faults.UnreadableRepairs: "What this file holds of the recording's repairs cannot be read (a "
    "script or another version of Hangtime wrote it); press Examine, and repair anew.",
    faults.UnreadableText: (
        "What Hangtime keeps in the property “{property}” of “{owner}” cannot be read (a "
        "script, an add-on or another version wrote it), and does not count; press Examine, which "
        "writes it anew.",
        "What Hangtime keeps in the property “{property}” of “{owner}” cannot be read (a "
        "script, an add-on or another version wrote it), and does not count; press Analyze, which "
        "writes it anew.",
        "What Hangtime keeps in the property “{property}” of “{owner}” cannot be read (a "
        "script, an add-on or another version wrote it), and does not count; show the take "
        "that it was made from, and adapt that again.",
    ),
    faults.UnreadableClip: (
        "The recording {path}: {problem}; mend the file or export it again from where it came.",
        "The recording {path}, line {line}: {problem}; mend the file or export it again from where "
        "it came.",
    ),
    faults.ClipNotOpened: "The recording {path} cannot be opened ({problem}); check its name and "
    "whether it may be read.",
    faults.NotInFile: "The recording {path} has no {what} “{name}”; name one that it has: "
    "{known:names}.",
    faults.OptionNotTaken: "“{option}” does not count for {path}, as files of this kind tell it "
    "themselves or do not need it; leave it out. What they tell wrongly is set under “[recording]” "
    "in a recipe, such as “time_scale” for a wrong rate.",
    faults.UnknownClipFormat: "The recording {path} is no BVH, FBX, AMC or .blend file; import it "
    "in Blender, and give the .blend file that you save.",
    faults.UnseenSupport: (
        "From frame {first:g} to {last:g} neither foot touches the ground, yet the body does not "
        "fall, so something unseen carries it (a box, a rail, a hand); choose frames without it, "
        "or let what carries it be ground in the panel World. If nothing does, give the scene the "
        "recording's frame rate.",
        "From frame {first:g} to {last:g} neither foot touches the ground, yet the body does not "
        "fall, for hands, knees or the trunk are on it, as of who crawls, rolls or lies. No "
        "contact is known there, so something unseen carries it; where it is hands, let them touch "
        "(Add Contact, the + beside the contacts of a stance, or an [[add_contact]] in a recipe).",
        "From frame {first:g} to {last:g} neither foot touches the ground, yet the body does not "
        "fall: the feet rest {boxes[0].size[2]:length} above the floor, as on a box. Add it (Add "
        "Box Here in the panel World, or an [[object]] in a recipe), or choose frames without it.",
        "From frame {first:g} to {last:g} neither foot touches the ground, yet the body does not "
        "fall, for hands are on the ground, whose contacts are not found where they roll. Let them "
        "touch in these frames ({hands:contacts}): Let Them Touch in the panel World, or an "
        "[[add_contact]] in a recipe.",
        "The body falls as gravity has it at {rate:.5g} frames a second, but the scene has "
        "{scene_rate:.5g} (frames {first:g} to {last:g}); set the scene's frame rate to "
        "{rate:.5g}.",
        "From frame {first:g} to {last:g} neither foot touches the ground, yet the body does not "
        "fall, for capture took the left leg for the right one; exchange them back (Examine, "
        'Exchange Back; repair = ["exchanged legs"] in a recipe), or choose frames without it.',
        "From frame {first:g} to {last:g} the feet that carry the body skid to another place, as "
        "none does under load, so something unseen carries it meanwhile; correct their contacts, "
        "choose frames without it, or let what they ride on be ground in the panel World.",
        "The figure lies: another axis than Z points from its feet to its head, so the body does "
        "not fall where neither foot touches the ground; import the clip again with other axes, "
        'or turn it upright (Examine, Turn Upright; up = "…" in a recipe).',
        "From frame {first:g} to {last:g} the feet rest on the ground, but no contact holds them, "
        "so something unseen carries the body; let the feet touch. Where a chair or a table "
        "carries it this may stay so, or a Point with Pushes Back on the pelvis or the hand takes "
        "it over.",
        "From frame {first:g} to {last:g} neither foot touches the ground, yet the body does not "
        "fall: the feet rest with steep soles, as on a wall. Let them touch in these frames "
        "({walls:contacts}): Let Them Touch in the panel World, or an [[add_contact]] in a recipe; "
        "and list the wall there, or as an [[object]], which they then push off from.",
        "From frame {first:g} to {last:g} neither foot touches the ground, yet the body does not "
        "fall, for hands hold on to something above, as of who hangs. To have that carry it in the "
        "result, give each a Point with Pushes Back and Grip ({holds:held}): Hold On Here in the "
        "panel World, or a [[point]] with “environment” and “grip” in a recipe.",
        "From frame {first:g} to {last:g} neither foot touches the ground, yet the body does not "
        "fall: the feet rest {boxes[0].size[2]:length} above the floor, as on a box, and hands "
        "keep one place above the head, as of who hangs. If it stands on a box, add that (Add Box "
        "Here in the panel World, or an [[object]] in a recipe); if it hangs, give each hand a "
        "Point with Pushes Back and Grip ({holds:held}): Hold On Here there, or a [[point]] with "
        "“environment” and “grip” in a recipe.",
    ),
    faults.ScaledStrip: "The body falls as gravity has it at {rate:.5g} frames a second, but the "
    "scene has {scene_rate:.5g} (frames {first:g} to {last:g}), and the NLA strip “{strip}” plays "
    "its action at Scale {scale:.4g}; set the strip's Scale to {fitting_scale:.4g} (Nonlinear "
    "Animation editor, sidebar, Action Clip), or, where it is meant to be so, the scene's frame "
    "rate to {rate:.5g}.",
    faults.UnseenSupports: (
        "In frames {spans:spans} neither foot touches the ground, yet the body does not fall, so "
        "something unseen carries it (a box, a rail, a hand); choose frames without it, or let "
        "what carries it be ground in the panel World. If nothing does, give the scene the "
        "recording's frame rate.",
        "In frames {spans:spans} neither foot touches the ground, yet the body does not fall, for "
        "hands, knees or the trunk are on it, as of who crawls, rolls or lies. No contact is known "
        "there, so something unseen carries it; where it is hands, let them touch (Add Contact, "
        "the + beside the contacts of a stance, or an [[add_contact]] in a recipe).",
    ),
    faults.OffBalance: (
        "In frames {spans:spans} the weight is beside the feet, as of who sits or leans, so "
        "something unseen carries it in the fit. To have a chair or a wall carry it in the result, "
        "give the pelvis, or the hand that leans, a Point with Pushes Back in the frames in which "
        "it rests there.",
        "In frames {spans:spans} the weight is beside the feet, as of who sits or leans, so "
        "something unseen carries it in the fit. To have a chair, a wall or the floor carry it in "
        "the result, give the pelvis, which rests in frames {resting:spans}, or the hand that "
        "leans, a Point with Pushes Back there.",
        "In frames {spans:spans} the weight is beside the feet, for hands are on the ground, whose "
        "contacts are not found, so something unseen carries it in the fit. Let them touch "
        "({hands:contacts}): Let Them Touch in the panel World, or an [[add_contact]] in a recipe.",
        "In frames {spans:spans} the weight is beside what touches ({touching:names}), so "
        "something unseen carries it in the fit. Correct the frames in which that touches, or give "
        "what else rests on something a Point with Pushes Back.",
        "In frames {spans:spans} the weight is beside what touches ({touching:names}), for hands "
        "hold on to something above, as of who hangs, and contacts only push. Give each hand a "
        "Point with Pushes Back and Grip ({holds:held}), instead of a contact: Hold On Here in the "
        "panel World, or a [[point]] with “environment” and “grip” in a recipe.",
    ),
    faults.FitNeedsSupport: "No motion comes near the recording unless something unseen carries "
    "the body in frames {spans:spans}, which the recipe refuses; correct the frames of the "
    "contacts there, add what does carry it (a contact, or an [[object]] that is ground), choose "
    "frames without it, or leave out “unseen_support”, to have it fitted and told.",
    faults.Treadmill: "While they stand, the feet slide along the floor at a steady {speed:.1f} "
    "m/s, as on a treadmill, so no place on the ground can hold them; add that speed to the hips' "
    "motion, as the doctor's repair of drift does (Examine, or the command doctor), or choose a "
    "recording that moves over the ground.",
    faults.OddHeight: "“{armature}” is {metres:.3g} m tall, so gravity does not fit its motion; "
    "import it again at {factor:digits} times the scale, or scale its object so.",
    faults.OddScale: "“scale = {scale:g}” makes the figure {metres:.3g} m tall, which nobody is; "
    "{factor:plain} would make a person of it.",
    faults.OutsideKeys: "In the chosen frames “{armature}” has no keys (they lie from frame "
    "{first:g} to {last:g}); choose frames there.",
    faults.SourceOutsideKeys: "What is read is “{source}”, from which “{result}” was made, and it "
    "has no keys in the chosen frames (they lie from frame {first:g} to {last:g}); choose frames "
    "there, or press Start From: This Result to read the result that is shown.",
    faults.UnknownContactName: "There is no contact “{name}” in these frames; there are "
    "{known:names}.",
}
