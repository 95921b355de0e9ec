"""Articulated rigid-body model of a figure (thesis 3.3.1), built from a recording.

A body's frame sits at its joint's centre (the bone's head) and is aligned with the world in the
rest pose, so a body's rotation is its bone's rotation times the inverse of the rest rotation.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import FloatArray, IntArray
from ..data.constants import STANDARD_GRAVITY, UP
from ..data.faults import NotComputable, StillBone, ZeroLengthBone
from ..data.problem import MassTable
from ..data.recording import Recording
from ..numerics.rotations import unit
from ..skeleton.ends import end_span
from ..skeleton.still_bones import without_still
from ..skeleton.tree import tree_of
from .anatomy import Part, Segment, Side, map_anatomy
from .joint_axes import JointAxes
from .joint_choice import MIN_BONE_LENGTH, chosen_axes, own_directions
from .mass_tables import BODY_DENSITY, BOX_ASPECT, MASS_FALLBACK, MASS_TABLES, SegmentInertia

MIN_BOX_LENGTH = 0.02  # m; of a body of almost no length, which still needs some inertia
LEVEL = np.array([1.0, 1.0, 0.0])
NECK_AREA_RATIO = 0.5  # a neck's cross-section as a share of the head's, to part their mass


@dataclass(frozen=True)
class Body:
    """Rigid body. Vectors (3,) in the body's frame, m; com and inertia (about com) in kg·m²."""

    name: str
    bone: str
    part: Part
    side: Side
    mass: float
    com: FloatArray
    inertia: FloatArray
    tip: FloatArray
    box_size: FloatArray  # (3,) extents along the box's own axes, the last is its length
    box_rotation: FloatArray  # (3, 3) box to body
    box_centre: FloatArray


@dataclass(frozen=True)
class Joint:
    """Joint of a body to its parent: `offset` (3,) m from parent's joint centre, parent's frame.

    parent: index of the parent body, -1 for the root, whose position is free.
    first: index of its first angle in the joint angles (n_angles,).
    """

    parent: int
    offset: FloatArray
    axes: JointAxes
    first: int

    @property
    def dofs(self) -> slice:
        """Its place in the joint angles (n_angles,)."""
        return slice(self.first, self.first + self.axes.dofs)


@dataclass(frozen=True)
class Character:
    """Kinematic tree: bodies and joints, one joint a body, parents first; the root is body 0.

    Configuration: centre of mass (3,) m and joint angles (n_angles,) rad, the root's three first.
    height: m. gravity: m/s², of the world that the figure is in. joined: bones of the trunk that
    are rigid to another, and that one's.
    """

    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    height: float
    gravity: float = STANDARD_GRAVITY
    joined: tuple[tuple[str, str], ...] = ()

    @property
    def mass(self) -> float:
        """Total, kg."""
        return sum(body.mass for body in self.bodies)

    @property
    def n_angles(self) -> int:
        """Number of joint angles, the root's three included."""
        last = self.joints[-1]
        return last.first + last.axes.dofs

    @property
    def n_dofs(self) -> int:
        """Degrees of freedom: the joint angles and the root's three translations."""
        return self.n_angles + 3

    @cached_property
    def body_of_angle(self) -> IntArray:
        """(n_angles,) index of the body whose joint each angle belongs to."""
        return np.repeat(np.arange(len(self.bodies)), [joint.axes.dofs for joint in self.joints])

    @cached_property
    def path_matrix(self) -> FloatArray:
        """(B, n_angles) path matrix: 1 where an angle lies between the root and a body."""
        moves = np.zeros((len(self.bodies), self.n_angles))
        for i in range(len(self.bodies)):
            for ancestor in self.ancestors(i):
                moves[i, self.joints[ancestor].dofs] = 1.0
        return moves

    @cached_property
    def mass_shares(self) -> FloatArray:
        """(B,) each body's share of the mass."""
        masses = np.array([body.mass for body in self.bodies])
        return np.asarray(masses / masses.sum())

    @cached_property
    def body_coms(self) -> FloatArray:
        """(B, 3) centres of mass of the bodies in their own frames, m."""
        return np.stack([body.com for body in self.bodies])

    def body(self, part: Part, side: Side = Side.MIDDLE) -> int | None:
        """Index of the first such body, None where the figure has none."""
        for i, body in enumerate(self.bodies):
            if body.part is part and body.side is side:
                return i
        return None

    def moved_by(self, request: str, bone: str) -> int:
        """Index of a bone's body. request: whose name a fault tells. Raises StillBone."""
        known, bone = tuple(body.bone for body in self.bodies), dict(self.joined).get(bone, bone)
        if bone not in known:
            raise StillBone(request, bone, known)
        return known.index(bone)

    def ancestors(self, body: int) -> list[int]:
        """Indices of the body and its ancestors up to the root, nearest first."""
        line = []
        while body >= 0:
            line.append(body)
            body = self.joints[body].parent
        return line


