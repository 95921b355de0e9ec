"""The manual's pictures, taken while the scenarios play: parts of the screen without its edges.

Which scenario takes which is told in manual_images.py.
"""

from __future__ import annotations

import subprocess
from dataclasses import dataclass

import bpy

from .driver import Actions, Driver, Until
from .manual_images import TAKEN


@dataclass(frozen=True)
class Frame:
    """A part of the screen, px from its upper left corner."""

    left: int
    top: int
    width: int
    height: int

    def __str__(self) -> str:
        return f"{self.width}x{self.height}+{self.left}+{self.top}"


def frame_of(driver: Driver, part: bpy.types.Area | bpy.types.Region) -> Frame:
    """Where an editor, or a region of one, is on the screen."""
    left, top = driver.screen.on_screen(part.x, part.y + part.height - 1)
    return Frame(round(left), round(top), part.width, part.height)


def keep(driver: Driver, name: str, frame: Frame | None = None) -> Actions:
    """Keeps a picture for the manual: of the viewport with its sidebar, or of another part."""
    frame = frame or frame_of(driver, driver.screen.area())
    file = driver.out / TAKEN / f"{name}.png"
    file.parent.mkdir(exist_ok=True)
    command = ["import", "-window", "root", "-crop", str(frame), "+repage", "-strip", str(file)]
    taking = subprocess.Popen(command)
    yield Until(f"the manual's picture {name}", lambda: taking.poll() is not None)
    assert taking.returncode == 0, f"the picture {name} was not taken"
