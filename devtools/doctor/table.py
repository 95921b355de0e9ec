"""docs/doctor.md: the figures, and a row for each damage."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...solver.data.constants import STANDARD_GRAVITY
from ..figures.limits import WorstFigure
from .fits import FittedClip
from .measure import Examined

HEAD = """# The doctor

`python3 dev.py doctor --table --out DIR` measures these anew (about {minutes:.0f} minutes on a busy
machine with 2 cores) and wrote this page; `DIR/figures.json` has every number.
"""
NOTES = """
The clips of `examples/recordings` (the first 5 s, from where the rest pose ends that some begin
with) are damaged in the ways of `devtools/doctor/damages`, diagnosed and repaired. *Found*:
named rightly, of two damages both. *Off*: rms distance of all joints from the undamaged clip at
the same frame, before and after all remedies that the doctor offers, its mistaken ones too; of a
clock that is wrong no joint is off. *Scale off*: of the factor of time or
size, median and worst over the clips where it was found. One clip has a fault of its own, whose
finding is no false alarm: the hips of rokoko_jesse_dance leap in frames 8 to 13, and the feet are
4 to 16 cm above the floor from then on; it is mended before it is damaged. Limbs are exchanged from
where they differ most; that of legs which the noise of video makes alike at its ends is not told.
A flight among others is retimed where a clip has two that tell a clock, of 0.2 s or more.

Time and size are told from gravity in the flights, no nearer than the clip itself has it: {bound}
A run's flights of 0.1 s do not tell enough, but where the frame rate that they tell is near a usual
one, that one is taken, and all clips here were recorded at a usual one. So is the ratio of two
units that is near for a size; size × 1.6 is none. Drift cannot be told from runs, whose feet stand
still for no more than moments, and how a body floats not from hops on the balls of the feet either:
it takes feet that stand flat for a third of a second. Between stances it is reckoned, not seen.
Who hops or swings the arms on one spot is in place as it is. A body that is below the floor for so
long that it stands there is told as standing on another height. A floor that slopes is told of who
goes somewhere, by flights of 0.3 s from 1.6° on also on one spot, and of runs, whose stances are
short, in the place of a rise.
"""
FITS_HEAD = """# Fits of what the doctor repairs

`python3 dev.py doctor --fits --out DIR` measures these anew (about {minutes:.0f} minutes on a busy
machine with 2 cores) and wrote this page; `DIR/fits.json` has every number.
"""
FITS_NOTES = """
The clips of `docs/doctor.md`, each with one damage of every finding and the noise of video,
repaired by all that the doctor offers and then fitted with nothing else said. *Valid*: the fit ends
with a motion in which the laws of motion and its contacts hold. *Off the clip*: rms distance of the
joint centres from the repaired clip that was fitted, *off the original* from the undamaged one at
the same frames; median and worst over the clips. *Slides*: the furthest that a contact slides while
it carries. *Let go*: contacts that were found but that the fit does not hold; *carried*: the most
of a clip in which something unseen carries the body. It tells both, for with these a fit can always
end: {released} of {fits} fits let go of a contact, and in {carried} something carries. The last row
holds the longest parts of the clips, of at most 5 s, in which nothing flies.
"""
FITS_COLUMNS = (
    *("damage", "clips", "valid", "off the clip (cm)", "off the original (cm)"),
    *("slides (mm)", "let go", "carried (%)"),
)
COLUMNS = (
    *("damage", "clips", "found", "other findings", "off before (cm)", "after (cm)"),
    "scale off, median (worst) %",
)


def page(examined: Sequence[Examined], found: Sequence[WorstFigure], minutes: float) -> str:
    """The whole page."""
    damages = dict.fromkeys(each.damage for each in examined if each.damage)
    rows = [row([e for e in examined if e.damage == damage]) for damage in damages]
    lines = [
        HEAD.format(minutes=max(minutes, 1.0)),
        *figure_table(found),
        NOTES.format(bound=bound(examined)),
        f"| {' | '.join(COLUMNS)} |",
        f"|{'---|' * len(COLUMNS)}",
        *rows,
    ]
    return "\n".join(lines) + "\n"


def figure_table(found: Sequence[WorstFigure]) -> list[str]:
    """Lines of the figures' table."""
    return [
        "| figure | found | unit | must | aim | | where |",
        "|---|---|---|---|---|---|---|",
        *(
            f"| {f.name} | {f.value:.3g} | {f.unit} | {f.must:g} | {f.aim:g} | {verdict(f)} "
            f"| {f.where} |"
            for f in found
        ),
    ]


