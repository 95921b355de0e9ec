"""When the viewport's overlays are shown, and when they are made again; without a window."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from math import radians
from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.traces_store import keep
from hangtime.bridge.constraint_kinds import KINDS
from hangtime.bridge.rows.choices import Span
from hangtime.bridge.rows.times import NEVER
from hangtime.operators.solve.live import live
from hangtime.tests.blender.helpers import motions, rigs
from hangtime.tests.blender.helpers.overlays import (
    FRAME,
    adapted,
    bone_in_world,
    constrain,
    in_world,
    seen,
    shown,
    traced,
)
from hangtime.ui.overlay import handlers
from hangtime.ui.overlay.context.figure_cache import FigureCache
from hangtime.ui.overlay.context.layer import Layer, Part
from hangtime.ui.overlay.context.redraw import Redraw
from hangtime.ui.overlay.context.view_context import read_view
from hangtime.ui.overlay.geometry.shapes import Label, Shape, Standing
from hangtime.ui.overlay.layer_selection import layers
from hangtime.ui.overlay.layers import ghosts, limits, pins
from hangtime.ui.overlay.picture_cache import PictureCache
from mathutils import Matrix

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def armature() -> bpy.types.Object:
    return adapted(Matrix.Identity(4))


# ---------------------------------------------------------------- when things are shown


@pytest.mark.parametrize(
    ("switch", "parts"),
    [
        ("pins", {Part.CONTACTS, Part.POINTS}),
        ("limits", {Part.LIMITS}),
        ("poses", {Part.POSES}),
        ("forces", {Part.FORCES}),
        ("path", {Part.RECORDED_PATH, Part.ADAPTED_PATH, Part.CENTRE}),
        ("ghosts", {Part.RECORDED_GHOSTS, Part.ADAPTED_GHOSTS, Part.GHOST_NOW}),
        ("recording_too", {Part.RECORDED_GHOSTS}),
    ],
)
def test_every_switch_takes_its_own_away(
    armature: bpy.types.Object, switch: str, parts: set[Part]
) -> None:
    constrain(armature, KINDS["POSE"])
    every = set(shown(armature))
    setattr(bpy.context.scene.hangtime.view, switch, False)
    assert every - set(shown(armature)) == parts


def test_what_counts_now_stands_out(armature: bpy.types.Object) -> None:
    armature.hangtime.contacts.add().used = False
    layer = pins.contacts(seen(armature))
    assert [pin.standing for pin in layer.content[0]] == [
        Standing.NOW,
        Standing.LATER,
        Standing.OFF,
    ]


def test_phases_and_instants_tell_when_a_constraint_holds(armature: bpy.types.Object) -> None:
    row = constrain(armature, KINDS["CONE"], "shin", span=Span.PHASE.name)
    armature.hangtime.use_range = True
    armature.hangtime.first_frame, armature.hangtime.last_frame = 1, 24
    for phase, instant, expected in (
        ("ground 1", "THROUGHOUT", (1.0, 12.0)),
        ("flight 1", "MIDDLE", (15.0, 15.0)),
        ("ground 2", "END", (24.0, 24.0)),
        ("flight 9", "START", NEVER),
    ):
        row.phase, row.instant = phase, instant
        assert seen(armature).span(row) == pytest.approx(expected)


def test_overlays_follow_the_viewport(armature: bpy.types.Object) -> None:
    context = viewport()
    assert read_view(context) is not None
    context.space_data.overlay.show_overlays = False
    assert read_view(context) is None
    context.space_data.overlay.show_overlays = True
    armature.hide_set(True)
    assert read_view(context) is None
    armature.hide_set(False)
    bpy.context.scene.hangtime.view.show = False
    assert read_view(context) is None
    bpy.context.scene.hangtime.view.show = True
    bpy.data.objects.remove(armature)
    assert read_view(context) is None


def test_a_state_stays_the_same_object_until_something_changes(
    armature: bpy.types.Object,
) -> None:
    context, looks = viewport(), Redraw()
    first = looks.begin(context).state
    looks.end()
    assert looks.begin(context).state is first
    constrain(armature, KINDS["POSE"])
    second = looks.begin(context).state
    assert second != first
    assert looks.begin(context).state is second


def viewport() -> SimpleNamespace:
    """A context of a 3D viewport."""
    areas = (area for screen in bpy.data.screens for area in screen.areas)
    space = next(s for area in areas for s in area.spaces if s.type == "VIEW_3D")
    space.overlay.show_overlays = True
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    return SimpleNamespace(scene=scene, view_layer=view_layer, space_data=space)


def test_the_live_ghost_takes_the_place_of_the_adapted_motion(armature: bpy.types.Object) -> None:
    stored = shown(armature)
    ghost = traced(armature)
    live().armature, live().seen = armature.name, SimpleNamespace(traces=ghost)
    try:
        now, again = shown(armature), shown(armature)
    finally:
        live().seen = None
    assert now[Part.ADAPTED_GHOSTS].content != stored[Part.ADAPTED_GHOSTS].content
    assert now[Part.ADAPTED_GHOSTS].content == again[Part.ADAPTED_GHOSTS].content
    head, _ = bone_in_world(armature, "head")
    points = in_world(now[Part.GHOST_NOW])
    assert np.linalg.norm(points - head, axis=1).min() < 0.01 * armature.scale[0]


# ---------------------------------------------------------------- what is made again


class Counted:
    """Draws without a graphics card, and counts."""

    def __init__(self) -> None:
        self.built: list[Part] = []
        self.uploads = 0
        self.pictures = PictureCache(self._upload)
        self.figures = FigureCache()

    def _upload(self, shapes: Sequence[Shape]) -> tuple[Shape, ...]:
        self.uploads += 1
        return tuple(shapes)

    def draw(self, armature: bpy.types.Object, frame: float = FRAME) -> set[Part]:
        """The layers that had to be made."""
        self.built.clear()
        self.picture(armature, frame)
        return set(self.built)

    def picture(self, armature: bpy.types.Object, frame: float = FRAME) -> list[bytes | Label]:
        """What is drawn: arrays and labels."""
        view = seen(armature, frame)
        shapes, labels = self.pictures.of(
            view.state, lambda: map(self._counted, layers(view, self.figures))
        )
        arrays = [a.tobytes() for shape in shapes for a in (shape.points, shape.colours)]
        return [*arrays, *labels]

    def _counted(self, layer: Layer) -> Layer:
        def build() -> Iterator[Shape | Label]:
            self.built.append(layer.part)
            yield from layer.build()

        return replace(layer, build=build)


@pytest.fixture
def constrained(armature: bpy.types.Object) -> bpy.types.Object:
    bpy.context.scene.hangtime.view.all_limits = True
    constrain(armature, KINDS["CONE"], "thigh")
    constrain(armature, KINDS["ANGLE"], "shin")
    constrain(armature, KINDS["TWIST"], "head")
    constrain(armature, KINDS["POINT"], "foot", use_place=True)
    constrain(armature, KINDS["POSE"], span=Span.FRAME.name, first_frame=5.0)
    return armature


def test_nothing_is_made_again_while_nothing_changes(constrained: bpy.types.Object) -> None:
    counted = Counted()
    assert counted.draw(constrained) == set(shown(constrained))
    assert counted.draw(constrained) == set()
    assert counted.uploads == 1


def moves_target(armature: bpy.types.Object) -> None:
    armature.hangtime.constraints[3].target.location.z += 1.0


def selects_bone(armature: bpy.types.Object) -> None:
    bpy.context.scene.hangtime.view.all_limits = False
    armature.hangtime.active_constraint = -1
    bpy.ops.object.mode_set(mode="POSE")
    bone = armature.pose.bones["thigh"]
    (bone if hasattr(bone, "select") else bone.bone).select = True


def lengthens_bone(armature: bpy.types.Object) -> None:
    bpy.ops.object.mode_set(mode="EDIT")
    armature.data.edit_bones["head"].length *= 2.0
    bpy.ops.object.mode_set(mode="OBJECT")


def shows_result(armature: bpy.types.Object) -> None:
    armature.animation_data.action = armature.hangtime.adapted


def stretches_time(armature: bpy.types.Object) -> None:
    armature.animation_data.action.hangtime.times = "[[1.0, 24.0], [1.0, 12.0]]"


CHANGES: dict[str, Callable[[bpy.types.Object], object]] = {
    "contact": lambda armature: setattr(armature.hangtime.contacts[0], "at", (1.0, 2.0, 3.0)),
    "contact that counts": lambda armature: setattr(armature.hangtime.contacts[0], "used", False),
    "contact's frames": lambda armature: setattr(armature.hangtime.contacts[0], "end_frame", 5.0),
    "chosen contact": lambda armature: setattr(armature.hangtime, "active_contact", -1),
    "size": lambda armature: setattr(armature.hangtime, "measured_height", 0.9),
    "scene's unit": lambda _: setattr(bpy.context.scene.unit_settings, "scale_length", 1.0),
    "pose": lambda armature: setattr(armature.pose.bones["thigh"], "rotation_euler", (1, 0, 0)),
    "place": lambda armature: setattr(armature, "location", (5.0, 0.0, 0.0)),
    "missing bone": lambda armature: armature.hangtime.constraints[0].bones.clear(),
    "fewer constraints": lambda armature: armature.hangtime.constraints.remove(1),
    "target": moves_target,
    "selected bone": selects_bone,
    "length of a bone": lengthens_bone,
    "shown action": shows_result,
    "stretched time": stretches_time,
    "no result": lambda armature: setattr(armature.hangtime, "adapted", None),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_change_of_whatever_is_shown_is_seen(constrained: bpy.types.Object, change: str) -> None:
    empty = bpy.data.objects.new("Target", None)
    bpy.context.scene.collection.objects.link(empty)
    constrained.hangtime.constraints[3].target = empty
    constrained.pose.bones["thigh"].rotation_mode = "XYZ"
    bpy.context.view_layer.update()
    counted = Counted()
    before = counted.picture(constrained)
    CHANGES[change](constrained)
    bpy.context.view_layer.update()
    now = counted.picture(constrained)
    assert now == Counted().picture(constrained)
    assert now != before


def test_what_is_drawn_moves_along_with_the_armature(constrained: bpy.types.Object) -> None:
    """Only the line from where the recording has a held point is another one."""
    counted = Counted()
    counted.draw(constrained)
    constrained.location.x += 1.0
    bpy.context.view_layer.update()
    assert counted.draw(constrained) == {Part.POINTS}
    assert counted.uploads == 2


def test_another_frame_makes_again_what_depends_on_it(constrained: bpy.types.Object) -> None:
    counted = Counted()
    counted.draw(constrained)
    bpy.context.scene.frame_set(10)
    again = {Part.POINTS, Part.LIMITS, Part.FORCES, Part.CENTRE, Part.GHOST_NOW}
    assert counted.draw(constrained, 10.0) == again
    bpy.context.scene.frame_set(int(FRAME))
    assert counted.draw(constrained) == set()
    assert counted.uploads == 2


@pytest.mark.parametrize(
    ("index", "change", "part"),
    [
        (0, "half_angle", Part.LIMITS),
        (1, "upper", Part.LIMITS),
        (2, "lower", Part.LIMITS),
        (3, "place", Part.POINTS),
        (4, "pose_frame", Part.POSES),
    ],
)
def test_a_changed_constraint_is_made_again(
    constrained: bpy.types.Object, index: int, change: str, part: Part
) -> None:
    counted = Counted()
    row = constrained.hangtime.constraints[index]
    row.use_pose_frame = True
    counted.draw(constrained)
    value = getattr(row, change)
    setattr(row, change, (1.0, 2.0, 3.0) if change == "place" else value + 0.1)
    assert counted.draw(constrained) == {part}


def test_other_traces_are_drawn_again(constrained: bpy.types.Object) -> None:
    counted = Counted()
    counted.draw(constrained)
    keep(constrained.hangtime.adapted, traced(constrained), constrained.matrix_world)
    again = {Part.ADAPTED_PATH, Part.ADAPTED_GHOSTS, Part.FORCES, Part.CENTRE, Part.GHOST_NOW}
    assert counted.draw(constrained) == again | {Part.POSES}


def test_what_is_remembered_is_bounded(constrained: bpy.types.Object) -> None:
    counted = Counted()
    for frame in range(1, 20):
        counted.draw(constrained, float(frame))
    assert counted.draw(constrained, 19.0) == set()
    assert counted.draw(constrained, 1.0) != set()


# ---------------------------------------------------------------- what may be missing


def test_a_renamed_or_missing_bone_is_no_trouble(constrained: bpy.types.Object) -> None:
    constrained.data.bones["shin"].name = "calf"
    constrained.hangtime.constraints[0].bones[0].name = "nobody"
    constrained.hangtime.constraints[3].bones.clear()
    assert Counted().draw(constrained) == set(shown(constrained))


def test_a_figure_of_one_body_without_a_length_is_drawn() -> None:
    armature = motions.adapted()
    constrain(armature, KINDS["CONE"], "shin")
    constrain(armature, KINDS["POSE"])
    assert Counted().draw(armature, motions.FIRST) == set(shown(armature, motions.FIRST))


def test_an_armature_without_anything_shows_nothing() -> None:
    rigs.reset()
    armature = rigs.make_armature()
    for layer in layers(seen(armature), FigureCache()):
        assert list(layer.build()) == []


def test_handlers_come_and_go_without_a_graphics_card() -> None:
    drawing = "hangtime.ui.overlay.gpu_batches"
    sys.modules.pop(drawing, None)
    with ExitStack() as undo:
        overlay = handlers.add(undo)
        overlay.draw_labels()
    assert drawing not in sys.modules


def test_a_chosen_limit_that_is_off_is_still_seen(armature: bpy.types.Object) -> None:
    row = constrain(armature, KINDS["CONE"], "shin", half_angle=radians(30.0), used=False)
    assert [x.standing for x in limits.layer(seen(armature), FigureCache()).content[0]] == [
        Standing.OFF
    ]
    bpy.context.scene.hangtime.view.all_limits = True
    armature.hangtime.active_constraint = -1
    assert not limits.layer(seen(armature), FigureCache()).content[0]
    row.used = True
    assert limits.layer(seen(armature), FigureCache()).content[0]


def test_ghosts_stand_about_a_flight_and_fade_around_it() -> None:
    frames, flight = np.arange(1.0, 2753.0), (1400.0, 1460.0)
    shown = frames[ghosts.about(frames, flight, 120.0)]
    assert len(shown) == 9
    assert (shown[0], shown[-1]) == (1340.0, 1520.0)
    clear = [ghosts.nearness(frame, flight, 120.0) for frame in (1430.0, 1470.0, 1520.0, 1800.0)]
    assert clear[0] == 1.0
    assert clear == sorted(clear, reverse=True)
    assert clear[-1] == ghosts.FAINTEST
