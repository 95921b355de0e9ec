"""Choices that rows of the sidebar's lists store.

The members' names are stored in the artist's file; the values are what the artist reads, or writes
in a recipe.
"""

from enum import Enum

from ...solver.data.scene import SceneRole

HOLD = "HOLD"  # the kind of constraint whose rows are phases by their own names


class BodyKind(Enum):
    """What a row of the body changes' list does."""

    LOAD = "Carried Weight"
    LIMB = "Limb"
    SHAPE = "Shape and Joints"


class Through(Enum):
    """What the solid shapes of some bones may go through; the names are the solver's."""

    NOTHING = "Nothing"
    EACH_OTHER = "Each Other"
    ALL = "Everything"


class SurfaceRole(Enum):
    """What an object of the scene is to the performer."""

    GROUND = "Ground"
    OBSTACLE = "Obstacle"
    CLEAR = "Hurdle"  # an obstacle over which the way goes

    @property
    def solid(self) -> SceneRole:
        """The same to the solver."""
        return SceneRole.GROUND if self is SurfaceRole.GROUND else SceneRole.OBSTACLE


class Moves(Enum):
    """What goes where a contact is moved to."""

    AUTO = "Automatic"  # of steps the foot, of landings and take-offs the stance
    CONTACT = "Contact Alone"
    FOOT = "Foot"
    STANCE = "Whole Stance"


class Span(Enum):
    """During what a constraint holds."""

    ALWAYS = "Whole Clip"
    PHASE = "Phase"
    FRAMES = "Frames"
    FRAME = "One Frame"


class Instant(Enum):
    """The one instant of a phase at which a constraint holds, if it is to be one."""

    THROUGHOUT = "Throughout"
    START = "Start"
    MIDDLE = "Middle"
    APEX = "Apex"
    END = "End"


class Met(Enum):
    """How a constraint came out of the last solve."""

    UNKNOWN = "Not Solved Yet"
    MET = "Met"
    MISSED = "Missed"


class After(Enum):
    """What becomes of the take after the frames that are adapted."""

    CARRY = "carry"  # moved and turned with the last stance
    RETURN = "return"  # back where it was by a frame
    CUT = "cut"  # left out, and what is before them, too


class LoopRoot(Enum):
    """What carries a loop's travel."""

    HIPS = "hips"
    IN_PLACE = "in place"  # nothing: what is left of it is the sway about a steady speed
    ROOT_BONE = "root bone"  # the topmost above the pelvis, at a steady speed


class WrittenAs(Enum):
    """Form in which a result is written."""

    ACTION = "action"
    STRIP = "strip"  # on top of the take
    COMBINE = "combine"  # only the difference, on top of the take
    SLOT = "slot"  # of the take's own action


class ContactMarkers(Enum):
    """Where contacts of a result are marked."""

    NONE = "none"
    ACTION = "action"  # pose markers
    TIMELINE = "timeline"  # the scene's


class KeyChoice(Enum):
    """Frames that get keys."""

    EVERY_FRAME = "every frame"
    REDUCED = "reduced"  # the fewest within an error
    TAKE = "as the take"  # where the take has keys


class Engine(Enum):
    """For whom a file is written."""

    NONE = "none"
    UNREAL = "unreal"
    UNITY = "unity"
    GODOT = "godot"


class FileFormat(Enum):
    """Of a file with takes."""

    FBX = "fbx"
    GLTF = "gltf"
    USD = "usd"


class RootMotion(Enum):
    """What carries the way over the floor in a file."""

    AS_IT_IS = "as it is"
    ROOT_BONE = "root bone"
    IN_PLACE = "in place"
