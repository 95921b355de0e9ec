"""What is said of every fault of the scene: an object by itself, or a pin that stands on it."""

from ....solver.data import faults
from ....solver.data.faults import Fault

# Of several, `_variant` says which.
SCENES: dict[type[Fault], str | tuple[str, ...]] = {
    faults.GroundNotThere: "The pin “{pin}” stands on “{object}” from frame {needed[0]:.1f} to "
    "{needed[1]:.1f} ({phase}), but its motion is known from frame {known[0]:g} to {known[1]:g} "
    "only; key it for all of these frames, or pin another phase.",
    faults.JerkyGround: "“{object}”, on which the pin “{pin}” stands, jumps at frame {frame:.0f} "
    "({acceleration:.0f} m/s²), and nobody could stay on it; smooth its keys there.",
    faults.NoFaces: "The object “{thing}” has no faces, so nothing can stand on it or run into it; "
    "choose a mesh with faces.",
    faults.NotFinite: "The object “{thing}” has a vertex or a place that is no number; mend its "
    "mesh, its modifiers or its animation.",
    faults.InsideOut: "The faces of “{thing}” look inwards, so its inside would be the world; "
    "recalculate its normals (edit mode, Mesh > Normals > Recalculate Outside), or swap the order "
    "of its faces' corners.",
    faults.NoThickness: "“{thing}” is pressed flat, its faces on each other, so that it has no "
    "inside; give it some thickness, or choose a plane in its place.",
    faults.StandsIn: (
        "“{contact}” stands in “{thing}”, {metres:length} below its surface; let its stance stand "
        "on it (On, in the panel Contacts), or move one of them.",
        "“{contact}” is in “{thing}”, {metres:length} behind the face at its side; move one of "
        "them so far, so that it touches that face.",
    ),
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
