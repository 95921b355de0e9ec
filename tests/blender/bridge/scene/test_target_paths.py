"""Paths of points that follow a target: how many frames are looked at for them."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.fcurves import curves_of
from hangtime.bridge.constraint_kinds import hold, point, timing
from hangtime.bridge.constraints.requests import requests_of
from hangtime.bridge.constraints.target_paths import BESIDE, LONGER_ANYWAY, PUSH, Durations
from hangtime.bridge.rows.times import Clip
from hangtime.solver.data.requests import Hold, Path, PhaseTiming, Requests
from hangtime.solver.data.solver_options import SolverOptions
from hangtime.tests.blender.helpers import rows

pytestmark = pytest.mark.usefixtures("_enabled")

RATE = 24.0
PHASES = {"ground 1": (1.0, 40.0), "flight 1": (40.0, 60.0), "ground 2": (60.0, 150.0)}
CLIP = Clip((1.0, 150.0), tuple(PHASES), PHASES)
FRAME = rows.IN_FLIGHT  # of the rig's clip of 24


def at_frame(frame: float) -> SimpleNamespace:
    return SimpleNamespace(span="FRAME", first_frame=frame)


@pytest.fixture
def followed() -> bpy.types.Object:
    """An armature with a hand that follows, at one frame, what a keyed truck carries."""
    rig = rows.make_rig()
    truck, handle = (bpy.data.objects.new(name, None) for name in ("Truck", "Handle"))
    for each in (truck, handle):
        bpy.context.scene.collection.objects.link(each)
    handle.parent = truck
    for frame in (1, 100):
        truck.location.x = frame
        truck.keyframe_insert("location", frame=frame)
    for curve in curves_of(truck):
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    fields = {"span": "FRAME", "first_frame": FRAME, "target": handle, "name": "Grab"}
    rows.added(rig, point.KIND, "foot", **fields)
    return rig


@pytest.fixture
def looked_at() -> Iterator[list[float]]:
    """The frames at which the scene is evaluated."""
    found: list[float] = []

    def note(scene: bpy.types.Scene, *_: object) -> None:
        found.append(scene.frame_current_final)

    bpy.app.handlers.frame_change_post.append(note)
    yield found
    bpy.app.handlers.frame_change_post.remove(note)


def path_of(rig: bpy.types.Object, **options: object) -> Path:
    (made,) = requests_of(rig.hangtime, rig, **options).points
    assert made.path is not None
    return made.path


def test_one_frame_is_looked_at_with_its_neighbours_alone(followed, looked_at: list[float]) -> None:
    followed.hangtime.keep_times = True
    path = path_of(followed)
    assert path.frames == tuple(FRAME + k for k in (-2.0, -1.0, 0.0, 1.0, 2.0))
    assert [place[0] for place in path.places] == pytest.approx(path.frames)
    assert len(looked_at) <= len(path.frames) + 1  # and the artist's frame again


def test_what_was_taken_before_is_not_looked_at_again(followed, looked_at: list[float]) -> None:
    path = path_of(followed)
    assert looked_at
    looked_at.clear()
    assert path_of(followed, paths={"Grab": path}) == path
    assert not looked_at
    followed.hangtime.constraints["Grab"].target = None
    (made,) = requests_of(followed.hangtime, followed, paths={"Grab": path}).points
    assert made.path is None


def test_a_path_goes_on_to_where_holds_and_timings_take_the_row(followed) -> None:
    followed.hangtime.keep_times = True
    rows.added(followed, hold.KIND, name="Freeze", first_frame=4.0, seconds=1.0)
    fields = {"phase": "ground 1", "timing_by": "FACTOR", "factor": 2.0}
    rows.added(followed, timing.KIND, name="Slower", **fields)
    beside = Requests(holds=(Hold("Wait", 3.0, 0.5),))
    rate = bpy.context.scene.render.fps
    last = FRAME + 1.5 * rate + 4.0  # of the first stance, which takes twice as long
    assert path_of(followed, beside=beside).frames[-1] == pytest.approx(last + BESIDE)
    later = Requests(holds=(Hold("Wait", 20.0, 0.5),))
    assert path_of(followed, beside=later).frames[-1] == pytest.approx(last + BESIDE - 0.5 * rate)


def test_what_a_text_keeps_of_durations_counts(followed) -> None:
    free = path_of(followed).frames
    kept = Requests(solution=SolverOptions(keep_times=True))
    assert len(path_of(followed, beside=kept).frames) < len(free)


@pytest.mark.parametrize(
    ("durations", "frame", "sooner", "later"),
    [
        (Durations(RATE, free=False), 100.0, 0.0, 0.0),
        (Durations(RATE), 30.0, PUSH * 29.0, PUSH * 29.0),
        (Durations(RATE), 55.0, 15.0 + PUSH * 54.0, 30.0 + PUSH * 54.0),
        (Durations(RATE), 100.0, 20.0 + PUSH * 99.0, 40.0 + PUSH * 99.0),
        (Durations(48.0), 100.0, 20.0 + PUSH * 99.0, 48.0 * LONGER_ANYWAY + PUSH * 99.0),
        (Durations(RATE, timings=(PhaseTiming("Short", "flight 1", 0.5),), free=False), 100, 10, 0),
        (Durations(RATE, holds=(Hold("Long", 5.0, 1e9),), free=False), 100.0, 0.0, 30.0 * RATE),
    ],
)
def test_a_row_is_moved_by_what_changes_before_it(
    durations: Durations, frame: float, sooner: float, later: float
) -> None:
    first, last = durations.reached(at_frame(frame), CLIP)
    expected = (max(frame - sooner - BESIDE, 1.0), frame + later + BESIDE)
    assert (first, last) == pytest.approx(expected)


def test_without_flights_nothing_gets_other_durations() -> None:
    walk = Clip((1.0, 150.0), ("ground 1",), {"ground 1": (1.0, 150.0)})
    row = SimpleNamespace(span="PHASE", phase="ground 1")
    assert Durations(RATE).reached(row, walk) == (1.0, 150.0 + BESIDE)
