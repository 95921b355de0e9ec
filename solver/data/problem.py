"""Problem statement of an adaptation: body, frames, corrected contacts, pins and requests."""

from dataclasses import dataclass, field, replace
from enum import Enum

from .recording import Skin
from .requests import Requests
from .scene import SceneObject
from .solver_options import Method


class MassTable(Enum):
    """Published table of segment inertia parameters (thesis Table 3.1; de Leva 1996)."""

    THESIS = "thesis"
    DE_LEVA = "de leva"


class Unseen(Enum):
    """What is done where something unseen carries the body: it is fitted and told, or refused."""

    SHOW = "show"
    REFUSE = "refuse"


class Mend(Enum):
    """A repair of poses, or of how the body stands. Its value is the word in recipes."""

    FULL_TURNS = "full turns"
    HELD_FRAMES = "held frames"
    LEGS = "exchanged legs"
    ARMS = "exchanged arms"
    FLIPS = "flips"
    SPIKES = "spikes"
    BONE_LENGTHS = "bone lengths"
    NOISE = "noise"
    LEVEL_HIPS = "level hips"
    IN_PLACE = "in place"
    FLOATING = "floating"
    SINKING = "sinking"


class OffsetAxes(Enum):
    """Axes of a pin's offset: the world's, or forward, left and up of the travel."""

    WORLD = "world"
    TRAVEL = "travel"


@dataclass(frozen=True)
class Pin:
    """Displacement of the contacts of one ground phase.

    name: the artist's. phase: such as "ground 2". touching: bone names or point names ("Left
    heel"); empty means every contact of the phase. offset: (3,) m in `axes`. place: (3,) m, world;
    where the contacts' centre goes instead (offset then adds to it). turn: rad about the vertical
    through the contacts' centre, counter-clockwise from above. on: name of a ground object of the
    scene; the contacts then stand on its faces, vertically below or above where they would be.
    step: the name of a contact ("Left heel 2"); of the phase's contacts those of its foot's
    footfall are meant, heel and toe.
    """

    name: str
    phase: str
    touching: tuple[str, ...] = ()
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    axes: OffsetAxes = OffsetAxes.TRAVEL
    place: tuple[float, float, float] | None = None
    turn: float = 0.0
    on: str | None = None
    step: str | None = None


@dataclass(frozen=True)
class ContactEdit:
    """Correction of a detected contact, by its name ("Left heel 2"); scene frames."""

    name: str
    start_frame: float | None = None
    end_frame: float | None = None
    remove: bool = False


@dataclass(frozen=True)
class AddedContact:
    """Contact that was not detected: a point ("Left heel") touches between two scene frames."""

    point: str
    start_frame: float
    end_frame: float


@dataclass(frozen=True)
class MotionProblem:
    """Everything that defines an adaptation but the recording itself.

    frames: first and last scene frame, None for all. mass: kg. height: m, None as the armature is.
    loop: whether the motion shall repeat; it is then made of the cycle nearest to the frames.
    skin: of the recording's figure, where it has one. unseen: what to do where the recording does
    not show what carries the body. good_enough: m by which a contact that the fit cannot hold
    exactly may miss its place. mend: repairs of the recording's poses, and drift and rise: m/s
    along the floor and upwards, that are taken out of its way from the first frame on; before
    anything else. mirrored: whether the recording is then mirrored, across the body at the first
    frame; pins and contacts are on the mirrored one's.
    """

    frames: tuple[float, float] | None = None
    mass: float = 70.0
    height: float | None = None
    mass_table: MassTable = MassTable.THESIS
    bones: dict[str, str] = field(default_factory=dict)  # part -> bone, the artist's choice
    contacts: tuple[ContactEdit, ...] = ()
    added: tuple[AddedContact, ...] = ()
    pins: tuple[Pin, ...] = ()
    scene: tuple[SceneObject, ...] = ()
    requests: Requests = field(default_factory=Requests)
    loop: bool = False
    skin: Skin | None = None
    unseen: Unseen = Unseen.SHOW
    good_enough: float = 2e-3  # a point that is let go slides by more
    mend: tuple[Mend, ...] = ()
    drift: tuple[float, float] = (0.0, 0.0)
    rise: float = 0.0
    mirrored: bool = False

    def known_to_fit(self) -> str:
        """Everything but pins, scene and requests, which the fit does not know, as text."""
        bones = dict(sorted(self.bones.items()))
        known = replace(self, pins=(), scene=(), skin=None, requests=Requests(), bones=bones)
        return repr((known, self.skin and self.skin.digest()))

    @property
    def names(self) -> tuple[str, ...]:
        """The artist's names of all that is asked for."""
        return (*(pin.name for pin in self.pins), *self.requests.names)

    @property
    def asks_nothing(self) -> bool:
        """Whether its result is the fit, and no edit of that."""
        alone = replace(self.requests, solution=Requests().solution) == Requests()
        refined = self.requests.solution.method is Method.EXPLICIT
        return alone and not (self.pins or self.scene or self.loop or refined)

    @property
    def pins_alone(self) -> bool:
        """Whether nothing but pins is asked for, of a recording as it was found: then those of its
        frames alone may be solved that the pins are about (worker/edited_part.py)."""
        alone = replace(self.requests, solution=Requests().solution) == Requests()
        moving = any(thing.moves for thing in self.scene)
        mended = bool(self.mend) or any((*self.drift, self.rise))
        corrected = bool(self.contacts or self.added)
        return bool(self.pins) and alone and not (self.loop or moving or mended or corrected)

    def weighing_torques(self) -> "MotionProblem":
        """The same with changes of torques weighed beside those of the movement."""
        solution = replace(self.requests.solution, method=Method.IMPLICIT_TORQUES)
        return replace(self, requests=replace(self.requests, solution=solution))

    def keeping_times(self) -> "MotionProblem":
        """The same, but for durations that are not asked for."""
        solution = replace(self.requests.solution, keep_times=True)
        return replace(self, requests=replace(self.requests, solution=solution))
