"""Letters for pictures that are made without Blender, from one picture of them all."""

from __future__ import annotations

import unicodedata
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .png import Pixels, read_png

ATLAS = Path(__file__).with_name("letters.png")  # drawn by devtools/batch_page/letters_picture.py
WIDE, HIGH, COLUMNS = 8, 16, 64  # pixels of a letter, letters in a line of the picture
# Latin, Greek and Cyrillic; a box stands for all others.
RANGES = (
    (0x20, 0x7F),
    (0xA1, 0x180),
    (0x386, 0x3CF),
    (0x401, 0x460),
    (0x2013, 0x2015),
    (0x2018, 0x201F),
    (0x2116, 0x2117),
)
BOX = "□"
LETTERS = (
    "".join(
        chr(code) for start, end in RANGES for code in range(start, end) if chr(code).isprintable()
    )
    + "…"
    + BOX
)


@cache
def _letters() -> dict[str, NDArray[np.float32]]:
    """The opacity of each letter's pixels, (HIGH, WIDE), 0 to 1."""
    picture = read_png(ATLAS)[..., 0].astype(np.float32) / 255
    places = (divmod(k, COLUMNS) for k in range(len(LETTERS)))
    cut = (picture[HIGH * y : HIGH * (y + 1), WIDE * x : WIDE * (x + 1)] for y, x in places)
    return dict(zip(LETTERS, cut, strict=True))


def write(
    pixels: Pixels, x: int, y: int, text: str, colour: tuple[int, int, int], room: int
) -> None:
    """Write a line of text into a picture, its upper left corner at x, y, at most `room` pixels
    wide; what is longer ends in "…"."""
    letters = _letters()
    text = unicodedata.normalize("NFC", text)
    most = room // WIDE
    if len(text) > most:
        text = text[: most - 1] + "…"
    for k, letter in enumerate(text):
        opacity = letters.get(letter, letters[BOX])[..., None]
        place = pixels[y : y + HIGH, x + WIDE * k : x + WIDE * (k + 1)]
        place[:] = np.rint(place * (1 - opacity) + np.array(colour) * opacity)
