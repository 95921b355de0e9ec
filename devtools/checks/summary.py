"""Adds up pytest's JUnit reports. As a program: python3 devtools/checks/summary.py FOLDER"""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Count:
    """Numbers of tests; an error in setting up or collecting is a failure."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0

    def __add__(self, other: Count) -> Count:
        return Count(
            self.passed + other.passed, self.failed + other.failed, self.skipped + other.skipped
        )

    def __str__(self) -> str:
        return f"{self.passed} passed, {self.failed} failed, {self.skipped} skipped"


def read(report: Path) -> Count:
    """The count of one JUnit file."""
    total = Count()
    for suite in ElementTree.parse(report).getroot().iter("testsuite"):
        failed = int(suite.get("failures", 0)) + int(suite.get("errors", 0))
        skipped = int(suite.get("skipped", 0))
        total += Count(int(suite.get("tests", 0)) - failed - skipped, failed, skipped)
    return total


def read_all(folder: Path) -> Count:
    """The sum over every report below `folder`."""
    return sum((read(report) for report in sorted(folder.rglob("*.xml"))), Count())


if __name__ == "__main__":
    print(read_all(Path(sys.argv[1])))
