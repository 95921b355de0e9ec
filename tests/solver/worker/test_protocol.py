"""What the worker and its parent say to each other, without a process in between."""

import io
import pickle
from dataclasses import fields
from typing import Any

import numpy as np
import pytest
from hangtime.solver.data import faults
from hangtime.solver.data.contacts import Contact, ContactSchedule
from hangtime.solver.data.problem import MassTable, Mend, MotionProblem, Pin
from hangtime.solver.data.recording import Bone, PoseTrack, Recording
from hangtime.solver.data.reports.certificate import CertificateItem, CertificateLine
from hangtime.solver.data.reports.constraints import (
    ConstraintReport,
    FitNeeds,
    LetGoReport,
    MovingGroundReport,
    PinReport,
    UnseenSupportReport,
)
from hangtime.solver.data.reports.dynamics import (
    DenseResiduals,
    ForcePeak,
    ForcesReport,
    PhaseResidual,
    TorquePeak,
    TorquesReport,
    TorqueUse,
)
from hangtime.solver.data.reports.joints import JointChange, RecordedRange
from hangtime.solver.data.reports.jumps import (
    FlightSummary,
    JumpReport,
    PhaseReport,
    RecordedFlight,
    TimeMap,
)
from hangtime.solver.data.reports.recording import FigureSummary, RecordingSummary
from hangtime.solver.data.reports.report import (
    DragSummary,
    FitQuality,
    MotionChange,
    RecordedOverlap,
    ReductionReport,
    Report,
    SolveReport,
    StageReport,
)
from hangtime.solver.data.row_kinds import RowKind, Violation
from hangtime.solver.data.scaling import (
    scaled_problem,
    scaled_recording,
    scaled_schedule,
    scaled_track,
)
from hangtime.solver.data.solver_options import ReductionKind
from hangtime.solver.data.stance_move import StanceMove
from hangtime.solver.data.status import DragStatus, Durations, Status
from hangtime.solver.data.traces import FlightParabola, Traces
from hangtime.solver.doctor.examination.diagnose import Diagnosis
from hangtime.solver.doctor.finding import Finding, FindingKind
from hangtime.solver.doctor.repairs import Repairs, UpAxis
from hangtime.solver.doctor.stance.feet import FootFault, FootFaultKind
from hangtime.solver.worker.protocol import (
    LARGEST,
    PROTOCOL,
    Adapted,
    Analysed,
    Cancelled,
    Ending,
    Examined,
    Failed,
    Fitted,
    Followed,
    Halt,
    Halted,
    Hello,
    Message,
    Progress,
    ProtocolError,
    Ready,
    Request,
    RequestKind,
    receive,
    send,
)

