"""Reader of Acclaim files: a skeleton (.asf) and its motion (.amc).

An ASF bone reaches from its parent's end to its own; its degrees of freedom turn it about its
start, measured in a frame that the file calls its axis.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import pi
from pathlib import Path

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.faults import UnreadableClip
from .guess import likely_unit
from .motion_clip import Joint, MotionClip, euler_matrices
from .text import Line, Reader, require_finite

INCH = 0.0254
USUAL_RATE = 120.0  # Hz; the files do not tell theirs
ROOT = "root"
_DOF = ("rx", "ry", "rz", "tx", "ty", "tz")


@dataclass
class _Part:
    """ASF bone, or the root; axes are counted 0 to 2, angles in degrees or as the file says."""

    name: str
    line: int
    direction: FloatArray = field(default_factory=lambda: np.zeros(3))
    length: float = 0.0
    axis: FloatArray = field(default_factory=lambda: np.eye(3))
    dof: list[str] = field(default_factory=list)
    position: FloatArray = field(default_factory=lambda: np.zeros(3))


@dataclass(frozen=True)
class _Skeleton:
    """parts: parents first, the root at 0. unit: m, None where the file's is implausible."""

    parts: list[_Part]
    parents: list[int]
    degree: float
    unit: float | None


def find_asf(amc: str | Path) -> Path:
    """Find the skeleton beside a motion.

    Of the same stem, else of the stem's part before the last _, else the folder's only one. Raises
    UnreadableClip (of the AMC, no line) where there is none.
    """
    amc = Path(amc)
    folder = amc.parent
    skeletons = sorted(p for p in folder.glob("*") if p.suffix.lower() == ".asf")
    for stem in (amc.stem, amc.stem.rpartition("_")[0]):
        for path in skeletons:
            if path.stem.lower() == stem.lower():
                return path
    if len(skeletons) == 1:
        return skeletons[0]
    count = "no" if not skeletons else "more than one"
    raise UnreadableClip(str(amc), None, f"{count} ASF file lies beside it")


def clip_files(path: str | Path, asf: str | Path | None = None) -> tuple[Path, ...]:
    """A clip's file, and the skeleton that an AMC file needs, where there is one. asf: the one that
    was stated."""
    path = Path(path)
    if path.suffix.lower() != ".amc":
        return (path,)
    if asf is not None:
        return path, Path(asf)
    try:
        return path, find_asf(path)
    except UnreadableClip:  # told when it is read
        return (path,)


def read_acclaim(
    asf_path: str | Path, amc_path: str | Path, rate: float | None = None
) -> MotionClip:
    """Read a skeleton and a motion; rate in Hz, which neither file tells: else the usual one.

    Raises UnreadableClip (with the file and line) and NonFiniteKey (frames counted from 1).
    """
    skeleton = _read_asf(Reader(Path(asf_path)))
    reader = Reader(Path(amc_path))
    tables = _read_amc(reader, skeleton)
    positions, matrices = _poses(skeleton, tables)
    return MotionClip(
        reader.path.stem,
        tuple(_joints(skeleton)),
        positions,
        matrices,
        1.0 / (USUAL_RATE if rate is None else rate),
        skeleton.unit,
        unmoved=tuple(p.name for p in skeleton.parts if p.dof and p.name not in tables),
    )


def _joints(skeleton: _Skeleton) -> Iterator[Joint]:
    for part, parent in zip(skeleton.parts, skeleton.parents, strict=True):
        if parent < 0:
            yield Joint(part.name, parent, part.position)
        else:
            above = skeleton.parts[parent]
            yield Joint(part.name, parent, above.direction * above.length, _tip(part))


def _tip(part: _Part) -> FloatArray:
    return part.direction * part.length


