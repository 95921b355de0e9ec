"""The limits of the code base, on graphs and trees made up for it."""

from pathlib import Path

import pytest
from hangtime.devtools import layers_picture
from hangtime.devtools.checks import house


def row(count: int) -> dict[Path, set[Path]]:
    """A chain of files in one folder, each of which imports the next."""
    files = [Path("solver/deep") / f"m{i}.py" for i in range(count)]
    return {file: set(files[i + 1 : i + 2]) for i, file in enumerate(files)}


def test_every_kind_of_import_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sources = {
        "__init__.py": "",
        "solver/__init__.py": "",
        "solver/a.py": "from . import b",
        "solver/b.py": "def late():\n    from ..bridge.c import C",
        "bridge/__init__.py": "",
        "bridge/c.py": "import typing\nif typing.TYPE_CHECKING:\n    from ..ui import d",
        "ui/__init__.py": "",
        "ui/d.py": "import json",
    }
    for name, text in sources.items():
        path = tmp_path / "tiny" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    graph = house.import_graph(tmp_path / "tiny", "tiny")
    assert {str(file): set(map(str, targets)) for file, targets in graph.items() if targets} == {
        "solver/a.py": {"solver/b.py"},
        "solver/b.py": {"bridge/c.py"},
        "bridge/c.py": {"ui/d.py"},
    }


def test_a_crowded_folder_is_told_with_its_files() -> None:
    files = [*row(house.MAX_FILES)]
    assert not list(house.crowded(files))
    (told,) = house.crowded([*files, Path("solver/deep/__init__.py")])
    assert told.startswith("solver/deep has 15 files")
    assert "m13.py" in told


def test_a_deep_chain_is_told_from_its_top() -> None:
    assert not list(house.deep(row(house.MAX_DEPTH)))
    (told,) = house.deep(row(house.MAX_DEPTH + 1))
    assert "solver/deep/m0.py -> solver/deep/m1.py" in told


def test_a_circle_within_a_folder_is_told() -> None:
    graph = row(2)
    graph[Path("solver/deep/m1.py")] = {Path("solver/deep/m0.py")}
    (told,) = house.deep(graph)
    assert told.startswith("import circle: ")


def test_a_circle_of_folders_is_told_by_its_imports() -> None:
    a, b, c, d = (Path(name) for name in ("ui/a.py", "ui/b.py", "bridge/c.py", "bridge/d.py"))
    assert not list(house.circular({a: {c}, b: {d}}))
    (told,) = house.circular({a: {c}, d: {b}})
    assert told.startswith("circle of folders: ")
    assert "ui/a.py -> bridge/c.py" in told
    assert "bridge/d.py -> ui/b.py" in told


def test_a_class_that_two_files_define_is_told(tmp_path: Path) -> None:
    files = [tmp_path / "a.py", tmp_path / "b.py"]
    files[0].write_text("class Pin: ...\nclass _Own: ...\nclass Cone: ...\n")
    files[1].write_text("class Pin: ...\nclass _Own: ...\n")
    (told,) = house.ambiguous({file: house.public_classes(file) for file in files})
    assert told == f"class Pin is defined more than once: {files[0]}, {files[1]}"


def test_the_picture_of_the_layers_is_the_contracts() -> None:
    drawn = layers_picture.PICTURE.read_text(encoding="utf-8")
    assert drawn == layers_picture.draw(layers_picture.ROOT), (
        "run python3 devtools/layers_picture.py"
    )