TIMES = np.arange(5) / 30.0
RECORDING = Recording(
    "walk",
    (Bone("hips", -1, np.zeros(3), np.array([0.0, 0.0, 0.1]), np.eye(3)),),
    np.arange(5.0),
    TIMES,
    np.arange(15.0).reshape(5, 1, 3),
    np.tile(np.eye(3), (5, 1, 1, 1)),
)
PROBLEM = MotionProblem(
    frames=(0.0, 4.0),
    mass_table=MassTable.DE_LEVA,
    pins=(Pin("further", "ground 1", offset=(0.3, 0.0, 0.2)),),
)
CONTACT = Contact("Left toe 1", "Left toe", "toe", np.ones(3), 0.0, 0.1, np.full(3, 2.0))
SCHEDULE = ContactSchedule((CONTACT,), 0.4, 0.01)
TRACK = PoseTrack(np.arange(5.0), ("hips",), np.tile(np.eye(3), (5, 1, 1, 1)), np.ones((5, 3)))
NONE = np.zeros((5, 0, 3))
TRACES = Traces(
    frames=np.arange(5.0),
    bones=("hips",),
    heads=np.ones((5, 1, 3)),
    tails=np.zeros((5, 1, 3)),
    com=np.ones((5, 3)),
    velocity=np.zeros((5, 3)),
    momentum=np.zeros((5, 3)),
    contacts=(),
    points=NONE,
    forces=NONE,
    weight=700.0,
    joints=(),
    torques=NONE[:, :, 0],
    flights=(FlightParabola("flight 1", 1.0, 2.0, np.ones((3, 3))),),
    changes=np.ones((5, 1)),
)
FAULT = faults.NoSolution(Status.STOPPED, (Violation("pin", RowKind.PIN, 1.0),))
FLIGHT = FlightSummary(None, 1.1, 0.5)
REPORT = Report(
    status=Status.SOLVED,
    certificate=(CertificateLine(CertificateItem.SLIDE, 4.0, "mm", 5.0, True, 3.0, "Left toe 1"),),
    recording=RecordingSummary("a.bvh", "walk", 0.0, 4.0, 0.1, 30.0, None, False, "Z", True, 0),
    figure=FigureSummary(70.0, MassTable.DE_LEVA, 1.7, 9.81, 1, 6, 0.0),
    pins=(PinReport("further", "ground 1", (), None, (0.3, 0.0, 0.2), None, 0.0),),
    solves=(SolveReport("fit", Status.SOLVED, 3, 0.5),),
    unknowns=30,
    rows=12,
    equations=(Violation("flight 1", RowKind.BALANCE, np.float64(1e-6)),),
    conditions=(ConstraintReport("knee", RowKind.BEND, 0.1, 2.0, True),),
    contacts=(),
    moving_ground=(
        MovingGroundReport("ground 1", "train", "Ride", (0.0, 1.0, 0.0), (3.0, 3.0), 0.9),
    ),
    between_nodes=DenseResiduals(1000.0, flight=PhaseResidual(0.0, 0.0, 0.0, 0.0)),
    forces=ForcesReport((ForcePeak("ground 1", 3.0, 2.0, 0.4),), 2.5, 0.0),
    objective_end_over_start=None,
    reduction=ReductionReport(ReductionKind.PCA, 5, (1.0,), (1.0,)),
    torques=TorquesReport((TorquePeak("hips", 10.0),), 8, 0.1),
    torque_limits=(TorqueUse("Limp arm", 0.2, 0.1, 1.5),),
    fit_to_recording=FitQuality(1.0, 0.1, 2.5, 3.0),
    recorded_overlaps=(RecordedOverlap("Left hand in left thigh", 12.0, 2.0),),
    recorded_ranges=(RecordedRange("Left knee bends", 7.0, 2.0),),
    change=MotionChange(2.0, 1.0),
    joint_changes=(JointChange("thigh.L", 12.0, 3.0),),
    jumps=(JumpReport("flight 1", 0.0, 0.1, 0, 3, RecordedFlight(1.0), FLIGHT, FLIGHT, None, 0.0),),
    durations=Durations.FOUND,
    phases=(PhaseReport("flight 1", 0.1, 0.125),),
    times=TimeMap((0.0, 4.0), (0.0, 5.0)),
    stages=(StageReport("Adapting", 1.5),),
)
MOVED = StanceMove("ground 2", (1.0, 0.0, 0.0), 0.5, (0.3, 0.0, 0.0))
REPAIRS = Repairs(UpAxis.Y, 1, (Mend.NOISE,), 0.8, 2.0, (0.1, 0.0), 0.2)
FINDING = Finding(FindingKind.SPIKE, 30.0, "°", ((2.0, 2.0),), "arm", REPAIRS)
FOOT = FootFault(FootFaultKind.SINKS, "Left toe", "toe.L", (0.0, 0.1, 0.0), 1.0, 4.0, 0.05)
SUPPORT = UnseenSupportReport(1.0, 4.0, 0.5, 2.0, 0.1, 0.3)
LET_GO = LetGoReport("Left toe 1", 1.0, 4.0, 12.0)
MESSAGES: tuple[Message, ...] = (
    Hello(PROTOCOL, ("somewhere",)),
    Ready(PROTOCOL),
    Request(1, RequestKind.ADAPT, RECORDING, PROBLEM),
    Request(2, RequestKind.FOLLOW, None, PROBLEM),
    Halt(2, Ending.AS_IT_STANDS),
    Halted(2),
    Progress(1, "fit", 2, 3.5, "Left toe 1", 0.25),
    Analysed(1, SCHEDULE, 1.7, {"ground 1": np.eye(3)}, {"pelvis": "hips"}, TRACES),
    Request(3, RequestKind.EXAMINE, RECORDING, PROBLEM, REPAIRS),
    Examined(3, Diagnosis((FINDING,), 30.0), (FOOT,)),
    Fitted(1, REPORT.fit_to_recording, 2.0, TRACES, FitNeeds((SUPPORT,), (LET_GO,))),
    Adapted(1, TRACK, REPORT, SCHEDULE, TRACES, MOVED, None),
    Adapted(1, TRACK, REPORT, SCHEDULE, TRACES, None, FAULT),
    Followed(1, TRACES, DragStatus.CONVERGED, DragSummary(3.0, 1.0, 2.0, 4.5)),
    Cancelled(1),
    Failed(1, faults.UnseenSupport(1.0, 5.0)),
)


def sent(*messages: Message) -> bytes:
    stream = io.BytesIO()
    for message in messages:
        send(stream, message)
    return stream.getvalue()


def framed(body: bytes) -> io.BytesIO:
    return io.BytesIO(len(body).to_bytes(8, "little") + body)


def assert_same(one: Any, other: Any) -> None:
    """Equal in type and content, arrays included."""
    assert type(one) is type(other)
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other)
    elif isinstance(one, tuple):
        assert len(one) == len(other)
        for a, b in zip(one, other, strict=True):
            assert_same(a, b)
    elif isinstance(one, dict):
        assert one.keys() == other.keys()
        for key in one:
            assert_same(one[key], other[key])
    elif hasattr(one, "__dataclass_fields__"):
        for field in fields(one):
            assert_same(getattr(one, field.name), getattr(other, field.name))
    else:
        assert one == other


