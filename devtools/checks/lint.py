"""ruff's rules, ruff's layout, and mypy."""

import os
import subprocess
import sys
from pathlib import Path

from ..environment.virtual_environment import CACHE, ROOT

TYPED = ("solver", "bridge", "operators", "ui", "devtools")


def main(argv: list[str]) -> int:
    """0 when every check passes; all of them run in any case."""
    if argv:
        print("dev.py lint takes no arguments.", file=sys.stderr)
        return 2
    typed = [word for name in TYPED for word in ("-p", f"hangtime.{name}")]
    checks = (["ruff", "check", "."], ["ruff", "format", "--check", "."], ["mypy", *typed])
    variables = {**os.environ, "MYPYPATH": str(named_folder())}
    codes = []
    for check in checks:
        print("$", *check, flush=True)
        codes.append(subprocess.call([sys.executable, "-m", *check], cwd=ROOT, env=variables))
    return int(any(codes))


def named_folder() -> Path:
    """A folder in which the checkout goes by the package's name, as mypy needs it to."""
    folder = CACHE / "types"
    folder.mkdir(parents=True, exist_ok=True)
    link = folder / "hangtime"
    if not link.exists():
        link.symlink_to(ROOT, target_is_directory=True)
    return folder
