"""What a command that ends early says it has written."""

from argparse import Namespace
from pathlib import Path

import pytest
from hangtime.operators.files.outbox import Outbox
from hangtime.operators.headless import commands


@pytest.mark.parametrize(("end", "code"), [(KeyboardInterrupt, 130), (MemoryError, 1)])
@pytest.mark.parametrize("delivered", [False, True])
def test_what_is_written_is_told_as_it_is(
    end: type[BaseException],
    code: int,
    delivered: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def ended(_options: Namespace) -> None:
        with Outbox(tmp_path) as outbox:
            outbox.write_text("report.txt", "all of it")
            if delivered:
                outbox.deliver()
            raise end

    monkeypatch.setattr(commands, "doctor", ended)
    assert commands.run(["doctor", "jump.bvh"]) == code
    told = f"written by then: {tmp_path / 'report.txt'}." if delivered else "nothing was written."
    assert f"; {told}" in capsys.readouterr().err
    assert (tmp_path / "report.txt").exists() == delivered
