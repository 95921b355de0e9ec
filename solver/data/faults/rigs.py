"""Faults of a rig whose bones follow others, so that a result could not be written to it."""

from dataclasses import dataclass

from .base import Fault


@dataclass
class NoControls(Fault):
    """Constraints pose these bones, and no bone that can be posed turns them by itself."""

    bones: tuple[str, ...]
