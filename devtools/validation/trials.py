"""Trials: recordings with measured ground forces, in the format that docs/validation.md tells.

X.bvh (cm, Y up, +Z forward, +X left), X_grf.csv (per foot: force on the body, N, and centre of
pressure, m), X_com.csv (the model's centre of mass, m) and X.json, all in the same axes and times.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.data.requests import Vector

UNIT = 0.01  # m per unit of the BVH
AXES = np.array([2, 0, 1])  # forward, left and up among the files' x, y, z
EDGE = 0.06  # s, that a filter spoils at an end
FEET = ("Left", "Right")


@dataclass(frozen=True)
class GroundForces:
    """Ground forces on both feet at instants (T,) s, a uniform grid.

    feet: (T, 2, 3) body weights, left foot first; forward, left, up. pressure: (T, 2, 2) m, forward
    and left, centre of pressure, meaningless where a foot carries nothing.
    """

    times: FloatArray
    feet: FloatArray
    pressure: FloatArray

    @property
    def rate(self) -> float:
        """Hz."""
        return (len(self.times) - 1) / float(self.times[-1] - self.times[0])

    @property
    def total(self) -> FloatArray:
        """(T, 3) sum over both feet, body weights."""
        return np.asarray(self.feet.sum(axis=1))


@dataclass(frozen=True)
class Trial:
    """One trial. facts: X.json. com: (T, 3) m at com_times (T,) s; forward, left, up."""

    name: str
    bvh: Path
    facts: dict[str, Any]
    plates: GroundForces
    com_times: FloatArray
    com: FloatArray

    @property
    def mass(self) -> float:
        """kg."""
        return float(self.facts["subject_mass_kg"])

    @property
    def kind(self) -> str:
        """Of movement, such as "run"; a "walk" has no flight."""
        return str(self.facts.get("kind", ""))

    @property
    def valid(self) -> tuple[float, float]:
        """The seconds in which all support was measured."""
        start, end = self.facts["valid_window_s"]
        return float(start), float(end)

    @property
    def frames(self) -> tuple[float, float]:
        """The scene's frames in the valid seconds; the file's first frame is scene frame 1."""
        rate = float(self.facts["bvh_fps"])
        first, last = (t * rate for t in self.valid)
        count = int(self.facts["bvh_frames"])
        return 1.0 + np.ceil(first - 1e-3), min(1.0 + np.floor(last + 1e-3), float(count))

    @property
    def compared(self) -> tuple[float, float]:
        """The seconds that are compared: valid ones, without the ends that the filters spoil."""
        start, end = self.facts.get("baseline_window_s", (self.valid[0], self.valid[1] - EDGE))
        return float(start), float(end)

    def stored_baseline(self, cut_off: float) -> Vector | None:
        """Rms of plain differentiation by the trial's own file, body weights: forward, left, up."""
        stored = self.facts.get("direct_differentiation_baseline", {}).get(f"{cut_off:g}Hz")
        if stored is None:
            return None
        forward, left, up = (
            stored[f"rmse_{axis}_BW"] for axis in ("forward", "lateral", "vertical")
        )
        return forward, left, up


def names(folder: Path) -> list[str]:
    """The trials in a folder: recordings with forces."""
    return sorted(path.name.removesuffix("_grf.csv") for path in folder.glob("*_grf.csv"))


def read(folder: Path, name: str) -> Trial:
    """Raises OSError, KeyError and ValueError for files that are not there or not in the format."""
    facts = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
    weight = float(facts["subject_mass_kg"]) * STANDARD_GRAVITY
    table = _table(folder / f"{name}_grf.csv", 13)
    sides = np.stack([table[:, 1:7], table[:, 7:13]], axis=1)
    plates = GroundForces(
        table[:, 0], sides[:, :, :3][..., AXES] / weight, sides[:, :, 3:][..., AXES[:2]]
    )
    com = _table(folder / f"{name}_com.csv", 4)
    return Trial(name, folder / f"{name}.bvh", facts, plates, com[:, 0], com[:, 1:][:, AXES])


def _table(path: Path, columns: int) -> FloatArray:
    """Raises ValueError where a file has other columns."""
    found = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    if found.shape[1] != columns:
        raise ValueError(f"{path.name} has {found.shape[1]} columns, not {columns}")
    return found
