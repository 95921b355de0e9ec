"""The readable table."""

from collections.abc import Sequence

from .solve import Json


def table(rows: Sequence[Json]) -> str:
    lines = [
        f"{'rms error, BW; ours / plain':34}"
        + "".join(f"{axis:^33}" for axis in ("vertical 10, 15, 20 Hz", "forward", "sideways"))
    ]
    ratios, ours = [], []
    for row in rows:
        if "refused" in row:
            lines.append(f"{row['trial']:34}refused: {row['refused']}")
            continue
        cells = []
        for axis in (2, 0, 1):
            cells += [f"{e['ours'][axis]:.3f}/{e['baseline'][axis]:.3f}" for e in row["errors"]]
        at15 = row["errors"][1]
        ours.append(at15["ours"])
        ratios.append(at15["ours"][2] / at15["baseline"][2])
        lines.append(f"{row['trial']:34}" + "  ".join(cells) + f"  ratio {ratios[-1]:.2f}")
    n = len(ours)
    if n:
        means = [sum(o[k] for o in ours) / n for k in (2, 0, 1)]
        lines.append(
            f"mean of {n} at 15 Hz: vertical {means[0]:.3f} BW, {sum(ratios) / n:.2f} of plain "
            f"differentiation (worst {max(ratios):.2f}); forward {means[1]:.3f}, sideways {means[2]:.3f}"
        )
    return "\n".join(lines)
