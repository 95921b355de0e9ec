"""What the artist asks for, as data: the recipe that a MotionProblem is written from and to."""

from dataclasses import dataclass, field
from enum import Enum

from .requests import Requests


class MassTable(Enum):
    """Which published table gives the segments' inertia."""

    THESIS = "thesis"
    DE_LEVA = "de leva"


class Axes3(Enum):
    """Which axes an offset is given in: the world's, or forward, left and up of the travel."""

    WORLD = "world"
    TRAVEL = "travel"


@dataclass(frozen=True)
class Pin:
    """Moves contacts of one phase.

    name: the artist's. phase: such as "ground 2". touching: bone names or point names ("Left
    heel"); empty means every contact of the phase. offset: (3,) m in `axes`. place: (3,) m, world;
    where the contacts' centre goes instead (offset then adds to it). turn: rad about the vertical
    through the contacts' centre, counter-clockwise from above.
    """

    name: str
    phase: str
    touching: tuple[str, ...] = ()
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    axes: Axes3 = Axes3.TRAVEL
    place: tuple[float, float, float] | None = None
    turn: float = 0.0


@dataclass(frozen=True)
class ContactEdit:
    """The artist's correction of a detected contact, by its name ("Left heel 2"); scene frames."""

    name: str
    start_frame: float | None = None
    end_frame: float | None = None
    remove: bool = False


@dataclass(frozen=True)
class AddedContact:
    """A contact that was not detected: a point ("Left heel") touches between two scene frames."""

    point: str
    start_frame: float
    end_frame: float


@dataclass(frozen=True)
class MotionProblem:
    """Everything that defines an adaptation but the recording itself."""

    frames: tuple[float, float] | None = None
    mass: float = 70.0
    height: float | None = None
    mass_table: MassTable = MassTable.THESIS
    bones: dict[str, str] = field(default_factory=dict)  # part -> bone, the artist's choice
    contacts: tuple[ContactEdit, ...] = ()
    added: tuple[AddedContact, ...] = ()
    pins: tuple[Pin, ...] = ()
    requests: Requests = field(default_factory=Requests)
