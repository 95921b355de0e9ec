"""What the pairs tell, as text, JSON and docs/pairs.md."""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from .compare import ComparedPair, FailedPair
from .limits import MEASURES, PairsFigure

SHARES = {  # columns of a pair's row: measure, heading
    "crouch_cm": "crouch",
    "take_off_speed": "vz",
    "apex_cm": "apex",
    "flight_time_ms": "flight",
    "arm_swing_deg": "arms",
    "push_time_ms": "push t",
    "peak_push_bw": "peak",
}


def text(
    figures: Sequence[PairsFigure], pairs: Sequence[ComparedPair], failed: Sequence[FailedPair]
) -> str:
    """For a terminal: a line a pair, then the figures."""
    head = f"{'pair':28}{'further':>8}  {'distance to the target, cm: crouch/flight/landing':58}"
    head += "".join(f"{name:>8}" for name in SHARES.values())
    lines = [head, f"{'':38}{'unchanged':16}{'slid':16}{'ours':16}{'its fit':16}shares of change"]
    lines += [_line(pair) for pair in pairs if not pair.to_itself]
    lines += [f"{f.source} → {f.target}, {f.solution}: failed: {f.why}" for f in failed]
    lines += ["", f"{'figure':56}{'value':>8} {'unit':4}{'pairs':>6}  {'must':14}{'aim':14}"]
    for f in figures:
        value = "–" if f.value is None else f"{f.value:.2f}"
        verdict = "" if f.ok else "MISSED"
        limits = f"{interval(f.must):14}{interval(f.aim):14}"
        lines.append(
            f"{f.name:56}{value:>8} {f.unit:4}{f.count:6d}  {limits}{verdict} {f.solution}"
        )
    return "\n".join(lines)


def _line(pair: ComparedPair) -> str:
    distances = (pair.unchanged, pair.slid, pair.ours, pair.bound)
    words = "".join(f"{'/'.join(f'{x:.1f}' for x in d.values()):16}" for d in distances)
    shares = "".join(f"{share(pair, name):>8}" for name in SHARES)
    return f"{f'{pair.source} → {pair.target}':28}{100 * pair.further:+6.0f}cm  {words}{shares}"


def share(pair: ComparedPair, measure: str) -> str:
    """A share, as text; – where the person changed nothing."""
    value = pair.share(measure)
    return "–" if value is None else f"{value:.2f}"


def interval(limits: tuple[float, float]) -> str:
    """Such as 0.5 to 1.2; empty where anything will do."""
    return "" if math.isinf(limits[1]) else f"{limits[0]:g} to {limits[1]:g}"


def write_json(
    figures: Sequence[PairsFigure],
    pairs: Sequence[ComparedPair],
    failed: Sequence[FailedPair],
    path: Path,
) -> None:
    """figures.json: figures, pairs and failures."""
    content = {
        "measures": MEASURES,
        "figures": [asdict(f) | _limits(f) | {"ok": f.ok} for f in figures],
        "pairs": [pair.record() for pair in pairs],
        "failed": [asdict(pair) for pair in failed],
    }
    path.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def _limits(figure: PairsFigure) -> dict[str, list[float] | None]:
    """JSON knows no infinity."""
    limits = {"must": figure.must, "aim": figure.aim}
    return {name: None if math.isinf(x[1]) else list(x) for name, x in limits.items()}
