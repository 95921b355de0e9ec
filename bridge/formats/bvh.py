"""Reader of Biovision files (.bvh), laid out line by line as Blender's importer wants them."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...solver.arrays import FloatArray
from .motion_clip import Joint, MotionClip, euler_matrices
from .text import Line, Reader, require_finite

FARTHEST = 1e7  # units of the file, of a joint from its parent
MOST_DIGITS = 9  # of a number of frames, which are three months at 120 a second
FRAME_TIMES = (1e-4, 1e4)  # s; Blender's scenes have no rates far beyond, and no camera has
_CHANNELS = {f"{axis}{kind}" for axis in "xyz" for kind in ("position", "rotation")}


@dataclass
class _Draft:
    """A joint while its block is read; channels are lower case, in the file's order."""

    name: str
    parent: int
    offset: FloatArray = field(default_factory=lambda: np.zeros(3))
    channels: list[str] = field(default_factory=list)
    tip: FloatArray | None = None


def read_bvh(path: str | Path, rate: float | None = None) -> MotionClip:
    """Read a BVH file.

    A position channel replaces the joint's offset, as in Blender. Rotations are multiplied in the
    order of the channels. The frame time is the rate's that the printed digits stand for, or
    of the rate that is given, Hz. All lines of motion are read, also where fewer are announced.
    Raises UnreadableClip (with the line) and NonFiniteKey (frames counted from 1).
    """
    reader = Reader(Path(path))
    drafts = _hierarchy(reader)
    announced, frame_time, table = _motion(reader, drafts)
    return MotionClip(
        reader.path.stem,
        tuple(Joint(d.name, d.parent, d.offset, d.tip) for d in drafts),
        *_poses(drafts, table),
        frame_time if rate is None else 1.0 / rate,
        miscount=(announced, len(table)) if announced < len(table) else None,
    )


def _hierarchy(reader: Reader) -> list[_Draft]:
    first = reader.take("HIERARCHY")
    if not first.starts("hierarchy"):
        reader.fail(first.number, "a BVH file begins with HIERARCHY")
    drafts: list[_Draft] = []
    while (line := reader.take("ROOT or MOTION")) and not line.starts("motion"):
        if not line.starts("root"):
            reader.fail(line.number, f"'{line.words[0]}' where ROOT or MOTION should stand")
        _tree(reader, line, drafts)
    if not drafts:
        reader.fail(line.number, "no ROOT before MOTION")
    return drafts


def _tree(reader: Reader, title: Line, drafts: list[_Draft]) -> None:
    """A root and all below it, by a stack: chains may be longer than calls may be nested."""
    begun = [_joint(reader, title, -1, drafts)]
    while begun:
        draft = drafts[begun[-1]]
        line = reader.take(f"}} of '{draft.name}'")
        if line.starts("}"):
            begun.pop()
        elif line.starts("joint"):
            begun.append(_joint(reader, line, begun[-1], drafts))
        elif line.starts("end", "site"):
            _brace(reader, "{")
            draft.tip = _offset(reader)
            _brace(reader, "}")
        else:
            reader.fail(line.number, f"'{line.words[0]}' where JOINT, End Site or }} should stand")


def _joint(reader: Reader, title: Line, parent: int, drafts: list[_Draft]) -> int:
    """Index of the joint whose block begins here, with its offset and channels."""
    draft = _Draft(_unique_name(reader, title, drafts), parent)
    drafts.append(draft)
    _brace(reader, "{")
    draft.offset = _offset(reader)
    draft.channels = _channels(reader)
    return len(drafts) - 1


def _unique_name(reader: Reader, title: Line, drafts: list[_Draft]) -> str:
    """Joint name as Blender spells it: words joined by underscores, doubles numbered."""
    if len(title.words) < 2:
        reader.fail(title.number, f"{title.words[0]} without a name")
    taken = {draft.name for draft in drafts}
    name = plain = "_".join(title.words[1:])
    count = 0
    while name in taken:
        count += 1
        name = f"{plain}.{count:03d}"
    return name


def _brace(reader: Reader, brace: str) -> None:
    line = reader.take(brace)
    if line.words != [brace]:
        reader.fail(line.number, f"{brace} should stand here, alone on its line")


