"""A process loads the solver with numpy and CasADi alone; import-linter reads sources only."""

import json
import subprocess
import sys
from pathlib import Path

from hangtime.devtools.environment.virtual_environment import ROOT

# Imports every module of hangtime.solver; prints what packages came, and which of them from files.
WALK = """
import importlib, json, pkgutil, runpy, sys
before = set(sys.modules)
runpy.run_path(sys.argv[1])["load"]()
import hangtime.solver as solver
for module in pkgutil.walk_packages(solver.__path__, "hangtime.solver."):
    importlib.import_module(module.name)
new = {name.partition(".")[0] for name in set(sys.modules) - before}
print(json.dumps([*new]))
print(json.dumps([n for n in new if getattr(sys.modules.get(n), "__file__", None)]))
"""


def test_a_fresh_interpreter_loads_the_solver_without_blender() -> None:
    command = [sys.executable, "-I", "-c", WALK, str(Path(ROOT, "devtools", "package.py"))]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    new, from_files = (set(json.loads(line)) for line in done.stdout.splitlines())
    assert not {"bpy", "mathutils", "bmesh", "gpu", "bpy_extras"} & new
    assert from_files - set(sys.stdlib_module_names) == {"hangtime", "numpy", "casadi"}
