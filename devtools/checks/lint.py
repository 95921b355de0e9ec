"""Static checks: ruff's rules and format, mypy, the import contracts, the limits of the house."""

import os
import subprocess
import sys
from pathlib import Path

from importlinter.cli import lint_imports

from ..environment.virtual_environment import CACHE, ROOT
from . import house

TYPED = ("solver", "bridge", "operators", "batch", "ui", "devtools")


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
    print("$ lint-imports", flush=True)  # the package as it is loaded here
    codes.append(lint_imports(str(ROOT / "pyproject.toml"), no_cache=True, no_logo=True))
    print("$ house", flush=True)
    problems = list(house.problems(ROOT))
    print(*problems or ["Every folder, chain and class name is within its limit."], sep="\n")
    return int(any(codes) or bool(problems))


def named_folder() -> Path:
    """A folder in which the checkout goes by the package's name, as mypy needs it to."""
    folder = CACHE / "types"
    folder.mkdir(parents=True, exist_ok=True)
    link = folder / "hangtime"
    if not link.exists() or not link.samefile(ROOT):  # of a checkout that was moved, or another's
        link.unlink(missing_ok=True)
        link.symlink_to(ROOT, target_is_directory=True)
    return folder