def build_character(
    recording: Recording,
    *,
    mass: float = 70.0,
    table: MassTable = MassTable.THESIS,
    chosen: Mapping[str, str] | None = None,
) -> Character:
    """Character of a recording: bodies from bones, joint axes from the clip, mass from a table.

    mass: total, kg. chosen: segment label -> bone name, see `map_anatomy`.
    Raises MissingPart, ZeroLengthBone.
    """
    segments, joined = without_still(recording, map_anatomy(recording.bones, chosen))
    parents = _parents(recording, segments)
    rotations = body_rotations(recording, [s.bone for s in segments])
    offsets = _offsets(recording, segments, parents, rotations)
    rest = [recording.bones[s.bone].head for s in segments]
    height = standing_height(segments, offsets)
    tips = [_tip(recording, segments, parents, offsets, i, height) for i in range(len(segments))]
    _check_lengths(recording, segments, tips)
    lengths = np.array([np.linalg.norm(tip) for tip in tips])
    masses, shares = _masses(segments, lengths, mass, table)
    forward = _forward(segments, rest)
    bodies, joints, frames, first = [], [], list[FloatArray](), 0
    for i, segment in enumerate(segments):
        bodies.append(_body(recording, segment, masses[i], shares[i], tips[i], forward))
        parent = parents[i]
        relative = rotations[:, i]
        if parent >= 0:
            relative = np.swapaxes(rotations[:, parent], -1, -2) @ relative
        frames.append(own_directions(segment, tips[i], forward))
        above = frames[parent] if parent >= 0 else None
        axes = chosen_axes(segment, relative, tips[i], above, frames[i])
        joints.append(Joint(parent, offsets[i], axes, first))
        first += axes.dofs
    return Character(tuple(bodies), tuple(joints), height, joined=joined)


def stature(recording: Recording, chosen: Mapping[str, str] | None = None) -> float:
    """The height of a recording's character, m, which takes a tenth of what the character does.

    Raises MissingPart, ZeroLengthBone where no bone has a length, and NotComputable where it is
    beyond all numbers.
    """
    segments, _ = without_still(recording, map_anatomy(recording.bones, chosen))
    rotations = body_rotations(recording, [s.bone for s in segments])
    parents = _parents(recording, segments)
    height = standing_height(segments, _offsets(recording, segments, parents, rotations))
    if not np.isfinite(height):
        raise NotComputable
    if height == 0.0:  # which no factor makes a person's
        thigh = next(segment for segment in segments if segment.part is Part.THIGH)
        raise ZeroLengthBone(recording.bones[thigh.bone].name)
    return height


def body_rotations(recording: Recording, bones: Sequence[int]) -> FloatArray:
    """(T, len(bones), 3, 3) rotations, body to world, of the bodies on these bones."""
    rest = np.stack([recording.bones[b].rotation for b in bones])
    return np.asarray(recording.rotations[:, bones] @ np.swapaxes(rest, -1, -2))


def _parents(recording: Recording, segments: Sequence[Segment]) -> list[int]:
    """Index of the nearest segment above each, -1 for the root."""
    tree = tree_of(recording.bones)
    by_bone = {s.bone: k for k, s in enumerate(segments)}
    lines = [tree.ancestors(segment.bone)[1:] for segment in segments]
    return [next((by_bone[b] for b in line if b in by_bone), -1) for line in lines]


