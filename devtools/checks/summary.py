"""Sum of pytest's JUnit reports, and skips that need a reason of the allowed ones.

As a program: python3 devtools/checks/summary.py FOLDER. Standard library only.
"""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

# Of other machines and other Blenders. Data that is missing is none of them.
ALLOWED_SKIPS = frozenset(
    {
        "no Drake",
        "no Pinocchio",
        "Windows has no such signal",
        "looks processes up in /proc",
        "actions have no slots before Blender 4.4",
        "actions have slots since Blender 4.4",
        "paths may be relative since Blender 4.5",
        "the zip under test is the one for Linux on x86-64",
    }
)


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


def unexpected_skips(folder: Path) -> Iterator[str]:
    """Report, test and reason of every skip for a reason that is not allowed."""
    for report in sorted(folder.rglob("*.xml")):
        for case in ElementTree.parse(report).getroot().iter("testcase"):
            for skip in case.iter("skipped"):
                if skip.get("message") not in ALLOWED_SKIPS:
                    name = f"{case.get('classname', '')}.{case.get('name')}".lstrip(".")
                    yield f"{report.relative_to(folder)}: {name}: {skip.get('message')}"


def main(folder: Path) -> int:
    """Print unexpected skips and, last, the sum; 1 where there were any."""
    skips = list(unexpected_skips(folder))
    for skip in skips:
        print("skipped, and may not be:", skip)
    print(read_all(folder))
    return int(bool(skips))


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
