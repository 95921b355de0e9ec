"""Protocol between the artist's program and the worker process: messages and their framing.

The parent starts the worker and says Hello; the worker answers Ready. Then the parent makes one
Request at a time, and the worker tells any number of Progress and one answer.

Meanwhile the parent may tell it to Halt: to drop the request, which is answered by Cancelled, or to
end with the motion as it stands. Each Halt is met by Halted at once.

Each message is a length (8 bytes, little-endian) and a pickle. Both ends run the same files of one
version, under the package names that their importers gave them; what arrives may name nothing but
this package's data classes and enums and numpy's arrays.
"""

from __future__ import annotations

import pickle
import struct
from dataclasses import dataclass
from enum import Enum
from typing import IO, TYPE_CHECKING

from ..data.status import DragStatus
from .unpickling import Unreadable, is_data, unpickled

# Standard library only: the worker learns where numpy is from the first message.
if TYPE_CHECKING:
    from ..arrays import FloatArray
    from ..data.contacts import ContactSchedule
    from ..data.faults import CarriedBy, Fault, NoSolution
    from ..data.loop import Cycle
    from ..data.problem import MotionProblem
    from ..data.recording import PoseTrack, Recording
    from ..data.reports.constraints import FitNeeds
    from ..data.reports.report import DragSummary, FitQuality, Report
    from ..data.stance_move import StanceMove
    from ..data.traces import Traces
    from ..doctor.examination.diagnose import Diagnosis
    from ..doctor.repairs import Repairs
    from ..doctor.stance.feet import FootFault

PROTOCOL = 8
LARGEST = 1 << 30  # bytes; a longer message is not one
_HEAD = struct.Struct("<Q")  # length of the pickle


class RequestKind(Enum):
    """Task that a request sets the worker."""

    ANALYSE = "analyse"
    EXAMINE = "examine"  # what is wrong with a recording, which the doctor tells
    FIT = "fit"
    ADAPT = "adapt"
    FOLLOW = "follow"  # a pin that is being dragged: the next few steps, not a whole solve


@dataclass(frozen=True)
class Hello:
    """The parent's first word: its protocol and where its Python finds modules."""

    protocol: int
    path: tuple[str, ...]


@dataclass(frozen=True)
class Ready:
    """The worker's answer to Hello."""

    protocol: int


@dataclass(frozen=True)
class Request:
    """A task for the worker; id comes back with everything that is said about it.

    recording: None is the last request's. placed: to be examined: the repairs by which the scene
    has it turned, in size, on the floor and in time already; None where there are none.
    """

    id: int
    kind: RequestKind
    recording: Recording | None
    problem: MotionProblem
    placed: Repairs | None = None


class Ending(Enum):
    """Way in which a request is halted."""

    CANCEL = "cancel"
    AS_IT_STANDS = "as it stands"


@dataclass(frozen=True)
class Halt:
    """The request with this id shall end before it is met."""

    id: int
    how: Ending


@dataclass(frozen=True)
class Halted:
    """The worker has heard the Halt for this id, whether the request still went on or not."""

    id: int


@dataclass(frozen=True)
class Progress:
    """Progress of a request: the stage's step-th step is done.

    violation: the worst over its tolerance, before it; worst: whose it was (a contact, a condition
    or an equation). share: progress fraction of the request, 0 to 1.
    """

    id: int
    stage: str
    step: int
    violation: float
    worst: str
    share: float


@dataclass(frozen=True)
class Analysed:
    """The contacts found.

    height: m, as measured. axes: (3, 3) by ground phase's name, columns forward, left and up.
    bones: by the part of the body that they move ("left foot"). fleshed: names of the bodies whose
    solid shapes are from the mesh. cycle: whose frames these are,
    where the motion shall repeat. unseen: where something unseen carries the body. backwards: the
    ground phases whose forward is at the body's back. odd_size: what makes a person of a figure
    that was read at a wrong scale; None of others.
    """

    id: int
    schedule: ContactSchedule
    height: float
    axes: dict[str, FloatArray]
    bones: dict[str, str]
    traces: Traces
    fleshed: tuple[str, ...] = ()
    cycle: Cycle | None = None
    unseen: tuple[CarriedBy, ...] = ()
    backwards: tuple[str, ...] = ()
    odd_size: float | None = None


@dataclass(frozen=True)
class Examined:
    """What is wrong with a recording before any repair, and with its feet as it is read now."""

    id: int
    diagnosis: Diagnosis
    feet: tuple[FootFault, ...]


@dataclass(frozen=True)
class Fitted:
    """The nearest valid motion is found. needs: what it needs beside what the recording shows."""

    id: int
    quality: FitQuality
    seconds: float
    traces: Traces
    needs: FitNeeds


@dataclass(frozen=True)
class Adapted:
    """The adapted motion at the recording's frames, its report and its contacts.

    moved: the last stance's move, with which the rest of the take goes. fault: why it is not what
    was asked for but the best that was found; None where it is.
    """

    id: int
    track: PoseTrack
    report: Report
    schedule: ContactSchedule
    traces: Traces
    moved: StanceMove | None
    fault: NoSolution | None


@dataclass(frozen=True)
class Followed:
    """The motion that follows a dragged pin, after a few steps more."""

    id: int
    traces: Traces
    status: DragStatus
    summary: DragSummary


@dataclass(frozen=True)
class Cancelled:
    """The request was dropped."""

    id: int


@dataclass(frozen=True)
class Failed:
    """The request cannot be met, and why."""

    id: int
    fault: Fault


Answer = Analysed | Examined | Fitted | Adapted | Followed | Cancelled | Failed
Message = Hello | Ready | Request | Halt | Halted | Progress | Answer


class ProtocolError(Exception):
    """Raised where what arrived is not a message of this version."""


def send(stream: IO[bytes], message: Message) -> None:
    """Writes one message. Raises OSError (BrokenPipeError where nobody listens any more)."""
    body = pickle.dumps(message, protocol=5)
    rest = memoryview(_HEAD.pack(len(body)) + body)
    while rest:
        rest = rest[stream.write(rest) :]  # a bare pipe takes what it has room for
    stream.flush()


def receive(stream: IO[bytes]) -> Message | None:
    """The next message; None where the stream ends before one. Raises ProtocolError."""
    head = stream.read(_HEAD.size)
    if not head:
        return None
    if len(head) < _HEAD.size:
        raise ProtocolError("a message breaks off")
    (length,) = _HEAD.unpack(head)
    if length > LARGEST:
        raise ProtocolError(f"a message of {length} bytes is announced")
    try:
        body = stream.read(length)
        if len(body) < length:
            raise ProtocolError("a message breaks off")
        message = unpickled(body, is_data)
    except (Unreadable, MemoryError) as problem:
        raise ProtocolError(f"a message cannot be read: {problem}") from problem
    if not isinstance(message, Message):
        raise ProtocolError(f"{type(message).__name__} is not a message")
    return message