def _offset(reader: Reader) -> FloatArray:
    line = reader.take("OFFSET")
    if not line.starts("offset"):
        reader.fail(line.number, f"'{line.words[0]}' where OFFSET should stand")
    offset = reader.numbers(line.number, line.words[1:], 3)
    if np.abs(offset).max() > FARTHEST:
        problem = f"an offset of {np.abs(offset).max():g} is no bone's; correct it, or export anew"
        reader.fail(line.number, problem)
    return offset


def _channels(reader: Reader) -> list[str]:
    line = reader.take("CHANNELS")
    if not line.starts("channels"):
        reader.fail(line.number, f"'{line.words[0]}' where CHANNELS should stand")
    count = len(line.words[2:])
    if line.words[1:2] != [str(count)]:
        reader.fail(line.number, f"{count} channels are named, another number is announced")
    names = reader.channels(line.number, line.words[2:], _CHANNELS)
    if sum(name.endswith("rotation") for name in names) not in (0, 3):
        reader.fail(line.number, "a joint has no rotation channel or three")
    return names


def _motion(reader: Reader, drafts: list[_Draft]) -> tuple[int, float, FloatArray]:
    """Frames announced, frame time, s, and channel values (T, C), units and degrees."""
    announced = _frame_count(reader)
    frame_time = _frame_time(reader)
    owners = [draft.name for draft in drafts for _ in draft.channels]
    rows = []
    while (line := reader.peek()) is not None:
        reader.next += 1
        rows.append(reader.keys(line.number, line.words, len(owners)))
    if len(rows) < announced:
        reader.fail(reader.last_line, f"the file ends after {len(rows)} of {announced} frames")
    table = np.array(rows)
    require_finite(table, owners)
    return announced, frame_time, table


def _frame_count(reader: Reader) -> int:
    line = reader.take("Frames:")
    if not line.starts("frames:") or len(line.words) != 2 or not line.words[1].isdecimal():
        reader.fail(line.number, "'Frames:' and a whole number should stand here")
    if len(line.words[1]) > MOST_DIGITS:
        reader.fail(line.number, f"'{line.words[1][:MOST_DIGITS]}…' is no number of frames")
    if int(line.words[1]) == 0:
        reader.fail(line.number, "the file holds no frames")
    return int(line.words[1])


def _frame_time(reader: Reader) -> float:
    line = reader.take("Frame Time:")
    if not line.starts("frame", "time:"):
        reader.fail(line.number, "'Frame Time:' and the seconds should stand here")
    seconds = reader.numbers(line.number, line.words[2:], 1)[0]
    if seconds <= 0.0:
        reader.fail(line.number, "the frame time is not positive")
    least, most = FRAME_TIMES
    if not least <= seconds <= most:
        problem = f"'{line.words[2]}' is no frame time, which is from {least:g} to {most:g} s"
        reader.fail(line.number, f"{problem}; write 1 / the frames a second, such as 0.0083333")
    return _unrounded(line.words[2], seconds)


def _unrounded(printed: str, seconds: float) -> float:
    """Frame time of the whole or television (x/1.001) rate that rounds to what is printed."""
    digits = printed.lower().partition("e")[0].partition(".")[2]
    slack = 0.5001 * 10.0 ** -len(digits) if "e" not in printed.lower() else 0.0
    for second in (1.0, 1.001):
        rate = round(second / seconds)
        if rate and abs(second / rate - seconds) <= slack:
            return second / rate
    return seconds


def _poses(drafts: list[_Draft], table: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Positions (T, J, 3) and rotations (T, J, 3, 3), each in the parent's frame."""
    frames, joints = len(table), len(drafts)
    positions = np.empty((frames, joints, 3))
    matrices = np.empty((frames, joints, 3, 3))
    column = 0
    for j, draft in enumerate(drafts):
        values = table[:, column : column + len(draft.channels)]
        column += len(draft.channels)
        spins = [c for c, name in enumerate(draft.channels) if name.endswith("rotation")]
        moves = [c for c, name in enumerate(draft.channels) if name.endswith("position")]
        axes = ["xyz".index(name[0]) for name in draft.channels]
        matrices[:, j] = euler_matrices([axes[c] for c in spins], np.radians(values[:, spins]))
        positions[:, j] = 0.0 if moves else draft.offset
        for c in moves:
            positions[:, j, axes[c]] = values[:, c]
    return positions, matrices
