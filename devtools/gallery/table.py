"""docs/gallery.md: every result's row, the limits, and the thesis's claims beside ours."""

from collections.abc import Iterator, Sequence
from statistics import median

from .claims import claims
from .jobs import Json
from .limits import (
    MEMORY,
    METHODS,
    RESIDUALS,
    SECONDS,
    faults,
    of_method,
    thesis,
    times,
    worst,
)

# Table 6.1: total unknowns and constraints of the thesis's adaptations, by motion. The scan
# has lost its columns; its text tells which is which: 42 DOFs x 24 control points are 1008 unknowns
# without forces, and PCA leaves the constraints without torques as they are.
TABLE_6_1 = {
    "jump": ("1100-2400", "700-1700"),
    "jump pca": ("500-1000", "660-940"),
    "run": ("1300-2900", "800-2000"),
    "run pca": ("520-1130", "800-1100"),
}
HEAD = """# The gallery

`python3 dev.py gallery` makes these results anew, each from its recipe in `examples/gallery`, or
`examples/world` for those in a scene, and wrote this page. A result lies in its folder:
`sheet.png`, `adapted.fbx`, `report.json`, `trajectory.npz`. Recordings: `examples/recordings`.
"""
NOTES = """
Seconds and iterations are those from the stored fit, with one thread of linear algebra. *Flight*
and *ground* are what nothing explains by MuJoCo's inverse dynamics at 960 Hz: force in body weights
and moment in body weights x m, rms. A joint has no residual of its own: its torque is what the
movement needs. *Worst constraint* is measured on the action written into Blender (points, bends,
cones), by MuJoCo (torques, forces), or by the solver between its rows (turns, poses, orientations).
*From the fit*: joint centres and joint angles, rms.
"""


def page(rows: Sequence[Json]) -> str:
    """The page of the thesis's results."""
    parts = [HEAD, *_limits(rows), "", *_rows(rows), NOTES, *_sizes(rows), "", *_claims(rows)]
    return "\n".join(parts).rstrip() + "\n"


def _limits(rows: Sequence[Json]) -> Iterator[str]:
    adapted = thesis(rows)
    yield "| figure | found | must | aim |"
    yield "|---|---|---|---|"
    good = sum(not faults(row) for row in adapted)
    yield f"| results in order | {good} of {len(adapted)} | {len(adapted)} | {len(adapted)} |"
    for key, limit in RESIDUALS.items():
        values = [row["residuals"][key] for row in adapted if "residuals" in row]
        if values:
            name = f"{key.replace('_', ', ')} ({limit.unit}), worst"
            yield f"| {name} | {max(values):.2g} | {limit.must:g} | {limit.aim:g} |"
    for method, limit in SECONDS.items():
        taken = times(adapted, method)
        found = f"{median(taken):.2f}" if taken else "not measured"
        yield f"| {method} (s), median | {found} | {limit.must:g} | {limit.aim:g} |"
    memory = [
        m["peak_memory_gb"] for r in rows for m in r.get("methods", {}).values() if "rows" in m
    ]
    if memory:
        yield f"| peak memory (GB) | {max(memory):.2f} | {MEMORY.must:g} | {MEMORY.aim:g} |"


def _rows(rows: Sequence[Json]) -> Iterator[str]:
    yield (
        "| result | unknowns; constraints | implicit (q, λ) | implicit (q, τ, λ) | explicit "
        "| flight | ground | worst constraint | torque (N·m) | force (BW) | from the fit | |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|---|---|"
    for row in rows:
        yield "| " + " | ".join(cells(row)) + " |"


def cells(row: Json) -> Iterator[str]:
    """The cells of a result's row."""
    yield link(row)
    unknowns, count = (of_method(row, "implicit", key) for key in ("unknowns", "rows"))
    yield "" if unknowns is None else f"{unknowns:.0f}; {count:.0f}"
    for method in METHODS:
        yield _solution(row, method)
    left = row.get("residuals")
    for where in ("flight", "ground"):
        yield f"{left[f'{where}_force']:.1g}; {left[f'{where}_moment']:.1g}" if left else ""
    missed = worst(row)
    yield "" if missed is None else f"{missed['worst']:.2g} {missed['unit']} ({missed['name']})"
    loads, away = row.get("loads"), row.get("from_fit")
    yield f"{loads['peak_torque_nm']:.0f} ({loads['peak_torque_at']})" if loads else ""
    yield f"{loads['peak_force_bw']:.1f}" if loads else ""
    yield f"{away['joint_centres_rms_cm']:.1f} cm; {away['angles_rms_deg']:.1f}°" if away else ""
    wrong = faults(row)
    yield f"**failed**: {'; '.join(wrong)}" if wrong else "in order"


def _solution(row: Json, method: str) -> str:
    solved = row.get("methods", {}).get(method)
    if solved is None:
        return ""
    return f"{solved['seconds']:.2f} s; {solved['iterations']}"


def link(row: Json) -> str:
    """A result's name, linked to its recipe."""
    return f"[{row['title'].partition(':')[0]}](../examples/{row['page']}/{row['name']}.toml)"


def _sizes(rows: Sequence[Json]) -> Iterator[str]:
    yield "| motion | unknowns here | Table 6.1 | constraints here | Table 6.1 |"
    yield "|---|---|---|---|---|"
    for motion, (unknowns, constraints) in TABLE_6_1.items():
        mine = [row for row in rows if _motion(row["name"]) == motion]
        ours = [
            [v for row in mine if (v := of_method(row, "implicit", key)) is not None]
            for key in ("unknowns", "rows")
        ]
        if all(ours):
            a, b = (f"{min(values):.0f}-{max(values):.0f}" for values in ours)
            yield f"| {motion} | {a} | {unknowns} | {b} | {constraints} |"


def _motion(name: str) -> str:
    kind = "run" if name.startswith("run_") else "jump"
    return f"{kind} pca" if name.endswith("_pca") else kind


def _claims(rows: Sequence[Json]) -> Iterator[str]:
    yield "| the thesis reports | found here | |"
    yield "|---|---|---|"
    for claim in claims({row["name"]: row for row in rows}):
        mark = {True: "found again", False: "not found", None: "open"}[claim.holds]
        yield f"| {claim.thesis} | {claim.found} | {mark} |"


def line(row: Json) -> str:
    """One result in a terminal's line."""
    first = row.get("methods", {}).get("implicit", {})
    time = f"{first['seconds']:6.2f} s {first['iterations']:3d} steps" if first else " " * 18
    wrong = faults(row)
    return f"{row['name']:28}{time}  {'; '.join(wrong) if wrong else 'in order'}"
