"""Records of the report on what was adapted: recording and figure."""

from dataclasses import dataclass

from ..problem import MassTable


@dataclass(frozen=True)
class ChosenTake:
    """What was read of a file that may hold several armatures, each with several takes.

    armatures: others that move. takes: the armature's others. Neither where one was asked for.
    """

    armature: str
    take: str
    armatures: tuple[str, ...] = ()
    takes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Origin:
    """Source file of a recording and how it was read; None where nothing had to be settled.

    unit_m: m per unit of length in the file. up: its axis that points up. bind_frames: at its
    beginning, which hold the rest pose and are left out. miscount: frames that the file
    announces, and that it holds, where these are more. chosen: what of it is read. unmoved:
    bones that its skeleton lets move, and that it says nothing of.
    """

    clip: str
    unit_m: float | None = None
    unit_guessed: bool = False
    up: str | None = None
    up_guessed: bool = False
    bind_frames: int = 0
    miscount: tuple[int, int] | None = None
    chosen: ChosenTake | None = None
    unmoved: tuple[str, ...] = ()


@dataclass(frozen=True)
class RecordingSummary:
    """The recording's source, frames and duration."""

    clip: str
    action: str
    first_frame: float
    last_frame: float
    seconds: float
    frames_per_second: float
    unit_m: float | None
    unit_guessed: bool
    up_axis: str | None
    up_axis_guessed: bool
    bind_pose_frames: int


@dataclass(frozen=True)
class FigureSummary:
    """The adapted figure, with what it carries."""

    mass_kg: float
    mass_table: MassTable
    height_m: float
    gravity_m_s2: float
    bodies: int
    degrees_of_freedom: int
    floor_m: float
