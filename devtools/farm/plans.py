"""Small batches of a real hop, whose landing is varied."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ...batch.planning.plan import Asked, plan
from ...batch.records.manifest import BatchSettings, Manifest
from ...batch.records.result import cell_folder, read_result
from ..recordings import HELD

CLIP = HELD / "hop_01_01.bvh"
NPZ = "trajectory.npz"
RECIPE = """\
[[pin]]
name = "Landing"
phase = "ground 2"
forward = {{ from = 0.0, to = 0.1, steps = {steps} }}
"""


def plan_hops(folder: Path, cells: int, *, check: bool = False) -> Manifest:
    """Plan one clip with so many landings, between where it landed and 0.1 m further."""
    recipe = recipe_of(folder)
    recipe.parent.mkdir(parents=True, exist_ok=True)
    recipe.write_text(RECIPE.format(steps=cells), encoding="utf-8")
    settings = BatchSettings(check=check)
    return plan(Asked(settings, [str(CLIP)], [str(recipe)]), folder).manifest


def recipe_of(folder: Path) -> Path:
    """The recipe of a batch that lies in this folder."""
    return folder.parent / f"{folder.name} recipes" / "hop further.toml"


def contents(folder: Path, manifest: Manifest) -> dict[str, str]:
    """What each cell's result says, as a hash: state, figures and the motion to the last bit, but
    no times. Cells without a result are left out."""
    found = {}
    for cell in (each.cell for each in manifest.cells):
        result = read_result(folder, cell)
        if result is not None:
            told = [result.state.value, result.sentence, result.headline, dict(result.figures)]
            content = hashlib.sha256(json.dumps(told, sort_keys=True).encode())
            if NPZ in result.files:
                content.update(motion(cell_folder(folder, cell) / NPZ))
            found[cell] = content.hexdigest()
    return found


def motion(path: Path) -> bytes:
    """Every array of a trajectory file, by name."""
    with np.load(path) as arrays:
        return b"".join(name.encode() + arrays[name].tobytes() for name in sorted(arrays.files))


def differing(mine: Mapping[str, str], others: Mapping[str, str]) -> list[str]:
    """Cells that two runs have not alike, or that one lacks."""
    return sorted(c for c in mine.keys() | others.keys() if mine.get(c) != others.get(c))


def half_written(folder: Path) -> list[str]:
    """What lies in the batch's folder that is no whole cell or fit."""
    found = [p.name for name in ("cells", "fits") for p in (folder / name).glob(".*") if p.is_dir()]
    strange = [p.name for p in (folder / "cells").iterdir() if read_result(folder, p.name) is None]
    return [*found, *(name for name in strange if name not in found)]
