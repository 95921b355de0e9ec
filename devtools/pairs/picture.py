"""A pair as stick figures from the side: source, ours and person at four instants, as SVG."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from ...solver.arrays import FloatArray
from .phased_jump import PhasedJump

SCALE = 150.0  # pixels a metre
BACK, AHEAD, HIGH = 0.75, 1.85, 2.15  # m, of a panel behind, before and above the take-off place
FOOT = 40.0  # pixels below the floor, for words
COLOURS = {"source": "#9a9a9a", "person": "#2563b0", "ours": "#d0342c"}  # drawn in this order
Bones = Sequence[tuple[int, int]]  # (parent, child) joints


def draw(jumps: Mapping[str, PhasedJump], bones: Bones, title: str, path: Path) -> None:
    """Writes the picture. jumps: by the names in COLOURS."""
    panel, height = SCALE * (BACK + AHEAD), SCALE * HIGH + FOOT
    names = list(jumps["source"].instants())
    width = panel * len(names)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        f'font-family="sans-serif" font-size="15">',
        '<rect width="100%" height="100%" fill="white"/>',
        f'<text x="12" y="22">{title}</text>',
    ]
    for i, (who, colour) in enumerate(COLOURS.items()):
        lines.append(f'<text x="{12 + 80 * i}" y="44" fill="{colour}">{who}</text>')
    for i, name in enumerate(names):
        lines.append(
            f'<g transform="translate({i * panel + SCALE * BACK:.0f} {SCALE * HIGH:.0f})">'
        )
        floor = f"M{-SCALE * BACK:.0f} 0H{SCALE * AHEAD:.0f}M0 0v8"
        lines.append(f'<path d="{floor}" stroke="#444" fill="none"/>')
        lines.append(f'<text x="0" y="28" text-anchor="middle">{name}</text>')
        for who, colour in COLOURS.items():
            lines += _figure(jumps[who].instants()[name], bones, colour)
        lines.append("</g>")
    path.write_text("\n".join([*lines, "</svg>"]) + "\n", encoding="utf-8")


def _figure(centres: FloatArray, bones: Bones, colour: str) -> Iterator[str]:
    """A stick figure of joint centres (B, 3) m, jump frame."""
    at = SCALE * centres[:, [0, 2]] * [1.0, -1.0]
    strokes = "".join(
        f"M{at[a, 0]:.1f} {at[a, 1]:.1f}L{at[b, 0]:.1f} {at[b, 1]:.1f}" for a, b in bones
    )
    yield f'<path d="{strokes}" stroke="{colour}" stroke-width="3" stroke-linecap="round"/>'
