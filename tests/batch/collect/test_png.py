"""PNG files: every filter of the format by its definition, and files that are damaged."""

from pathlib import Path

import numpy as np
import pytest
from hangtime.batch.collect.png import UnreadablePicture, read_png, shrunk, unfiltered, write_png

CHANCE = np.random.default_rng(5)


def predicted(kind: int, left: int, above: int, corner: int) -> int:
    """PNG specification, 9.2 to 9.4."""
    estimate = left + above - corner
    far = [abs(estimate - left), abs(estimate - above), abs(estimate - corner)]
    paeth = (left, above, corner)[far.index(min(far))]
    return (0, left, above, (left + above) // 2, paeth)[kind]


def filtered(pixels: np.ndarray, kinds: np.ndarray) -> np.ndarray:
    """Each pixel less its prediction, one by one."""
    height, width, channels = pixels.shape
    framed = np.zeros((height + 1, width + 1, channels), int)
    framed[1:, 1:] = pixels
    found = np.zeros_like(pixels)
    for y, x, c in np.ndindex(pixels.shape):
        guess = predicted(kinds[y], framed[y + 1, x, c], framed[y, x + 1, c], framed[y, x, c])
        found[y, x, c] = (int(pixels[y, x, c]) - guess) % 256
    return found


@pytest.mark.parametrize("shape", [(7, 9, 3), (9, 4, 4), (1, 5, 1), (6, 1, 3)])
def test_lines_of_all_filters_are_read(shape: tuple[int, int, int]) -> None:
    pixels = CHANCE.integers(0, 256, shape, dtype=np.uint8)
    kinds = (np.arange(shape[0]) % 5).astype(np.uint8)
    assert np.array_equal(unfiltered(kinds, filtered(pixels, kinds)), pixels)
    every = CHANCE.integers(0, 5, shape[0]).astype(np.uint8)
    assert np.array_equal(unfiltered(every, filtered(pixels, every)), pixels)


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    pixels = CHANCE.integers(0, 256, (20, 31, 3), dtype=np.uint8)
    write_png(tmp_path / "a.png", pixels)
    assert np.array_equal(read_png(tmp_path / "a.png"), pixels)


@pytest.mark.parametrize("kept", [0, 20, 40, 90])
def test_a_damaged_file_is_told_as_such(tmp_path: Path, kept: int) -> None:
    write_png(tmp_path / "a.png", CHANCE.integers(0, 256, (20, 31, 3), dtype=np.uint8))
    content = (tmp_path / "a.png").read_bytes()
    (tmp_path / "a.png").write_bytes(content[:kept])
    with pytest.raises(UnreadablePicture):
        read_png(tmp_path / "a.png")


def test_a_picture_shrinks_in_its_proportions_to_means() -> None:
    pixels = np.zeros((40, 100, 3), np.uint8)
    pixels[:, 50:] = 200
    small = shrunk(pixels, 20, 20)
    assert small.shape == (8, 20, 3)
    assert small[:, :10].max() == 0
    assert small[:, 10:].min() == 200
    assert shrunk(pixels[:10, :10], 20, 20).shape == (10, 10, 3)
