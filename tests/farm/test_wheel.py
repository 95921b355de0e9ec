"""The wheel, installed by pip into an environment that has neither Blender nor this checkout."""

import os
import subprocess
import sys
import venv
from pathlib import Path

from hangtime.batch.records.result import read_result
from hangtime.devtools.farm.plans import contents, plan_hops
from hangtime.devtools.wheel import build_wheel, outside, wheel_files

HERE = {"PYTHONPATH", "PYTHONHOME"}


def test_a_cell_is_solved_by_the_installed_wheel(tmp_path: Path, solved: dict[str, str]) -> None:
    wheel = build_wheel(tmp_path / "dist")
    assert wheel.stat().st_size < 2e6
    others = tmp_path / "readable by others"
    others.touch()
    assert wheel.stat().st_mode == others.stat().st_mode, "workers of other users install it"
    environment = tmp_path / "environment"
    # The libraries are those of these tests: to fetch them anew would tell nothing more.
    venv.EnvBuilder(with_pip=True).create(environment)
    site = next((environment / "lib").glob("python*/site-packages"))
    own = next(path for path in sys.path if path.endswith("site-packages"))
    borrowed = ("numpy", "casadi", "scipy_openblas32")
    for name in (*borrowed, "numpy.libs", *(p.name for p in Path(own).glob("*dist-info"))):
        if name.partition("-")[0].partition(".")[0] in borrowed:
            (site / name).symlink_to(Path(own) / name)
    python = environment / "bin" / "python"
    install = [python, "-m", "pip", "install", "--quiet", "--no-index", wheel]
    subprocess.run(install, check=True, capture_output=True)
    folder = tmp_path / "batch"
    manifest = plan_hops(folder, 12)
    first = manifest.cells[0].cell
    program = environment / "bin" / "hangtime-batch"
    variables = {name: value for name, value in os.environ.items() if name not in HERE}
    done = subprocess.run(
        [program, "cell", folder, first],
        cwd=tmp_path,
        env=variables,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert read_result(folder, first) is not None
    assert contents(folder, manifest) == {first: solved[first]}


def test_two_builds_are_the_same_bytes(tmp_path: Path) -> None:
    first, second = build_wheel(tmp_path / "a"), build_wheel(tmp_path / "b")
    assert first.read_bytes() == second.read_bytes()


def test_nothing_in_it_loads_blender_and_no_tests_or_tools_are_in_it() -> None:
    files = wheel_files()
    modules = [file for file in files if file.suffix == ".py"]
    assert not any(outside(module) & {"bpy", "mathutils"} for module in modules)
    root = Path(__file__).resolve().parents[2]
    folders = {file.relative_to(root).parts[0] for file in files}
    assert folders == {
        *("__init__.py", "blender_manifest.toml", "batch", "bridge", "operators", "solver", "ui")
    }
