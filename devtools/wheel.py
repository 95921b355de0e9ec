"""Makes the wheel for machines without Blender: `hangtime-batch`, and of the package what it needs.

What `batch` imports, and what that imports, goes in; the rest of the package needs Blender. In the
wheel the package is laid out as in the extension, so relative imports mean the same in both.
"""

import ast
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from pathlib import Path

from .environment.virtual_environment import ROOT

PACKAGE = ROOT / "__init__.py"
BEGIN = ROOT / "batch"
MANIFEST = "blender_manifest.toml"  # tells the version at run time too
OF_BLENDER = {"bpy", "bpy_extras", "bmesh", "gpu", "mathutils"}
MADE_AT = "1577836800"  # s since 1970, the first of 2020: the same sources make the same bytes

PROJECT = """\
[build-system]
requires = ["flit_core==3.12.0"]
build-backend = "flit_core.buildapi"

[project]
name = "hangtime"
version = "{version}"
description = "Adapts recorded jumps by physics: batches on machines without Blender"
license = "GPL-3.0-or-later"
requires-python = ">=3.11"
dependencies = ["numpy>=1.26", "{casadi}"]

[project.optional-dependencies]
dask = ["distributed>=2025.1"]

[project.scripts]
hangtime-batch = "hangtime.batch.cli:main"
"""


class BuildError(Exception):
    """Says in one sentence what could not be built."""


def build_wheel(out: Path) -> Path:
    """Make the wheel in `out`; its path. Raises BuildError, as where a part of it needs Blender."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for file in wheel_files():
            target = folder / "hangtime" / file.relative_to(ROOT)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, target)
        version = tomllib.loads((ROOT / MANIFEST).read_text("utf-8"))["version"]
        pins = (ROOT / "requirements" / "casadi.txt").read_text().splitlines()
        casadi = next(line.split()[0] for line in pins if line.startswith("casadi"))
        project = PROJECT.format(version=version, casadi=casadi)
        (folder / "pyproject.toml").write_text(project, encoding="utf-8")
        command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-input", "--no-deps"]
        command += ["--disable-pip-version-check", "-w", scratch, scratch]
        variables = os.environ | {"SOURCE_DATE_EPOCH": MADE_AT}
        done = subprocess.run(command, env=variables, capture_output=True, text=True)
        if done.returncode != 0:
            raise BuildError(f"{done.stdout}{done.stderr}\nfailed: {' '.join(command)}")
        made = next(folder.glob("*.whl"))
        out.mkdir(parents=True, exist_ok=True)
        return Path(shutil.copy(made, out / made.name))


def wheel_files() -> list[Path]:
    """Every file that goes in: modules that `batch` comes to, their packages, and their data.

    Raises BuildError where one of the modules imports Blender as it loads.
    """
    modules = reached(set(BEGIN.rglob("*.py")))
    for module in sorted(modules):
        if blender := top_level_imports(module) & OF_BLENDER:
            where = module.relative_to(ROOT)
            raise BuildError(f"{where} is imported by a batch and needs {min(blender)}.")
    data = {
        file
        for folder in {module.parent for module in modules} - {ROOT}
        for file in folder.rglob("*")
        if file.is_file() and file.suffix not in (".py", ".pyc")
    }
    return sorted(modules | data | {ROOT / MANIFEST})


def reached(begin: set[Path]) -> set[Path]:
    """The modules and all within the package that they import, in functions too. What the package
    itself imports is for Blender, which registers it."""
    found: set[Path] = set()
    waiting = begin
    while waiting:
        found |= waiting
        waiting = {target for module in waiting - {PACKAGE} for target in imported(module)} - found
    return found


def imported(module: Path) -> Iterator[Path]:
    """Files of the package that one imports, with the packages that they are in."""
    for node in statements(ast.parse(module.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            folder = module.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            for name in ("", *(each.name for each in node.names)):
                for file in ((folder / name).with_suffix(".py"), folder / name / "__init__.py"):
                    if file.is_file():
                        yield file
    for folder in module.parents:
        yield folder / "__init__.py"
        if folder == ROOT:
            return


def top_level_imports(module: Path) -> set[str]:
    """First parts of the names that a module imports from elsewhere as it loads."""
    found = set()
    for node in ast.parse(module.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Import):
            found |= {each.name.partition(".")[0] for each in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level and node.module:
            found.add(node.module.partition(".")[0])
    return found


def statements(tree: ast.AST) -> Iterator[ast.AST]:
    """Every node but for those that only the type checker sees."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            continue
        yield node
        yield from statements(node)
