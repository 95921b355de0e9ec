"""Made-up batches of any size: manifest and results as cells leave them, with nothing solved."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from random import Random

import numpy as np

from ...batch.collect.gathering import PICTURE
from ...batch.collect.png import write_png
from ...batch.records.manifest import (
    BatchSettings,
    CellPlan,
    Manifest,
    Output,
    version,
    write_manifest,
)
from ...batch.records.result import CELLS, RESULT, CellResult, State

# Names that break what does not take care: letters, quotes, markup, marks of a spreadsheet.
HARD_NAMES = (
    "прыжок с разбега №3.bvh",
    "走り幅跳び 二回目.bvh",
    'a "quoted" <b>bold & hop #1%.bvh',
    "<!-- <script>document.title='broken'.bvh",
    "قفزة.bvh",
    "=2+3, a comma.bvh",
)
REASONS = (
    (
        State.NO_SOLUTION,
        "Landing: {far:.1f} m further than the body gets with what its legs can bear.",
    ),
    (State.NO_SOLUTION, "Nobody can stay up for {far:.1f} s; ask for less height."),
    (State.WRONG_INPUT, "Line 3: unknown key “</script><b>pin</b>”."),
    (State.WRONG_INPUT, "The clip has no frame 140 to 330: it ends at frame 96."),
    (State.FAILED, "The cell's process ended by itself (signal 9); was there enough memory?"),
)
FAILING = 0.06  # share of the cells


def make_batch(
    folder: Path,
    cells: int,
    *,
    clips: int = 20,
    unfinished: int = 0,
    pictures: bool = True,
    names: Sequence[str] = HARD_NAMES,
    seed: int = 13,
) -> Manifest:
    """Write a batch of so many cells: clips with two recipes, whose landings are varied.

    unfinished: cells at the end that have no result. pictures: whether those that are done have
    small ones. names: of the first clips.
    """
    chance = Random(seed)
    outputs = (Output.NPZ, Output.PICTURE) if pictures else (Output.NPZ,)
    settings = BatchSettings(outputs=outputs)
    plans = tuple(_plans(settings, cells, [*names, *_names(clips - len(names))][:clips], chance))
    manifest = Manifest(settings, plans)
    folder.mkdir(parents=True, exist_ok=True)
    write_manifest(folder, manifest)
    drawn = _pictures(folder) if pictures else []
    for k, plan in enumerate(plans[: cells - unfinished]):
        home = folder / CELLS / plan.cell
        home.mkdir(parents=True)
        result = _result(plan, chance, pictures)
        if PICTURE in result.files:
            (home / PICTURE).hardlink_to(drawn[k % len(drawn)])
        (home / RESULT).write_text(result.as_json(), encoding="utf-8")
    return manifest


def _names(count: int) -> Iterator[str]:
    for k in range(count):
        yield f"{('jump', 'hop', 'leap', 'vault')[k % 4]} {k // 4 + 1:03}.bvh"


def _plans(
    settings: BatchSettings, count: int, clips: Sequence[str], chance: Random
) -> Iterator[CellPlan]:
    for k in range(count):
        values = {
            "pin.Landing.forward": round(0.1 * (k // len(clips) % 9), 3),
            "pin.Landing.up": round(chance.uniform(-0.2, 0.4), 3),
            "load.Briefcase.share": (0.0, 0.1, 0.2)[k % 3],
            "mirrored": k % 2 == 1,
            "gravity": 9.81,
        }
        clip = clips[k % len(clips)]
        recipe = ("further.toml", "höher & weiter.toml")[k // len(clips) % 2]
        plan = CellPlan(
            "",
            f"/library/takes/{clip}",
            sha256(clip.encode()).hexdigest(),
            f"/library/recipes/{recipe}",
            sha256(f"{recipe}{values}".encode()).hexdigest(),
            values,
        )
        yield plan.named(k + 1, settings)


def _result(plan: CellPlan, chance: Random, pictures: bool) -> CellResult:
    forward, up = (float(plan.values[f"pin.Landing.{way}"]) for way in ("forward", "up"))
    solve = chance.lognormvariate(-0.2, 0.4)
    result = CellResult(
        cell=plan.cell,
        state=State.DONE,
        clip=Path(plan.clip).name,
        recipe=Path(plan.recipe).name,
        version=version(),
        seconds={"fit": 0.8, "solve": solve, "total": 0.9 + solve},
        values=plan.values,
        files=("log.txt", "report.json", "report.txt"),
    )
    if chance.random() < FAILING:
        state, why = chance.choice(REASONS)
        sentence = why.format(far=round(forward, 1))
        return replace(result, state=state, sentence=sentence, files=("log.txt",))
    peak = 2.4 + 1.8 * max(forward, 0.05) + 0.9 * up + chance.gauss(0.0, 0.12)
    figures = {
        "peak_force_bw": peak,
        "flight_1_s": 0.31 + 0.12 * forward + 0.2 * up + chance.gauss(0.0, 0.01),
        "flight_1_length_m": forward,
        "deepest_crouch_m": 0.62 - 0.14 * forward + chance.gauss(0.0, 0.01),
        "change_joint_centres_rms_cm": 0.4 + 6 * forward**2 + abs(chance.gauss(0.0, 0.2)),
        "momentum_between_nodes_rms_bw_m": math.exp(chance.gauss(-8.0, 0.8)),
        "steps": float(chance.randrange(4, 30)),
        **{f"torque_of_joint_{k:02}_nm": chance.gauss(120.0, 25.0) for k in range(18)},
    }
    headline = (f"Solved: it lands {forward:g} m further.", f"At most {peak:.2f} body weights.")
    files = ("log.txt", "report.json", "report.txt", "trajectory.npz")
    return replace(
        result,
        figures=figures,
        headline=headline,
        files=(*files, PICTURE) if pictures else files,
    )


def _pictures(folder: Path) -> list[Path]:
    """Some small pictures of an arc with dots on it, which cells share by hard links."""
    made = []
    (folder / CELLS).mkdir(exist_ok=True)
    for k in range(8):
        pixels = np.full((196, 480, 3), 247, np.uint8)
        pixels[170:173] = 201
        for t in np.linspace(0.05, 0.95, 240):
            x, y = int(480 * t), int(160 - (30 + 12 * k) * 4 * t * (1 - t))
            pixels[y - 1 : y + 2, x - 1 : x + 2] = (63, 131, 196)
        for t in np.linspace(0.08, 0.92, 8):
            x, y = int(480 * t), int(160 - (30 + 12 * k) * 4 * t * (1 - t))
            pixels[y - 8 : y + 9, x - 5 : x + 6] = (18, 63, 112)
        made.append(folder / f"made up {k}.png")
        write_png(made[-1], pixels)
    return made
