"""Signals that end a process politely."""

from __future__ import annotations

import io
import signal
from contextlib import suppress

import pytest
from hangtime.operators.terminal.interrupts import ended_by_signals
from hangtime.operators.terminal.stages import Stages

pytestmark = pytest.mark.usefixtures("_handlers_stay")


@pytest.fixture
def _handlers_stay() -> object:
    """As in a terminal: who starts the tests in the background of a shell ignores interrupts."""
    signals, inherited = (signal.SIGINT, signal.SIGTERM), signal.getsignal(signal.SIGINT)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    before = [signal.getsignal(number) for number in signals]
    yield
    assert [signal.getsignal(number) for number in signals] == before
    signal.signal(signal.SIGINT, inherited)


def blender_operator(number: int | None) -> None:
    """Raises as Blender's operators do, whatever goes wrong in them."""
    with suppress(KeyboardInterrupt):
        if number is not None:
            signal.raise_signal(number)
    raise RuntimeError("Error: Python: Traceback")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_interrupts(number: int) -> None:
    with pytest.raises(KeyboardInterrupt), ended_by_signals():
        signal.raise_signal(number)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_interrupts_an_operator_of_blender_too(number: int) -> None:
    with pytest.raises(KeyboardInterrupt), ended_by_signals():
        blender_operator(number)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_that_blender_swallows_ends_the_next_stage(number: int) -> None:
    """As while it saves: what its own calls raise it prints, and goes on."""
    with pytest.raises(KeyboardInterrupt), ended_by_signals():
        _saves_and_exports(number)
    with Stages(io.StringIO()).stage("Another command"):
        pass


def _saves_and_exports(number: int) -> None:
    with suppress(KeyboardInterrupt):
        signal.raise_signal(number)
    with Stages(io.StringIO()).stage("Exporting FBX"):
        pytest.fail("nothing is exported")


def test_what_fails_by_itself_is_no_interrupt() -> None:
    with pytest.raises(RuntimeError), ended_by_signals():
        blender_operator(None)


def test_a_handler_that_python_did_not_set_ends_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Blender sets its own in the background, of which Python knows nothing, and cannot put it
    back: each command would end by that."""
    before = signal.getsignal(signal.SIGINT)
    try:
        with monkeypatch.context() as patched:
            patched.setattr(signal, "getsignal", lambda _number: None)
            with ended_by_signals():
                pass
        assert signal.getsignal(signal.SIGINT) is signal.SIG_DFL
    finally:
        signal.signal(signal.SIGINT, before)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