def _poses(skeleton: _Skeleton, tables: dict[str, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Positions (T, J, 3) and rotations (T, J, 3, 3), each in the parent's frame."""
    frames = len(tables[ROOT])
    offsets = np.array([joint.offset for joint in _joints(skeleton)])
    positions = np.tile(offsets, (frames, 1, 1))
    matrices = np.tile(np.eye(3), (frames, len(skeleton.parts), 1, 1))
    for j, part in enumerate(skeleton.parts):
        table = tables.get(part.name)
        if table is None:
            continue
        spins = [c for c, name in enumerate(part.dof) if name[0] == "r"]
        angles = table[:, spins] * skeleton.degree
        axes = ["xyz".index(part.dof[c][1]) for c in spins]
        # The first of the order turns first: it stands last in the product.
        turn = euler_matrices(axes[::-1], angles[:, ::-1])
        matrices[:, j] = part.axis @ turn @ part.axis.T
        for c, name in enumerate(part.dof):
            if name[0] == "t":
                positions[:, j, "xyz".index(name[1])] += table[:, c]
    return positions, matrices


# ---------------------------------------------------------------- skeleton


def _read_asf(reader: Reader) -> _Skeleton:
    sections = _sections(reader)
    for needed in ("root", "bonedata", "hierarchy"):
        if needed not in sections:
            reader.fail(reader.last_line, f"the file ends without a section :{needed}")
    length, degree = _units(reader, sections.get("units", []))
    root = _root(reader, sections["root"], degree)
    bones = _bones(reader, sections["bonedata"], degree)
    parts, parents = _hierarchy(reader, sections["hierarchy"], {ROOT: root, **bones})
    return _Skeleton(parts, parents, degree, _plausible_unit(length, parts, parents))


def _sections(reader: Reader) -> dict[str, list[Line]]:
    """Lines by section, comments apart; a section's own line stays first."""
    sections: dict[str, list[Line]] = {}
    current: list[Line] | None = None
    for line in reader.lines:
        word = line.words[0]
        if word.startswith(":"):
            current = sections.setdefault(word[1:].lower(), [])
            current.append(line)
        elif word.startswith("#"):
            continue
        elif current is None:
            reader.fail(line.number, "an ASF file begins with a section such as :version")
        else:
            current.append(line)
    return sections


def _units(reader: Reader, lines: list[Line]) -> tuple[float, float]:
    """The scale of lengths, 1/inch, and radians per unit of angle."""
    length, degree = 1.0, pi / 180.0
    for line in lines[1:]:
        if line.starts("length"):
            length = float(reader.numbers(line.number, line.words[1:], 1)[0])
            if length <= 0.0:
                reader.fail(line.number, "the unit of length is not positive")
        elif line.starts("angle") and line.words[1:2] == ["rad"]:
            degree = 1.0
    return length, degree


def _plausible_unit(length: float, parts: list[_Part], parents: list[int]) -> float | None:
    """An inch over the length, as Acclaim has it, unless no figure can be so small or large."""
    unit = INCH / length
    ends = np.zeros((len(parts), 3))
    for j, parent in enumerate(parents):
        if parent >= 0:
            ends[j] = ends[parent] + _tip(parts[j])
    size = float(np.max(np.ptp(ends, axis=0)))
    return unit if 0.5 <= unit * size <= 3.0 or likely_unit(size) == unit else None


def _root(reader: Reader, lines: list[Line], degree: float) -> _Part:
    root = _Part(ROOT, lines[0].number)
    order, turn = "XYZ", np.zeros(3)
    for line in lines[1:]:
        if line.starts("order"):
            root.dof = reader.channels(line.number, line.words[1:], _DOF)
        elif line.starts("axis"):
            order = _axis_order(reader, line, line.words[1:])
        elif line.starts("position"):
            root.position = reader.numbers(line.number, line.words[1:], 3)
        elif line.starts("orientation"):
            turn = reader.numbers(line.number, line.words[1:], 3) * degree
    if not root.dof:
        reader.fail(lines[0].number, "the root has no order of channels")
    root.axis = _axis_frame(order, turn)
    return root


def _bones(reader: Reader, lines: list[Line], degree: float) -> dict[str, _Part]:
    bones: dict[str, _Part] = {}
    block: list[Line] | None = None
    for line in lines[1:]:
        if line.starts("begin"):
            if block is not None:
                reader.fail(line.number, "'begin' before the 'end' of the bone above")
            block = [line]
        elif block is None:
            reader.fail(line.number, f"'{line.words[0]}' where 'begin' should stand")
        elif line.starts("end"):
            bone = _bone(reader, block, degree)
            if bone.name in bones or bone.name == ROOT:
                reader.fail(bone.line, f"a second bone '{bone.name}'")
            bones[bone.name] = bone
            block = None
        else:
            block.append(line)
    if block is not None:
        reader.fail(
            lines[-1].number, f"the bone that begins at line {block[0].number} has no 'end'"
        )
    return bones


def _bone(reader: Reader, block: list[Line], degree: float) -> _Part:
    bone = _Part("", block[0].number)
    missing = {"name", "direction", "length"}
    for line in block[1:]:
        keyword, values = line.words[0].lower(), line.words[1:]
        missing.discard(keyword)
        if keyword == "name":
            bone.name = "_".join(values)
            bone.line = line.number
        elif keyword == "direction":
            bone.direction = _direction(reader, line)
        elif keyword == "length":
            bone.length = float(reader.numbers(line.number, values, 1)[0])
        elif keyword == "axis":
            turn = reader.numbers(line.number, values[:3], 3) * degree
            bone.axis = _axis_frame(_axis_order(reader, line, values[3:]), turn)
        elif keyword == "dof":
            bone.dof = reader.channels(line.number, values, _DOF)
    if missing or not bone.name:
        reader.fail(block[0].number, f"a bone without {' and '.join(sorted(missing)) or 'name'}")
    return bone


def _direction(reader: Reader, line: Line) -> FloatArray:
    direction = reader.numbers(line.number, line.words[1:], 3)
    norm = float(np.linalg.norm(direction))
    return direction / (norm or 1.0)


def _axis_order(reader: Reader, line: Line, words: list[str]) -> str:
    order = "".join(words).upper() or "XYZ"
    if sorted(order) != ["X", "Y", "Z"]:
        reader.fail(line.number, f"'{order}' is no order of the axes X, Y and Z")
    return order


def _axis_frame(order: str, turn: FloatArray) -> FloatArray:
    """(3, 3) the frame that turn (3,), rad, about x, y and z in this order reaches."""
    axes = ["XYZ".index(letter) for letter in reversed(order)]
    return np.asarray(euler_matrices(axes, turn[None, axes])[0])


def _hierarchy(
    reader: Reader, lines: list[Line], named: dict[str, _Part]
) -> tuple[list[_Part], list[int]]:
    """Parts in the order of the hierarchy, parents first, with their parents' indices."""
    rows = lines[1:]
    if not rows or not rows[-1].starts("end"):
        reader.fail(lines[-1].number, "the hierarchy has no 'end'")
    parts, parents = [named[ROOT]], [-1]
    index = {ROOT: 0}
    for line in rows[:-1]:
        if line.starts("begin"):
            continue
        above, *children = line.words
        if above not in index:
            reader.fail(line.number, f"bone '{above}' has no parent above this line")
        for child in children:
            if child not in named or child in index:
                reader.fail(line.number, f"bone '{child}' is unknown or has a parent already")
            index[child] = len(parts)
            parts.append(named[child])
            parents.append(index[above])
    for name, part in named.items():
        if name not in index:
            reader.fail(part.line, f"bone '{name}' is missing from the hierarchy")
    return parts, parents


# ---------------------------------------------------------------- motion


def _read_amc(reader: Reader, skeleton: _Skeleton) -> dict[str, FloatArray]:
    """Each moving bone's channel values (T, n), in units and the skeleton's angles."""
    dof = {part.name: part.dof for part in skeleton.parts if part.dof}
    frames: list[dict[str, list[float]]] = []
    for line in reader.lines:
        bone = line.words[0]
        if bone.startswith(("#", ":")):
            _check_angles(reader, line, skeleton.degree)
        elif len(line.words) == 1 and bone.isdecimal():
            _check_bones(reader, line.number, frames)
            frames.append({})
        elif bone not in dof:
            reader.fail(line.number, f"bone '{bone}' has no channels in the ASF file")
        elif not frames:
            reader.fail(line.number, "a bone's values before the first frame's number")
        elif bone in frames[-1]:
            reader.fail(line.number, f"bone '{bone}' twice in frame {len(frames)}")
        else:
            frames[-1][bone] = reader.keys(line.number, line.words[1:], len(dof[bone]))
    _check_bones(reader, reader.last_line, frames)
    if not frames or ROOT not in frames[0]:
        reader.fail(reader.last_line, "the file ends without a frame that moves the root")
    tables = {bone: np.array([frame[bone] for frame in frames]) for bone in frames[0]}
    owners = [bone for bone, table in tables.items() for _ in table[0]]
    require_finite(np.hstack(list(tables.values())), owners)
    return tables


def _check_angles(reader: Reader, line: Line, degree: float) -> None:
    """The motion's unit of angle must be the skeleton's: a mix is a mistake, not a motion."""
    told = {":degrees": False, ":radians": True}.get(line.words[0].lower())
    if told is not None and told != (degree == 1.0):
        reader.fail(line.number, f"{line.words[0]} contradicts the ASF file's unit of angle")


def _check_bones(reader: Reader, line: int, frames: list[dict[str, list[float]]]) -> None:
    """The last frame so far, which ends at this line, must move the bones of the first."""
    if not frames:
        return
    missing = sorted(frames[0].keys() - frames[-1].keys())
    if missing:
        reader.fail(line, f"frame {len(frames)} ends without bone '{missing[0]}'")
    extra = sorted(frames[-1].keys() - frames[0].keys())
    if extra:
        reader.fail(line, f"frame {len(frames)} has bone '{extra[0]}', the first frame has not")