def every_fault(base: type[faults.Fault] = faults.Fault) -> list[type[faults.Fault]]:
    found = []
    for fault in base.__subclasses__():
        found += [fault, *every_fault(fault)]
    return found


def test_every_message_arrives_as_it_was_sent() -> None:
    stream = io.BytesIO(sent(*MESSAGES))
    for message in MESSAGES:
        assert_same(receive(stream), message)
    assert receive(stream) is None


@pytest.mark.parametrize("fault", every_fault(), ids=lambda fault: fault.__name__)
def test_every_fault_arrives_though_it_was_given_by_name(fault: type[faults.Fault]) -> None:
    values = {field.name: f"some {field.name}" for field in fields(fault)}
    arrived = receive(io.BytesIO(sent(Failed(1, fault(**values)))))
    assert isinstance(arrived, Failed)
    assert_same(arrived.fault, fault(**values))


def test_the_sender_may_know_the_package_by_another_name() -> None:
    body = pickle.dumps(MESSAGES[-1], protocol=2)  # 2 spells names out, each with its end
    renamed = body.replace(b"changtime.solver", b"cbl_ext.user_default.hangtime.solver")
    assert renamed != body
    assert_same(receive(framed(renamed)), MESSAGES[-1])


@pytest.mark.parametrize("cut", [1, 7, 8, 9, 60])
def test_a_message_that_breaks_off_is_refused(cut: int) -> None:
    with pytest.raises(ProtocolError, match="breaks off"):
        receive(io.BytesIO(sent(MESSAGES[2])[:cut]))


def test_a_length_beyond_reason_is_refused_before_it_is_read() -> None:
    with pytest.raises(ProtocolError, match=str(LARGEST + 1)):
        receive(io.BytesIO((LARGEST + 1).to_bytes(8, "little")))


class Trap:
    """What runs a command when it is unpickled."""

    def __reduce__(self) -> tuple[Any, ...]:
        return print, ("sprung",)


class _Starved(io.BytesIO):
    """There is no memory for as much as is announced."""

    def read(self, size: int | None = -1, /) -> bytes:
        if size is not None and size > 100:
            raise MemoryError
        return super().read(size)


def test_a_message_that_memory_has_no_room_for_is_refused() -> None:
    """The thread that listens would end without a word, and whoever asked would wait for ever."""
    stream = _Starved((1000).to_bytes(8, "little"))
    with pytest.raises(ProtocolError, match="cannot be read"):
        receive(stream)


@pytest.mark.parametrize(
    "content",
    [Trap(), io.BytesIO, np.testing.assert_allclose, ("Ready", PROTOCOL), PROBLEM],
    ids=["call", "class", "function", "no message", "our own but no message"],
)
def test_nothing_but_messages_is_accepted(
    content: object, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(ProtocolError):
        receive(framed(pickle.dumps(content)))
    assert capsys.readouterr().out == ""


def test_a_function_of_the_solver_is_no_class_to_be_called() -> None:
    body = b"\x80\x02changtime.solver.worker.protocol\nreceive\n."
    with pytest.raises(ProtocolError, match="not expected"):
        receive(framed(body))


@pytest.mark.parametrize("body", [b"", b"N", b"nonsense", b"\x80\x05]", b"\x80\x05K\x01."])
def test_nonsense_is_refused_as_such(body: bytes) -> None:
    with pytest.raises(ProtocolError):
        receive(framed(body))


@pytest.mark.parametrize(
    ("scaled", "thing"),
    [
        (scaled_recording, RECORDING),
        (scaled_problem, PROBLEM),
        (scaled_schedule, SCHEDULE),
        (scaled_track, TRACK),
    ],
)
def test_scaling_to_another_stature_and_back_changes_nothing(scaled: Any, thing: Any) -> None:
    assert_same(scaled(scaled(thing, 0.5), 2.0), thing)


def test_a_stature_scales_lengths_and_nothing_else() -> None:
    bone = scaled_recording(RECORDING, 2.0).bones[0]
    np.testing.assert_array_equal(bone.tail, [0.0, 0.0, 0.2])
    np.testing.assert_array_equal(scaled_recording(RECORDING, 2.0).heads, 2.0 * RECORDING.heads)
    assert scaled_problem(PROBLEM, 2.0).pins[0].offset == (0.6, 0.0, 0.4)
    np.testing.assert_array_equal(scaled_track(TRACK, 2.0).root_head, np.full((5, 3), 2.0))
    np.testing.assert_array_equal(scaled_schedule(SCHEDULE, 2.0).contacts[0].place, np.full(3, 4.0))
    assert scaled_schedule(SCHEDULE, 2.0).contacts[0].end == CONTACT.end
