"""What the mathematics may depend on: nothing of Blender's, and little beyond the library."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]

# Imports every module of hangtime.solver and prints what that loaded.
WALK = """
import importlib, json, pkgutil, runpy, sys
before = set(sys.modules)
runpy.run_path(sys.argv[1])["load"]()
import hangtime.solver as solver
names = [m.name for m in pkgutil.walk_packages(solver.__path__, "hangtime.solver.")]
for name in names:
    importlib.import_module(name)
new = {n.partition(".")[0] for n in set(sys.modules) - before}
files = [n for n in new if getattr(sys.modules.get(n), "__file__", None)]
print(json.dumps({"walked": names, "loaded": sorted(new), "from files": sorted(files)}))
"""


@pytest.fixture(scope="module")
def walk() -> dict[str, list[str]]:
    command = [sys.executable, "-I", "-c", WALK, str(ROOT / "devtools" / "package.py")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    answer: dict[str, list[str]] = json.loads(done.stdout)
    return answer


def test_every_module_of_the_solver_is_walked(walk: dict[str, list[str]]) -> None:
    files = {p.relative_to(ROOT) for p in (ROOT / "solver").rglob("*.py")}
    expected = {
        "hangtime." + ".".join(p.with_suffix("").parts).removesuffix(".__init__") for p in files
    }
    assert set(walk["walked"]) == expected - {"hangtime.solver"}


def test_the_solver_loads_nothing_of_blender(walk: dict[str, list[str]]) -> None:
    assert not {"bpy", "mathutils", "bmesh", "gpu", "bpy_extras"} & set(walk["loaded"])


def test_the_solver_needs_numpy_and_casadi_alone(walk: dict[str, list[str]]) -> None:
    foreign = set(walk["from files"]) - set(sys.stdlib_module_names)
    assert foreign <= {"hangtime", "numpy", "casadi"}