def _offsets(
    recording: Recording,
    segments: Sequence[Segment],
    parents: Sequence[int],
    rotations: FloatArray,
) -> list[FloatArray]:
    """Each joint's centre in its parent's frame: the median over the clip, as bones may slide."""
    offsets = []
    for i, parent in enumerate(parents):
        if parent < 0:
            offsets.append(np.zeros(3))
            continue
        apart = recording.heads[:, segments[i].bone] - recording.heads[:, segments[parent].bone]
        local = np.einsum("tji,tj->ti", rotations[:, parent], apart)
        offsets.append(np.median(local, axis=0))
    return offsets


def _children(parents: Sequence[int], i: int) -> list[int]:
    return [k for k, parent in enumerate(parents) if parent == i]


def standing_height(segments: Sequence[Segment], offsets: Sequence[FloatArray]) -> float:
    """Standing height, m, from the segments' lengths: leg, trunk, neck, head and a sole."""
    leg = trunk = 0.0
    for i, segment in enumerate(segments):
        length = float(np.linalg.norm(offsets[i]))
        if segment.part in (Part.SHANK, Part.FOOT):
            leg += 0.5 * length
        elif segment.part in (Part.SPINE, Part.NECK, Part.HEAD):
            trunk += length
        elif segment.part is Part.THIGH:
            trunk += 0.5 * abs(float(offsets[i][2]))
    # Ankle's height and head's length by Drillis and Contini (1966): 0.039 H and about 0.12 H.
    return (leg + trunk) / (1 - 0.039 - 0.12)


def _tip(
    recording: Recording,
    segments: Sequence[Segment],
    parents: Sequence[int],
    offsets: Sequence[FloatArray],
    i: int,
    height: float,
) -> FloatArray:
    """The far end of a body in its frame: the next joint of its chain, or the end of a leaf."""
    part = segments[i].part
    children = _children(parents, i)
    if part is Part.PELVIS:
        hips = [offsets[k] for k in children if segments[k].part is Part.THIGH]
        tip = np.mean(hips, axis=0)
        shortest = 0.06 * height
        return np.asarray(tip if np.linalg.norm(tip) > shortest else -UP * shortest)
    follow = {Part.FOOT: (Part.TOE,), Part.SPINE: (Part.SPINE, Part.NECK, Part.HEAD)}.get(part)
    chain = [k for k in children if follow is None or segments[k].part in follow]
    if chain:
        # Some rigs hang neck and shoulders on the chest's own head: then it reaches to the next.
        short = float(np.linalg.norm(offsets[chain[0]])) < 0.01 * height
        after = _children(parents, chain[0]) if short and part is Part.SPINE else []
        return offsets[chain[0]] + (offsets[after[0]] if after else 0.0)
    onwards = _onwards(recording, segments, parents, i)
    return end_span(recording.bones, segments[i].bone, part, onwards, height)


def _onwards(
    recording: Recording, segments: Sequence[Segment], parents: Sequence[int], i: int
) -> FloatArray:
    """(3,) where a last segment would lead by those before it, at rest; 0 where they do not tell.

    Hands on from the forearm, heads up from the pelvis, feet and toes ahead.
    """
    rest = [recording.bones[s.bone].head for s in segments]
    match segments[i].part:
        case Part.HAND:
            return rest[i] - rest[parents[i]]
        case Part.HEAD:
            return rest[i] - rest[0]
        case Part.TOE:
            return np.asarray((rest[i] - rest[parents[i]]) * LEVEL)
        case Part.FOOT:
            return _forward(segments, rest)
    return np.zeros(3)


def _check_lengths(
    recording: Recording, segments: Sequence[Segment], tips: Sequence[FloatArray]
) -> None:
    may_be_short = (Part.PELVIS, Part.SPINE, Part.NECK, Part.CLAVICLE)
    for segment, tip in zip(segments, tips, strict=True):
        if segment.part not in may_be_short and np.linalg.norm(tip) < MIN_BONE_LENGTH:
            raise ZeroLengthBone(recording.bones[segment.bone].name)


