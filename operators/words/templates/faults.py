"""What is said of every fault but a rig's and of changes meanwhile."""

from ....solver.data import faults
from ....solver.data.faults import Fault

# Of several, `_variant` says which.
FAULTS: dict[type[Fault], str | tuple[str, ...]] = {
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
    faults.AimedBone: "“{request}” is about the bone “{bone}”, which the result leaves to the "
    "constraints or drivers that aim neck or head; mute what aims neck and head (or bake the "
    "action and delete that) and press Analyze again, or switch “{request}” off.",
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
        "touch in these frames ({hands:contacts}): Add Contact, the + beside the contacts of a "
        "stance, or an [[add_contact]] in a recipe.",
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
        "({hands:contacts}): Add Contact, the + beside the contacts of a stance, or an "
        "[[add_contact]] in a recipe.",
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
    faults.UnknownBone: "“{request}” names the bone “{bone}”, which the armature does not have; "
    "choose one of its bones.",
    faults.NotAboveZero: "“{request}” asks for a mass or a factor of {amount:g}; give it one above "
    "zero.",
    faults.NotComputable: "What is asked for is too large or too small to compute with; give "
    "masses, gravity, lengths, times and weights as they are in the world.",
    faults.BeyondReason: "“{request}” asks for a factor of {amount:g}; give it one of at most "
    "{most:g}.",
    faults.UnknownPhaseIn: "“{request}” is about the phase “{phase}”, which the clip does not "
    "have; choose one of {known:names}.",
    faults.JoinedPhase: (
        "“{request}” is about the phase “{phase}”, in which something unseen carries the body, so "
        "that it is no phase by itself; choose frames in which what carries the body is recorded.",
        "“{request}” is about the phase “{phase}”, in which something unseen carries the body, so "
        "that it is no phase by itself; choose {kept:names}, or frames in which what carries the "
        "body is recorded.",
    ),
    faults.StillBone: "“{request}” names the bone “{bone}”, which is none of those that physics "
    "moves; choose one, such as {likeliest:names}.",
    faults.BadTiming: (
        "“{request}” would last {seconds:.3f} s; change its frames, phase or duration.",
        "“{request}” would end before it begins; change its frames, phase or duration.",
    ),
    faults.BesideFrames: "“{request}” is about frame {at:g}, but the adapted frames are {first:g} "
    "to {last:g}; choose frames among these.",
    faults.BesidePhase: "“{request}” is about frames {first:g} to {last:g}, which lie outside "
    "{phase}; choose frames in it, or state only one of the two.",
    faults.NoSuchPoseFrame: "“{request}” takes its pose from frame {frame:g}, but the adapted "
    "frames are {first:g} to {last:g}; choose a pose frame among these.",
    faults.RootHasNoJoint: "“{request}” limits the joint of “{bone}”, but that is the root, which "
    "has no joint; choose a bone that hangs on another.",
    faults.NeedsTorques: "“{request}” is about torques, but the reduced dynamics have none; choose "
    '"automatic" or "standard" dynamics.',
    faults.NothingTouches: (
        "“{request}” is about all that touches, but nothing touches then; choose a phase or frames "
        "in which the analysis lists a contact.",
        "“{request}” is about {touching:names}, which does not touch then; name contacts, points "
        "or bones that the analysis lists.",
    ),
    faults.WrongAngle: "“{request}” names an angle that the joint of “{bone}” does not have; "
    "name one of its {count}, counted from 0.",
    faults.FreePoint: "“{request}” is pushed by the world but held in no direction; hold it in one "
    "at least, or let it be no part of the environment.",
    faults.TakenName: "“{request}” is called like a contact that was found; give it a name of its "
    "own.",
    faults.NamedAsPhase: "The hold “{request}” has the name of a phase; give it another, such as "
    "“Held”, so that constraints can tell them apart.",
    faults.TimedTwice: "“{request}” is the second to say how long “{phase}” takes; keep one.",
    faults.TooMuchTime: "With “{request}” the motion would be {seconds:.4g} s longer than it was "
    "recorded, and {most:g} s are the most that can be added; ask for less.",
    faults.BeyondPrecision: "“{request}” moves what touches by {metres:.0f} m, and beyond "
    "{most:.0f} m places are too coarse for contacts (lengths are in metres); move it less, or "
    "move the armature with the whole scene.",
    faults.OutOfReach: "“{request}” is {metres:length} from “{other}”, with {seconds:.2f} s "
    "between them: nobody goes so far in that time. Move it nearer, give it more time, or switch "
    "Human Ranges off for a figure that is no human.",
    faults.PeakTooLow: "“{request}” lets the ground push with {peak:plain} body weights at most, "
    "with which nobody keeps off the floor so long, nor with {least:.2f}; raise its peak, or let "
    "it hold for a shorter time.",
    faults.PoseHeld: "“{request}” holds the whole body, which then stands and lands where it did, "
    "but “{pin}” moves that by {metres:length}; let the pose hold in one phase or fewer bones, or "
    "give it slack or a weight.",
    faults.NoBoneChosen: "“{request}” is about no bone yet; choose one, or switch it off.",
    faults.NoPhaseChosen: "“{request}” holds in a phase, but none is chosen; choose one of "
    "{known:names}.",
    faults.EmptyRange: "“{request}” ends at frame {last:g}, before it begins at frame {first:g}; "
    "swap them.",
    faults.PlacedNowhere: "The contact “{request}” has a place or a frame that is no number; press "
    "Put Back for its stance (panel Contacts) or give it other frames.",
    faults.NoNumber: "“{setting}” is no number; give it one.",
    faults.ReturnTooEarly: "The take is to be back by frame {frame:g}, but is adapted until frame "
    "{last:g}; choose a later frame.",
    faults.ReturnTooLate: "The take is to be back by frame {frame:g}, but its last frame is "
    "{end:g}; choose one up to that and after those that are adapted, or let what follows be "
    "carried along.",
    faults.NoNewSlot: "The result cannot be a new slot of “{action}”: {why}. Choose New "
    "Action under Written As.",
    faults.SameUsdNames: "“{first_bone}” and “{second_bone}” would be one name in a USD file, "
    "which has letters, digits and underscores alone; rename one, or export as FBX or glTF.",
    faults.SeveralTakes: "A USD file holds one take, and several are chosen ({takes:names}); "
    "export a file for each, or all together as FBX or glTF.",
    faults.CrossedBounds: "“{request}” asks for at least {at_least:.4g} {unit} and at most "
    "{at_most:.4g} {unit}, which nothing is; raise the one or lower the other.",
    faults.AsksNothing: "“{request}” asks for nothing; switch on one of its options, or it off.",
    faults.NoDirection: "“{request}” has an axis that points nowhere; give it a direction.",
    faults.NamedTwice: "“{request}” is the name of two constraints, body changes or contacts; "
    "rename one, so that the report can tell them apart.",
    faults.NameMissing: "A constraint ({kind}) has no name; give it one in the list.",
    faults.WorkerDied: "The solver stopped without an answer ({detail}), and nothing was changed; "
    "try again, and report it if it happens twice.",
    faults.BadDimensions: "The figure cannot be reduced to {given} dimensions; choose from 1 to "
    "{most}, or leave them out to have them chosen.",
    faults.UnknownReductionBone: "Row {row} of the reduction's matrix names “{bone}”, whose joint "
    "cannot be tied to others; those that can are {known:names}.",
    faults.WrongWeights: "Row {row} of the reduction's matrix gives “{bone}” a list of {given} "
    "weights, but its joint has {needed} angles; give one weight each.",
    faults.DependentRows: "Of the {rows} rows of the reduction's matrix only {rank} say something "
    "that the others do not; leave out the empty and the repeated ones.",
    faults.UnknownPhase: "The pin “{pin}” is about “{phase}”, which is no phase of the clip in "
    "which something touches the ground; choose one of {known:names}.",
    faults.GroundNotThere: "The pin “{pin}” stands on “{object}” from frame {needed[0]:.1f} to "
    "{needed[1]:.1f} ({phase}), but its motion is known from frame {known[0]:g} to {known[1]:g} "
    "only; key it for all of these frames, or pin another phase.",
    faults.JerkyGround: "“{object}”, on which the pin “{pin}” stands, jumps at frame {frame:.0f} "
    "({acceleration:.0f} m/s²), and nobody could stay on it; smooth its keys there.",
    faults.UnknownContact: "The pin “{pin}” names “{what}”, which does not touch in its phase; "
    "name one of those that do: {known:names}.",
    faults.PinLetGo: "The pin “{pin}” moves {contacts:names}, which cannot be held beside the "
    "recording's other contacts, so the fit let go of what it moves; correct these contacts' "
    "frames, or pin others.",
    faults.NoFaces: "The object “{thing}” has no faces, so nothing can stand on it or run into it; "
    "choose a mesh with faces.",
    faults.NotFinite: "The object “{thing}” has a vertex or a place that is no number; mend its "
    "mesh, its modifiers or its animation.",
    faults.InsideOut: "The faces of “{thing}” look inwards, so its inside would be the world; "
    "recalculate its normals (edit mode, Mesh > Normals > Recalculate Outside), or swap the order "
    "of its faces' corners.",
    faults.NoThickness: "“{thing}” is pressed flat, its faces on each other, so that it has no "
    "inside; give it some thickness, or choose a plane in its place.",
    faults.StandsIn: "“{contact}” stands in “{thing}”, {metres:length} below its surface; let its "
    "stance stand on it (On, in the panel Contacts), or move one of them.",
    faults.StandsBelow: "The recording stands {metres:length} below the top of “{thing}”, in it; "
    "lower the object so far, or raise the armature.",
    faults.NoRoom: "Nothing fits between “{contact}” and “{thing}”: {free:length} are free above "
    "it, and a leg alone takes {needed:length}; move the object, or the stance.",
    faults.TooManyFaces: "The object “{thing}” has {count} triangles, and {most} are the most; "
    "choose a simpler mesh in its place, or put a Decimate modifier on it.",
    faults.SameObjectName: "Two objects of the scene are called “{thing}”; rename one, so that the "
    "report can tell them apart.",
    faults.UnknownObject: (
        "“{request}” names the object “{thing}”, but the scene has none; add it as an object.",
        "“{request}” names the object “{thing}”, which the scene does not have; name one of "
        "{known:names}.",
    ),
    faults.NotGround: "“{request}” stands on “{thing}”, which is an obstacle; make it ground, or "
    "stand on something else.",
    faults.NoFaceThere: (
        "“{request}” stands on “{thing}”, but “{contact}” would be beside it: none of its faces "
        "is above or below; move the pin over it, or the object under the pin.",
        "“{request}” stands on “{thing}”, but “{contact}” would be beside it, at "
        "x = {at[0]:.2f} m, y = {at[1]:.2f} m (it reaches over x = {reach[0][0]:.2f} to "
        "{reach[0][1]:.2f} m, y = {reach[1][0]:.2f} to {reach[1][1]:.2f} m); move the pin over it, "
        "or the object under the pin.",
    ),
    faults.OverTheEdge: "“{request}” stands on “{thing}”, but “{contact}” hangs over the edge of "
    "its face by {metres:length}; move the pin so far, or turn it.",
    faults.TooSteep: "“{request}” stands on “{thing}” where it is {slope:.0f}° steep, and "
    "“{contact}” holds with a friction of {friction:g} at most; ask for more friction, or stand "
    "where it is flatter.",
    faults.ObjectGone: "“{thing}” is not in the scene any more; remove it from the list in the "
    "panel World, or switch it off.",
}

PLACES = ("Recipe {path}", "Recipe {path}, line {line}")