def row(alike: Sequence[Examined]) -> str:
    """A damage's row, over its clips."""
    errors = [100.0 * e.scale_error for e in alike if e.scale_error is not None]
    missed = [e.clip for e in alike if not e.found]
    scale = f"{np.median(errors):.1f} ({max(errors):.1f})" if errors else ""
    others = sorted({kind for e in alike for kind in e.false})
    before, after = (100.0 * float(np.mean([getattr(e, n) for e in alike])) for n in BOTH)
    cells = (
        alike[0].damage,
        str(len(alike)),
        f"{len(alike) - len(missed)}" + (f" (not {', '.join(missed)})" if missed else ""),
        ", ".join(others),
        f"{before:.1f}",
        f"{after:.1f}",
        scale,
    )
    return f"| {' | '.join(cells)} |"


def fits_page(fitted: Sequence[FittedClip], found: Sequence[WorstFigure], minutes: float) -> str:
    """The whole page of the fits."""
    damages = dict.fromkeys(each.damage for each in fitted)
    rows = [fits_row([e for e in fitted if e.damage == damage]) for damage in damages]
    lines = [
        FITS_HEAD.format(minutes=max(minutes, 1.0)),
        *figure_table(found),
        FITS_NOTES.format(
            fits=len(fitted),
            released=sum(each.let_go > 0 for each in fitted),
            carried=sum(each.carried > 0.0 for each in fitted),
        ),
        f"| {' | '.join(FITS_COLUMNS)} |",
        f"|{'---|' * len(FITS_COLUMNS)}",
        *rows,
        *(f"\n{e.clip}, {e.damage or 'clean'}: {e.said}" for e in fitted if not e.valid),
    ]
    return "\n".join(lines) + "\n"


def fits_row(alike: Sequence[FittedClip]) -> str:
    """A damage's row, over its clips."""
    valid = [each for each in alike if each.valid]
    failed = ", ".join(each.clip for each in alike if not each.valid)
    cells = [alike[0].damage or "none", str(len(alike)), str(len(valid))]
    cells[2] += f" (not {failed})" if failed else ""
    for name in ("off_fitted", "off_original"):
        off = [100.0 * float(getattr(each, name)) for each in valid] or [float("nan")]
        cells.append(f"{np.median(off):.1f} ({max(off):.1f})")
    cells.append(f"{1000.0 * max((each.slides for each in valid), default=float('nan')):.2f}")
    cells.append(str(sum(each.let_go for each in valid)))
    cells.append(f"{100.0 * max((each.carried for each in valid), default=float('nan')):.0f}")
    return f"| {' | '.join(cells)} |"


BOTH = ("before", "after")
FAR = 0.3  # s; a flight of a jump, no step of a run


def bound(examined: Sequence[Examined]) -> str:
    """How near the undamaged clips have gravity, in a sentence."""
    falls = [each.falls for each in examined if each.falls is not None]
    if not falls:
        return "none of these has a flight."
    off = np.array([100.0 * abs(f.acceleration / STANDARD_GRAVITY - 1.0) for f in falls])
    far = np.array([f.longest >= FAR for f in falls])
    told = [(f"in the {len(falls)} clips that have flights", off)]
    if far.any():
        told.append((f"in the {far.sum()} with one of {FAR:g} s or more", off[far]))
    words = "; ".join(f"{np.median(o):.1f} % (worst {o.max():.1f}) {where}" for where, o in told)
    return f"undamaged, it is\noff by {words}."


def verdict(figure: WorstFigure) -> str:
    """In a word."""
    if not figure.ok:
        return "missed" if figure.missed else "known miss"
    return "aim" if figure.reached else "ok"


def text(found: Sequence[WorstFigure]) -> str:
    """The figures for a terminal."""
    return "\n".join(
        f"{f.name:<52} {f.value:8.3g} {f.unit:<3} must {f.must:g}: {verdict(f)}  {f.where}"
        for f in found
    )