def _masses(
    segments: Sequence[Segment], lengths: FloatArray, total: float, table: MassTable
) -> tuple[list[float], list[SegmentInertia]]:
    """Mass of every segment and the share it comes from; they sum to the total exactly.

    Spine bones share the spine's mass by length, neck and head the head's, foot and toe the
    foot's; what has no bone gives its mass to the part it hangs on.
    """
    shares = MASS_TABLES[table]
    parts = {(s.part, s.side) for s in segments}
    amounts: dict[tuple[Part, Side], float] = {}
    for part, share in shares.items():
        middle = part in (Part.PELVIS, Part.SPINE, Part.HEAD)
        for side in (Side.MIDDLE,) if middle else (Side.LEFT, Side.RIGHT):
            home = part if (part, side) in parts else MASS_FALLBACK.get(part, part)
            home_side = Side.MIDDLE if home is Part.SPINE else side
            amounts[home, home_side] = amounts.get((home, home_side), 0.0) + share.mass
    owner = {Part.NECK: Part.HEAD, Part.TOE: Part.FOOT}
    keys = [(owner.get(s.part, s.part), s.side) for s in segments]
    weights = np.maximum(lengths, MIN_BOX_LENGTH)  # a spine joint may sit on the next
    for i, segment in enumerate(segments):
        if segment.part is Part.NECK:
            weights[i] *= NECK_AREA_RATIO
    masses = []
    for i, key in enumerate(keys):
        together = sum(weights[k] for k, other in enumerate(keys) if other == key)
        masses.append(total * amounts[key] * float(weights[i] / together))
    scale = total / sum(masses)
    alone = [keys.count(key) == 1 for key in keys]
    used = [
        shares[key[0]] if single else SegmentInertia(0.0)
        for key, single in zip(keys, alone, strict=True)
    ]
    return [m * scale for m in masses], used


def _forward(segments: Sequence[Segment], rest: Sequence[FloatArray]) -> FloatArray:
    """The rest pose's forward direction: up x (right hip to left hip) turned ahead, (3,)."""
    hips = {s.side: rest[i] for i, s in enumerate(segments) if s.part is Part.THIGH}
    left = hips[Side.LEFT] - hips[Side.RIGHT]
    ahead = np.cross(left, UP)
    return unit(ahead) if np.linalg.norm(ahead) > 1e-6 else np.array([0.0, -1.0, 0.0])


def _body(
    recording: Recording,
    segment: Segment,
    mass: float,
    share: SegmentInertia,
    tip: FloatArray,
    forward: FloatArray,
) -> Body:
    """Rigid body of a segment: a uniform box, or published radii of gyration."""
    length = max(float(np.linalg.norm(tip)), MIN_BOX_LENGTH)
    direction = unit(tip) if np.linalg.norm(tip) > MIN_BONE_LENGTH else UP
    box = _box_frame(direction, forward)
    section = mass / (BODY_DENSITY * length)
    aspect = BOX_ASPECT.get(segment.part, 1.0)
    size = np.array([np.sqrt(section * aspect), np.sqrt(section / aspect), length])
    if share.gyration is None:
        squared = (size @ size - size**2) / 12.0  # a uniform box about its centre
    else:
        sagittal, transverse, longitudinal = share.gyration
        squared = (np.array([transverse, sagittal, longitudinal]) * length) ** 2
    centre = direction * length
    return Body(
        name=segment.label
        if segment.part not in (Part.SPINE, Part.NECK)
        else f"{segment.label} {recording.bones[segment.bone].name}",
        bone=recording.bones[segment.bone].name,
        part=segment.part,
        side=segment.side,
        mass=mass,
        com=share.centre * centre,
        inertia=mass * box @ np.diag(squared) @ box.T,
        tip=tip,
        box_size=size,
        box_rotation=box,
        box_centre=0.5 * centre,
    )


def _box_frame(direction: FloatArray, forward: FloatArray) -> FloatArray:
    """Box axes as columns: width (sideways), depth, length."""
    depth = forward if abs(float(forward @ direction)) < 0.8 else UP
    width = unit(np.cross(depth, direction))
    return np.stack([width, np.cross(direction, width), direction], axis=1)
