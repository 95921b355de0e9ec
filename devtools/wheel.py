"""Makes the wheel for machines without Blender: `hangtime-batch`, and of the package what it needs.

What `batch` imports, and what that imports, goes in; the rest of the package needs Blender. In the
wheel the package is laid out as in the extension, so relative imports mean the same in both.
"""

import ast
import os
import shutil
import tempfile
import tomllib
from collections.abc import Iterator
from pathlib import Path

from .build import BuildError, run
from .environment.virtual_environment import ROOT

NAME = "hangtime"
OF_BLENDER = {"bpy", "bpy_extras", "bmesh", "gpu", "mathutils"}
MADE_AT = "1577836800"  # s since 1970, 2020-01-01: the same sources make the same bytes

PROJECT = """\
[build-system]
requires = ["flit_core=={flit}"]
build-backend = "flit_core.buildapi"

[project]
name = "{name}"
version = "{version}"
description = "Adapts recorded jumps by physics: batches on machines without Blender"
license = "GPL-3.0-or-later"
requires-python = ">=3.11"
dependencies = ["numpy>=1.26", "casadi=={casadi}"]

[project.optional-dependencies]
dask = ["distributed>=2026.1"]

[project.scripts]
hangtime-batch = "{name}.batch.cli:main"
"""


def build_wheel(out: Path) -> Path:
    """Make the wheel in `out`; its path. Raises BuildError, as where a part of it needs Blender."""
    out.mkdir(parents=True, exist_ok=True)
    version = tomllib.loads((ROOT / "blender_manifest.toml").read_text("utf-8"))["version"]
    with tempfile.TemporaryDirectory() as scratch:
        stage(Path(scratch), version)
        command = [os.sys.executable, "-m", "pip", "wheel", "--quiet", "--no-input", "--no-deps"]
        run([*command, "--disable-pip-version-check", "-w", scratch, scratch])
        made = next(Path(scratch).glob("*.whl"))
        return Path(shutil.copy(made, out / made.name))
