"""Jobs of the command line on the recorded jump."""

from pathlib import Path

from hangtime.operators.headless.cli import main

WINDOW = (110.0, 260.0)
FILES = {
    *("adapted.blend", "adapted.fbx", "sheet.png"),
    *("report.json", "report.txt", "trajectory.npz"),
}
EDIT = """
frames = [110, 260]
[[pin]]
name = "Landing"
phase = "ground 2"
forward = 0.3
up = 0.2
"""

# Physics and pins alone: quicker, and sooner given up.
PLAIN = "[solution]\nsolid = false\nhuman = false\nkeep_times = true\n"


def run(tmp_path: Path, clip: Path, recipe: str, *options: str) -> int:
    """The exit code of a job whose results would go to tmp_path / "out"."""
    path = tmp_path / "edit.toml"
    path.write_text(recipe)
    out = ["--out", str(tmp_path / "out")]
    return main(["adapt", str(clip), "--recipe", str(path), *out, *options])
