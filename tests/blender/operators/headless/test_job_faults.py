"""Jobs that cannot be done: one line that says why, and what is left."""

import json
from dataclasses import asdict
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.batch.cells.reading import read_clip
from hangtime.bridge.files.import_clip import import_clip
from hangtime.operators.files.outbox import Outbox
from hangtime.operators.headless import commands
from hangtime.operators.headless.cli import main
from hangtime.solver.data.faults import OutsideKeys
from hangtime.solver.data.problem import MotionProblem
from hangtime.tests.blender.helpers.jobs import EDIT, PLAIN, run
from hangtime.tests.helpers.clips import mocap_path


def one_line(capsys) -> str:
    """What was said on the standard error: one line, no traceback."""
    said = capsys.readouterr().err
    assert said.count("\n") == 1, said
    assert "Traceback" not in said
    return said


@pytest.mark.slow
@pytest.mark.parametrize(
    ("recipe", "line"),
    [
        (EDIT.replace("ground 2", "ground 7"), "line 5"),
        (EDIT + 'points = ["Left nose"]\n', "line 8"),
        (EDIT + "offset = [1, 2, 3]\n", "line 8"),
        (EDIT.replace("forward", "foward"), "line 6"),
        (EDIT + '[bones]\n"left foot" = "Fuss.L"\n', "line 9"),
        (EDIT + '[[contact]]\nname = "Left nose 1"\nremove = true\n', "line 9"),
        (EDIT + '[[pin]]\nphase = "ground 2"\npoints = ["Left toe"]\nup = -0.4\n', "line 8"),
    ],
)
def test_what_is_wrong_in_a_recipe_is_said_with_its_line(
    recipe: str, line: str, clip: Path, tmp_path: Path, capsys
) -> None:
    assert run(tmp_path, clip, recipe) == 2
    assert f"edit.toml, {line}:" in one_line(capsys)
    assert not (tmp_path / "out").exists()


def test_frames_beyond_the_recording_are_told_with_those_that_it_has(
    clip: Path, tmp_path: Path, capsys
) -> None:
    assert run(tmp_path, clip, "frames = [400, 700]\n") == 2
    assert "from frame 1 to 3" in one_line(capsys)
    assert main(["doctor", str(clip), "--first", "400"]) == 2
    assert "from frame 1 to 3" in one_line(capsys)
    with pytest.raises(OutsideKeys):
        read_clip(clip, MotionProblem(frames=(400.0, 700.0)))


def test_frames_that_end_before_they_begin_are_told(clip: Path, capsys) -> None:
    assert main(["doctor", str(clip), "--first", "200", "--last", "100"]) == 2
    assert "end at 100, before they begin at 200; swap them" in one_line(capsys)


def test_a_loop_without_its_root_bone_is_refused_before_the_solve(tmp_path: Path, capsys) -> None:
    recipe = 'frames = [28, 122]\n[loop]\nroot = "root bone"\n'
    assert run(tmp_path, mocap_path("run_1.bvh"), recipe) == 2
    assert "no bone above the pelvis" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["adapted.blend", "adapted.fbx"])
