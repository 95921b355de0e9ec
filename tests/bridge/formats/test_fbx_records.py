"""A damaged FBX is told before Blender's importer asks for all memory over it."""

from pathlib import Path
from struct import Struct

import pytest
from hangtime.bridge.formats.fbx_records import MAGIC, require_sound
from hangtime.solver.data.faults import UnreadableClip
from hangtime.tests.helpers.clips import mocap_path

RUN = mocap_path("09_11_cmu.fbx")
FIRST = len(MAGIC) + 4  # where the first record begins: its end, number and length of values
END, COUNT, LENGTH = range(3)


def test_a_sound_file_passes() -> None:
    require_sound(RUN)


def test_what_is_no_binary_fbx_is_left_to_the_importer(tmp_path: Path) -> None:
    path = tmp_path / "text.fbx"
    path.write_text("; FBX 7.3.0 project file", encoding="utf-8")
    require_sound(path)


@pytest.mark.parametrize(
    ("content", "words"),
    [(b"", "empty"), (b"\n", "empty"), (b"HIERARCHY\nROOT Hips", "BVH"), (b"\x89PNG", "no FBX")],
)
def test_what_is_no_fbx_at_all_is_told(content: bytes, words: str, tmp_path: Path) -> None:
    with pytest.raises(UnreadableClip, match=words):
        require_sound(written(tmp_path, content))


@pytest.mark.parametrize("place", [END, COUNT, LENGTH])
@pytest.mark.parametrize("value", [1, 2**31, 2**32 - 1])
def test_counts_that_cannot_be_are_told(place: int, value: int, tmp_path: Path) -> None:
    data = bytearray(RUN.read_bytes())
    Struct("<I").pack_into(data, FIRST + 4 * place, value)
    with pytest.raises(UnreadableClip, match="damaged"):
        require_sound(written(tmp_path, bytes(data)))


def test_an_array_longer_than_its_bytes_can_hold_is_told(tmp_path: Path) -> None:
    data = RUN.read_bytes()
    at = data.index(b"\x07KeyTime") + len(b"\x07KeyTime") + 1
    count = Struct("<I").pack(2**32 - 1)
    with pytest.raises(UnreadableClip, match="counted"):
        require_sound(written(tmp_path, data[:at] + count + data[at + 4 :]))


@pytest.mark.parametrize("size", [FIRST - 2, FIRST, 1000, 100_000])
def test_a_file_that_is_cut_off_is_told(size: int, tmp_path: Path) -> None:
    with pytest.raises(UnreadableClip, match="damaged"):
        require_sound(written(tmp_path, RUN.read_bytes()[:size]))


def written(folder: Path, data: bytes) -> Path:
    """A file of these bytes."""
    path = folder / "clip.fbx"
    path.write_bytes(data)
    return path
