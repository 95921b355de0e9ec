"""Bones are mapped by themselves, by hand, and by presets that are kept as files."""

from __future__ import annotations

from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")

from hangtime.bridge.constraints import bone_presets
from hangtime.bridge.constraints.bone_mapping import evidence_of, missing_parts
from hangtime.devtools.rigs.actor import actor
from hangtime.devtools.rigs.build import build
from hangtime.devtools.rigs.layout import layouts
from hangtime.solver.skeleton.mapping import Evidence

pytestmark = pytest.mark.usefixtures("_enabled")
RIGS = {layout.key: layout for layout in layouts()}


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bone_presets, "preset_folder", lambda: tmp_path / "kept")


def made(key: str) -> bpy.types.Object:
    armature = build(RIGS[key], actor())
    bpy.context.view_layer.objects.active = armature
    assert bpy.ops.hangtime.find_bones() == {"FINISHED"}
    return armature


def bone(armature: bpy.types.Object, part: str) -> str:
    return armature.hangtime.parts[part].bone


def test_a_convention_is_named_and_sure() -> None:
    settings = made("mixamo").hangtime
    assert settings.convention == "Mixamo"
    assert missing_parts(settings) == []
    assert evidence_of(settings.parts["left shank"]) is Evidence.NAME_AND_SHAPE


def test_a_rig_in_german_is_mapped_and_says_that_it_is_by_its_shape() -> None:
    settings = made("german").hangtime
    assert settings.convention == ""
    assert settings.parts["left shank"].bone == "Unterschenkel_links"
    assert evidence_of(settings.parts["left shank"]) is Evidence.SHAPE
    assert missing_parts(settings) == []


def test_a_choice_is_kept_as_a_preset_and_applied_to_another_armature() -> None:
    first = made("gibberish")
    first.hangtime.parts["left toe"].bone = "uta7"
    assert evidence_of(first.hangtime.parts["left toe"]) is Evidence.CHOSEN
    assert bpy.ops.hangtime.save_bone_preset(name="Mine") == {"FINISHED"}
    assert bone_presets.preset_names() == ["Mine"]
    second = made("gibberish")
    assert bone(second, "left toe") == "ya7"
    assert bpy.ops.hangtime.apply_bone_preset(name="Mine") == {"FINISHED"}
    assert bone(second, "left toe") == "uta7"
    assert bpy.ops.hangtime.find_bones() == {"FINISHED"}
    assert bone(second, "left toe") == "uta7"
    assert bpy.ops.hangtime.remove_bone_preset(name="Mine") == {"FINISHED"}
    assert bone_presets.preset_names() == []
    for name in ("Mine", " "):
        for ask in (bpy.ops.hangtime.remove_bone_preset, bpy.ops.hangtime.apply_bone_preset):
            with pytest.raises(RuntimeError, match="There is no bone preset"):
                ask(name=name)


def test_presets_are_exported_and_imported(tmp_path: Path) -> None:
    armature = made("spanish")
    armature.hangtime.parts["head"].bone = "cuello"
    path = tmp_path / "handed on.toml"
    assert bpy.ops.hangtime.export_bone_preset(filepath=str(path)) == {"FINISHED"}
    assert '"left shank" = "pantorrilla_izq"' in path.read_text(encoding="utf-8")
    other = made("spanish")
    assert bpy.ops.hangtime.import_bone_preset(filepath=str(path)) == {"FINISHED"}
    assert bone(other, "head") == "cuello"
    assert bone_presets.preset_names() == ["handed on"]


@pytest.mark.parametrize("path", ["", "/"])
def test_a_preset_is_not_exported_without_a_name(path: str) -> None:
    made("spanish")
    with pytest.raises(RuntimeError, match="Error: No file is given"):
        bpy.ops.hangtime.export_bone_preset(filepath=path)


def test_a_preset_is_overwritten_only_where_that_is_asked_for() -> None:
    armature = made("spanish")
    assert bpy.ops.hangtime.save_bone_preset(name="Mine") == {"FINISHED"}
    armature.hangtime.parts["head"].bone = "cuello"
    with pytest.raises(RuntimeError, match="already: choose another name, or tick Replace"):
        bpy.ops.hangtime.save_bone_preset(name="Mine")
    kept = bone_presets.read_preset(bone_presets.preset_path("Mine"))
    assert kept["head"] != "cuello"
    assert bpy.ops.hangtime.save_bone_preset(name="Mine", replace=True) == {"FINISHED"}
    assert bone_presets.read_preset(bone_presets.preset_path("Mine"))["head"] == "cuello"


def test_an_imported_preset_leaves_another_of_the_same_name_alone(tmp_path: Path) -> None:
    armature = made("spanish")
    path = tmp_path / "Mine.toml"
    assert bpy.ops.hangtime.save_bone_preset(name="Mine") == {"FINISHED"}
    armature.hangtime.parts["head"].bone = "cuello"
    assert bpy.ops.hangtime.export_bone_preset(filepath=str(path)) == {"FINISHED"}
    for _ in range(2):  # what is there already is not kept once more
        assert bpy.ops.hangtime.import_bone_preset(filepath=str(path)) == {"FINISHED"}
        assert bone_presets.preset_names() == ["Mine", "Mine 2"]


def test_a_preset_of_another_rig_says_what_is_lacking() -> None:
    made("german")
    assert bpy.ops.hangtime.save_bone_preset(name="German") == {"FINISHED"}
    armature = made("japanese")
    assert bpy.ops.hangtime.apply_bone_preset(name="German") == {"FINISHED"}
    assert bone(armature, "left shank") == "左すね"


def test_a_file_that_is_no_preset_is_refused(tmp_path: Path) -> None:
    made("german")
    path = tmp_path / "empty.toml"
    path.write_text("mass = 70\n", encoding="utf-8")
    with pytest.raises(RuntimeError, match=r"Bone preset .*empty\.toml: names no bones"):
        bpy.ops.hangtime.import_bone_preset(filepath=str(path))
    with pytest.raises(RuntimeError, match="No file is given"):
        bpy.ops.hangtime.import_bone_preset(filepath="")


def test_a_name_that_no_file_can_have_is_refused() -> None:
    made("german")
    with pytest.raises(RuntimeError, match=r"Nothing can be written to .*xxx"):
        bpy.ops.hangtime.save_bone_preset(name="x" * 300)
    with pytest.raises(RuntimeError, match="There is no bone preset “xxx"):
        bpy.ops.hangtime.remove_bone_preset(name="x" * 300)
    with pytest.raises(RuntimeError, match="There is no bone preset “xxx"):
        bpy.ops.hangtime.apply_bone_preset(name="x" * 300)


@pytest.mark.slow
def test_a_rest_pose_on_the_first_frame_is_told_and_left_out() -> None:
    armature = build(RIGS["mixamo"], actor())
    bpy.context.view_layer.objects.active = armature
    first = actor().frames[0]
    for posed in armature.pose.bones:
        posed.rotation_quaternion = (1.0, 0.0, 0.0, 0.0)
        posed.keyframe_insert("rotation_quaternion", frame=first)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert armature.hangtime.use_range
    assert armature.hangtime.first_frame == first + 1
