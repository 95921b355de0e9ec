"""Plots at the foot of the viewport: what is shown of which motion, when it is made, and saving."""

from __future__ import annotations

import csv
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.traces_store import keep
from hangtime.bridge.plots.charts import plotted
from hangtime.bridge.plots.curves import Cap, Chart
from hangtime.tests.blender.helpers import motions, regions, rigs
from hangtime.ui.plots import handler

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def armature() -> bpy.types.Object:
    made = motions.adapted()
    bpy.context.scene.hangtime.view.plots = True
    return made


@pytest.fixture
def canvas(monkeypatch: pytest.MonkeyPatch) -> regions.Canvas:
    return regions.canvas(monkeypatch)


@pytest.fixture
def overlay(armature: bpy.types.Object) -> handler.PlotOverlay:
    assert armature is not None
    return handler.PlotOverlay()


def draw(overlay: handler.PlotOverlay, monkeypatch: pytest.MonkeyPatch, context: Any) -> None:
    monkeypatch.setattr(handler, "bpy", SimpleNamespace(context=context))
    overlay.draw()


def charts(armature: bpy.types.Object) -> dict[str, Chart]:
    found = plotted(armature, bpy.context.scene.hangtime.view)
    assert found is not None
    return {chart.title: chart for chart in found.charts()}


def constraint(armature: bpy.types.Object, kind: str, **values: Any) -> bpy.types.PropertyGroup:
    row = armature.hangtime.constraints.add()
    row.kind = kind
    for name, value in values.items():
        setattr(row, name, value)
    return row


# ---------------------------------------------------------------- which curves


def test_curves_of_the_recording_and_of_the_adapted_motion(armature: bpy.types.Object) -> None:
    bpy.context.scene.hangtime.view.plot_bone = "foot"
    shown = charts(armature)
    height = shown["Height of Centre of Mass"]
    assert [curve.name for curve in height.curves] == ["Recording", "Adapted"]
    assert height.curves[0].at(50.0) == pytest.approx(1.05)
    assert shown["Speed of Centre of Mass"].curves[1].at(50.0) == pytest.approx(5.0)
    force = shown["Contact Force"]
    assert [curve.name for curve in force.curves] == ["Adapted", "Adapted Vertical"]
    assert force.curves[0].at(20.0) == pytest.approx(1.2)
    assert force.curves[0].at(60.0) == 0.0
    assert shown["Torque of foot"].curves[0].at(50.0) == pytest.approx(100.0)


def test_the_torque_is_of_the_bone_named_else_of_the_active_one(armature: bpy.types.Object) -> None:
    view = bpy.context.scene.hangtime.view
    view.plot_forces = view.plot_com = False
    armature.data.bones.active = armature.data.bones["shin"]
    assert list(charts(armature)) == ["Torque of shin"]
    view.plot_bone = "foot"
    assert list(charts(armature)) == ["Torque of foot"]
    view.plot_bone = "finger"
    assert charts(armature)["Torque"].missing == "finger has no joint that is solved"


def test_before_an_adaptation_it_is_said_what_is_missing() -> None:
    shown = charts(motions.analysed())
    assert shown["Contact Force"].missing == "Adapt to see forces"
    assert shown["Torque"].missing == "Adapt to see torques"
    assert [c.name for c in shown["Height of Centre of Mass"].curves] == ["Recording"]


def test_caps_of_constraints_that_count_are_shown_where_they_hold(
    armature: bpy.types.Object,
) -> None:
    bpy.context.scene.hangtime.view.plot_bone = "foot"
    constraint(armature, "FORCE", name="Soft", peak=2.0, span="PHASE", phase="ground 2")
    constraint(armature, "FORCE", name="Off", peak=2.0, used=False)
    constraint(armature, "FORCE", name="Slippery", use_peak=False)
    frames = {"span": "FRAMES", "first_frame": 20.0, "last_frame": 30.0}
    constraint(armature, "TORQUE", name="Weak", torque=80.0, **frames).bones.add().name = "foot"
    constraint(armature, "TORQUE", name="Knee", torque=80.0).bones.add().name = "shin"
    constraint(armature, "TORQUE", name="Half", torque_by="SHARE").bones.add().name = "foot"
    shown = charts(armature)
    assert shown["Contact Force"].caps == (Cap("Soft", motions.LANDING, motions.LAST, 2.0),)
    assert shown["Torque of foot"].caps == (Cap("Weak", 20.0, 30.0, 80.0),)


# ---------------------------------------------------------------- drawing


def test_values_at_the_playhead_are_written(
    overlay: handler.PlotOverlay, canvas: regions.Canvas, monkeypatch: pytest.MonkeyPatch
) -> None:
    bpy.context.scene.frame_set(50)
    draw(overlay, monkeypatch, regions.viewport())
    assert {"Contact Force", "Height of Centre of Mass", "1.05", "5.00", "50"} <= set(canvas.words)
    assert "flight 1" in canvas.words


