"""Jobs in a process of their own, where no extension is enabled, as the command line has them."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("bpy", reason="needs the bpy module")

ROOT = Path(__file__).resolve().parents[4]


@pytest.mark.slow
def test_the_examples_loop_is_written(tmp_path: Path) -> None:
    recipe = ROOT / "examples" / "loops" / "run_cycle.toml"
    words = ["adapt", "--recipe", str(recipe), "--out", str(tmp_path / "out"), "--no-picture"]
    done = subprocess.run(
        [sys.executable, str(ROOT / "dev.py"), *words], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["status"] == "solved"
    assert report["take"] == {"bones_kept_on_body": {}}
    assert (tmp_path / "out" / "adapted.fbx").stat().st_size > 500
