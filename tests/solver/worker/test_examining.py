"""An examination tells how far it is, and ends where nobody waits for it."""

from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.worker.protocol import (
    Cancelled,
    Ending,
    Examined,
    Progress,
    Request,
    RequestKind,
)
from hangtime.solver.worker.service import Service
from hangtime.tests.helpers.doctored import jump

REQUEST = Request(3, RequestKind.EXAMINE, jump(), MotionProblem())


def test_it_tells_its_share() -> None:
    heard: list[Progress] = []
    assert isinstance(Service().answer(REQUEST, heard.append), Examined)
    assert {each.id for each in heard} == {3}
    shares = [each.share for each in heard]
    assert len(set(shares)) > 3
    assert 0.0 < shares[0] < 0.2 < 0.9 < max(shares) <= 1.0


def test_it_ends_at_its_next_part() -> None:
    heard: list[Progress] = []
    service = Service(lambda _: Ending.CANCEL if heard else None)
    assert service.answer(REQUEST, heard.append) == Cancelled(3)
    assert len(heard) == 1