def test_nothing_is_made_again_when_only_the_frame_changes(
    overlay: handler.PlotOverlay,
    armature: bpy.types.Object,
    canvas: regions.Canvas,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for frame in range(20, 40):
        bpy.context.scene.frame_set(frame)
        draw(overlay, monkeypatch, regions.viewport())
    assert canvas.made == 2  # charts, playhead
    constraint(armature, "FORCE", name="Soft", peak=1.0)
    draw(overlay, monkeypatch, regions.viewport())
    assert canvas.made == 4
    assert "Soft 1.0" in canvas.words
    other = motions.traces(adapted=True)
    other.com[:, 2] += 1.0
    keep(armature.hangtime.adapted, other, armature.matrix_world)
    draw(overlay, monkeypatch, regions.viewport())
    assert canvas.made == 6


def test_charts_stay_clear_of_toolbar_and_sidebar(
    overlay: handler.PlotOverlay, canvas: regions.Canvas, monkeypatch: pytest.MonkeyPatch
) -> None:
    beside = (
        regions.region("TOOLS", "LEFT", 0, 0, 58, 640),
        regions.region("UI", "RIGHT", 900, 0, 300, 640),
        regions.region("ASSET_SHELF_HEADER", "BOTTOM", 0, 0, 1200, 25),  # of a closed shelf
    )
    draw(overlay, monkeypatch, regions.viewport(1200, 700, *beside))
    assert min(text.x for text in canvas.texts) >= 58.0
    assert max(text.x for text in canvas.texts) <= 900.0
    assert min(text.y for text in canvas.texts) < 25.0


def hidden(context: Any) -> None:
    context.space_data.overlay.show_overlays = False


def switched_off(context: Any) -> None:
    context.scene.hangtime.view.plots = False


def all_off(context: Any) -> None:
    view = context.scene.hangtime.view
    view.plot_forces = view.plot_com = view.plot_torque = False


def too_small(context: Any) -> None:
    context.region.height = 150


def deleted(_context: Any) -> None:
    bpy.data.objects.remove(bpy.data.objects["Rig"])


@pytest.mark.parametrize("spoil", [hidden, switched_off, all_off, too_small, deleted])
def test_nothing_is_drawn_where_nothing_is_wanted_or_there(
    spoil: Any,
    overlay: handler.PlotOverlay,
    canvas: regions.Canvas,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bpy.context.scene.hangtime.armature = bpy.data.objects["Rig"]
    context = regions.viewport()
    draw(overlay, monkeypatch, context)
    assert canvas.texts
    canvas.clear()
    spoil(context)
    draw(overlay, monkeypatch, context)
    assert canvas.texts == []


def test_an_armature_that_was_never_analysed_draws_nothing(
    canvas: regions.Canvas, monkeypatch: pytest.MonkeyPatch
) -> None:
    rigs.reset()
    rigs.make_armature()
    bpy.context.scene.hangtime.view.plots = True
    draw(handler.PlotOverlay(), monkeypatch, regions.viewport())
    assert canvas.texts == []


# ---------------------------------------------------------------- saving


def test_curves_are_saved_as_a_table(armature: bpy.types.Object, tmp_path: Path) -> None:
    assert armature is not None
    path = tmp_path / "plots.csv"
    assert bpy.ops.hangtime.save_plots(filepath=str(path)) == {"FINISHED"}
    with path.open(encoding="utf-8", newline="") as file:
        lines = list(csv.DictReader(file))
    assert len(lines) == len(motions.FRAMES)
    line = next(line for line in lines if line["Frame"] == "50")
    assert float(line["Recording: Height of Centre of Mass (m)"]) == pytest.approx(1.05)
    assert float(line["Adapted: Torque of shin (N m)"]) == pytest.approx(50.0)
    assert float(lines[0]["Adapted Vertical: Force of Left toe (body weights on Earth)"]) == 0.6
    assert [p.name for p in tmp_path.iterdir()] == ["plots.csv"]


def test_a_place_that_cannot_be_written_is_said(armature: bpy.types.Object, tmp_path: Path) -> None:
    assert armature is not None
    taken = tmp_path / "file"
    taken.write_text("")
    with pytest.raises(RuntimeError, match="file"):
        bpy.ops.hangtime.save_plots(filepath=str(taken / "plots.csv"))
    with pytest.raises(RuntimeError, match="No file is given"):
        bpy.ops.hangtime.save_plots(filepath="")


def test_without_a_motion_saving_is_grey_and_says_why(tmp_path: Path) -> None:
    rigs.reset()
    rigs.make_armature()
    with pytest.raises(RuntimeError, match="Press Analyze first"):
        bpy.ops.hangtime.save_plots(filepath=str(tmp_path / "plots.csv"))
