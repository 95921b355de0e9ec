"""Scripts in a Python of their own."""

import subprocess
import sys
from pathlib import Path

LOADER = str(Path(__file__).parents[3] / "devtools" / "package.py")


def output_of(script: str, *arguments: str) -> str:
    """What a script says in a Python of its own; its first argument loads the package."""
    command = [sys.executable, "-c", script, LOADER, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, (done.returncode, done.stderr)
    return done.stdout.strip()
