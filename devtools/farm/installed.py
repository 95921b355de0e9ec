"""The wheel, made and unpacked as a worker has it."""

import sys
import zipfile
from pathlib import Path

from ..wheel import build_wheel

PROGRAM = """\
#!{python}
import sys
sys.path.insert(0, {package!r})
from hangtime.batch.cli import main
sys.exit(main())
"""


def unpacked_wheel(folder: Path) -> Path:
    """A folder for PYTHONPATH with the package as the wheel lays it out. Raises BuildError."""
    target = folder / "package"
    with zipfile.ZipFile(build_wheel(folder)) as wheel:
        wheel.extractall(target)
    program = program_in(target)
    program.parent.mkdir()
    program.write_text(PROGRAM.format(python=sys.executable, package=str(target)), encoding="utf-8")
    program.chmod(0o755)
    return target


def program_in(package: Path) -> Path:
    """`hangtime-batch`, as pip would write it beside Python."""
    return package / "bin" / "hangtime-batch"
