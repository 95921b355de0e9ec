"""Figures built from recordings: mass, inertia, height and freedom."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.devtools.recordings import HOPS
from hangtime.solver.analysis.performance import perform
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import Character, build_character
from hangtime.solver.body.joint_axes import residual_angle
from hangtime.solver.body.mass_tables import MASS_TABLES
from hangtime.solver.data.faults import MissingPart, ZeroLengthBone
from hangtime.solver.data.problem import MassTable
from hangtime.solver.data.recording import Recording
from hangtime.tests.helpers.clips import load_recording

ADULTS = (
    "forward_jump_116cm.bvh",
    "run_1.bvh",
    "131_03_hop.bvh",
    HOPS,
    "cmu1_jumping_jacks.bvh",
    "rokoko_jesse_dance.bvh",
)
CHILD = "fair1_jumping.bvh"
JUMP = ADULTS[0]
ONCE = (Part.PELVIS, Part.SPINE, Part.HEAD)


@cache
def clip(relative: str) -> Recording:
    """At most the first two seconds."""
    recording = load_recording(relative)
    count = int(np.searchsorted(recording.times, 2.0))
    return recording.window(float(recording.frames[0]), float(recording.frames[count - 1]))


@cache
def character(relative: str) -> Character:
    return build_character(clip(relative))


def without(recording: Recording, words: tuple[str, ...]) -> Recording:
    """The recording with bones renamed so that nobody knows them."""
    bones = tuple(
        replace(b, name=f"x{i}") if b.name.endswith(words) else b
        for i, b in enumerate(recording.bones)
    )
    return replace(recording, bones=bones)


def shares(figure: Character) -> Mapping[tuple[Part, Side], float]:
    amounts: dict[tuple[Part, Side], float] = {}
    for b in figure.bodies:
        part = {Part.NECK: Part.HEAD, Part.TOE: Part.FOOT}.get(b.part, b.part)
        amounts[part, b.side] = amounts.get((part, b.side), 0.0) + b.mass / figure.mass
    return amounts


@pytest.mark.parametrize("table", MassTable)
def test_the_tables_sum_to_the_whole(table: MassTable) -> None:
    total = sum(s.mass * (1 if part in ONCE else 2) for part, s in MASS_TABLES[table].items())
    assert total == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("table", MassTable)
@pytest.mark.parametrize("gone", [(), ("Hand",), ("ToeBase",), ("Shoulder",), ("Hand", "ToeBase")])
def test_masses_sum_to_the_total(table: MassTable, gone: tuple[str, ...]) -> None:
    figure = build_character(without(clip(JUMP), gone), mass=63.0, table=table)
    assert figure.mass == pytest.approx(63.0, abs=1e-10)
    assert min(b.mass for b in figure.bodies) > 0.0


@pytest.mark.parametrize("table", MassTable)
def test_every_part_has_its_published_share(table: MassTable) -> None:
    found = shares(build_character(clip(JUMP), table=table))
    expected = {
        (part, side): share.mass
        for part, share in MASS_TABLES[table].items()
        for side in ((Side.MIDDLE,) if part in ONCE else (Side.LEFT, Side.RIGHT))
    }
    assert found == pytest.approx(expected, abs=1e-12)


def test_what_has_no_bone_gives_its_mass_to_where_it_hangs() -> None:
    table = MASS_TABLES[MassTable.THESIS]
    handless = shares(build_character(without(clip(JUMP), ("Hand",))))
    arm = table[Part.FOREARM].mass + table[Part.HAND].mass
    assert handless[Part.FOREARM, Side.LEFT] == pytest.approx(arm)
    unshouldered = shares(build_character(without(clip(JUMP), ("Shoulder",))))
    trunk = table[Part.SPINE].mass + 2 * table[Part.CLAVICLE].mass
    assert unshouldered[Part.SPINE, Side.MIDDLE] == pytest.approx(trunk)


@pytest.mark.parametrize("relative", [*ADULTS, CHILD])
def test_enough_freedom_and_little_of_the_recording_missed(relative: str) -> None:
    figure = character(relative)
    assert figure.n_dofs >= 42
    assert figure.joints[0].axes.dofs == 3
    angles = [slice(j.first, j.first + j.axes.dofs) for j in figure.joints]
    assert [i for a in angles for i in range(a.start, a.stop)] == list(range(figure.n_angles))
    performance = perform(clip(relative), figure)
    for i, joint in enumerate(figure.joints):
        turn = performance.rotations[:, i]
        if joint.parent >= 0:
            turn = np.swapaxes(performance.rotations[:, joint.parent], -1, -2) @ turn
        most = 1e-6 if joint.axes.dofs == 3 else 12.0
        assert np.degrees(residual_angle(joint.axes, turn)) < most, figure.bodies[i].name
        if joint.axes.dofs == 3:
            middle = performance.angles[:, joint.first + 1]
            assert np.abs(middle).max() < np.radians(75.0), figure.bodies[i].name


@pytest.mark.parametrize("relative", ADULTS)
def test_adults_are_of_plausible_height(relative: str) -> None:
    assert 1.5 < character(relative).height < 2.0


def test_a_child_is_smaller() -> None:
    assert 0.9 < character(CHILD).height < 1.5


@pytest.mark.parametrize("relative", [JUMP, CHILD, "rokoko_jesse_dance.bvh"])
def test_left_and_right_are_alike(relative: str) -> None:
    bodies = {(b.part, b.side): b for b in character(relative).bodies}
    for (part, side), left in bodies.items():
        if side is Side.LEFT:
            right = bodies[part, Side.RIGHT]
            assert left.mass == pytest.approx(right.mass, rel=0.02)
            assert np.linalg.norm(left.tip) == pytest.approx(np.linalg.norm(right.tip), rel=0.25)


@pytest.mark.parametrize("relative", [JUMP, CHILD])
def test_a_box_s_inertia_is_the_integral_over_it(relative: str) -> None:
    corner = (np.arange(20) + 0.5) / 20 - 0.5
    grid = np.stack(np.meshgrid(corner, corner, corner, indexing="ij"), axis=-1).reshape(-1, 3)
    for b in character(relative).bodies:
        points = grid * b.box_size @ b.box_rotation.T
        second = points.T @ points / len(points)
        integral = b.mass * (np.trace(second) * np.eye(3) - second)
        assert b.inertia == pytest.approx(integral, rel=0.01, abs=0.01 * np.abs(integral).max())
        assert np.linalg.det(b.box_rotation) == pytest.approx(1.0)


@pytest.mark.parametrize("table", MassTable)
@pytest.mark.parametrize("relative", [*ADULTS, CHILD])
def test_inertias_are_those_of_real_bodies(table: MassTable, relative: str) -> None:
    """Positive, and no principal moment above the sum of the others."""
    for b in build_character(clip(relative), table=table).bodies:
        low, middle, high = np.linalg.eigvalsh(b.inertia)
        assert low > 0.0
        assert high <= low + middle + 1e-12, b.name


def test_de_leva_s_centres_of_mass_lie_where_published() -> None:
    figure = build_character(clip(JUMP), table=MassTable.DE_LEVA)
    for part in (Part.THIGH, Part.SHANK, Part.UPPER_ARM, Part.FOREARM):
        index = figure.body(part, Side.LEFT)
        assert index is not None
        b = figure.bodies[index]
        along = b.com @ b.tip / (b.tip @ b.tip)
        assert along == pytest.approx(MASS_TABLES[MassTable.DE_LEVA][part].centre, abs=1e-9)


def test_the_figure_scales_with_the_recording() -> None:
    big = clip(JUMP)
    scaled = replace(
        big,
        heads=1.2 * big.heads,
        bones=tuple(replace(b, head=1.2 * b.head, tail=1.2 * b.tail) for b in big.bones),
    )
    taller = build_character(scaled)
    assert taller.height == pytest.approx(1.2 * character(JUMP).height, rel=1e-9)
    assert taller.mass == pytest.approx(70.0)


def test_a_bone_without_length_is_named() -> None:
    recording = clip(JUMP)
    foot = recording.index("LeftFoot")
    heads = recording.heads.copy()
    heads[:, foot] = heads[:, recording.index("LeftLeg")]
    with pytest.raises(ZeroLengthBone) as caught:
        build_character(replace(recording, heads=heads))
    assert caught.value.bone == "LeftLeg"


def test_a_missing_part_is_named() -> None:
    recording = clip(JUMP)
    keep = [not b.name.startswith(("LeftFoot", "LeftToe")) for b in recording.bones]
    index = np.cumsum(keep) - 1
    bones = tuple(
        replace(b, parent=int(index[b.parent]) if b.parent >= 0 else -1)
        for b, kept in zip(recording.bones, keep, strict=True)
        if kept
    )
    with pytest.raises(MissingPart) as caught:
        build_character(
            replace(
                recording,
                bones=bones,
                heads=recording.heads[:, keep],
                rotations=recording.rotations[:, keep],
            )
        )
    assert caught.value.part == "left foot"


def test_a_bone_of_no_known_name_is_found_by_the_skeleton_s_shape() -> None:
    figure = build_character(without(clip(JUMP), ("LeftFoot",)))
    foot = figure.body(Part.FOOT, Side.LEFT)
    assert foot is not None
    assert figure.bodies[foot].bone == f"x{clip(JUMP).index('LeftFoot')}"


def test_the_centre_of_mass_of_who_stands_lies_where_people_have_it() -> None:
    """About 55 to 57 % of the height (Winter 2009, ch. 4)."""
    figure = character(JUMP)
    performance = perform(clip(JUMP), figure)
    assert 0.53 < performance.com[0, 2] / figure.height < 0.6
