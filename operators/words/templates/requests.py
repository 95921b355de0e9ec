"""What is said of every fault of one request or pin."""

from ....solver.data import faults
from ....solver.data.faults import Fault

# Of several, `_variant` says which.
REQUESTS: dict[type[Fault], str | tuple[str, ...]] = {
    faults.AimedBone: "“{request}” is about the bone “{bone}”, which the result leaves to the "
    "constraints or drivers that aim neck or head; mute what aims neck and head (or bake the "
    "action and delete that) and press Analyze again, or switch “{request}” off.",
    faults.UnknownBone: "“{request}” names the bone “{bone}”, which the armature does not have; "
    "choose one of its bones.",
    faults.NotAboveZero: "“{request}” asks for a mass or a factor of {amount:g}; give it one above "
    "zero.",
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
    faults.UnknownContact: "The pin “{pin}” names “{what}”, which does not touch in its phase; "
    "name one of those that do: {known:names}.",
}
