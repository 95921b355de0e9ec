"""Claims of the thesis about its results (chapter 6), checked on ours."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from .jobs import Json
from .limits import METHODS, of_method

Rows = Mapping[str, Json]
SEEN = 0.02  # m; an arm that moves less is not seen to move


@dataclass(frozen=True)
class Claim:
    """thesis: what it says. found: what we measured. holds: None where nothing can be said yet."""

    thesis: str
    found: str
    holds: bool | None


def claims(rows: Rows) -> list[Claim]:
    """Every claim that the results at hand speak of."""
    makers: tuple[Callable[[Rows], Iterator[Claim]], ...] = (_order, _crouch, _arms, _pca)
    return [claim for make in makers for claim in make(rows)]


def _order(rows: Rows) -> Iterator[Claim]:
    says = (
        "implicit (q, λ) is always fastest, then implicit (q, τ, λ), explicit slowest almost always"
    )
    timed: list[list[float]] = []
    for row in rows.values():
        times = [s for method in METHODS if (s := of_method(row, method, "seconds")) is not None]
        if len(times) == len(METHODS) and not row["name"].endswith("_fit"):
            timed.append(times)
    if not timed:
        yield Claim(says, "the other two solutions are not timed yet", None)
        return
    first = sum(t[0] == min(t) for t in timed)
    last = sum(t[2] == max(t) for t in timed)
    words = f"implicit fastest in {first} and explicit slowest in {last} of {len(timed)}"
    yield Claim(says, words, first == len(timed) and last > 0.8 * len(timed))


def _crouch(rows: Rows) -> Iterator[Claim]:
    pairs = (("jump_fit", "diagonal"), ("jump_fit", "step_landing"), ("run_fit", "run_hurdle"))
    for start, name in pairs:
        rise = _change(rows, start, name, "crouch_m")
        if rise is not None:
            words = f"{name}: {-100 * rise:+.1f} cm deeper"
            yield Claim("a longer or higher jump crouches deeper", words, rise < 0.0)


def _arms(rows: Rows) -> Iterator[Claim]:
    out = _change(rows, "jump_fit", "briefcase", "left_hand_out_m")
    if out is not None:
        words = f"left hand {100 * out:+.1f} cm further from the centre of mass in flight"
        yield Claim("briefcase: the left arm extends far out", words, out > SEEN)
    rise = _change(rows, "jump_fit", "limp_arm", "left_arm_raised_m")
    if rise is not None:
        words = f"left hand {100 * rise:+.1f} cm higher above its shoulder in flight"
        yield Claim("limp arm: the other arm rises much higher", words, rise > SEEN)


def _pca(rows: Rows) -> Iterator[Claim]:
    for name in ("diagonal", "half_twist_right", "run_cross_step", "run_wide_step"):
        full, reduced = rows.get(name), rows.get(f"{name}_pca")
        if not full or not reduced or "from_fit" not in full or "from_fit" not in reduced:
            continue
        times = [of_method(row, "implicit", "seconds") for row in (full, reduced)]
        away = [row["from_fit"]["angles_rms_deg"] for row in (full, reduced)]
        if None in times:
            continue
        words = (
            f"{name}: full {times[0]:.2f} s and {away[0]:.1f}° from the fit, "
            f"PCA {times[1]:.2f} s and {away[1]:.1f}°"
        )
        slower, further = times[1] >= times[0], away[1] >= away[0]  # type: ignore[operator]
        yield Claim("PCA is slower and no better than the full figure", words, slower and further)


def _change(rows: Rows, start: str, name: str, key: str) -> float | None:
    """Change of a measure of shape from one result to another; None where either lacks it."""
    was, now = (rows.get(n, {}).get("shape", {}).get(key) for n in (start, name))
    return None if was is None or now is None else float(now - was)
