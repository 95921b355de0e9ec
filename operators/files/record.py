"""How a file was written: by what it is told whether anybody has changed it since."""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import file_digest
from pathlib import Path


@dataclass(frozen=True)
class FileRecord:
    """bytes: the size. sha256: of all that is in it, hexadecimal."""

    bytes: int
    sha256: str

    @staticmethod
    def of(path: Path) -> FileRecord:
        """The file as it is now. Raises OSError."""
        with path.open("rb") as file:
            digest = file_digest(file, "sha256").hexdigest()
            return FileRecord(file.tell(), digest)
