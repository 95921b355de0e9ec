"""The wheel, made and unpacked as a worker has it."""

import zipfile
from pathlib import Path

from ..wheel import build_wheel


def unpacked_wheel(folder: Path) -> Path:
    """A folder for PYTHONPATH with the package as the wheel lays it out. Raises BuildError."""
    target = folder / "package"
    with zipfile.ZipFile(build_wheel(folder)) as wheel:
        wheel.extractall(target)
    return target
