"""A worker solves BVH and Acclaim files in a process that never loads Blender."""

import json
import subprocess
import sys
from pathlib import Path

from hangtime.devtools.environment.virtual_environment import ROOT

WALK = """
import importlib, json, pkgutil, runpy, sys
sys.modules["bpy"] = None  # whoever imports it fails
runpy.run_path(sys.argv[1])["load"]()
import hangtime.batch as batch
names = [m.name for m in pkgutil.walk_packages(batch.__path__, "hangtime.batch.")]
for name in names:
    importlib.import_module(name)
loaded = {name.partition(".")[0] for name in sys.modules}
print(json.dumps([names, [n for n in ("mathutils", "bpy_extras", "bmesh") if n in loaded]]))
"""


def test_every_module_of_batches_loads_without_blender() -> None:
    command = [sys.executable, "-I", "-c", WALK, str(Path(ROOT, "devtools", "package.py"))]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    names, blender = json.loads(done.stdout)
    assert "hangtime.batch.cells.work" in names
    assert not blender
