"""Jobs in a process of their own, where no extension is enabled, as the command line has them."""

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.operators.headless.explained import CANCELLED
from hangtime.tests.blender.helpers.jobs import EDIT

ROOT = Path(__file__).resolve().parents[4]


def adapted(recipe: Path, out: Path) -> dict[str, Any]:
    """The report of a job that leaves its files in a folder."""
    words = ["adapt", "--recipe", str(recipe), "--out", str(out), "--no-picture"]
    done = subprocess.run(
        [sys.executable, str(ROOT / "dev.py"), *words], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    assert (out / "adapted.fbx").stat().st_size > 500
    report: dict[str, Any] = json.loads((out / "report.json").read_text(encoding="utf-8"))
    assert report["status"] == "solved"
    return report


@pytest.mark.slow
def test_the_examples_loop_is_written(tmp_path: Path) -> None:
    report = adapted(ROOT / "examples" / "loops" / "run_cycle.toml", tmp_path / "out")
    assert report["take"] == {"bones_kept_on_body": {}}


@pytest.mark.slow
@pytest.mark.skipif(bpy.app.version < (4, 5), reason="Blender before 4.5 cannot copy a slot")
def test_a_result_is_a_new_slot(tmp_path: Path, clip: Path) -> None:
    recipe, out = tmp_path / "slot.toml", tmp_path / "out"
    recipe.write_text(f"clip = {json.dumps(str(clip))}\n{EDIT}\n[result]\nwritten_as = 'slot'\n")
    adapted(recipe, out)
    bpy.ops.wm.open_mainfile(filepath=str(out / "adapted.blend"))
    assert max(len(action.slots) for action in bpy.data.actions) == 2


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot end a process politely")
def test_a_run_that_is_ended_while_it_writes_leaves_nothing(tmp_path: Path) -> None:
    recipe, out = ROOT / "examples" / "loops" / "run_cycle.toml", tmp_path / "out"
    words = ["adapt", "--recipe", str(recipe), "--out", str(out)]
    with subprocess.Popen([sys.executable, str(ROOT / "dev.py"), *words]) as run:
        deadline = time.monotonic() + 200.0
        while not any(out.glob("unfinished-*.blend")) and time.monotonic() < deadline:
            time.sleep(0.05)
        assert run.poll() is None
        run.terminate()
        assert run.wait(60) == CANCELLED
    assert not out.exists()