def test_a_result_never_takes_the_place_of_its_recording(
    name: str, clip: Path, tmp_path: Path, capsys
) -> None:
    """As where the result of one job is the recording of the next."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    import_clip(clip)
    recording = tmp_path / "out" / name
    recording.parent.mkdir()
    if recording.suffix == ".blend":
        bpy.ops.wm.save_as_mainfile(filepath=str(recording))
    else:
        bpy.ops.export_scene.fbx(filepath=str(recording))
    before = recording.read_bytes()
    assert run(tmp_path, recording, EDIT, "--no-picture") == 2
    assert f"written over {recording}" in one_line(capsys)
    assert [recording] == list(recording.parent.iterdir())
    assert recording.read_bytes() == before


OBJECT = '[[object]]\nname = "Crate"\n'
MESH = "".join(f"v {corner}\n" for corner in ("0 0 0", "1 0 0", "0 1 0")) + "f 1 2 3\n"


@pytest.mark.parametrize(
    ("name", "text", "recipe", "options"),
    [
        ("report.txt", MESH, OBJECT + 'file = "out/report.txt"\n', ()),
        ("trajectory.npz", "a skeleton", "", ("--asf", "out/trajectory.npz")),
        ("report.json", "{}", None, ()),
    ],
)
def test_a_result_takes_the_place_of_nothing_that_it_is_made_from(
    name: str,
    text: str,
    recipe: str | None,
    options: tuple[str, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys,
) -> None:
    """An object's mesh, an AMC file's skeleton, and the recipe itself."""
    monkeypatch.chdir(tmp_path)
    read, edit = Path("out", name), Path("edit.toml")
    read.parent.mkdir()
    read.write_text(text)
    edit.write_text(recipe or "")
    asked = read if recipe is None else edit
    assert main(["adapt", "jump.amc", "--recipe", str(asked), "--out", "out", *options]) == 2
    assert f"written over {read}, from which it is made" in one_line(capsys)
    assert [read] == list(read.parent.iterdir())
    assert read.read_text() == text


def test_nor_of_what_its_scene_links(clip: Path, tmp_path: Path, capsys) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    library, scene = tmp_path / "out" / "adapted.blend", tmp_path / "scene.blend"
    library.parent.mkdir()
    bpy.data.libraries.write(str(library), {bpy.data.worlds.new("Sky")}, fake_user=True)
    import_clip(clip)
    with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
        wanted.worlds = ["Sky"]
    bpy.context.scene.world = bpy.data.worlds["Sky", str(library)]
    bpy.ops.wm.save_as_mainfile(filepath=str(scene))
    before = library.read_bytes()
    assert run(tmp_path, scene, EDIT, "--no-picture") == 2
    # Handlers of Rigify, which another test enabled, may complain when a file is opened.
    assert f"written over {library}" in capsys.readouterr().err.splitlines()[-1]
    assert library.read_bytes() == before


def test_a_truncated_clip_is_said_with_its_line(clip: Path, tmp_path: Path, capsys) -> None:
    short = tmp_path / "short.bvh"
    short.write_bytes(clip.read_bytes()[:20_000])
    assert run(tmp_path, short, EDIT) == 2
    assert "short.bvh, line " in one_line(capsys)
    assert not (tmp_path / "out").exists()


def test_too_little_memory_is_told_and_leaves_nothing(
    clip: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    def starved(*_: object) -> None:
        raise MemoryError("Unable to allocate 14.4 MiB")

    monkeypatch.setattr(commands, "solve", starved)
    assert run(tmp_path, clip, EDIT) == 1
    assert "too little memory" in one_line(capsys)
    assert not (tmp_path / "out").exists()


def test_a_clip_that_is_no_clip(tmp_path: Path, capsys) -> None:
    for name in ("none.fbx", "none.blend", "none.txt"):
        assert run(tmp_path, tmp_path / name, EDIT) == 2
        assert name in one_line(capsys)
    (tmp_path / "bad.blend").write_bytes(b"not a blend")
    assert run(tmp_path, tmp_path / "bad.blend", EDIT) == 2
    assert "bad.blend: Blender cannot open it, as it is damaged" in one_line(capsys)
    (tmp_path / "folder.fbx").mkdir()
    assert run(tmp_path, tmp_path / "folder.fbx", EDIT) == 2
    assert "folder.fbx cannot be opened (it is a folder)" in one_line(capsys)


def test_a_scene_whose_armature_is_in_a_file_that_is_gone(tmp_path: Path, capsys) -> None:
    library, scene = tmp_path / "rig.blend", tmp_path / "scene.blend"
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.data.libraries.write(str(library), {rig}, fake_user=True)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
        wanted.objects = ["Rig"]
    bpy.context.collection.objects.link(bpy.data.objects["Rig"])
    bpy.ops.wm.save_as_mainfile(filepath=str(scene))
    library.unlink()
    assert run(tmp_path, scene, EDIT) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert "rig.blend”, which is not there" in said


@pytest.mark.slow
def test_no_solution_leaves_a_report_and_nothing_of_an_earlier_run(
    clip: Path, tmp_path: Path, capsys
) -> None:
    """But for what was polished since, and what is somebody's own."""
    with Outbox(tmp_path / "out") as earlier:
        for name in ("adapted.fbx", "adapted.glb", "adapted.blend"):
            earlier.write_text(name, "of an earlier run")
        listed = {name: asdict(record) for name, record in earlier.records().items()}
        earlier.write_text("report.json", json.dumps({"files": listed}))
        earlier.deliver()
    own = {"adapted.blend", "film.mp4"}
    for name in own:
        (tmp_path / "out" / name).write_text("the artist's")
    assert run(tmp_path, clip, EDIT.replace("up = 0.2", "up = 8.0") + PLAIN) == 3
    said = capsys.readouterr()
    doubt, failure = said.err.splitlines()
    removed, left = said.out.split("Removed, as of an earlier run:")[1].split("Left as it is", 1)
    assert [Path(each).name for each in removed.split()] == ["adapted.fbx", "adapted.glb"]
    assert "since it was changed after it was written: " in left
    assert "since no report in its folder lists it: " in left
    assert "nobody jumps onto more than" in doubt
    assert "“Landing: " in failure
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert written - {"best_found.blend"} == {"report.json", "report.txt"} | own
    assert all((tmp_path / "out" / name).read_text() == "the artist's" for name in own)
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["status"] in ("stalled", "too many steps")
    assert set(report["files"]) == written - own - {"report.json"}


@pytest.mark.slow
def test_bones_that_a_usd_could_not_tell_apart_are_told_before_the_solve(
    clip: Path, tmp_path: Path, monkeypatch, capsys
) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bones = import_clip(clip).armature.data.bones
    bones["LeftToeBase"].name, bones["RightToeBase"].name = "toe!", "toe?"
    path = tmp_path / "named.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    monkeypatch.setattr(commands, "solve", lambda *_: pytest.fail("it was solved"))
    text = EDIT + '[export]\nformat = "usd"\n[bones]\n"left toe" = "toe!"\n"right toe" = "toe?"\n'
    assert run(tmp_path, path, text) == 2
    assert "would be one name in a USD file" in capsys.readouterr().err


def test_a_wrong_option_is_wrong_input(capsys) -> None:
    assert main(["adapt", "x.bvh", "--recipe", "x.toml", "--mass", "-3"]) == 2
    assert main(["adapt", "x.bvh"]) == 2
    assert main(["fly"]) == 2
    assert "Traceback" not in capsys.readouterr().err
    assert main(["--help"]) == 0


def test_a_job_without_a_clip(tmp_path: Path, capsys) -> None:
    (tmp_path / "edit.toml").write_text(EDIT)
    assert main(["adapt", "--recipe", str(tmp_path / "edit.toml")]) == 2
    assert "no recording" in one_line(capsys)
