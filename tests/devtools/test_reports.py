"""Where a report is to be left is looked at before its work begins."""

from importlib import import_module
from pathlib import Path

import pytest

REPORTS = [
    *("campaign", "doctor", "figures", "gallery", "keys", "loop", "pairs", "reach", "rigs"),
    *("solid", "survey", "validation", "window"),
]


@pytest.mark.parametrize("name", REPORTS)
def test_a_folder_that_cannot_be_made_is_told_before_any_work(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main = import_module(f"hangtime.devtools.{name}.main").main
    (tmp_path / "file").write_text("")
    where = tmp_path / "file" / "out"
    with pytest.raises(SystemExit, match="2"):
        main([*(["--table"] if name == "doctor" else []), "--out", str(where)])
    last = capsys.readouterr().err.splitlines()[-1]
    assert f"nothing can be written to {where} (" in last
    assert last.endswith("choose another --out")
